"""Analyses of the program applied to scenes in memory."""

import json
import os
import subprocess

import numpy as np
import pytest

import butee


def test_check_is_the_programs(rotor, program, tmp_path):
    rotor.save(tmp_path / "scene.toml")
    theirs = json.loads(subprocess.run([program, "check", "scene.toml", "--json"], cwd=tmp_path, check=True, capture_output=True).stdout)
    ours = rotor.check()
    for key in ("free_dofs", "stops", "angular_frequency", "critical_step", "mass"):
        assert ours[key] == theirs[key], key


def test_trust(rotor):
    trust = rotor.with_values(end_time=0.01).trust()
    assert trust["to_the_end"] and not trust["chaotic"]


def test_compare_gives_work_and_precision(rotor):
    methods = ["exponential", {"type": "rodas4", "sweep": "tolerance", "values": [1e-3, 1e-6]}]
    runs = rotor.with_values(end_time=0.01).compare(methods, targets=[1e-3])
    assert {run["method"] for run in runs} == {"exponential", "rodas4"}
    loose, tight = (run for run in runs if run["method"] == "rodas4")
    assert loose["value"] == 1e-3 and tight["error_rms"] < loose["error_rms"] and tight["steps"] > loose["steps"]
    assert all(run["outcome"] == "completed" and run["seconds"] > 0.0 for run in runs)


def test_stability_of_the_classical_method():
    found = butee.stability("rk4")
    # The stability limit of the classical Runge-Kutta method on the imaginary axis is h omega = 2 sqrt(2).
    assert np.isclose(found["undamped"]["value"], 2.0 * np.sqrt(2.0), rtol=1e-6)


def test_errors_of_the_program_are_errors(rotor):
    with pytest.raises(butee.InputError, match="rk5"):
        butee.stability("rk5")
    with pytest.raises(butee.InputError, match="rk5"):
        rotor.compare(["rk5"])
    with pytest.raises(butee.InputError, match="nothing turns"):
        rotor.whirl(10.0)


def test_a_program_that_is_missing_is_named(monkeypatch, tmp_path):
    monkeypatch.setattr(butee._butee, "plugin_folder", os.fspath(tmp_path / "lib" / "butee" / "plugins"))
    with pytest.raises(butee.RunError, match="only partly installed"):
        butee.stability("rk4")


def test_what_is_found_is_the_programs(program):
    listed = json.loads(subprocess.run([program, "plugins", "--json"], check=True, capture_output=True).stdout)
    assert butee.plugins() == listed
    assert "rk4" in json.dumps(butee.plugins("rk4"))


def test_pictures(rotor, tmp_path):
    assert "rotor" in rotor.picture()
    made = rotor.draw(tmp_path / "pictures", "displacement", formats="script", end_time=0.01)
    assert made == [os.fspath(tmp_path / "pictures" / "displacement.gp")] and all(map(os.path.exists, made))
    with pytest.raises(butee.InputError, match="displacemant"):
        rotor.draw(tmp_path / "pictures", "displacemant")


def test_a_run_that_was_interrupted_goes_on_to_the_same_bits(rotor, tmp_path):
    rotor.update({"output.checkpoint": 5000, "integrator.type": "rk4", "integrator.tolerance": None, "integrator.time_step": 1e-5})

    class Enough(Exception):
        pass

    def stop(t, end):
        if t > 0.1:
            raise Enough

    long = rotor.with_values(end_time=1.5)
    folder = tmp_path / "results"
    with pytest.raises(Enough):
        long.run(output=folder, progress=stop)
    assert any(name.startswith("checkpoint") for name in os.listdir(folder)), os.listdir(folder)
    with pytest.raises(butee.InputError, match="another scene"):
        rotor.run(output=folder, resume=True)
    rest, whole = long.run(output=folder, resume=True), long.run()
    assert 0.0 < rest.t[0] and np.array_equal(rest["rotor.u"], whole["rotor.u"][-rest.t.size:])
    assert rest.peaks == whole.peaks and rest.summary["steps"] == whole.summary["steps"]
    with pytest.raises(ValueError, match="output"):
        rotor.run(resume=True)


def test_every_command_for_one_scene_has_its_method(program):
    """The commands of the program and the equivalent methods; the other commands do not use a scene."""
    here = {"run": ["run", "batch", "draw", "trust"], "check": ["check", "picture"], "modes": ["modes", "whirl", "campbell"],
            "compare": ["compare"], "stability": ["stability"], "plot": ["draw"], "study": ["study"]}
    elsewhere = {"plugins": butee.plugins, "test-plugin": butee.conformance}
    without_scene = {"help", "init", "completion", "new-plugin"}
    text = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
    listed = text[text.index("Subcommands:"):].partition("\n\n")[0].splitlines()[1:]
    commands = {line.split()[0] for line in listed if line[2] != " "}
    assert commands == set(here) | set(elsewhere) | without_scene
    for methods in here.values():
        assert all(callable(getattr(butee.Scene, method)) for method in methods)
