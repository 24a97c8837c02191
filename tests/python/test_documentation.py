"""Doctests, the tutorial, and docstrings with annotations for everything public."""

import ast
import doctest
import inspect
import math
import os
import pathlib
import re
import subprocess
import sys

import pytest

import butee
from conftest import ROTOR, SOURCE

DOCTESTS = [test for test in doctest.DocTestFinder().find(butee, module=False) if test.examples]


@pytest.mark.parametrize("test", DOCTESTS, ids=lambda test: test.name)
def test_doctests(test):
    test.globs.update(butee=butee, math=math, scene=butee.Scene(ROTOR))
    assert doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(test).failed == 0


def test_there_are_doctests():
    assert len(DOCTESTS) >= 9


def test_the_tutorial_runs(tmp_path):
    text = (SOURCE / "apps" / "python" / "tutorial.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 6
    code = "\n".join(blocks)
    # The code of the tutorial with fewer and shorter runs.
    shorter = [("291", "9"), ("1500 * turn", "100 * turn"), ("settle=1440", "settle=40")]
    for long, short in shorter:
        assert long in code
        code = code.replace(long, short)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    expected = [line for block in re.findall(r"```text\n(.*?)```", text, re.DOTALL) for line in block.splitlines()]
    assert expected and done.stdout.splitlines()[: len(expected)] == expected
    pictures = re.findall(r'savefig\("(.*?)"', code)
    assert pictures and all((tmp_path / picture).stat().st_size > 1000 for picture in pictures)


def test_the_readme_names_the_path():
    line = re.search(r"PYTHONPATH=\S+", (SOURCE / "README.md").read_text()).group()
    assert (SOURCE / line.partition("=")[2]).resolve() == pathlib.Path(butee.__file__).parents[1].resolve() or "build/release" in line


def public_members():
    for name in butee.__all__:
        thing = getattr(butee, name)
        if not inspect.isclass(thing) and not inspect.isfunction(thing):
            continue
        yield name, thing
        if inspect.isclass(thing):
            own = {member: value for base in thing.__mro__ if base.__module__.startswith("butee") for member, value in vars(base).items()}
            for member, value in own.items():
                if not member.startswith("_") and (callable(value) or isinstance(value, (property, classmethod))):
                    yield f"{name}.{member}", value


@pytest.mark.parametrize("name, thing", public_members(), ids=lambda value: value if isinstance(value, str) else "")
def test_everything_public_is_documented_and_annotated(name, thing):
    if name.startswith("Snapshot") or name == "Scene.copy":
        return
    assert inspect.getdoc(thing), name
    function = thing.fget if isinstance(thing, property) else getattr(thing, "__func__", thing)
    if inspect.isfunction(function) and name not in ("Result.plot", "Result.to_dataframe", "Study.plot", "Study.to_dataframe"):
        assert "return" in function.__annotations__, name


def test_names_are_those_of_the_package():
    assert butee.Scene.__module__ == "butee" and butee.InputError.__module__ == "butee"
    assert re.fullmatch(r"\d+\.\d+\.\d+", butee.__version__)
    assert (pathlib.Path(butee.__file__).parent / "py.typed").exists()


def run_example(name, folder, *arguments):
    environment = dict(os.environ, MPLBACKEND="Agg", BUTEE=butee._program.program())
    path = SOURCE / "apps" / "python" / name
    return subprocess.run([sys.executable, path, *arguments], cwd=folder, env=environment, check=True, capture_output=True,
                          text=True).stdout


def test_example_bifurcation(tmp_path):
    assert run_example("bifurcation.py", tmp_path, "6", "200").startswith("6 loads, ")
    assert (tmp_path / "bifurcation.png").exists()


def test_example_control_loop(tmp_path):
    without, held = (float(line.split()[-2]) for line in run_example("control_loop.py", tmp_path).splitlines())
    assert held < 0.8 * without


def test_example_run_up(tmp_path):
    words = run_example("run_up.py", tmp_path).split()
    critical, peak = float(words[2]), float(words[-2])
    assert critical < peak < 1.2 * critical  # in a run-up the largest orbit follows the critical speed


def test_example_against_scipy(tmp_path):
    out = run_example("against_scipy.py", tmp_path)
    assert float(out.split()[2]) < 1e-5 and "stops closed" in out


def test_the_stub_has_the_names_of_the_extension():
    """The type stub of the extension module matches its contents."""
    tree = ast.parse((SOURCE / "framework" / "python" / "butee" / "_butee.pyi").read_text())
    stub = {}
    for node in tree.body:
        names = [part.target.id if isinstance(part, ast.AnnAssign) else part.name for part in getattr(node, "body", [])
                 if isinstance(part, (ast.AnnAssign, ast.FunctionDef))]
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            stub[node.name] = sorted(names) if isinstance(node, ast.ClassDef) else None
        elif isinstance(node, ast.AnnAssign):
            stub[node.target.id] = None
    module = {}
    for name, value in vars(butee._butee).items():
        if not name.startswith("_"):
            module[name] = sorted(n for n in vars(value) if not n.startswith("_")) if inspect.isclass(value) else None
    assert stub == module
