"""The analyses of a scene that the program does."""

from __future__ import annotations

import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Union

from . import _butee, _program

if TYPE_CHECKING:
    from ._scene import Scene


class Analyses:
    """What scenes can be asked beside their runs."""

    __slots__ = ()

    def whirl(self: "Scene", speed: float, n: int = 0) -> Dict[str, Any]:
        """Damped, whirling modes at a speed of rotation in rad/s, as ``butee modes --speed ... --json`` gives them."""
        return _program.json_of(self, "modes", ["--speed", repr(float(speed)), *(["-n", str(n)] if n else [])])

    def campbell(self: "Scene", start: float, stop: float, steps: int, n: int = 0, order: float = 1.0) -> Dict[str, Any]:
        """Whirling modes at ``steps`` + 1 speeds (rad/s) and critical speeds, as ``butee modes --campbell ... --json``."""
        speeds = [repr(float(start)), repr(float(stop)), str(steps)]
        return _program.json_of(self, "modes", ["--campbell", *speeds, "--order", repr(float(order)),
                                                *(["-n", str(n)] if n else [])])

    def check(self: "Scene") -> Dict[str, Any]:
        """What the scene holds, its frequencies, likely mistakes and the cost of a run, as ``butee check --json``."""
        return _program.json_of(self, "check")

    def picture(self: "Scene") -> str:
        """A drawing of the scene in text, with what it holds, as ``butee check``."""
        return _program.text_of(self, "check")

    def draw(self: "Scene", folder: Union[str, "os.PathLike[str]"], *kinds: str, formats: Union[str, Sequence[str]] = "png",
             values: Optional[Mapping[str, Any]] = None, **integrator: Any) -> List[str]:
        """Runs the scene and draws it by gnuplot into ``folder``, as ``butee run --plot`` and ``butee plot``; the paths of the pictures.

        ``kinds`` are those of ``butee plot --kind`` (``displacement``, ``phase``, ``spectrum``, ``shape``, ...), all that the results allow
        where there are none. Keywords are keys of ``[integrator]``.
        """
        chosen = [formats] if isinstance(formats, str) else list(formats)
        return _program.pictures_of(self.with_values(values, **integrator), os.fspath(folder), kinds, chosen)

    def trust(self: "Scene") -> Dict[str, Any]:
        """How far the answer can be trusted, and whether the scene is chaotic, as ``butee run --trust``: several runs."""
        return _program.trust_of(self)

    def stability(self: "Scene") -> Dict[str, Any]:
        """How far the scene's method is stable, and what it does to period and amplitude; see ``butee.stability``."""
        return stability(self.method)

    def compare(self: "Scene", methods: Sequence[Union[str, Mapping[str, Any]]] = (), *, targets: Sequence[float] = (),
                time_limit: float = 2.0) -> List[Dict[str, Any]]:
        """Run time against error of several methods, as ``butee compare``; a dict for each run, with ``method``, ``knob``,
        ``value``, ``outcome``, ``error_rms``, ``seconds``, ``steps``, ...

        ``methods`` are names, or dicts as of ``[[study.method]]`` (``type``, ``sweep``, ``values``, ``with``); all that are found where
        there are none. ``targets`` are relative errors; a single run takes ``time_limit`` seconds at most.
        """
        study: Dict[str, Any] = {"scenes": ["scene.toml"], "time_limit": float(time_limit)}
        if targets:
            study["targets"] = [float(target) for target in targets]
        if methods:
            study["method"] = [{"type": entry} if isinstance(entry, str) else dict(entry) for entry in methods]
        return _program.comparison_of(self, _butee.toml({"schema": 1, "study": study}))


def stability(method: str, parameters: Optional[Mapping[str, Any]] = None) -> Dict[str, Any]:
    """How far a method is stable, and what it does to period and amplitude, as ``butee stability METHOD --json``."""
    settings = [word for key, value in (parameters or {}).items() for word in ("--set", f"{key}={value}")]
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        return json.loads(_program.call(["stability", method, *settings, "--json", "-o", "results"], folder))[0]


def plugins(name: str = "") -> Any:
    """Every method, law, load and element that is found, or the one of a name: aliases, parameters with units and defaults, as
    ``butee plugins --json``."""
    return json.loads(_program.call(["plugins", *([name] if name else []), "--json"]))
