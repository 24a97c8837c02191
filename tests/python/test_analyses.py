"""The analyses of the program, on scenes in memory."""

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
    # h omega = 2 sqrt(2) bounds the classical Runge-Kutta method on the imaginary axis.
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
    with pytest.raises(butee.RunError, match="not installed as a whole"):
        butee.stability("rk4")
