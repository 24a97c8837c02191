"""Studies: many runs of one scene, each with a row of numbers as its result."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _butee
from ._program import refuse_functions

if TYPE_CHECKING:
    from ._scene import Scene

Collected = Union[str, Sequence[str]]


class Study(Mapping[str, np.ndarray]):
    """The rows of ``Scene.study``: a mapping of columns to arrays of shape (runs,), or (runs, periods) for sections.

    Columns are those of ``butee study``: ``run``, ``point``, the keys that vary, ``status`` (``completed``, ``failed``, ``refused``),
    ``reason``, the collected results, ``steps`` and the cost of the run. Missing results of a run are NaN.
    """

    def __init__(self, rows: np.ndarray, units: Dict[str, str]):
        self.rows = rows
        """All rows, a structured array."""
        self.units = units
        """Units by column; "1" for pure numbers, "" if unknown."""

    @classmethod
    def load(cls, folder: Union[str, "os.PathLike[str]"]) -> "Study":
        """The rows in a folder of ``butee study -o`` or ``Scene.study(..., output=...)``, in the order of the plan.

        While the study is running, in threads, processes or shards, the rows that exist so far.
        """
        return cls._of(_butee.study_rows(os.fspath(folder)))

    @classmethod
    def _of(cls, table: Tuple[List[Tuple[str, str, str, int]], int, bytes]) -> "Study":
        columns, row_bytes, rows = table
        names, units, formats, offsets = zip(*columns)
        row = np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": row_bytes})
        return cls(np.frombuffer(rows, dtype=row), dict(zip(names, units)))

    def __getitem__(self, column: str) -> np.ndarray:
        if column not in self.units:
            raise KeyError(f"{column}; the columns are {', '.join(self.units)}")
        values = self.rows[column]
        return np.char.decode(values, "utf-8") if values.dtype.kind == "S" else values

    def __iter__(self) -> Iterator[str]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)

    @property
    def failed(self) -> Dict[int, str]:
        """The numbers of the runs without results, each with its reason."""
        return {int(i): str(self["reason"][i]) for i in np.flatnonzero(self["status"] != "completed")}

    def to_dataframe(self):
        """The rows as a ``pandas.DataFrame`` (requires pandas); sections become columns ``NAME[1]``, ``NAME[2]``, ..."""
        import pandas

        columns: Dict[str, np.ndarray] = {}
        for name, values in self.items():
            if values.ndim == 1:
                columns[name] = np.array(values)
            else:
                columns.update({f"{name}[{k + 1}]": np.array(values[:, k]) for k in range(values.shape[1])})
        return pandas.DataFrame(columns)

    def plot(self, result: str, axes=None):
        """Draws one result by matplotlib over the first varied key and returns the axes. Sections are drawn as dots (a bifurcation
        diagram), upward and downward sweeps as separate lines, a grid over two keys as a map.

        >>> axes = scene.study({"contact[0].gap": [1e-4, 2e-4]}, "section rotor.u", periods=5).plot("section rotor.u")
        """
        from ._plot import plot_rows

        return plot_rows(self, result, axes)

    @property
    def keys_varied(self) -> List[str]:
        """The varied keys, in the order given."""
        names = list(self.units)
        return [name for name in names[:names.index("status")] if name not in ("run", "point", "direction")]

    def __repr__(self) -> str:
        return f"<butee.Study of {self.rows.size} runs; {len(self.failed)} without results>"

    def __reduce__(self):
        return type(self), (self.rows, self.units)

    __hash__ = object.__hash__

    def __eq__(self, other: object) -> bool:
        return self is other


def run_study(core: "_butee.Session", vary: Mapping[str, Any], collect: Collected, settings: Dict[str, Any], threads: Optional[int],
              kept: Tuple[str, str, bool], horizon: Callable[["_butee.Session"], float],
              progress: Optional[Callable[[int, int], None]]) -> Study:
    if threads is None:
        threads = len(os.sched_getaffinity(0))
    if threads < 1:
        raise ValueError(f"threads = {threads}: at least 1 is needed")
    if kept[1] not in ("", "hdf5", "csv"):
        raise ValueError(f'format = {kept[1]!r}: "hdf5" and "csv" are allowed')
    axes: List[Dict[str, Any]] = []
    for key, values in vary.items():
        if isinstance(values, Mapping):
            axes.append({"key": key, **values})
        elif isinstance(values, (str, bytes)) or not hasattr(values, "__iter__"):
            raise TypeError(f"{key}: give a sequence of values, or a dict of from, to, count")
        else:
            axes.append({"key": key, "values": list(values)})
    tables: Dict[str, Any] = {"schema": 1, "scene": core.name}
    if axes:
        tables["vary"] = axes
    tables["study"] = {"collect": [collect] if isinstance(collect, str) else list(collect)}
    tables["study"].update((key, value) for key, value in settings.items() if value is not None)
    if "trust" in tables["study"]["collect"]:
        refuse_functions(core.to_dict())
    return Study._of(_butee.study(core, tables, threads, *kept, horizon, progress))


__all__ = ["Study"]
