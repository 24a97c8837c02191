"""Matrices, forces and modes compared with closed forms and with scipy."""

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import butee

E, RHO, WIDTH, HEIGHT, LENGTH = 2.0e11, 7800.0, 0.02, 0.01, 1.5
AREA, INERTIA = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12.0
#: Rounding of sums of two elements and of products in another order.
ROUNDING = 1e-13


def beam(elements, supports, damping=None):
    scene = {
        "schema": 1,
        "material": {"steel": {"young_modulus": E, "density": RHO}},
        "section": {"bar": {"shape": "rectangle", "width": WIDTH, "height": HEIGHT}},
        "element": [{"type": "beam", "name": "bar", "material": "steel", "section": "bar", "length": LENGTH, "elements": elements}],
        "support": supports,
        "load": [{"type": "constant", "node": "bar:last", "dof": "theta", "value": 5.0}],
        "integrator": {"end_time": 0.1},
        "output": {"probe": [{"label": "end", "node": "bar:last", "quantities": ["theta"]}]},
    }
    if damping:
        scene["damping"] = damping
    return butee.Scene(scene)


CLAMPED = [{"nodes": "bar:first", "fix": ["u", "theta"]}]
PINNED = [{"nodes": ["bar:first", "bar:last"], "fix": ["u"]}]


def hermite(h):
    """K and M of one Euler-Bernoulli element: u, theta, u, theta."""
    k = E * INERTIA / h**3 * np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                                       [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])
    m = RHO * AREA * h / 420 * np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                                         [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]])
    return k, m


def close(a, b):
    scale = np.sqrt(np.outer(np.diag(b), np.diag(b)))
    return np.all(np.abs(a - b) <= ROUNDING * scale)


def test_matrices_of_two_elements_are_the_closed_form():
    scene = beam(2, CLAMPED, {"mass_proportional": 0.3, "stiffness_proportional": 1e-4})
    k, m = hermite(LENGTH / 2)
    expected_k, expected_m = np.zeros((6, 6)), np.zeros((6, 6))
    for at in (0, 2):
        expected_k[at : at + 4, at : at + 4] += k
        expected_m[at : at + 4, at : at + 4] += m
    expected_k, expected_m = expected_k[2:, 2:], expected_m[2:, 2:]
    M, C, K = scene.matrices()
    assert all(scipy.sparse.issparse(matrix) and matrix.shape == (4, 4) for matrix in (M, C, K))
    assert close(K.toarray(), expected_k) and close(M.toarray(), expected_m)
    assert close(C.toarray(), 0.3 * expected_m + 1e-4 * expected_k)
    equations = scene.equations()
    assert equations.dofs == ["u of bar:1", "theta of bar:1", "u of bar:2", "theta of bar:2"]
    assert np.array_equal(equations.external_force(0.0), [0.0, 0.0, 0.0, 5.0])


def test_modal_damping_gives_each_mode_its_ratio():
    scene = beam(6, PINNED, {"modal": [0.01, 0.03]})
    M, C, K = (matrix.toarray() for matrix in scene.matrices())
    squares, shapes = scipy.linalg.eigh(K, M)
    ratios = np.diag(shapes.T @ C @ shapes) / (2 * np.sqrt(squares))
    assert np.allclose(ratios, [0.01, 0.03] + [0.0] * (len(ratios) - 2), atol=1e-10)


def test_modes_of_a_pinned_bar_are_the_closed_form():
    modes = beam(40, PINNED, {"modal": 0.02}).modes(4)
    n = np.arange(1, 5)
    expected = (n * np.pi / LENGTH) ** 2 * np.sqrt(E * INERTIA / (RHO * AREA))
    # Cubic elements are too stiff by (n pi / 40)^4 / 1440, plus less than a tenth of the next power.
    expected *= 1 + (n * np.pi / 40) ** 4 / 1440
    assert np.allclose(modes.angular_frequencies, expected, rtol=1e-7)
    assert np.array_equal(modes.frequencies, modes.angular_frequencies / (2 * np.pi))
    assert np.allclose(modes.damping_ratios, 0.02)
    assert np.isclose(modes.total_mass, RHO * AREA * LENGTH)
    M = beam(40, PINNED).matrices()[0]
    assert np.allclose(modes.shapes.T @ M @ modes.shapes, np.eye(4), atol=1e-9)
    assert len(beam(2, CLAMPED).modes().frequencies) == 4
    for n in (1000, -1):
        with pytest.raises(ValueError):
            beam(2, CLAMPED).modes(n)


def test_a_closed_stop_is_a_spring(rotor):
    closed = rotor.modes(closed="all").angular_frequencies[0]
    assert np.isclose(closed, np.sqrt((1.0e9 + 1.0e10) / 100.0), rtol=1e-14)
    with pytest.raises(butee.InputError, match="well"):
        rotor.modes(closed=["well"])


def test_forces_of_stops_and_loads(rotor):
    equations = rotor.equations()
    for x, force in [(3.0e-4, 0.0), (5.0e-4, -1.0e6), (-6.0e-4, 2.0e6)]:
        assert np.isclose(equations.contact_force([x])[0], force, rtol=1e-12)
    rotor["contact[0].damping"] = {"type": "kelvin_voigt", "coefficient": 2.0e4}
    damped = rotor.equations()
    assert np.isclose(damped.contact_force([5.0e-4], [3.0])[0], -1.0e6 - 6.0e4, rtol=1e-12)
    assert np.isclose(damped.contact_force([5.0e-4])[0], -1.0e6, rtol=1e-12)
    t = 0.0123
    assert np.isclose(equations.external_force(t)[0], 201240.0 * np.cos(1256.6 * t), rtol=1e-14)
    a = (201240.0 * np.cos(1256.6 * t) - 1.0e6 - 50.0 * 2.0 - 1.0e9 * 5.0e-4) / 100.0
    assert np.isclose(equations.acceleration(t, [5.0e-4], [2.0])[0], a, rtol=1e-12)
    assert equations.t0 == 0.0 and np.array_equal(equations.x0, [0.0]) and np.array_equal(equations.v0, [0.0])


def test_wrong_shapes_are_refused(rotor):
    equations = rotor.equations()
    for x in ([], [1.0, 2.0], [[1.0]], 3.0, np.zeros((1, 1)), "x", None):
        with pytest.raises((ValueError, TypeError)):
            equations.contact_force(x)


def test_a_shaft_turns_at_its_speed():
    scene = butee.Scene({
        "schema": 1,
        "material": {"steel": {"young_modulus": E, "density": RHO, "poisson_ratio": 0.3}},
        "section": {"bar": {"shape": "circle", "radius": 0.01}},
        "element": [
            {"type": "beam", "motion": "lateral", "name": "bar", "material": "steel", "section": "bar", "length": 1.0, "elements": 2},
            {"type": "disc", "node": "bar:middle", "mass": 5.0, "diametral_inertia": 0.01, "polar_inertia": 0.02},
        ],
        "support": [{"nodes": ["bar:first", "bar:last"], "fix": ["uy", "uz"]}],
        "rotation": {"speed": {"type": "ramp", "from": 0.0, "to": 100.0, "start": 0.0, "end": 2.0}},
        "load": [{"type": "unbalance", "node": "bar:middle", "moment": 1e-4}],
        "integrator": {"end_time": 0.1},
        "output": {"probe": [{"label": "disc", "node": "bar:middle", "quantities": ["u"]}]},
    })
    equations = scene.equations()
    ry, rz = equations.dofs.index("ry of bar:1"), equations.dofs.index("theta of bar:1")
    gyroscopic = (equations.matrices(1.0)[1] - equations.matrices(0.0)[1]).toarray()
    assert np.allclose(gyroscopic, -gyroscopic.T) and abs(gyroscopic[ry, rz]) >= 50.0 * 0.02
    K = equations.matrices(1.0)[2].toarray() - equations.matrices(3.0)[2].toarray()
    assert np.allclose(K, gyroscopic)  # Omega' G, with Omega = Omega' (1 s); 0 after the ramp
    whirl = scene.whirl(50.0, 2)
    assert len(whirl["modes"]) == 2
