"""Structures: a scene as a part of another computation."""

from __future__ import annotations

from typing import Dict, List, Sequence, Union

import numpy as np

from . import _butee

Snapshot = _butee.Snapshot


class Structure:
    """A scene that another solver advances in time, reads, loads by forces and resets; created by ``Scene.structure``.

    Forces act on the degrees of freedom of ``forced``. ``forces`` and ``set_force`` set constant ones, ``set_forces`` ones that vary
    linearly in time, with which a partitioned iteration is of second order in its windows. Vectors are arrays of shape (n,) over the free degrees of freedom
    ``dofs``; force vectors have shape (forced,). Only one thread at a time can use a structure; another one gets a RunError.

    >>> part = scene.structure(forced=["rotor"])
    >>> part.forces = [1000.0]                          # N, from now on
    >>> part.advance_to(1e-3)
    >>> before = part.snapshot()
    >>> part.advance_to(2e-3)
    >>> part.restore(before)
    >>> part.time
    0.001

    After a failed step (RunError) the state is that of the last good step; the structure can continue after other forces, another
    motion or ``restore``. A wrong call raises ValueError or InputError and has no effect. Structures and snapshots can be pickled.
    """

    __slots__ = ("_core", "__weakref__")

    def __init__(self, core: "_butee.Part"):
        self._core = core

    # --- names

    @property
    def dofs(self) -> List[str]:
        """The names of the free degrees of freedom, ``u of string:17``."""
        return self._core.dof_names()

    @property
    def forced_dofs(self) -> List[int]:
        """The degrees of freedom on which forces act, in the order of ``forced``: indices into ``dofs``."""
        return self._core.forced_dofs()

    def dof(self, node: str, kind: str = "u") -> int:
        """The index of a degree of freedom of one node: ``part.dof("string:middle", "theta")``."""
        return self._core.dof(node, kind)

    def dof_list(self, nodes: str, kind: str = "u") -> List[int]:
        """The indices of the free degrees of freedom of one kind at several nodes: ``part.dof_list("string:all")``."""
        return self._core.dof_list(nodes, kind)

    # --- time

    @property
    def time(self) -> float:
        """The present instant, s."""
        return self._core.time()

    def advance_to(self, t: float) -> None:
        """Advances exactly to ``t``, s. Other Python threads continue meanwhile, and Ctrl-C stops after a step."""
        self._core.advance_to(t)

    def advance_step(self, limit: float) -> float:
        """Takes one step of the method's own length, not beyond ``limit`` (s), and returns the new time."""
        return self._core.advance_step(limit)

    # --- motion

    @property
    def x(self) -> np.ndarray:
        """The displacements, a read-only copy, (n,), m and rad; ``set_motion`` changes them."""
        return self._core.x()

    @property
    def v(self) -> np.ndarray:
        """The velocities, a read-only copy, (n,)."""
        return self._core.v()

    @property
    def a(self) -> np.ndarray:
        """The accelerations, a read-only copy, (n,)."""
        return self._core.a()

    def displacement(self, dof: int) -> float:
        """The displacement of one degree of freedom, m or rad."""
        return self._core.displacement(dof)

    def velocity(self, dof: int) -> float:
        """The velocity of one degree of freedom."""
        return self._core.velocity(dof)

    def acceleration(self, dof: int) -> float:
        """The acceleration of one degree of freedom."""
        return self._core.acceleration(dof)

    def set_motion(self, x: Sequence[float], v: Sequence[float]) -> None:
        """Sets the displacements and velocities, (n,) each, at the present instant; the method restarts from them."""
        self._core.set_motion(x, v)

    # --- forces

    @property
    def forces(self) -> np.ndarray:
        """The forces on ``forced_dofs`` at the present instant, (forced,), N and N m. Values that are set remain constant from
        now on; to change one of them, assign all, or use ``set_force``."""
        return self._core.forces()

    @forces.setter
    def forces(self, values: Union[Sequence[float], np.ndarray]) -> None:
        self._core.set_forces(values)

    def set_forces(self, start: Sequence[float], end: Sequence[float], until: float) -> None:
        """Sets forces that vary linearly from ``start`` now to ``end`` at ``until`` (s), and continue beyond; (forced,) each."""
        self._core.set_lines(start, end, until)

    def set_force(self, dof: int, value: float) -> None:
        """Sets a constant force on one of ``forced_dofs`` from now on, N or N m."""
        self._core.set_force(dof, value)

    def contact_force(self, dof: int) -> float:
        """The force of all contacts on a degree of freedom, N."""
        return self._core.contact_force(dof)

    def quantity(self, name: str, node: str, element: str = "") -> float:
        """A quantity of probes (``M``, ``reaction``, ...) at the present instant; ``element`` selects the beam or spring."""
        return self._core.quantity(name, node, element)

    @property
    def energy(self) -> Dict[str, float]:
        """The energies ``kinetic``, ``strain`` and ``contact``, J."""
        return self._core.energy()

    # --- snapshots

    def snapshot(self) -> Snapshot:
        """The state with the method's memory and the forces, for ``restore``; it is independent of the structure and can be pickled."""
        return self._core.snapshot()

    def restore(self, snapshot: Snapshot) -> None:
        """Restores a snapshot of this structure, or of another one with the same scene and ``forced``, bit for bit.

        The methods of SUNDIALS keep a history of their own, which a snapshot lacks: they go on to their tolerance.
        """
        self._core.restore(snapshot)

    @property
    def method(self) -> str:
        """The canonical name of the time integrator."""
        return self._core.method()

    @property
    def steps(self) -> int:
        """The number of accepted steps so far."""
        return self._core.steps()

    def __repr__(self) -> str:
        return f"<butee.Structure by {self.method} at t = {self.time:g} s>"

    def __reduce__(self):
        session = self._core.session()
        return _restored, (session.state(), session.plugins, self._core.forced(), self.snapshot())


def _restored(state: bytes, plugins: List[str], forced: List[str], snapshot: Snapshot) -> Structure:
    structure = Structure(_butee.part(_butee.from_state(state, plugins), forced))
    structure.restore(snapshot)
    return structure


def _snapshot_of(state: bytes) -> Snapshot:
    return _butee.snapshot(state)
