"""Scenes: values by key, mistakes, copies."""

import copy
import multiprocessing
import pickle
import warnings

import numpy as np
import pytest

import butee
from conftest import MODELS, ROTOR


def test_reads_and_sets_by_key(rotor):
    assert rotor["contact[0].gap"] == 4.0e-4
    rotor["contact[0].gap"] = 0.001
    assert rotor["contact[0].gap"] == 0.001 and rotor["contact"][0]["gap"] == 0.001
    assert rotor["element[1].type"] == "spring" and rotor["output.impacts"] is True
    assert "contact[0].gap" in rotor and "contact[1].gap" not in rotor and "contact[0].gpa" not in rotor
    assert rotor.get("contact[0].damping") is None and rotor.get("contact[7].gap", 3) == 3
    with pytest.raises(KeyError):
        rotor["contact[0].damping"]
    with pytest.raises(butee.InputError, match="index is a whole number"):
        rotor["contact[x].gap"]
    del rotor["integrator.tolerance"]
    assert "integrator.tolerance" not in rotor


def test_what_is_set_counts(rotor):
    soft = rotor.with_values({"contact[0].stiffness": 1.0e6})
    assert soft.run()["rotor.u"].max() > 1.01 * rotor.run()["rotor.u"].max()
    assert rotor["contact[0].stiffness"] == 1.0e10
    assert rotor.run({"load[0].amplitude": 0.0}).peaks["rotor.u"] == 0.0
    assert rotor.run(end_time=0.01).t[-1] == 0.01 and rotor["integrator.end_time"] == 0.05


def test_takes_numbers_of_numpy_and_lists(rotor):
    rotor.update({"contact[0].gap": np.float64(1e-3), "output.every": np.int64(3), "output.interval": None,
                  "load[0]": {"type": "table", "node": "rotor", "times": np.linspace(0.0, 1.0, 3), "values": (0, 1, 0)}})
    assert rotor["contact[0].gap"] == 1e-3 and rotor["output.every"] == 3
    assert rotor["load[0].times"] == [0.0, 0.5, 1.0] and rotor["load[0].values"] == [0, 1, 0]
    assert rotor.run(end_time=0.01).completed


def test_all_mistakes_come_at_once():
    scene = copy.deepcopy(ROTOR)
    scene["contact"][0]["gap"] = -1.0
    scene["element"][0]["masss"] = 3
    scene["integrator"]["type"] = "rk5"
    with pytest.raises(butee.InputError) as caught:
        butee.Scene(scene)
    keys = [mistake.key for mistake in caught.value.mistakes]
    assert {"contact[0].gap", "element[0].masss", "integrator.type"} <= set(keys)
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, butee.Error)
    for mistake in caught.value.mistakes:
        assert mistake.file == "scene" and mistake.message and mistake.message in str(caught.value)
    assert pickle.loads(pickle.dumps(caught.value)).mistakes == caught.value.mistakes


def test_mistakes_name_file_and_line(tmp_path):
    path = tmp_path / "bad.toml"
    text = (MODELS / "oscillator.toml").read_text()
    lines = text.splitlines()
    gap = next(i for i, line in enumerate(lines) if line.startswith("gap"))
    lines[gap] = "gap = -0.5"
    path.write_text("\n".join(lines))
    with pytest.raises(butee.InputError) as caught:
        butee.Scene.load(path)
    (mistake,) = caught.value.mistakes
    assert mistake == butee.Mistake(str(path), gap + 1, "contact[0].gap", mistake.message)
    assert mistake.message.startswith("-0.5: ")
    with pytest.raises(butee.InputError) as caught:
        butee.Scene("schema = 1\nx = \n", name="typed")
    assert caught.value.mistakes[0][:2] == ("typed", 2)
    with pytest.raises(butee.InputError, match="nowhere.toml"):
        butee.Scene.load(tmp_path / "nowhere.toml")


def test_a_mistake_changes_nothing(rotor):
    before = rotor.to_toml()
    for key, value in [("contact[0].gap", -1.0), ("contact[0].gpa", 1.0), ("contact[5].gap", 1.0), ("integrator.type", "rk5"),
                       ("contact[0].gap", float("nan")), ("load[0].amplitude", float("inf")), ("contact[0].gap", "wide")]:
        with pytest.raises(butee.InputError) as caught:
            rotor[key] = value
        assert "--set " + key in str(caught.value)
        assert rotor.to_toml() == before
    with pytest.raises(butee.InputError):
        rotor.update({"contact[0].gap": 1.0e-3, "load[0].amplitude": "strong"})
    assert rotor.to_toml() == before


def test_values_that_no_scene_holds(rotor):
    endless = []
    endless.append(endless)
    for value, error in [(object(), TypeError), (1j, TypeError), (endless, ValueError), (2**70, OverflowError),
                         ({1: 2}, TypeError), (np.array([1j]), TypeError)]:
        with pytest.raises(error):
            rotor["contact[0].gap"] = value
    with pytest.raises(TypeError):
        rotor[3]
    with pytest.raises(TypeError):
        rotor.run({5: 3})
    for source in (5, None, [1, 2]):
        with pytest.raises((TypeError, ValueError)):
            butee.Scene(source)


def test_dict_text_and_file_are_one_scene(rotor, tmp_path):
    rotor.save(tmp_path / "rotor.toml")
    runs = [butee.Scene(rotor.to_dict()), butee.Scene(rotor.to_toml()), butee.Scene.load(tmp_path / "rotor.toml"),
            butee.Scene.load(str(tmp_path / "rotor.toml"), {"integrator.end_time": 0.05})]
    expected = rotor.run()["rotor.u"]
    for scene in runs:
        assert np.array_equal(scene.run()["rotor.u"], expected)
        assert scene.to_dict() == rotor.to_dict()


def test_copies_and_pickles_are_scenes_of_their_own(rotor):
    rotor["contact[0].gap"] = 5.0e-4
    expected = rotor.run()["rotor.u"]
    for other in (rotor.copy(), copy.copy(rotor), copy.deepcopy(rotor), pickle.loads(pickle.dumps(rotor))):
        assert np.array_equal(other.run()["rotor.u"], expected)
        other["contact[0].gap"] = 1.0
        assert rotor["contact[0].gap"] == 5.0e-4
    other = pickle.loads(pickle.dumps(butee.Scene.load(MODELS / "beam1.toml")))
    with pytest.raises(butee.InputError, match=r"beam1.toml:[1-9]\d*: element\[0\].material"):
        del other["material"]


def test_damaged_pickles_are_refused(rotor):
    state = rotor._core.state()
    for damaged in (b"", state[:-3], state[: len(state) // 2], state + b"x", b"\xff" * 64, bytes(64)):
        with pytest.raises((butee.Error, ValueError, MemoryError)):
            butee._butee.from_state(damaged, [])


def _peak(scene):
    return scene.run().peaks["rotor.u"]


def test_scenes_go_to_other_processes(rotor):
    scenes = [rotor.with_values({"load[0].amplitude": a}) for a in (1e5, 2e5)]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(_peak, scenes) == [_peak(scene) for scene in scenes]


def test_many_changes_leave_no_trace(rotor):
    for i in range(200):
        rotor["contact[0].gap"] = 1e-4 * (i + 1)
    rotor["contact[0].gap"] = 4.0e-4
    assert len(pickle.dumps(rotor)) < 2 * len(pickle.dumps(butee.Scene(ROTOR)))


def test_warns_as_the_program_does():
    scene = butee.Scene.load(MODELS / "oscillator.toml", ["integrator.end_time=0.2"])
    with pytest.warns(butee.SceneWarning, match="an impact can be as short as"):
        result = scene.run()
    assert result.warnings and result.summary["warnings"] == result.warnings
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene.with_values({"output.impacts": True}).run()


def test_overrides_are_those_of_the_command_line():
    scene = butee.Scene.load(MODELS / "beam1.toml", ["integrator.type=NMM2", "contact[0].gap=0.008"])
    assert scene.method == "newmark_modified_adaptive" and scene["contact[0].gap"] == 0.008
    assert butee.Scene.load(MODELS / "beam1.toml", {"integrator.type": "NMM2"}).method == scene.method
    with pytest.raises(butee.InputError, match="no such module"):
        butee.Scene.load(MODELS / "beam1.toml", plugins=["/nowhere.so"])


def test_files_are_found_beside_the_scene(tmp_path, rotor):
    (tmp_path / "force.csv").write_text("t,f\n0,0\n1,1e5\n")
    rotor["load[0]"] = {"type": "table", "node": "rotor", "times": [0.0, 1.0], "values": [0.0, 1.0e5]}
    rotor.save(tmp_path / "rotor.toml")
    text = (tmp_path / "rotor.toml").read_text()
    lines = [line for line in text.splitlines() if not line.startswith(("times", "values"))]
    at = lines.index('type = "table"')
    (tmp_path / "rotor.toml").write_text("\n".join(lines[: at + 1] + ['file = "force.csv"', "skip = 1"] + lines[at + 1 :]))
    other = butee.Scene.load(tmp_path / "rotor.toml")
    assert np.array_equal(other.run()["rotor.u"], rotor.run()["rotor.u"])
    (tmp_path / "below").mkdir()
    other.save(tmp_path / "below" / "moved.toml")
    assert np.array_equal(butee.Scene.load(tmp_path / "below" / "moved.toml").run()["rotor.u"], rotor.run()["rotor.u"])
