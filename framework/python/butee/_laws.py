"""Contact laws written in Python."""

from __future__ import annotations

import inspect
from typing import Callable, Optional

from . import _butee
from ._functions import declared, written


def law(name: str, *, tangent: Optional[Callable[..., float]] = None,
        energy: Optional[Callable[..., float]] = None) -> Callable[[Callable[..., float]], Callable[..., float]]:
    """Registers a function of the penetration as a contact law of stops. Scenes created later can use ``law = "name"`` in ``contact``.

    The function receives the penetration g in m (negative while the stop is open) and its parameters, and returns the restoring
    force in N; it must be 0 at g = 0, and is also called from 1e-9 to 0.01 m and at -1 m. Its other arguments are keys of the contact and must be numbers; those without a default
    are required. ``tangent`` and ``energy`` are functions of the same arguments: dF/dg in N/m and the integral of F from 0 to g
    in J. If they are absent, the force is differentiated by finite differences and integrated by Gauss' rule over intervals that
    shrink towards 0, with a few hundred calls for each value of the energy.

    Intended for experiments: each call takes some microseconds and the interpreter's lock, so a scene of one mass runs a hundred
    times slower than with a law in C++, and threads wait for each other. The method ``exact`` refuses the law.
    ``butee.conformance`` runs the test suite that laws in C++ pass.

    >>> @butee.law("hardening")
    ... def hardening(g, stiffness, cubic=0.0):
    ...     return stiffness * g * (1.0 + cubic * g * g) if g > 0.0 else 0.0
    >>> hard = butee.Scene({**scene.to_dict(), "contact": [
    ...     {"type": "stop", "nodes": "rotor", "gap": 4e-4, "law": "hardening", "stiffness": 1e10, "cubic": 1e6}]})
    >>> hard.run(end_time=0.001).completed
    True
    """

    if not isinstance(name, str):
        raise TypeError("the decorator needs the name of the law: @butee.law(\"NAME\")")

    def register(force: Callable[..., float]) -> Callable[..., float]:
        parameters = declared(name, force, "the penetration")
        for other in (tangent, energy):
            if other is not None and [one for one, _ in declared(name, other, "the penetration")] != [one for one, _ in parameters]:
                raise TypeError(f"{name}: tangent and energy take the arguments of the force")
        _butee.register_law(name, force, tangent, energy, parameters, inspect.getdoc(force) or "a function in Python")
        written.add(name)
        return force

    return register
