"""Loads written in Python."""

import gc
import math
import pickle

import numpy as np
import pytest

import butee
from conftest import ROTOR


@butee.load("python_cosine")
def cosine(t, amplitude, omega=1256.6):
    return amplitude * math.cos(omega * t)


def with_load(**load):
    return butee.Scene({**ROTOR, "load": [{"node": "rotor", **load}], "integrator": {"type": "rodas4", "tolerance": 1e-8, "end_time": 0.02}})


def test_a_load_in_python_is_a_load():
    ours = with_load(type="python_cosine", amplitude=2e5)
    theirs = with_load(type="harmonic", amplitude=2e5, angular_frequency=1256.6)
    u, expected = ours.run()["rotor.u"], theirs.run()["rotor.u"]
    # One uses the load's exact derivative and the other finite differences, so their steps differ.
    assert np.abs(u - expected).max() < 1e-5 * np.abs(expected).max()
    assert np.isclose(ours.equations().external_force(0.001)[0], cosine(0.001, 2e5), rtol=1e-15)
    many = ours.batch({"load[0].amplitude": [1e5, 2e5]}, threads=2)
    assert np.array_equal(many[1]["rotor.u"], u)
    part = ours.structure()
    part.advance_to(0.001)
    assert part.x[0] > 0.0
    assert np.array_equal(pickle.loads(pickle.dumps(ours)).run()["rotor.u"], u)


def test_keys_are_checked():
    for load in ({}, {"amplitude": "x"}, {"amplitude": 1.0, "phase": 0.0}):
        with pytest.raises(butee.InputError):
            with_load(type="python_cosine", **load)


def test_what_it_raises_fails_the_run():
    @butee.load("python_broken")
    def broken(t):
        return 1.0 / (1.0 - 100.0 * t) if t < 0.01 else [][3]

    with pytest.raises(butee.RunError, match="IndexError") as caught:
        with_load(type="python_broken").run()
    assert caught.value.result.t.size > 0

    @butee.load("python_text")
    def text(t):
        return "much"

    with pytest.raises((butee.RunError, RuntimeError, TypeError)):
        with_load(type="python_text").run()

    @butee.load("python_nan")
    def nan(t):
        return math.nan if t > 0.01 else 0.0

    with pytest.raises(butee.RunError):
        with_load(type="python_nan").run()


def test_names_that_are_taken_or_wrong():
    with pytest.raises(butee.RunError, match="registered twice"):
        butee.load("harmonic")(cosine)
    with pytest.raises(butee.RunError, match="registered twice"):
        butee.load("distributed")(cosine)
    for function in (lambda: 0.0, lambda t, *more: 0.0, lambda t, *, key: 0.0):
        with pytest.raises(TypeError):
            butee.load("python_wrong")(function)
    with pytest.raises((TypeError, ValueError)):
        butee.load("python_wrong")(lambda t, key="text": 0.0)
    for decorator in (butee.load, butee.law):
        with pytest.raises(TypeError, match="NAME"):
            decorator(cosine)


def test_a_function_lives_as_long_as_its_scene():
    scenes = []
    for factor in (1.0, 2.0):
        butee.load("python_again")(lambda t, factor=factor: factor)
        scenes.append(with_load(type="python_again"))
    gc.collect()
    assert [scene.equations().external_force(0.0)[0] for scene in scenes] == [1.0, 2.0]
