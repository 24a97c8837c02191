"""Results of runs."""

from __future__ import annotations

import csv
import io
import json
from typing import Any, Dict, Iterator, List, Mapping, Optional

import numpy as np

from . import _butee
from ._errors import RunError

_IMPACT = [("side", "i4"), ("t_in", "f8"), ("t_out", "f8"), ("peak_force", "f8"), ("impulse", "f8"), ("impact_speed", "f8"),
           ("tangential_impulse", "f8"), ("slip", "f8"), ("dissipated", "f8"), ("dof", "U5")]


class Result(Mapping[str, np.ndarray]):
    """The history of a run, by column, with its summary and its impacts.

    A mapping from the names of the columns, ``"t"``, ``"mid.u"``, ..., ``"h"``, to arrays of shape (rows,): the columns of
    ``history.csv``. They are read-only views of the run's own memory, without a copy, and keep it alive.

    >>> result = scene.run(end_time=0.01)
    >>> result["rotor.u"].shape == result.t.shape
    True
    >>> result["rotor.u"].base is result, result["rotor.u"].flags.writeable
    (True, False)
    """

    __slots__ = ("_core", "_columns", "_summary", "__weakref__")

    def __init__(self, core: "_butee.Outcome"):
        self._core = core
        self._columns: Optional[List[str]] = None
        self._summary: Optional[Dict[str, Any]] = None

    # --- the history

    def __getitem__(self, column: str) -> np.ndarray:
        return self._core.column(column, self)

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __contains__(self, column: object) -> bool:
        return column in self.columns

    @property
    def columns(self) -> List[str]:
        """The names of the columns, in the order of ``history.csv``."""
        if self._columns is None:
            self._columns = self._core.columns
        return self._columns

    @property
    def t(self) -> np.ndarray:
        """The instants of the rows, s; shape (rows,)."""
        return self._core.column("t", self)

    # --- outcome of the run

    @property
    def title(self) -> str:
        """The scene's title."""
        return self._core.title

    @property
    def completed(self) -> bool:
        """Whether the run reached its end time."""
        return self._core.completed

    @property
    def message(self) -> str:
        """Why the run failed; "" if it completed."""
        return self._core.message

    @property
    def summary(self) -> Dict[str, Any]:
        """The contents of ``summary.json``: status, counters, times, peaks, energies."""
        if self._summary is None:
            self._summary = json.loads(self._core.summary)
        return self._summary

    @property
    def peaks(self) -> Dict[str, float]:
        """The largest magnitude of each column over the whole motion, including between rows and steps."""
        return self.summary["peak"]

    @property
    def warnings(self) -> List[str]:
        """The warnings of the run."""
        return list(self._core.warnings)

    @property
    def impacts(self) -> np.ndarray:
        """The closings of stops, if the scene has ``output.impacts = true``, as a structured array of shape (impacts,).

        Fields: ``node``, ``side`` (+1 or -1), ``t_in`` and ``t_out`` (s; NaN if still closed), ``peak_force`` (N), ``impulse``
        (N s), ``impact_speed`` (m/s), ``tangential_impulse`` (N s), ``slip`` (m), ``dissipated`` (J), ``dof`` ("u", "uz", ... of a stop,
        empty for a ring or plane).
        """
        rows = self._core.impacts()
        longest = max((len(row[0]) for row in rows), default=1)
        return np.array(rows, dtype=[("node", f"U{longest}"), *_IMPACT])

    @property
    def wear(self) -> List[Dict[str, Any]]:
        """Friction work and dissipation of each contact in the plane, with dissipation or friction: the rows of ``wear.csv`` as dicts with
        ``node``, ``kind``, ``work`` (J), ``mean_power`` (W), ``contact_share``, ``slip`` (m), ``dissipated`` (J), ..."""
        rows = csv.DictReader(io.StringIO(self._core.wear))
        return [{key: value if key in ("node", "kind") else float(value or "nan") for key, value in row.items()} for row in rows]

    @property
    def energy(self) -> Optional[Dict[str, np.ndarray]]:
        """The energies in J at the output times if the scene has ``output.energy = true``, otherwise None.

        Keys: ``t``, ``kinetic``, ``strain``, ``contact``, ``work``, ``dissipated``; arrays are views, as in the history.
        """
        views = self._core.energy(self)
        return views if views["t"].size else None

    def check(self) -> "Result":
        """Returns this result, or raises RunError if the run failed."""
        if not self.completed:
            raise RunError(self.message, self)
        return self

    # --- for other packages

    def to_dict(self) -> Dict[str, np.ndarray]:
        """The columns as a dict of arrays."""
        return self._core.history(self)

    def to_dataframe(self):
        """The history as a ``pandas.DataFrame`` with the time as its index (requires pandas)."""
        import pandas

        frame = pandas.DataFrame({name: np.array(column) for name, column in self.items()})
        return frame.set_index("t")

    def plot(self, *columns: str, axes=None):
        """Draws columns over time by matplotlib (default: those of the probes) and returns the axes.

        >>> axes = scene.run(end_time=0.01).plot("rotor.u")
        """
        from ._plot import plot_history

        return plot_history(self, columns, axes)

    def __repr__(self) -> str:
        state = "completed" if self.completed else f"failed: {self.message}"
        return f"<butee.Result of {self.title!r}: {self.t.size} rows of {', '.join(self.columns[1:-1])}; {state}>"

    def __eq__(self, other: object) -> bool:
        return self is other

    __hash__ = object.__hash__

    def __reduce__(self):
        core = self._core
        state = (self.to_dict(), core.energy(self), core.impacts(), core.title, core.summary, core.completed, core.message,
                 core.warnings, core.wear)
        return _restored, state


def _restored(*state) -> Result:
    return Result(_butee.outcome(*state))
