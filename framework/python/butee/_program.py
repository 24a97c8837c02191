"""Runs the program ``butee`` for analyses of scenes in memory."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import tempfile
from typing import TYPE_CHECKING, Any, Iterator, List, Sequence, Tuple

from . import _butee
from ._errors import InputError, RunError
from ._functions import names_in

if TYPE_CHECKING:
    from ._scene import Scene


def program() -> str:
    """The path of the program that belongs to this package."""
    folder = os.path.dirname(os.path.dirname(_butee.plugin_folder))
    found = os.path.normpath(os.path.join(folder, _butee.lib_to_program))
    if not os.path.exists(found):
        raise RunError(f"{found}: is missing; this butee is only partly installed or built")
    return found


def call(arguments: Sequence[str], folder: str = ".") -> str:
    """Runs the program and returns its output. Its errors become exceptions."""
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


def words(option: str, values: Sequence[Any]) -> List[str]:
    """An option with comma-separated values; empty if there are no values."""
    if isinstance(values, (str, int, float)):
        values = [values]
    return [option, ",".join(value if isinstance(value, str) else repr(float(value)) for value in values)] if len(values) else []


def with_plugins(plugins: Sequence[Any]) -> List[str]:
    if isinstance(plugins, (str, os.PathLike)):
        plugins = [plugins]
    return [word for plugin in plugins for word in ("--plugin", os.path.abspath(plugin))]


def refuse_functions(tables: Any) -> None:
    """Raises InputError if the scene uses laws or loads written in Python, which the program cannot call."""
    names = sorted(names_in(tables))
    if names:
        raise InputError(f"the scene names {', '.join(names)}, which is written in Python; this analysis runs the program butee, "
                         "which supports only laws and loads of modules")


@contextlib.contextmanager
def saved(scene: "Scene") -> Iterator[Tuple[str, List[str]]]:
    """A temporary folder with the scene as ``scene.toml``, and the options that name its modules."""
    refuse_functions(scene.to_dict())
    with tempfile.TemporaryDirectory(prefix="butee-") as folder:
        scene.save(os.path.join(folder, "scene.toml"))
        yield folder, with_plugins(scene._core.plugins)


def json_of(scene: "Scene", command: str, arguments: Sequence[str] = ()) -> Any:
    """The output of a command on a scene with --json."""
    with saved(scene) as (folder, plugins):
        return json.loads(call([command, "scene.toml", *arguments, *plugins, "--json"], folder))


def text_of(scene: "Scene", command: str, arguments: Sequence[str] = ()) -> str:
    """The text output of a command on a scene."""
    with saved(scene) as (folder, plugins):
        return call([command, "scene.toml", *arguments, *plugins], folder)


def pictures_of(scene: "Scene", to: str, options: Sequence[str]) -> List[str]:
    """Runs a scene, draws it into a folder and returns the paths of the pictures."""
    to = os.path.abspath(to)
    with saved(scene) as (folder, plugins):
        call(["run", "scene.toml", "-q", "-o", "results", *plugins], folder)
        return call(["plot", "results", "-o", to, *options, *plugins], folder).splitlines()


def files_of(scene: "Scene", command: str, to: str, options: Sequence[str]) -> List[str]:
    """The paths of the files that a command with -o writes for a scene."""
    to = os.path.abspath(to)
    with saved(scene) as (folder, plugins):
        call([command, "scene.toml", "-q", "-o", to, *options, *plugins], folder)
    return [os.path.join(to, name) for name in sorted(os.listdir(to))]


def trust_of(scene: "Scene") -> Any:
    with saved(scene) as (folder, plugins):
        call(["run", "scene.toml", "--trust", "-q", "-o", "results", *plugins], folder)
        with open(os.path.join(folder, "results", "summary.json"), encoding="utf-8") as file:
            return json.load(file)["trust"]


def comparison_of(scene: "Scene", study: str, to: str, fresh: bool) -> List[Any]:
    import csv

    with saved(scene) as (folder, plugins):
        with open(os.path.join(folder, "study.toml"), "w", encoding="utf-8") as file:
            file.write(study)
        results = os.path.abspath(to) if to else os.path.join(folder, "results")
        call(["compare", "study.toml", "-o", results, *(["--fresh"] if fresh else []), *plugins], folder)
        with open(os.path.join(results, "runs.csv"), encoding="utf-8", newline="") as rows:
            return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(rows)]


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
