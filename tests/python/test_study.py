"""Studies, and laws written in Python."""

import os
import pickle
import signal
import threading

import numpy as np
import pytest

import butee
from conftest import ROTOR

AMPLITUDES = [1.0e5, 2.0e5, 3.0e5]


def study(scene, **more):
    settings = dict(settle=3, periods=4, threads=2)
    settings.update(more)
    return scene.study({"load[0].amplitude": AMPLITUDES}, ["peak rotor.u", "section rotor.u", "impacts"], **settings)


def test_rows_are_those_of_runs(rotor):
    rows = study(rotor)
    assert list(rows["load[0].amplitude"]) == AMPLITUDES and list(rows["run"]) == [0, 1, 2]
    assert rows["section rotor.u"].shape == (3, 4) and rows.units["section rotor.u"] == "m"
    period = 2.0 * np.pi / 1256.6
    for i, amplitude in enumerate(AMPLITUDES):
        one = rotor.run({"load[0].amplitude": amplitude, "output.interval": period}, end_time=7 * period)
        # A run ends steps at its rows, a study at the collected periods; the tolerance is 1e-4 of the largest displacement.
        assert np.allclose(one["rotor.u"][4:8], rows["section rotor.u"][i], rtol=0, atol=1e-4 * rows["peak rotor.u"][i])
    assert not rows.failed and set(rows["status"]) == {"completed"}


def test_rows_do_not_depend_on_threads_nor_on_the_folder(rotor, tmp_path):
    names = ["peak rotor.u", "section rotor.u", "impacts", "steps", "scene"]
    one = study(rotor, threads=1)
    for other in (study(rotor, threads=3), study(rotor, output=tmp_path / "rows"), study(rotor, output=tmp_path / "rows"),
                  pickle.loads(pickle.dumps(one))):
        for name in names:
            assert np.array_equal(one[name], other[name]), name
    assert any(name.startswith("study.") for name in os.listdir(tmp_path / "rows"))
    changed = rotor.with_values({"contact[0].gap": 5e-4})
    with pytest.raises(butee.InputError, match="has changed"):
        study(changed, output=tmp_path / "rows")


def test_plans_and_sweeps(rotor):
    spread = rotor.study({"contact[0].gap": {"from": 1e-4, "to": 1e-3}}, "peak rotor.u", plan="sobol", count=8, seed=1, periods=2)
    gaps = np.sort(spread["contact[0].gap"])
    assert np.array_equal(np.floor((gaps - 1e-4) / 9e-4 * 8), np.arange(8))
    sweep = study(rotor, follow=True)
    assert list(sweep["direction"]) == [1, 1, 1, -1, -1, -1]
    assert sweep["peak rotor.u"][0] != sweep["peak rotor.u"][3]


def test_a_run_that_fails_is_a_row(rotor):
    rows = rotor.study({"contact[0].gap": [4e-4, -1.0]}, ["peak rotor.u"], periods=2)
    assert list(rows.failed) == [1] and "must be >= 0" in rows.failed[1]
    assert np.isfinite(rows["peak rotor.u"][0]) and np.isnan(rows["peak rotor.u"][1])


def test_mistakes_are_told(rotor):
    vary = {"load[0].amplitude": AMPLITUDES}
    for call, text in [(lambda: rotor.study(vary, "peek rotor.u", periods=2), "did you mean \"peak\""),
                       (lambda: rotor.study({"load[1].amplitude": [1.0]}, "peak rotor.u", periods=2), "there is no load"),
                       (lambda: rotor.study({"load[0].amplitude": []}, "peak rotor.u", periods=2), "vary"),
                       (lambda: rotor.study(vary, "trust", periods=2, follow=True), "remove follow"),
                       (lambda: with_law(law="python_linear", stiffness=1e10).study(vary, ["trust"], periods=2), "written in Python"),
                       (lambda: rotor.study(vary, "section rotor.u"), "periods")]:
        with pytest.raises(butee.InputError, match=text):
            call()
    with pytest.raises(TypeError):
        rotor.study({"load[0].amplitude": 1.0}, "peak rotor.u", periods=2)
    with pytest.raises(ValueError, match="threads"):
        rotor.study(vary, "peak rotor.u", periods=2, threads=0)
    with pytest.raises(KeyError, match="columns are"):
        study(rotor)["peak"]


def test_progress_and_an_interruption(rotor):
    seen = []
    study(rotor, progress=lambda done, runs: seen.append((done, runs)))
    assert all(0 <= done <= runs == 3 for done, runs in seen)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        rotor.study({"load[0].amplitude": np.linspace(1e5, 3e5, 100000)}, "peak rotor.u", periods=2000)
    with pytest.raises(ZeroDivisionError):
        rotor.study({"load[0].amplitude": np.linspace(1e5, 3e5, 100000)}, "peak rotor.u", periods=2000, progress=lambda *_: 1 / 0)


def test_a_table_of_rows(rotor):
    import pandas

    frame = study(rotor).to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and "section rotor.u[4]" in frame and len(frame) == 3


@butee.law("python_linear")
def linear(g, stiffness):
    return stiffness * g if g > 0.0 else 0.0


@butee.law("python_hertz", tangent=lambda g, stiffness: 1.5 * stiffness * g**0.5 if g > 0.0 else 0.0,
           energy=lambda g, stiffness: stiffness * g**2.5 / 2.5 if g > 0.0 else 0.0)
def hertz(g, stiffness):
    return stiffness * g**1.5 if g > 0.0 else 0.0


def with_law(**contact):
    tables = {**ROTOR, "contact": [{"type": "stop", "nodes": "rotor", "gap": 4.0e-4, **contact}]}
    return butee.Scene({**tables, "integrator": {"type": "rodas4", "tolerance": 1e-7, "end_time": 0.02}})


@pytest.mark.parametrize("name, keys, law", [("python_linear", {"stiffness": 1e10}, {"law": "linear", "stiffness": 1e10}),
                                             ("python_hertz", {"stiffness": 1e12}, {"law": "hertz", "stiffness": 1e12, "exponent": 1.5})])
def test_a_law_in_python_is_a_law(name, keys, law):
    ours, theirs = with_law(law=name, **keys), with_law(**law)
    assert ours.equations().contact_force([5e-4]) == pytest.approx(theirs.equations().contact_force([5e-4]), rel=1e-12)
    u, expected = ours.run()["rotor.u"], theirs.run()["rotor.u"]
    # Steps differ because one of them uses finite differences.
    assert np.abs(u - expected).max() < 1e-4 * np.abs(expected).max()
    assert np.array_equal(pickle.loads(pickle.dumps(ours)).run()["rotor.u"], u)


@pytest.mark.parametrize("name, keys", [("python_linear", {"stiffness": 1e6}), ("python_hertz", {"stiffness": 1e6}),
                                        ("linear", {"stiffness": 1e6}), ("harmonic", {"amplitude": 3.0, "angular_frequency": 7.0})])
def test_conformance_of_laws_and_loads(name, keys):
    findings = butee.conformance(name, **keys)
    assert len(findings) == 6 and all(finding.passed for finding in findings), findings


def test_conformance_finds_what_is_wrong():
    @butee.law("python_wrong_energy", energy=lambda g, k: 0.4 * k * g * g if g > 0 else 0.0)
    def wrong(g, k):
        return k * g if g > 0 else 0.0

    failed = {finding.name: finding.details for finding in butee.conformance("python_wrong_energy", k=1e6) if not finding.passed}
    assert "dV/dg" in failed["derivatives"]

    calls = []

    @butee.load("python_forgetful")
    def forgetful(t):
        calls.append(t)
        return float(len(calls))

    findings = butee.conformance("python_forgetful")
    assert not findings[0].passed and "another value at the same t" in findings[0].details
    with pytest.raises(butee.InputError, match="did you mean \"linear\""):
        butee.conformance("linaer")
    with pytest.raises(butee.InputError):
        butee.conformance("python_linear", stifness=1e6)


def test_laws_that_are_none():
    @butee.law("python_preloaded")
    def preloaded(g, k):
        return k * (g + 1.0)

    with pytest.raises(butee.InputError, match="force that is 0"):
        with_law(law="python_preloaded", k=1e6)
    with pytest.raises(butee.InputError):
        with_law(law="python_linear")
    with pytest.raises(butee.RunError, match="registered twice"):
        butee.law("linear")(linear)
    with pytest.raises(TypeError):
        butee.law("python_other", energy=lambda g: 0.0)(linear)

    @butee.law("python_forgetful")
    def forgetful(g, k):
        k * g

    with pytest.raises(butee.RunError, match="function forgetful returned None at .*, not a number"):
        with_law(law="python_forgetful", k=1e6)

    @butee.law("python_late")
    def late(g, k):
        if 1e-8 < g < 0.9e-6:
            raise IndexError("late")
        return k * g if g > 0 else 0.0

    with pytest.raises((butee.RunError, IndexError), match="late"):
        with_law(law="python_late", k=1e10).run()


def test_laws_in_python_on_threads():
    scene = with_law(law="python_linear", stiffness=1e10)
    rows = scene.study({"load[0].amplitude": AMPLITUDES}, ["peak rotor.u"], periods=3, threads=3)
    peaks = [scene.run({"load[0].amplitude": amplitude}, end_time=3 * 2.0 * np.pi / 1256.6).peaks["rotor.u"] for amplitude in AMPLITUDES]
    assert np.allclose(rows["peak rotor.u"], peaks, rtol=1e-5)
    many = scene.batch({"load[0].amplitude": AMPLITUDES}, threads=2, end_time=0.005)
    assert np.array_equal(many[1]["rotor.u"], scene.run({"load[0].amplitude": AMPLITUDES[1]}, end_time=0.005)["rotor.u"])


def test_threads_of_runs_keep_their_state_in_python():
    local, calls = threading.local(), []

    @butee.law("python_counting")
    def counting(g, k):
        local.calls = getattr(local, "calls", 0) + 1
        calls.append(local.calls)
        return k * g if g > 0.0 else 0.0

    with_law(law="python_counting", k=1e10).batch({"load[0].amplitude": AMPLITUDES[:1]}, threads=1, end_time=0.005)
    # The scene is read and checked on this thread.
    assert max(calls) > 0.9 * len(calls) > 1000
