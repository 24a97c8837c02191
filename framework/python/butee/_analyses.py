"""The analyses of a scene that the program does."""

from __future__ import annotations

import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Union

from . import _butee, _program

if TYPE_CHECKING:
    from ._scene import Scene

Plugins = Sequence[Union[str, "os.PathLike[str]"]]


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

    def picture(self: "Scene", file: Union[str, "os.PathLike[str]", None] = None) -> str:
        """A drawing of the scene in text, with what it holds, as ``butee check``; into ``file`` as SVG too, where it is named."""
        return _program.text_of(self, "check", [] if file is None else ["--picture", os.path.abspath(file)])

    def draw(self: "Scene", folder: Union[str, "os.PathLike[str]"], *kinds: str, formats: Union[str, Sequence[str]] = "png",
             probes: Union[str, Sequence[str]] = (), start: Optional[float] = None, stop: Optional[float] = None,
             values: Optional[Mapping[str, Any]] = None, **integrator: Any) -> List[str]:
        """Runs the scene and draws it by gnuplot into ``folder``, as ``butee run --plot`` and ``butee plot``; the paths of the pictures.

        ``kinds`` are those of ``butee plot --kind`` (``displacement``, ``phase``, ``spectrum``, ``shape``, ...), all that the results allow
        where there are none. ``probes`` are labels, all where there are none; the pictures go from ``start`` to ``stop`` (s).
        Keywords are keys of ``[integrator]``.
        """
        options = [*_program.words("--kind", kinds), *_program.words("--format", formats), *_program.words("--probe", probes)]
        for name, instant in (("--from", start), ("--to", stop)):
            options += [] if instant is None else [name, repr(float(instant))]
        return _program.pictures_of(self.with_values(values, **integrator), os.fspath(folder), options)

    def draw_modes(self: "Scene", folder: Union[str, "os.PathLike[str]"], n: int = 0, *, closed: Union[str, Sequence[str]] = (),
                   campbell: Optional[Sequence[float]] = None, order: float = 1.0) -> List[str]:
        """Draws the mode shapes by gnuplot into ``folder``, as ``butee modes --plot``; with ``campbell = (start, stop, steps)``
        (rad/s) the Campbell diagram. The paths of the pictures and tables there."""
        options = ["--plot", *(["-n", str(n)] if n else [])]
        for selector in [closed] if isinstance(closed, str) else closed:
            options += ["--closed", selector]
        if campbell is not None:
            first, last, steps = campbell
            options += ["--campbell", repr(float(first)), repr(float(last)), str(int(steps)), "--order", repr(float(order))]
        return _program.files_of(self, "modes", os.fspath(folder), options)

    def trust(self: "Scene") -> Dict[str, Any]:
        """How far the answer can be trusted, and whether the scene is chaotic, as ``butee run --trust``: several runs."""
        return _program.trust_of(self)

    def stability(self: "Scene", **options: Any) -> Dict[str, Any]:
        """How far the scene's method is stable, and what it does to period and amplitude; see ``butee.stability``."""
        return stability(self.method, plugins=self._core.plugins, **options)

    def compare(self: "Scene", methods: Sequence[Union[str, Mapping[str, Any]]] = (), *, targets: Sequence[float] = (),
                time_limit: float = 2.0, quantities: Union[str, Sequence[str]] = (), end_time: Optional[float] = None,
                reference: Union[str, "os.PathLike[str]"] = "", output: Union[str, "os.PathLike[str]"] = "",
                fresh: bool = False) -> List[Dict[str, Any]]:
        """Run time against error of several methods, as ``butee compare``; a dict for each run, with ``method``, ``knob``,
        ``value``, ``outcome``, ``error_rms``, ``seconds``, ``steps``, ...

        ``methods`` are names, or dicts as of ``[[study.method]]`` (``type``, ``sweep``, ``values``, ``with``); all that are found where
        there are none. ``targets`` are relative errors; a single run takes ``time_limit`` seconds at most. ``quantities`` are the columns
        that are compared, ``reference`` is a CSV file with them, computed where there is none. Tables and pictures are kept in the folder
        ``output``, from where the same call goes on; with ``fresh`` it begins anew.
        """
        study: Dict[str, Any] = {"scenes": ["scene.toml"], "time_limit": float(time_limit)}
        if len(targets):
            study["targets"] = [float(target) for target in targets]
        if quantities:
            study["quantity"] = [quantities] if isinstance(quantities, str) else list(quantities)
        if end_time is not None:
            study["end_time"] = float(end_time)
        if reference:
            study["reference"] = os.path.abspath(reference)
        if methods:
            study["method"] = [{"type": entry} if isinstance(entry, str) else dict(entry) for entry in methods]
        return _program.comparison_of(self, _butee.toml({"schema": 1, "study": study}), os.fspath(output), fresh)


def stability(method: str, parameters: Optional[Mapping[str, Any]] = None, *, damping: Sequence[float] = (),
              stops: Sequence[float] = (), output: Union[str, "os.PathLike[str]"] = "", plugins: Plugins = ()) -> Dict[str, Any]:
    """How far a method is stable, and what it does to period and amplitude, as ``butee stability METHOD --json``.

    ``damping`` are damping ratios and ``stops`` stiffnesses k_c/k of a closed stop that are looked at. Curves and pictures go into the
    folder ``output``.
    """
    options = [word for key, value in (parameters or {}).items() for word in ("--set", f"{key}={value}")]
    options += [*_program.words("--damping", damping), *_program.words("--stops", stops), *_program.with_plugins(plugins)]
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        to = os.path.abspath(output) if output else "results"
        return json.loads(_program.call(["stability", method, *options, "--json", "-o", to], folder))[0]


def plugins(name: str = "", *, plugins: Plugins = ()) -> Any:
    """Every method, law, load and element that is found, or the one of a name: aliases, parameters with units and defaults, as
    ``butee plugins --json``."""
    return json.loads(_program.call(["plugins", *([name] if name else []), *_program.with_plugins(plugins), "--json"]))
