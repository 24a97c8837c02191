"""Structures: co-simulation, snapshots, pickles."""

import pickle

import numpy as np
import pytest

import butee
from conftest import MODELS


@pytest.fixture
def part(rotor):
    del rotor["load"]
    return rotor.structure(forced=["rotor"])


def test_a_force_acts_as_a_load_does(rotor):
    rotor["load"] = [{"type": "ramp", "node": "rotor", "from": 0.0, "to": 5.0e5, "start": 0.0, "end": 0.01}]
    expected = rotor.run(end_time=0.01, type="exact")["rotor.u"][-1]
    del rotor["load"]
    rotor.update({"integrator.type": "exact", "integrator.tolerance": None})
    part = rotor.structure(forced="rotor")
    windows = np.linspace(0.0, 0.01, 11)
    for begin, end in zip(windows, windows[1:]):
        part.set_forces([5.0e7 * begin], [5.0e7 * end], end)
        part.advance_to(end)
    # The same linear force in ten windows: the Taylor series of exact end at the window boundaries.
    assert part.time == 0.01 and np.isclose(part.x[0], expected, rtol=1e-9)
    assert part.x[0] > 4.0e-4 and part.contact_force(0) < 0.0


def test_reads_and_sets(part):
    assert part.dofs == ["u of rotor"] and part.forced_dofs == [0] and part.dof("rotor") == 0 and part.dof_list("rotor") == [0]
    part.forces = np.array([2.0e5])
    assert np.array_equal(part.forces, [2.0e5])
    part.advance_to(1.0e-3)
    assert part.time == 1.0e-3 and part.steps > 0
    assert part.displacement(0) == part.x[0] > 0.0 and part.velocity(0) == part.v[0] and part.acceleration(0) == part.a[0]
    assert np.isclose(part.energy["kinetic"], 50.0 * part.v[0] ** 2, rtol=1e-12)
    assert np.isclose(part.quantity("u", "rotor"), part.x[0])
    part.set_motion([1.0e-4], [0.5])
    assert part.x[0] == 1.0e-4 and part.v[0] == 0.5
    assert part.advance_step(1.0) == part.time > 1.0e-3


def test_forces_of_contacts_with_dissipation(rotor):
    rotor["contact[0].damping"] = {"type": "kelvin_voigt", "coefficient": 2.0e4}
    part = rotor.structure()
    part.set_motion([5.0e-4], [3.0])
    assert np.isclose(part.contact_force(0), -1.0e6 - 6.0e4, rtol=1e-12)


def test_arrays_are_copies_that_cannot_be_changed(part):
    part.forces = [2.0e5]
    for array in (part.x, part.v, part.a, part.forces):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    x = part.x
    part.advance_to(1.0e-3)
    assert x[0] == 0.0 and part.x[0] != 0.0 and part.forces[0] == 2.0e5


@pytest.mark.parametrize("model", ["beam1", "beam4"])
def test_restore_goes_back_to_the_bit(model):
    part = butee.Scene.load(MODELS / f"{model}.toml").structure(forced=["string:middle"])
    part.forces = [100.0]
    part.advance_to(0.01)
    before = part.snapshot()
    assert before.time == 0.01
    courses = []
    for _ in range(2):
        part.restore(before)
        assert part.forces[0] == 100.0
        part.forces = [50.0]
        part.advance_to(0.03)
        courses.append(np.concatenate([part.x, part.v, part.a]))
    assert np.array_equal(*courses)
    other = pickle.loads(pickle.dumps(before))
    part.restore(other)
    part.forces = [50.0]
    part.advance_to(0.03)
    assert np.array_equal(courses[0], np.concatenate([part.x, part.v, part.a]))


def test_a_pickled_structure_goes_on_to_the_bit(part):
    part.forces = [3.0e5]
    part.advance_to(2.0e-3)
    other = pickle.loads(pickle.dumps(part))
    assert other.time == part.time and np.array_equal(other.forces, part.forces)
    for structure in (part, other):
        structure.advance_to(7.0e-3)
    assert np.array_equal(part.x, other.x) and np.array_equal(part.v, other.v)


def test_wrong_calls_change_nothing(part):
    part.forces = [1.0e5]
    part.advance_to(1.0e-3)
    state = (part.time, part.x[0], part.v[0], part.forces[0])
    nan = float("nan")
    calls = [
        lambda: part.advance_to(0.0), lambda: part.advance_to(nan), lambda: part.advance_to(float("inf")),
        lambda: part.advance_to("later"), lambda: part.advance_step(0.0), lambda: part.displacement(5),
        lambda: part.displacement(-1), lambda: part.set_motion([1.0, 2.0], [0.0]), lambda: part.set_motion([nan], [0.0]),
        lambda: part.set_motion([[0.0]], [0.0]), lambda: part.set_force(3, 1.0), lambda: part.set_force(0, nan),
        lambda: setattr(part, "forces", [nan]), lambda: setattr(part, "forces", [1.0, 2.0]), lambda: setattr(part, "forces", 5.0),
        lambda: setattr(part, "forces", None), lambda: part.set_forces([0.0], [1.0], 0.0), lambda: part.set_forces([0.0], [nan], 1.0),
        lambda: part.dof("nobody"), lambda: part.dof("rotor", "theta"), lambda: part.dof("rotor", "q"),
        lambda: part.quantity("q", "rotor"), lambda: part.restore(None), lambda: part.restore(5),
    ]
    for number, call in enumerate(calls):
        with pytest.raises((ValueError, TypeError)):
            call()
            pytest.fail(f"call {number} was taken")
        assert (part.time, part.x[0], part.v[0], part.forces[0]) == state, number


def test_snapshots_of_others_are_refused(part, rotor):
    rotor["contact[0].gap"] = 1.0
    with pytest.raises(ValueError, match="another structure"):
        part.restore(rotor.structure(forced=["rotor"]).snapshot())
    state = pickle.dumps(part.snapshot())
    with pytest.raises(Exception):
        pickle.loads(state[:-20])
    with pytest.raises(butee.Error):
        butee._butee.snapshot(b"12345678901234567890")
    with pytest.raises(butee.InputError, match="nobody"):
        rotor.structure(forced=["nobody"])


def test_a_failed_step_is_an_error_and_not_the_end(rotor):
    rotor.update({"integrator.type": "rk4", "integrator.time_step": 2.0e-3, "integrator.tolerance": None})
    part = rotor.structure(forced=["rotor"])
    for _ in range(2):
        with pytest.raises(butee.RunError):
            part.advance_to(1.0)
    reached = part.time
    assert 0.0 < reached < 1.0
    part.set_motion([0.0], [0.0])
    part.advance_to(reached + 1.0e-6)
    assert part.time == reached + 1.0e-6
