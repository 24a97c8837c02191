"""The analyses that the program does, on scenes in memory."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from typing import TYPE_CHECKING, Any, List, Sequence, Tuple

from . import _butee
from ._errors import InputError, RunError

if TYPE_CHECKING:
    from ._scene import Scene


def program() -> str:
    """The program that belongs to this package."""
    folder = os.path.dirname(os.path.dirname(_butee.plugin_folder))
    found = os.path.normpath(os.path.join(folder, _butee.lib_to_program))
    if not os.path.exists(found):
        raise RunError(f"{found}: is missing; this butee is not installed as a whole, or was only partly built")
    return found


def call(arguments: Sequence[str], folder: str = ".") -> str:
    """Runs the program; what it printed. Its errors become exceptions."""
    process = subprocess.Popen([program(), *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        out, errors = process.communicate()
    except BaseException:
        process.terminate()
        process.wait()
        raise
    if process.returncode != 0:
        raise (InputError if process.returncode == 2 else RunError)(errors.strip())
    return out


def _folder_with(scene: "Scene", folder: str) -> Tuple[str, List[str]]:
    scene.save(os.path.join(folder, "scene.toml"))
    return "scene.toml", [word for plugin in scene._core.plugins for word in ("--plugin", os.path.abspath(plugin))]


def json_of(scene: "Scene", command: str, arguments: Sequence[str] = ()) -> Any:
    """What a command says of a scene with --json."""
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        name, plugins = _folder_with(scene, folder)
        return json.loads(call([command, name, *arguments, *plugins, "--json"], folder))


def text_of(scene: "Scene", command: str) -> str:
    """What a command prints of a scene."""
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        name, plugins = _folder_with(scene, folder)
        return call([command, name, *plugins], folder)


def pictures_of(scene: "Scene", to: str, kinds: Sequence[str], formats: Sequence[str]) -> List[str]:
    """Runs a scene and draws it into a folder; the paths of the pictures."""
    to = os.path.abspath(to)
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        name, plugins = _folder_with(scene, folder)
        call(["run", name, "-q", "-o", "results", *plugins], folder)
        chosen = ["--kind", ",".join(kinds)] if kinds else []
        return call(["plot", "results", "-o", to, "--format", ",".join(formats), *chosen, *plugins], folder).splitlines()


def trust_of(scene: "Scene") -> Any:
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        name, plugins = _folder_with(scene, folder)
        call(["run", name, "--trust", "-q", "-o", "results", *plugins], folder)
        with open(os.path.join(folder, "results", "summary.json"), encoding="utf-8") as file:
            return json.load(file)["trust"]


def comparison_of(scene: "Scene", study: str) -> List[Any]:
    import csv

    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        name, plugins = _folder_with(scene, folder)
        if study:
            name = "study.toml"
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(study)
        call(["compare", name, "-o", "results", *plugins], folder)
        with open(os.path.join(folder, "results", "runs.csv"), encoding="utf-8", newline="") as file:
            return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(file)]


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
