"""Many runs of one scene."""

from __future__ import annotations

import itertools
import math
import os
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from . import _butee
from ._result import Result

#: Largest number of points; all points are held in memory.
MOST_POINTS = 10_000_000


class Batch(Sequence[Any]):
    """The runs of ``Scene.batch``: a sequence of their results, or of the values that ``collect`` returned.

    ``batch.points[i]`` is a dict of the values of run i by key; ``batch.values(key)`` is an array of the values of one key for
    all runs, shape (runs,). ``batch.failed`` contains the numbers of the failed runs.
    """

    def __init__(self, keys: Tuple[str, ...], rows: List[Tuple[Any, ...]]):
        self.keys = keys
        self._rows = rows
        self._items: List[Any] = [None] * len(rows)
        self._failed: Dict[int, str] = {}

    def __len__(self) -> int:
        return len(self._items)

    def __getitem__(self, i):
        return self._items[i]

    @property
    def points(self) -> List[Dict[str, Any]]:
        """The values of each run, by key."""
        return [dict(zip(self.keys, row)) for row in self._rows]

    def values(self, key: str) -> np.ndarray:
        """The values of one key in all runs; shape (runs,)."""
        return np.array([row[self.keys.index(key)] for row in self._rows])

    @property
    def failed(self) -> Dict[int, str]:
        """The numbers of the failed runs, each with its message. Their results end at the failure."""
        return dict(sorted(self._failed.items()))

    def peaks(self, column: str) -> np.ndarray:
        """The peak of a column in each run (``Result.peaks``), if results are kept; shape (runs,)."""
        return np.array([result.peaks[column] for result in self._items])

    def __repr__(self) -> str:
        return f"<butee.Batch of {len(self)} runs over {', '.join(self.keys)}; {len(self._failed)} failed>"


def points_of(values: Mapping[str, Sequence[Any]], plan: str) -> Tuple[Tuple[str, ...], List[Tuple[Any, ...]]]:
    keys = tuple(values)
    columns = []
    for key, given in values.items():
        if isinstance(given, (str, bytes)) or not hasattr(given, "__iter__"):
            raise TypeError(f"{key}: give a sequence of values, one for each run")
        columns.append(list(given))
    if plan == "grid":
        points = math.prod(map(len, columns))
        if points > MOST_POINTS:
            raise ValueError(f"the grid has {points:.3g} points, but a batch has at most {MOST_POINTS:.0e}; use fewer values, or study")
        return keys, list(itertools.product(*columns))
    if plan != "list":
        raise ValueError(f'plan = {plan!r}: "grid" (every combination) or "list" (value by value) is allowed')
    if len({len(column) for column in columns}) > 1:
        lengths = ", ".join(f"{key}: {len(column)}" for key, column in zip(keys, columns))
        raise ValueError(f'plan = "list" needs the same number of values for each key; given are {lengths}')
    return keys, list(zip(*columns))


def run_batch(core: "_butee.Session", values: Mapping[str, Sequence[Any]], plan: str, threads: Optional[int],
              collect: Optional[Callable[[Result], Any]], progress: Optional[Callable[[int, int], None]]) -> Batch:
    keys, rows = points_of(values, plan)
    if threads is None:
        threads = len(os.sched_getaffinity(0))
    if threads < 1:
        raise ValueError(f"threads = {threads}: at least 1 is needed")
    batch = Batch(keys, rows)
    runs = _butee.batch(core, list(keys), rows, threads)
    for done, (i, outcome) in enumerate(iter(runs.next, None), 1):
        result = Result(outcome)
        if not result.completed:
            batch._failed[i] = result.message
        batch._items[i] = result if collect is None else collect(result)
        if progress is not None:
            progress(done, len(rows))
    return batch


__all__ = ["Batch"]
