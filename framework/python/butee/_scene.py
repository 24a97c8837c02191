"""Scenes: what is to be computed."""

from __future__ import annotations

import os
import warnings
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Union

from . import _butee
from ._errors import SceneWarning
from ._result import Result

Plugins = Sequence[Union[str, "os.PathLike[str]"]]
#: Called some times a second with the present time and the end time, s; what it raises ends the run.
Progress = Callable[[float, float], None]


def _paths(plugins: Plugins) -> List[str]:
    if isinstance(plugins, (str, os.PathLike)):
        plugins = [plugins]
    return [os.fspath(plugin) for plugin in plugins]


def _warn(messages: Iterable[str]) -> None:
    for message in messages:
        warnings.warn(message, SceneWarning, stacklevel=3)


class Scene:
    """A scene: elements, stops, loads, a method, and what is asked of its output; as in a model file, in SI units.

    ``source`` is a dict of the tables of a model file, or the text of one. A scene is valid at any time: whatever would make it
    invalid raises InputError with every mistake, and changes nothing. Values are read and set by the keys that ``--set``
    takes on the command line:

    >>> scene["contact[0].gap"]
    0.0004
    >>> scene["contact[0].gap"] = 0.0005
    >>> scene["contact[0].gap"] = -1
    Traceback (most recent call last):
    butee._errors.InputError: --set contact[0].gap=-1: contact[0].gap = -1: must be at least 0
    >>> scene["contact[0].gap"]
    0.0005

    Scenes can be copied and pickled. A run goes on with the scene as it was when the run began.
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

        ``overrides`` are texts ``KEY=VALUE`` as after ``--set``, or a dict of keys and values. ``plugins`` are modules or folders of
        modules, as after ``--plugin``.
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
        """The value at ``key``, or ``default`` where nothing is written there."""
        return self._core.find(key) if self._core.contains(key) else default

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several keys at once, for values that are valid together alone. None takes a key out."""
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
        """A copy, which may be changed alone."""
        return self._of(self._core)

    __copy__ = copy

    def __deepcopy__(self, memo: Dict[int, Any]) -> "Scene":
        return self.copy()

    def __reduce__(self):
        return _restored, (type(self), self._core.state(), self._core.plugins)

    # --- as a whole

    @property
    def title(self) -> str:
        """The scene's title, "" where it has none."""
        return self._core.title

    @property
    def method(self) -> str:
        """The canonical name of the time integrator."""
        return self._core.method

    @property
    def warnings(self) -> List[str]:
        """What reading the scene warned of."""
        return self._core.warnings

    def to_dict(self) -> Dict[str, Any]:
        """The tables of the scene; ``Scene(scene.to_dict())`` is an equal one."""
        return self._core.to_dict()

    def to_toml(self) -> str:
        """The scene as the text of a model file."""
        return self._core.to_toml("")

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes a model file. Files that the scene names are found from there, with their size and checksum."""
        path = os.fspath(path)
        text = self._core.to_toml(os.path.dirname(path) or ".")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    def __repr__(self) -> str:
        return f"<butee.Scene {self._core.name!r}: {self.title!r}, {self.method} to t = {self._core.end_time:g} s>"

    # --- what can be done with it

    def run(self, values: Optional[Mapping[str, Any]] = None, *, progress: Union[bool, Progress] = False,
            output: Union[str, "os.PathLike[str]", None] = None, **integrator: Any) -> Result:
        """Integrates the scene, with other ``values`` where given, and leaves the scene as it is.

        Keywords are keys of ``[integrator]``: ``end_time``, ``time_step``, ``type``, ``tolerance``, ...
        ``progress`` is True for a bar on standard error, or a function of the present time and the end time (s) that is called
        some times a second. ``output`` is a folder for the files that ``butee run -o`` writes.

        Other Python threads go on meanwhile. Ctrl-C ends the run after a step. Raises InputError where the scene cannot be run,
        and RunError, with the result so far, where the run fails.

        >>> scene.run(end_time=0.01).summary["status"]
        'completed'
        """
        core = self._with(values, integrator)
        end = core.end_time
        call = (lambda t: progress(t, end)) if callable(progress) else None
        result = Result(core.run(call, progress is True, "" if output is None else os.fspath(output)))
        if result._core.warnings:
            _warn(result._core.warnings)
        return result.check()


def _restored(cls, state: bytes, plugins: List[str]) -> Scene:
    return cls._of(_butee.from_state(state, plugins))
