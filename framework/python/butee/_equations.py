"""The equations of motion of a scene, and its modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, List, Optional, Tuple

import numpy as np

from . import _butee

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


class Equations:
    """M a + C v + K x = F(t) + F_c(x, v) on the n free degrees of freedom of a scene, for other solvers.

    Vectors are arrays of shape (n,), displacements in m or rad, forces in N or N m, in the order of ``dofs``. C = c_m M + c_k K +
    dashpots, or modal damping and dashpots. If shafts turn at a varying speed, C and K depend on time. Under a moving
    ``[base]`` the motion is relative to it; with ``frame = "space"``, and if ``[[base]]`` moves nodes, it is the motion in space.
    Friction with stick has no memory here: ``contact_force`` is that of sliding.

    >>> equations = scene.equations()
    >>> equations.dofs
    ['u of rotor']
    >>> equations.K.toarray()
    array([[1.e+09]])
    >>> equations.contact_force([0.0005])       # a stop of 1e10 N/m behind a gap of 4e-4 m
    array([-1000000.])
    """

    __slots__ = ("_core",)

    def __init__(self, core: "_butee.Equations"):
        self._core = core

    @property
    def dofs(self) -> List[str]:
        """The names of the free degrees of freedom, ``u of string:17``."""
        return self._core.dofs

    @property
    def M(self) -> "csc_matrix":
        """The mass matrix, (n, n), kg and kg m2."""
        return self._core.mass()

    @property
    def C(self) -> "csc_matrix":
        """The damping matrix at the initial instant, (n, n), N s/m and N m s/rad."""
        return self._core.damping(self.t0)

    @property
    def K(self) -> "csc_matrix":
        """The stiffness matrix at the initial instant, stops open, (n, n), N/m and N m/rad."""
        return self._core.stiffness(self.t0)

    def matrices(self, t: float) -> Tuple["csc_matrix", "csc_matrix", "csc_matrix"]:
        """M, C and K at the instant ``t`` in s."""
        return self._core.mass(), self._core.damping(t), self._core.stiffness(t)

    @property
    def t0(self) -> float:
        """The initial instant, s."""
        return self._core.t0

    @property
    def x0(self) -> np.ndarray:
        """The initial displacements, (n,)."""
        return self._core.x0

    @property
    def v0(self) -> np.ndarray:
        """The initial velocities, (n,)."""
        return self._core.v0

    def external_force(self, t: float) -> np.ndarray:
        """The forces of the loads at ``t`` in s, (n,)."""
        return self._core.external_force(t)

    def contact_force(self, x: np.ndarray, v: Optional[np.ndarray] = None, t: float = 0.0) -> np.ndarray:
        """The forces of all contacts, (n,), at the displacements ``x`` and the velocities ``v`` (default: 0). Velocities
        matter only for contacts with dissipation or friction, and the time ``t`` only if shafts turn at a varying speed."""
        return self._core.contact_force(t, x, np.zeros(np.shape(x)) if v is None else v)

    def acceleration(self, t: float, x: np.ndarray, v: np.ndarray) -> np.ndarray:
        """M^-1 (F(t) + F_c(x) - C v - K x), (n,)."""
        return self._core.acceleration(t, x, v)

    def __repr__(self) -> str:
        return f"<butee.Equations of {len(self.dofs)} degrees of freedom>"


@dataclass(frozen=True)
class Modes:
    """The lowest natural modes of a scene without damping, its stops open or closed, ascending.

    >>> modes = scene.modes()
    >>> float(modes.angular_frequencies[0]), modes.shapes.shape
    (3162.2776601683795, (1, 1))
    """

    angular_frequencies: np.ndarray
    """(modes,), rad/s; 0 for rigid motion"""
    frequencies: np.ndarray
    """(modes,), Hz"""
    damping_ratios: np.ndarray
    """(modes,), 1 = critical; NaN for rigid motion"""
    effective_masses: np.ndarray
    """(modes,), kg, for a uniform transverse acceleration of all nodes"""
    total_mass: float
    """kg"""
    shapes: np.ndarray
    """(n, modes), with shapes.T @ M @ shapes = 1"""
