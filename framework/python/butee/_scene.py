"""Scenes: descriptions of computations."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from . import _butee
from ._analyses import Analyses
from ._batch import Batch, run_batch
from ._equations import Equations, Modes
from ._errors import SceneWarning
from ._program import trust_of
from ._result import Result
from ._structure import Structure
from ._study import Collected, Study, run_study

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

Plugins = Sequence[Union[str, "os.PathLike[str]"]]
#: Called some times a second with the present time and the end time, s; an exception from it ends the run.
Progress = Callable[[float, float], None]


def _paths(plugins: Plugins) -> List[str]:
    if isinstance(plugins, (str, os.PathLike)):
        plugins = [plugins]
    return [os.fspath(plugin) for plugin in plugins]


def _warn(messages: Iterable[str]) -> None:
    for message in messages:
        warnings.warn(message, SceneWarning, stacklevel=3)


class Scene(Analyses):
    """A scene: elements, stops, loads, a method and the requested output; as in a model file, in SI units.

    ``source`` is a dict of the tables of a model file, or its text. A scene is always valid: a change that would make it invalid
    raises InputError with all mistakes and has no effect. Values are read and set by the keys that ``--set`` takes on the
    command line:

    >>> scene["contact[0].gap"]
    0.0004
    >>> scene["contact[0].gap"] = 0.0005
    >>> scene["contact[0].gap"] = -1
    Traceback (most recent call last):
    butee.InputError: --set contact[0].gap=-1: contact[0].gap = -1: must be >= 0 (m)
    >>> scene["contact[0].gap"]
    0.0005

    Scenes can be copied and pickled. A run uses the scene as it was when the run began.
    """

    __slots__ = ("_core", "__weakref__")

    def __init__(self, source: Union[Mapping[str, Any], str], *, name: str = "scene", plugins: Plugins = ()):
        if isinstance(source, str):
            self._core = _butee.from_toml(source, name, _paths(plugins))
        else:
            self._core = _butee.from_dict(dict(source), name, _paths(plugins))
        _warn(self._core.warnings)

    @classmethod
    def load(cls, path: Union[str, "os.PathLike[str]"], overrides: Union[Mapping[str, Any], Sequence[str]] = (), *,
             plugins: Plugins = ()) -> "Scene":
        """Reads a model file.

        ``overrides`` are texts ``KEY=VALUE`` as for ``--set``, or a dict of keys and values. ``plugins`` are modules or folders of
        modules, as for ``--plugin``.
        """
        texts = [] if isinstance(overrides, Mapping) else [overrides] if isinstance(overrides, str) else list(overrides)
        core = _butee.load(os.fspath(path), texts, _paths(plugins))
        if isinstance(overrides, Mapping) and overrides:
            core = core.with_values(dict(overrides))
        _warn(core.warnings)
        return cls._of(core)

    @classmethod
    def _of(cls, core: "_butee.Session") -> "Scene":
        scene = cls.__new__(cls)
        scene._core = core
        return scene

    # --- values by key

    def __getitem__(self, key: str) -> Any:
        return self._core.find(key)

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __delitem__(self, key: str) -> None:
        self._core = self._core.with_values({key: None})

    def __contains__(self, key: str) -> bool:
        return self._core.contains(key)

    def get(self, key: str, default: Any = None) -> Any:
        """The value at ``key``, or ``default`` if the scene does not contain the key."""
        return self._core.find(key) if self._core.contains(key) else default

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several keys at once, for values that are only valid together. None removes a key."""
        self._core = self._core.with_values(dict(values))
        _warn(self._core.warnings)

    def with_values(self, values: Optional[Mapping[str, Any]] = None, **integrator: Any) -> "Scene":
        """A copy with other values; keywords are keys of ``[integrator]``.

        >>> scene.with_values({"load[0].amplitude": 1e4}, end_time=0.5)["integrator.end_time"]
        0.5
        """
        return self._of(self._with(values, integrator))

    def _with(self, values: Optional[Mapping[str, Any]], integrator: Mapping[str, Any]) -> "_butee.Session":
        if not values and not integrator:
            return self._core
        changes = dict(values or {})
        changes.update((f"integrator.{key}", value) for key, value in integrator.items())
        return self._core.with_values(changes)

    def copy(self) -> "Scene":
        """An independent copy."""
        return self._of(self._core)

    __copy__ = copy

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Scene":
        return self.copy()

    def __reduce__(self):
        return _restored, (type(self), self._core.state(), self._core.plugins)

    # --- as a whole

    @property
    def title(self) -> str:
        """The scene's title, "" if it has none."""
        return self._core.title

    @property
    def method(self) -> str:
        """The canonical name of the time integrator."""
        return self._core.method

    @property
    def warnings(self) -> List[str]:
        """The warnings from reading the scene."""
        return self._core.warnings

    def to_dict(self) -> Dict[str, Any]:
        """The tables of the scene; ``Scene(scene.to_dict())`` is an equal scene."""
        return self._core.to_dict()

    def to_toml(self) -> str:
        """The scene as the text of a model file."""
        return self._core.to_toml("")

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a model file. Paths in it are adjusted to its folder; the size and checksum of the named files are stored."""
        path = os.fspath(path)
        text = self._core.to_toml(os.path.dirname(path) or ".")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def __repr__(self) -> str:
        return f"<butee.Scene {self._core.name!r}: {self.title!r}, {self.method} to t = {self._core.end_time:g} s>"

    # --- runs and analyses

    def run(self, values: Optional[Mapping[str, Any]] = None, *, progress: Union[bool, Progress] = False,
            output: Union[str, "os.PathLike[str]", None] = None, resume: bool = False, repeat: int = 1,
            **integrator: Any) -> Result:
        """Integrates the scene, with changed ``values`` if given; the scene itself is not changed.

        Keywords are keys of ``[integrator]``: ``end_time``, ``time_step``, ``type``, ``tolerance``, ...
        ``progress`` is True for a bar on standard error, or a function of the present time and the end time (s) that is called
        some times a second. ``output`` is a folder for the files that ``butee run -o`` writes, including checkpoints if the
        scene requests them (``output.checkpoint``). With ``resume`` an interrupted run continues from the newest checkpoint to
        the same bits, and the result contains the rows from there on; without a checkpoint it runs from the start. ``repeat``
        integrates the scene this many times and returns the result of the fastest run (``summary["wall_seconds"]``); files are
        those of the last run.

        Other Python threads continue meanwhile. Ctrl-C ends the run after a step. Raises InputError if the scene cannot be run,
        and RunError, with the result so far, if the run fails.

        >>> scene.run(end_time=0.01).summary["status"]
        'completed'
        """
        if resume and output is None:
            raise ValueError("resume: output must name the folder of the run to resume")
        if repeat < 1 or (resume and repeat > 1):
            raise ValueError(f"repeat = {repeat}: 1 or more is needed, and 1 with resume")
        core = self._with(values, integrator)
        end = core.end_time
        call = (lambda t: progress(t, end)) if callable(progress) else None
        to = "" if output is None else os.fspath(output)
        result = Result(core.run(call, progress is True, to, resume))
        for _ in range(repeat - 1):
            again = Result(core.run(call, progress is True, to, resume))
            if not result.completed or again.summary["wall_seconds"] < result.summary["wall_seconds"]:
                result = again
        if result._core.warnings:
            _warn(result._core.warnings)
        return result.check()

    def batch(self, values: Mapping[str, Sequence[Any]], *, threads: Optional[int] = None, plan: str = "grid",
              collect: Optional[Callable[[Result], Any]] = None, progress: Optional[Callable[[int, int], None]] = None,
              **integrator: Any) -> Batch:
        """Runs the scene once for each combination of ``values``, on threads that do not hold the interpreter's lock.

        ``values`` is a dict of keys, each with a sequence of values. ``plan`` is ``"grid"``, all combinations with the last key varying
        fastest, or ``"list"``, value by value. ``threads`` defaults to the number of processors. ``collect`` maps each result to the
        value that is kept, so that results need not stay in memory; it and ``progress(done, runs)`` are called on this thread.
        Keywords are keys of ``[integrator]`` for all runs. Results are the same bits as those of ``run``.

        Bad input raises InputError. A run that fails does not end the others: see ``Batch.failed``.

        >>> many = scene.batch({"load[0].amplitude": [1e5, 2e5]}, end_time=0.01)
        >>> [result.completed for result in many]
        [True, True]
        """
        return run_batch(self._with(None, integrator), values, plan, threads, collect, progress)

    def study(self, vary: Mapping[str, Any], collect: Collected, *, plan: str = "grid", count: Optional[int] = None,
              seed: Optional[int] = None, follow: Union[bool, str] = False, settle: int = 0, periods: Optional[int] = None,
              period: Optional[float] = None, steady: Optional[float] = None, threads: Optional[int] = None,
              output: Union[str, "os.PathLike[str]"] = "", format: str = "", fresh: bool = False,
              progress: Optional[Callable[[int, int], None]] = None, **integrator: Any) -> Study:
        """Runs the scene at many points and keeps a row of numbers for each, as ``butee study``, on threads without the interpreter's lock.

        ``vary`` is a dict of keys, each with a sequence of values, or with ``{"from": ..., "to": ..., "count": ...}``; ``collect``
        names the results, ``"peak rotor.u"``, ``"section rotor.u"``, ``"impacts"``, ``"lyapunov"``, ...; ``butee help study``
        explains them and the other arguments. If the points differ only in loads, gaps and laws, each thread assembles and
        factorizes the system once. ``output`` is a folder as for ``butee study -o``: finished runs are kept there, and the same
        call continues after Ctrl-C, or starts again with ``fresh``; ``format`` is ``"hdf5"`` (if installed) or ``"csv"``.
        ``progress(done, runs)`` is called some times a second. Keywords are keys of ``[integrator]``
        for all runs. Rows do not depend on the number of threads.

        Bad input raises InputError; a failed run gives a row, see ``Study.failed``.

        >>> rows = scene.study({"load[0].amplitude": [1e5, 2e5]}, ["peak rotor.u", "impacts"], settle=5, periods=10)
        >>> rows["peak rotor.u"].shape, rows.units["peak rotor.u"], list(rows["status"])
        ((2,), 'm', ['completed', 'completed'])
        """
        settings = {"plan": plan, "count": count, "seed": seed, "follow": follow, "settle": settle, "periods": periods,
                    "period": period, "steady": steady}
        return run_study(self._with(None, integrator), vary, collect, settings, threads, (os.fspath(output), format, fresh),
                         lambda judged: trust_of(self._of(judged))["horizon"], progress)

    def equations(self) -> Equations:
        """M, C, K, the forces of loads and stops, and the initial state, for other solvers."""
        return Equations(_butee.equations(self._core))

    def matrices(self) -> Tuple["csc_matrix", "csc_matrix", "csc_matrix"]:
        """M, C and K on the free degrees of freedom, (n, n) each, as ``scipy.sparse.csc_matrix``; see ``Equations``.

        >>> M, C, K = scene.matrices()
        >>> M.toarray(), C.toarray(), K.toarray()
        (array([[100.]]), array([[50.]]), array([[1.e+09]]))
        """
        equations = self.equations()
        return equations.M, equations.C, equations.K

    def modes(self, n: int = 0, *, closed: Union[str, Sequence[str]] = ()) -> Modes:
        """The ``n`` lowest natural modes (0: 10, or all of a smaller scene), as from ``butee modes``.

        ``closed`` are selectors of nodes whose stops count as closed, or ``"all"``.
        """
        if n < 0:
            raise ValueError(f"n = {n}: a positive number of modes is required")
        return Modes(**_butee.modes(self._core, n, [closed] if isinstance(closed, str) else list(closed)))

    def structure(self, forced: Union[str, Sequence[str]] = ()) -> Structure:
        """The scene as a part of another computation. ``forced`` are selectors of the nodes on which forces will act,
        ``"string:middle"``, or ``"string:all.theta"`` for moments."""
        return Structure(_butee.part(self._core, [forced] if isinstance(forced, str) else list(forced)))


def _restored(cls, state: bytes, plugins: List[str]) -> Scene:
    return cls._of(_butee.from_state(state, plugins))
