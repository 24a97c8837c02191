"""Calls with arbitrary arguments raise errors and never crash the interpreter."""

import pathlib
import subprocess
import sys

import pytest

CALLS = 4000

FUZZ = """
import faulthandler, gc, inspect, random, re, signal, sys, warnings
faulthandler.enable()
sys.path.insert(0, {path!r})
import numpy as np
import butee
from conftest import ROTOR

warnings.simplefilter("ignore")
choose = random.Random({seed})

class Stop(Exception):
    pass

def stop(*_):
    raise Stop

class Broken:
    def __float__(self):
        raise ZeroDivisionError
    __index__ = __len__ = __iter__ = __float__

signal.signal(signal.SIGALRM, stop)
VALUES = [None, 0, 1, -1, 2**31, 2**63, 2**70, -2**63, 1.0, 1e-3, float("nan"), float("inf"), 1e308, 5e-324, True, object(), Broken(),
          "", "u", "rotor", "rotor.u", "contact[0].gap", "contact[99999999999].gap", "peak rotor.u", "all", "x" * 1000, "\\x00", "\\ud800",
          b"x", [], [1], [[1.0]], ["rotor"], ["rotor", "rotor"], [float("nan")], (), (1, 2), {{1}}, {{}}, {{"a": 1}}, {{1: 2}},
          {{"contact[0].gap": [1e-4]}}, {{"contact[0].gap": -1.0}}, np.zeros(0), np.zeros(1), np.zeros((2, 2)), np.array([np.nan]),
          np.arange(5.0)[::-1], np.array(["a"]), np.array([1], dtype=object), np.zeros(1, dtype=complex), np.float32(1), range(3),
          lambda *_: 1.0, print, butee, type, Exception]
# Programs, folders and pictures have tests of their own.
LEFT_OUT = {{"trust", "compare", "draw", "draw_modes", "check", "picture", "stability", "whirl", "campbell", "save", "plot", "to_dataframe"}}

def made():
    scene = butee.Scene(ROTOR).with_values(end_time=0.001)
    part = scene.structure(forced=["rotor"])
    return [scene, part, scene.run(), scene.equations(), scene.batch({{"load[0].amplitude": [1e5]}}),
            scene.study({{"load[0].amplitude": [1e5]}}, ["peak rotor.u"], periods=1), part.snapshot()]

def count_of(function):
    try:
        return len([p for p in inspect.signature(function).parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD])
    except (TypeError, ValueError):
        first = (function.__doc__ or "").split("\\n")[0]
        return first.count(": ") - first.count("self: ")

free = [value for name, value in vars(butee._butee).items() if not name.startswith("_") and callable(value)]
errors = set()
for call in range({calls}):
    if call % 500 == 0:
        objects = made()
        cores = [thing._core for thing in objects if hasattr(thing, "_core")]
    thing = choose.choice(objects + cores)
    names = [name for name in dir(thing) if name not in LEFT_OUT and (name[0] != "_" or name in ("__getitem__", "__setitem__", "__contains__"))]
    pool = VALUES + objects + cores
    # Runs that never end are ended as by Ctrl-C.
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        target = choose.choice(free) if choose.random() < 0.2 else getattr(thing, choose.choice(names))
        if callable(target):
            count = count_of(target) if choose.random() < 0.9 else choose.randrange(6)
            target(*(choose.choice(pool) for _ in range(max(count, 0))))
    except Exception as error:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        errors.add(type(error).__name__)
    signal.setitimer(signal.ITIMER_REAL, 0.0)
del objects, cores, thing, target, pool
gc.collect()
assert {{"TypeError", "ValueError", "InputError"}} <= errors, errors
expected = butee.Scene(ROTOR).run()["rotor.u"]
assert expected.size == 2501 and np.isfinite(expected).all()
print("done")
"""


@pytest.mark.parametrize("seed", range(2))
def test_arguments_of_all_kinds(seed, tmp_path):
    code = FUZZ.format(path=str(pathlib.Path(__file__).parent), seed=seed, calls=CALLS)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=250)
    assert (done.returncode, done.stdout.splitlines()[-1:]) == (0, ["done"]), done.stderr[-3000:]
