"""Analyses of a scene, performed by the program ``butee``."""

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
    """The analyses of a scene other than its runs."""

    __slots__ = ()

    def whirl(self: "Scene", speed: float, n: int = 0) -> Dict[str, Any]:
        """Damped whirl modes at a speed of rotation in rad/s, as from ``butee modes --speed ... --json``."""
        return _program.json_of(self, "modes", ["--speed", repr(float(speed)), *(["-n", str(n)] if n else [])])

    def campbell(self: "Scene", start: float, stop: float, steps: int, n: int = 0, order: float = 1.0) -> Dict[str, Any]:
        """Whirl modes at ``steps`` + 1 speeds (rad/s) and critical speeds, as from ``butee modes --campbell ... --json``."""
        speeds = [repr(float(start)), repr(float(stop)), str(steps)]
        return _program.json_of(self, "modes", ["--campbell", *speeds, "--order", repr(float(order)),
                                                *(["-n", str(n)] if n else [])])

    def check(self: "Scene") -> Dict[str, Any]:
        """The contents of the scene, its frequencies, likely mistakes and the cost of a run, as from ``butee check --json``."""
        return _program.json_of(self, "check")

    def picture(self: "Scene", file: Union[str, "os.PathLike[str]", None] = None) -> str:
        """A text drawing and description of the scene, as from ``butee check``; if ``file`` is given, also writes the drawing as SVG."""
        return _program.text_of(self, "check", [] if file is None else ["--picture", os.path.abspath(file)])

    def draw(self: "Scene", folder: Union[str, "os.PathLike[str]"], *kinds: str, formats: Union[str, Sequence[str]] = "png",
             probes: Union[str, Sequence[str]] = (), start: Optional[float] = None, stop: Optional[float] = None,
             values: Optional[Mapping[str, Any]] = None, **integrator: Any) -> List[str]:
        """Runs the scene, draws it by gnuplot into ``folder`` and returns their paths, as ``butee run --plot`` and ``butee plot``.

        ``kinds`` are those of ``butee plot --kind`` (``displacement``, ``phase``, ``spectrum``, ``shape``, ...); default: all that the
        results allow. ``probes`` are labels; default: all. The pictures show the time from ``start`` to ``stop`` (s).
        Keywords are keys of ``[integrator]``.
        """
        options = [*_program.words("--kind", kinds), *_program.words("--format", formats), *_program.words("--probe", probes)]
        for name, instant in (("--from", start), ("--to", stop)):
            options += [] if instant is None else [name, repr(float(instant))]
        return _program.pictures_of(self.with_values(values, **integrator), os.fspath(folder), options)

    def draw_modes(self: "Scene", folder: Union[str, "os.PathLike[str]"], n: int = 0, *, closed: Union[str, Sequence[str]] = (),
                   campbell: Optional[Sequence[float]] = None, order: float = 1.0) -> List[str]:
        """Draws the mode shapes by gnuplot into ``folder``, as ``butee modes --plot``; with ``campbell = (start, stop, steps)``
        (rad/s) the Campbell diagram. Returns the paths of the pictures and tables."""
        options = ["--plot", *(["-n", str(n)] if n else [])]
        for selector in [closed] if isinstance(closed, str) else closed:
            options += ["--closed", selector]
        if campbell is not None:
            first, last, steps = campbell
            options += ["--campbell", repr(float(first)), repr(float(last)), str(int(steps)), "--order", repr(float(order))]
        return _program.files_of(self, "modes", os.fspath(folder), options)

    def trust(self: "Scene") -> Dict[str, Any]:
        """The accuracy of the result, and whether the scene is chaotic, as from ``butee run --trust``; needs several runs."""
        return _program.trust_of(self)

    def stability(self: "Scene", **options: Any) -> Dict[str, Any]:
        """Stability limits, period error and numerical damping of the scene's method; see ``butee.stability``."""
        return stability(self.method, plugins=self._core.plugins, **options)

    def compare(self: "Scene", methods: Sequence[Union[str, Mapping[str, Any]]] = (), *, targets: Sequence[float] = (),
                time_limit: float = 2.0, quantities: Union[str, Sequence[str]] = (), end_time: Optional[float] = None,
                reference: Union[str, "os.PathLike[str]"] = "", output: Union[str, "os.PathLike[str]"] = "",
                fresh: bool = False) -> List[Dict[str, Any]]:
        """Run time against error of several methods, as ``butee compare``. Returns a dict for each run, with ``method``, ``knob``,
        ``value``, ``outcome``, ``error_rms``, ``seconds``, ``steps``, ...

        ``methods`` are names, or dicts like ``[[study.method]]`` (``type``, ``sweep``, ``values``, ``with``); default: all methods found.
        ``targets`` are relative errors; a single run takes ``time_limit`` seconds at most. ``quantities`` are the compared columns, and
        ``reference`` is a CSV file with them; without it the reference is computed. Tables and pictures are kept in the folder
        ``output``; a repeated call keeps the runs found there, unless ``fresh`` is set.
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
    """Stability limits, period error and numerical damping of a method, as from ``butee stability METHOD --json``.

    ``damping`` are the damping ratios, and ``stops`` the stiffness ratios k_c/k of a closed stop, that are analysed. Curves and pictures
    are written into the folder ``output``.
    """
    options = [word for key, value in (parameters or {}).items() for word in ("--set", f"{key}={value}")]
    options += [*_program.words("--damping", damping), *_program.words("--stops", stops), *_program.with_plugins(plugins)]
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        to = os.path.abspath(output) if output else "results"
        return json.loads(_program.call(["stability", method, *options, "--json", "-o", to], folder))[0]


def plugins(name: str = "", *, plugins: Plugins = ()) -> Any:
    """Every available method, law, load and element, or the one named ``name``: aliases, parameters with units and defaults, as from
    ``butee plugins --json``."""
    return json.loads(_program.call(["plugins", *([name] if name else []), *_program.with_plugins(plugins), "--json"]))
