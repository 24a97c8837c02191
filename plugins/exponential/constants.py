#!/usr/bin/env python3
"""Recomputes the constants of the method `exponential` that follow from a derivation (THEORY.md).

Prints each beside the value in the sources and exits with 1 if a value of the sources is not what its derivation gives.
Run it from anywhere: python3 plugins/exponential/constants.py. Needs numpy.
"""
import pathlib
import re
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = "\n".join(
    path.read_text() for folder in ("integrators", "framework") for path in sorted((ROOT / folder).rglob("*.[hc]pp")))
LEGENDRE = (lambda s: 1 + 0 * s, lambda s: 2 * s - 1, lambda s: 6 * s * s - 6 * s + 1)
failures = 0


def in_code(pattern, below=np.inf):
    """The number, or quotient of numbers, that a pattern with one group finds in the sources."""
    found = {eval(text, {}) for text in re.findall(pattern, SOURCES)}
    found = {number for number in found if number < below}
    return found.pop() if len(found) == 1 else None


def constant(name, below=np.inf):
    """`below` leaves out constants of other methods that have the same name."""
    return in_code(rf"\b{name} = ([-\d./ e]+?)\s*[,;]", below)


def compare(name, code, computed, how, allowed, is_open=False):
    """`how`: "=": the code rounds `computed`, to within the factor `allowed`; ">=": the code is a bound of it, and at
    most `allowed` times as large. `is_open`: a difference is one of the open points of THEORY.md and no failure."""
    global failures
    holds = code is not None and computed <= code * (1 + 1e-9) <= allowed * computed * (1 + 1e-9)
    if how == "=":
        holds = code is not None and abs(code - computed) <= (allowed - 1) * abs(computed)
    failures += not holds and not (is_open and code is not None)
    shown = "not found" if code is None else f"{code:.7g}"
    remark = "" if holds else "<-- open point" if is_open else "<-- differs"
    print(f"{name:<48} {shown:>12} {how:>2}  {computed:<12.7g} {remark}".rstrip())


def note(text, *values):
    print(f"{text:<48} " + " ".join(f"{value:.6g}" for value in values))


def gauss(begin, end, points=160):
    x, w = np.polynomial.legendre.leggauss(points)
    return 0.5 * (end - begin) * x + 0.5 * (end + begin), 0.5 * (end - begin) * w


def moments(rise, a):
    """(2 k + 1) int_0^1 P_k F for F = (s - a)_+^rise."""
    s, w = gauss(a, 1.0, 8)
    return [(2 * k + 1) * np.sum(w * LEGENDRE[k](s) * (s - a) ** rise) for k in range(3)]


def remainder(rise, a, s):
    return np.where(s > a, np.maximum(s - a, 0.0) ** rise, 0.0) - sum(
        f * p(s) for f, p in zip(moments(rise, a), LEGENDRE))


PLACES = np.linspace(0.0, 1.0, 1001)[1:-1]


def running_integral(rise, a, s):
    """int_0^s (F - P F)"""
    f0, f1, f2 = moments(rise, a)
    return np.maximum(s - a, 0.0) ** (rise + 1) / (rise + 1) - (
        f0 * s + f1 * (s * s - s) + f2 * (2 * s ** 3 - 3 * s * s + s))


def hermite_functions(degree):
    """Rows: coefficients of 1, s, ... of the polynomials that are 1 in one of x, v (and a) at s = 0, then at s = 1."""
    n = degree + 1
    rows = []
    for s in (0.0, 1.0):
        for order in range(n // 2):
            rows.append([np.prod(np.arange(j, j - order, -1.0)) * s ** (j - order) if j >= order else 0.0
                         for j in range(n)])
    return np.linalg.inv(np.array(rows)).T


def value(coefficients, s, order=0):
    return np.polynomial.polynomial.polyval(s, np.polynomial.polynomial.polyder(coefficients, order) if order else
                                            coefficients)


def interpolated(degree, function, s, order):
    """Derivative `order` of the Hermite interpolant of function(s, derivative)."""
    half = (degree + 1) // 2
    data = [function(end, d) for end in (0.0, 1.0) for d in range(half)]
    return sum(y * value(h, s, order) for y, h in zip(data, hermite_functions(degree)))


def power_plus(exponent, a):
    """(s - a)_+^exponent / exponent! and its derivatives."""
    def function(s, d):
        left = exponent - d
        if left < 0:
            return np.zeros_like(s)
        return np.where(s > a, np.maximum(s - a, 0.0) ** left, 0.0) / float(np.prod(np.arange(1, left + 1)))
    return function


def worst_interpolation(degree, exponent, order):
    s = np.linspace(0.0, 1.0, 2001)
    worst = 0.0
    for a in PLACES[::2]:
        f = power_plus(exponent, a)
        worst = max(worst, np.abs(f(s, order) - interpolated(degree, lambda e, d: f(np.array(e), d), s, order)).max())
    return worst


def quintic_bound(order):
    """max_s int |d^order/ds^order of Peano's kernel| da: the sharp bound for |sixth derivative| <= 1."""
    a = (np.arange(4000) + 0.5) / 4000
    worst = 0.0
    for s in np.linspace(0.0, 1.0, 401):
        data = np.zeros((6, a.size))
        for d in range(3):
            data[3 + d] = (1 - a) ** (5 - d) / [120.0, 24.0, 6.0][d]
        own = np.maximum(s - a, 0.0) ** (5 - order) / [120.0, 24.0, 6.0][order]
        kernel = own - sum(y * value(h, s, order) for y, h in zip(data, hermite_functions(5)))
        worst = max(worst, np.abs(kernel).mean())
    return worst


def interpolation():
    print("\nInterpolation")
    s = np.linspace(0.0, 1.0, 100001)
    compare("kBump: max s (1-s)^2", constant("kBump"), (s * (1 - s) ** 2).max(), "=", 1 + 1e-8)
    compare("kHermite: max s^2 (1-s)^2/24", constant("kHermite"), (s ** 2 * (1 - s) ** 2).max() / 24, "=", 1 + 1e-8)
    compare("kQuintic: 384/46080", constant("kQuintic"), 384 / 46080, "=", 1 + 1e-12)
    compare("quintic_error x", 1 / in_code(r"fourth \* h \* h / ([\d.]+)"), quintic_bound(0), "=", 1.001)
    compare("quintic_error v", in_code(r"fourth \* h \* \(([\d. /]+)\)"), quintic_bound(1), "=", 1.002)
    compare("quintic_error a", 1 / in_code(r"h / 46080.0.*?fourth / ([\d.]+)"), quintic_bound(2), "=", 1.002)
    middle = [value(h, 0.5) for h in hermite_functions(5)]
    compare("is_smooth: weight of h (v0 - v1)", in_code(r"\((\d\.0 / 32\.0) \* h\)"), middle[1], "=", 1 + 1e-12)
    compare("is_smooth: weight of h^2 (a0 + a1)", 1 / in_code(r"\(h \* h / (64\.0)\)"), middle[2], "=", 1 + 1e-12)
    h = hermite_functions(5)
    steps = np.linspace(0.0, 1.0, 20001)
    size = lambda i, order: np.abs(value(h[i], steps, order))
    compare("departure x: of |v| h", in_code(r"\+ ([\d.]+) \* h \* of\[1\]"), (size(1, 0) + size(4, 0)).max(), ">=",
            1.5)
    compare("departure x: of |a| h^2", in_code(r"\+ ([\d.]+) \* h \* h \* of\[2\]"),
            (size(2, 0) + size(5, 0)).max(), ">=", 1.5)
    compare("departure v: of |v|", in_code(r"\(([\d.]+) \* of\[1\] \+ 0\.3"),
            1 + (size(3, 1) + size(1, 1) + size(4, 1)).max(), ">=", 1.5)
    compare("departure v: of |a| h", in_code(r"of\[1\] \+ ([\d.]+) \* h \* of\[2\]"), (size(2, 1) + size(5, 1)).max(),
            ">=", 3.5)
    compare("departure a: of |v|/h", in_code(r"\(([\d.]+) / h \* of\[1\]"),
            (size(3, 2) + size(1, 2) + size(4, 2)).max(), ">=", 1.6)
    compare("departure a: of |a|", in_code(r"/ h \* of\[1\] \+ ([\d.]+) \* of\[2\]"),
            1 + (size(2, 2) + size(5, 2)).max(), ">=", 1.5)
    turn = np.linspace(0.0, 2 * np.pi, 121)[:, None]
    for angle in (5.2643, 8.0, 15.0, 30.0):
        wave = lambda s, d: angle ** d * np.cos(angle * np.asarray(s) + turn + 0.5 * np.pi * d)
        s = np.linspace(0.0, 1.0, 801)
        off = np.abs(wave(s, 0) - interpolated(3, wave, s, 0)).max()
        compare(f"cubic, omega h = {angle}: departure", float(in_code(r"min\(2\.0 \+ ([\d.]+) \* angle\)")) * angle + 2.0,
                off, ">=", 3.0)


def discontinuities():
    print("\nOne discontinuity within a step, worst place")
    compare("kKinkedSlope: the same, v", constant("kKinkedSlope"), worst_interpolation(5, 3, 1), ">=", 1.1)
    compare("kJumpedSlope: (s-a)_+^2/2, quintic, v", constant("kJumpedSlope"), worst_interpolation(5, 2, 1), ">=", 1.1)
    s = np.linspace(0.0, 1.0, 4001)
    kink = max(np.abs(running_integral(1, a, s)).max() for a in PLACES)
    jump = max(np.abs(running_integral(0, a, s)).max() for a in PLACES)
    compare("kSlopeImpulse: max |int_0^s (F - P F)|, F = (s-a)_+", constant("kSlopeImpulse"), kink, "=", 1.01)
    compare("kJumpImpulse: the same, F = 1 beyond a", constant("kJumpImpulse"), jump, ">=", 1.01)


def speed_response(frequency, decay, s):
    """The speed of x'' + 2 decay x' + frequency^2 x = 0 after an impulse of 1, for each mode and each s."""
    root = np.sqrt((decay ** 2 - frequency ** 2).astype(complex))[:, None]
    slow, fast = root - decay[:, None], -root - decay[:, None]
    return ((slow * np.exp(slow * s) - fast * np.exp(fast * s)) / (slow - fast)).real


def unresolved(name, power, force):
    print(f"\n{name}(x) = min(A x^3, B, C/x): largest |int (F - P F) e^(i x s)|, {force}")
    bounds = re.search(name + r"\(double x\) \{\s*return std::min\(\{([\d.e-]+) \* x \* x \* x, ([\d.e-]+), ([\d.e-]+) / x\}\)", SOURCES)
    code = [float(text) for text in bounds.groups()] if bounds else [None] * 3
    angles = np.geomspace(0.3, 400.0, 300)
    worst = np.zeros(angles.size)
    partial = 0.0
    cubic = ends = 0.0
    for a in PLACES[4::10]:
        nodes = [gauss(0.0, a), gauss(a, 1.0)]
        s, w = (np.concatenate([part[i] for part in nodes]) for i in (0, 1))
        e = remainder(power, a, s)
        worst = np.maximum(worst, np.abs(np.exp(1j * np.outer(angles, s)) @ (w * e)))
        cubic = max(cubic, abs(np.sum(w * e * s ** 3)) / 6)
        ends = max(ends, np.abs(remainder(power, a, np.array([0.0, 1.0]))).sum())
        fine = (np.arange(4000) + 0.5) / 4000
        running = np.cumsum(np.exp(1j * np.outer(angles[::6], fine)) * remainder(power, a, fine), axis=1) / 4000
        partial = max(partial, np.abs(running).max())
    compare("A: max |int (F - P F) s^3|/6, x -> 0", code[0], cubic, "=", 1.01)
    compare("B: the largest over x", code[1], worst.max(), "=", 1.02)
    compare("C: max (x times the integral)", code[2], (angles * worst).max(), ">=", 1.1)
    note("   |F - P F| at both ends, the limit for large x", ends)
    note("   the largest up to any s, any x (not used)", partial)
    bound = np.minimum.reduce([code[0] * angles ** 3, np.full(angles.size, code[1]), code[2] / angles])
    low = (bound / worst).argmin()
    note("   min(...) over the true value: least, at x", (bound / worst)[low], angles[low])
    note("   x at the largest, and at the largest x times it", angles[worst.argmax()],
         angles[(angles * worst).argmax()])
    print("The same for the speed of a damped mode, x = h (omega^2 + 4 delta^2)^(1/2): 2 delta h/x, min(...) over the "
          "true value, at x")
    for share in (0.1, 0.3, 0.5, 0.7, 0.9, 1.0):
        frequency, decay = angles * np.sqrt(1 - share ** 2), 0.5 * angles * share
        worst = np.zeros(angles.size)
        for a in PLACES[4::10]:
            s, w = (np.concatenate([gauss(0.0, a)[i], gauss(a, 1.0)[i]]) for i in (0, 1))
            worst = np.maximum(worst, np.abs(speed_response(frequency, decay, 1 - s) @ (w * remainder(power, a, s))))
        ratio = bound / worst
        note("  ", share, ratio.min(), angles[ratio.argmin()])


def coupling_of_free_mass(theta=0.0, order=6):
    """Rows end, h speed, middle by P_0, P_1, P_2 for q'' + theta^2 q = f, h = 1."""
    table = np.zeros((3, 3))
    for row, (end, derivative) in enumerate(((1.0, 0), (1.0, 1), (0.5, 0))):
        s, w = gauss(0.0, end, 40)
        tau = end - s
        response = np.cos(theta * tau) if derivative else tau if theta == 0.0 else np.sin(theta * tau) / theta
        table[row] = [np.sum(w * response * p(s)) for p in LEGENDRE]
    return table


QUARTIC = np.array([[-5.0, 1.0, 16.0], [14.0, -3.0, -32.0], [-8.0, 2.0, 16.0]])


def projection_of_powers(begin, end):
    """Rows k: (2 k + 1) int_begin^end P_k s^j, j = 0 ... 4."""
    s, w = gauss(begin, end, 8)
    return np.array([[(2 * k + 1) * np.sum(w * LEGENDRE[k](s) * s ** j) for j in range(5)] for k in range(3)])


def contraction():
    print("\nIteration: spectral radius of f -> projection of the path moved by f, over (h omega_c)^2")
    powers = projection_of_powers(0.0, 1.0)[:, 2:]
    values = np.linalg.eigvals(powers @ QUARTIC @ coupling_of_free_mass())
    note("   a free mass: radius, 1/radius", np.abs(values).max(), 1 / np.abs(values).max())
    print("      eigenvalues " + " ".join(f"{x:.5f}" for x in values))
    # The path moved by the force of changes of end, h speed and middle, measured by |end| + 4/27 |h speed| + |middle|.
    moved = np.array([1.0, 4.0 / 27.0, 1.0]) @ np.abs(coupling_of_free_mass() @ powers @ QUARTIC)
    for name, by_one in zip(("kMissingByEnd", "kMissingBySpeed", "kMissingByMiddle"), moved):
        compare(name + ": change of the path", constant(name), by_one, ">=", 1.01)


def sweeps():
    print("\nSweeps over 2 to 8 closed stops of random compliance c, theta << 1, sigma the largest h^2 k c_ii")
    table = projection_of_powers(0.0, 1.0)[:, 2:] @ QUARTIC @ coupling_of_free_mass()
    draw, below, diverging = np.random.default_rng(1), 0.0, np.inf
    for _ in range(4000):
        m = draw.integers(2, 9)
        shapes = draw.normal(size=(m, draw.integers(1, m + 1)))
        compliance = shapes @ shapes.T + 1e-3 * np.eye(m)
        sigma = 10.0 ** draw.uniform(0.0, 3.0)
        matrix = np.eye(3 * m) + np.kron(sigma / np.diag(compliance).max() * compliance, table)
        lower = np.kron(np.tril(np.ones((m, m))), np.ones((3, 3))) * matrix
        radius = np.abs(np.linalg.eigvals(np.eye(3 * m) - np.linalg.solve(lower, matrix))).max()
        below = max(below, radius) if sigma < 10.0 else below
        diverging = min(diverging, sigma) if radius > 1.0 else diverging
    note("   largest contraction factor for sigma < 10", below)
    note("   smallest sigma at which sweeps diverge", diverging)


def one_step(h, k_c, omega, w0, v0, gap, always=False):
    """A step of the method for one DOF of mass 1 with a spring k_c beyond a gap (or always), order 6: q, v, |bulge|."""
    theta = omega * h
    c, s = np.cos(theta), np.sin(theta)
    c2, s2 = np.cos(theta / 2), np.sin(theta / 2)
    free = np.array([c * w0 + s / omega * v0, h * (-omega * s * w0 + c * v0), c2 * w0 + s2 / omega * v0])
    table = h * h * coupling_of_free_mass(theta)
    f = np.zeros(3)
    for _ in range(200):
        end, speed, middle = free + table @ f
        rise, bulge = end - w0, middle - 0.5 * (w0 + end) - 0.125 * (h * v0 - speed)
        path = np.array([w0 - gap, h * v0, 3 * rise - 2 * h * v0 - speed + 16 * bulge,
                         h * v0 + speed - 2 * rise - 32 * bulge, 16 * bulge])
        roots = [] if always else [r.real for r in np.roots(path[::-1]) if abs(r.imag) < 1e-12 and 0 < r.real < 1]
        places = [0.0, *sorted(roots), 1.0]
        projected, tangent = np.zeros(3), np.eye(3)
        for begin, stop in zip(places, places[1:]):
            if always or value(path, 0.5 * (begin + stop)) > 0:
                powers = projection_of_powers(begin, stop)
                projected -= k_c * powers @ path
                tangent += k_c * powers[:, 2:] @ QUARTIC @ table
        f, old = f + np.linalg.solve(tangent, projected - f), f
        if np.abs(f - old).max() <= 1e-15 * np.abs(f).max():
            break
    end, speed, middle = free + table @ f
    return end, speed / h, abs(middle - 0.5 * (w0 + end) - 0.125 * (h * v0 - speed))


def local_orders():
    print("\nLocal errors of one step of one DOF, omega = 1, k_c = 10: slopes over h, q, v and bulge")
    omega, k_c, gap = 1.0, 10.0, 0.0
    fast = np.sqrt(omega ** 2 + k_c)

    def closed(w, v, t):
        return np.cos(fast * t) * w + np.sin(fast * t) / fast * v, -fast * np.sin(fast * t) * w + np.cos(fast * t) * v

    def slopes(errors, steps):
        return np.log(errors[0] / errors[-1]) / np.log(steps[0] / steps[-1])

    for name, place, expected, steps in (("closed throughout", None, (7.0, 7.0, 4.0), (0.1, 0.05)),
                                         ("closes at 0.3 of the step", 0.3, (5.0, 4.0, 3.0), (0.04, 0.02))):
        errors = []
        for h in steps:
            w0, v0 = 0.3, 0.8
            if place is None:
                exact = closed(w0, v0, h)
            else:
                t = place * h  # back from w = 0 with v = 1
                w0, v0 = -np.sin(omega * t) / omega, np.cos(omega * t)
                exact = closed(0.0, 1.0, h - t)
            end, speed, bulge = one_step(h, k_c, omega, w0, v0, gap)
            errors.append((abs(end - exact[0]), abs(speed - exact[1]), bulge))
        found = slopes(np.array(errors), steps)
        note(f"   {name}", *found)
        for what, slope, at_least in zip(("q", "v", "bulge"), found, expected):
            global failures
            if slope < at_least - 0.35:
                failures += 1
                print(f"   <-- {what} is of a lower order than {at_least}")


def changes_of_contact():
    print("\nA free mass that closes a stop at any place of a step, sigma = (h omega_c)^2, h = v = 1: largest errors")
    print("   sigma, |b|/sigma, speed/sigma^2, displacement/sigma^2, largest speed error over largest |b|, "
          "kOfSpeed sigma^2")
    of_change = 0.0
    for sigma in (0.01, 0.1, 0.3, 1.0, 3.0, 10.0):
        fast, worst = np.sqrt(sigma), np.zeros(3)
        for a in np.linspace(0.02, 0.98, 49):
            t = 1.0 - a
            exact = (np.sin(fast * t) / fast, np.cos(fast * t)) if fast * t < np.pi else (np.pi / fast - t, -1.0)
            end, speed, bulge = one_step(1.0, sigma, 1e-4, -a, 1.0, 0.0)
            worst = np.maximum(worst, (bulge, abs(speed - exact[1]), abs(end - exact[0])))
        note("  ", sigma, worst[0] / sigma, *worst[1:] / sigma ** 2, worst[1] / worst[0],
             constant("kOfSpeed") * sigma ** 2)
        if sigma <= 3.0:
            of_change = max(of_change, worst[1] / sigma ** 2)
    compare("kOfChange: largest speed error/sigma^2, sigma <= 3", constant("kOfChange"), of_change, ">=", 1.1)
    print("The same closed throughout, any phase: sigma, largest speed error/(sigma^2 largest |b|), "
          "kOfSpeedClosed over it")
    of_closed = 0.0
    for sigma in (0.1, 0.3, 1.0, 3.0, 10.0):
        fast, worst = np.sqrt(sigma), np.zeros(2)
        for phase in np.linspace(0.0, np.pi, 61):
            _, speed, bulge = one_step(1.0, sigma, 1e-6, np.cos(phase), -fast * np.sin(phase), 0.0, True)
            worst = np.maximum(worst, (abs(speed + fast * np.sin(phase + fast)), bulge))
        ratio = worst[0] / (sigma ** 2 * worst[1])
        note("  ", sigma, ratio, constant("kOfSpeedClosed") / ratio)
        of_closed = max(of_closed, ratio)
    compare("kOfClosed: largest of these", constant("kOfClosed"), of_closed, ">=", 1.1)


def quartic_path(w0, d0, w1, d1, wm, s):
    b = wm - (w0 + w1) / 2 - (d0 - d1) / 8
    return (w0 * (1 + 2 * s) + d0 * s) * (1 - s) ** 2 + (w1 * (3 - 2 * s) + d1 * (s - 1)) * s * s + \
        16 * b * (s * (1 - s)) ** 2


def unreceived():
    print("\nA weak spring on a mode that turns by theta in a step: the part of the frequency rise that is left out")
    slow, fast = constant("kSlow", 1e-4), constant("kFast", 0.1)
    s, w = gauss(0.0, 1.0)
    worst = 0.0
    for theta in (0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 10.0):
        received = []
        for phase in np.linspace(0.0, 2 * np.pi, 16, endpoint=False):
            at, speed = lambda t: np.cos(theta * t + phase), lambda t: -theta * np.sin(theta * t + phase)
            path = quartic_path(at(0), speed(0), at(1), speed(1), at(0.5), s)
            force = sum((2 * k + 1) * np.sum(w * path * p(s)) * p(s) for k, p in enumerate(LEGENDRE))
            received.append(2 * np.sum(w * force * at(s)))  # the impulse that turns the phase
        computed, power = 1 - np.mean(received), slow * theta ** 6
        code = power / (1 + fast * theta ** 2 + power)
        note("   theta, left out, unreceived_part", theta, computed, code)
        worst = max(worst, abs(code / computed - 1))
    compare("unreceived_part: allowed and largest error", 0.1, worst, ">=", 2.0)


def unresolved_rest():
    """What a mode receives of a force P_3 or P_4, which the projection leaves out."""
    print("\nA force P_3 or P_4 in a step: what it gives to a mode that turns by x")
    cubic, most, fast = constant("kOfCubic"), constant("kMostOfRest"), constant("kFastOfRest")
    s, w = gauss(0.0, 1.0)
    for name, force in (("P_3", 20 * s ** 3 - 30 * s ** 2 + 12 * s - 1),
                        ("P_4", 70 * s ** 4 - 140 * s ** 3 + 90 * s ** 2 - 20 * s + 1)):
        received = lambda x: abs(np.sum(w * np.exp(1j * x * s) * force))
        worst = max(received(x) / min(cubic * x ** 3, most, fast / x) for x in np.linspace(0.1, 200.0, 4000))
        compare(f"unresolved_rest: |int {name} e^(i x s)| over it", 1.0, worst, ">=", 3.0)


def residual_force():
    print("\nResidual force of the law arctan, R(y)/R = y atan(1/y), y = |g|/bend")
    departs = lambda y: 1 - y * np.arctan(1 / y)
    for name in ("kOffBend", "kFarOff"):
        far = constant(name)
        note(f"{name} = {far:g}: departure there, and 1/(3 y^2)", departs(far) if far < 1e3 else 1 / (3 * far ** 2),
             1 / (3 * far ** 2))
    y, w = gauss(0.0, 1.0, 400)
    mean = np.sum(w * departs(y)) + np.sum(w / y ** 2 * departs(1 / y))
    note("int_0^infinity of the departure (pi/4)", mean)
    compare("kShortcuts: 2 kSharp pi/4, path at equal speed", constant("kShortcuts"),
            2 * constant("kSharp") * mean, ">=", 2.0)
    print("Moments of it beside a bend, w = s, 4-point Gauss on graded panels: largest error for bends above kSharp")
    nodes, weights = gauss(0.0, 1.0, 4)
    for grading, panels in (("kGrading", "kPanels"), ("kPreciseGrading", "kPrecisePanels")):
        worst = 0.0
        for width in np.geomspace(constant("kSharp"), 10.0, 60):
            law = lambda s: s / width * np.arctan2(width, s)
            def integrate(borders, x, w):
                total = np.zeros(3)
                for low, high in zip(borders, borders[1:]):
                    s = low + (high - low) * x
                    total += [(2 * k + 1) * (high - low) * np.sum(w * LEGENDRE[k](s) * law(s)) for k in range(3)]
                return total
            n = int(constant(panels))
            borders = [0.0] + [constant(grading) ** j for j in range(n - 1, -1, -1)]
            exact = integrate([0.0] + [0.3 ** j for j in range(24, -1, -1)], *gauss(0.0, 1.0, 30))
            worst = max(worst, np.abs(integrate(borders, nodes, weights) - exact).max())
        note(f"   {grading} = {constant(grading):g}, {panels} = {n}", worst)
    compare("kPreciseError: that of kPrecisePanels", constant("kPreciseError"), worst, ">=", 2.0)
    # rho^-8 of a panel [a, a/grading] with a pole at its beginning's distance, and of the innermost one with a pole a
    # bend away: the sum of the semi-axes of the Bernstein ellipse through the pole.
    rho = lambda pole: abs(pole + np.sqrt(pole - 1 + 0j) * np.sqrt(pole + 1 + 0j))
    ratio, inner = constant("kFinestGrading"), constant("kInnermost")
    note("   kFinestGrading, rho^-8", rho(-(1 + ratio) / (1 - ratio)) ** -8.0)
    note("   kInnermost, rho^-8", rho(complex(-1.0, 2.0 / inner)) ** -8.0)
    compare("kLasting: kResidualError kOutputs kTimes", constant("kLasting"),
            constant("kResidualError") * constant("kOutputs") * constant("kTimes"), "=", 1 + 1e-12)


def series():
    print("\nTaylor series of the propagators")
    terms, longest = in_code(r"inline constexpr int kTerms = (\d+);"), constant("kShort", 1.0)
    # y_{k+2} = -(2 delta h (k+1) y_{k+1} + (omega h)^2 y_k)/((k+1)(k+2)) with (omega + delta) h = kShort
    worst = 0.0
    for share in np.linspace(0.0, 1.0, 21):
        angle, decay = share * longest, (1 - share) * longest
        for start in ((1.0, 0.0), (0.0, 1.0)):
            y = list(start)
            for k in range(int(terms) + 6):
                y.append(-(2 * decay * (k + 1) * y[k + 1] + angle ** 2 * y[k]) / ((k + 1) * (k + 2)))
            worst = max(worst, abs(y[int(terms) + 1]))
    note(f"kTerms = {terms}, kShort = {longest:g}: first term left out", worst)


interpolation()
discontinuities()
unresolved("unresolved_part", 1, "F = (s-a)_+")
unresolved("unresolved_jump", 0, "F = 1 beyond a")
contraction()
sweeps()
local_orders()
changes_of_contact()
unreceived()
unresolved_rest()
residual_force()
series()
print(f"\n{failures} values differ" if failures else "\nno value differs but for the open points of THEORY.md")
sys.exit(1 if failures else 0)
