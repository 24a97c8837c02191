"""Options of the commands, applied to scenes in memory."""

import os
import subprocess

import numpy as np
import pytest

import butee
from conftest import ROTOR

SHAFT = {
    "schema": 1,
    "material": {"steel": {"young_modulus": 2.1e11, "density": 7850.0, "poisson_ratio": 0.3}},
    "section": {"round": {"shape": "circle", "radius": 0.02}},
    "element": [{"type": "beam", "name": "shaft", "material": "steel", "section": "round", "length": 1.0, "elements": 6,
                 "motion": "lateral"},
                {"type": "disc", "node": "shaft:middle", "mass": 5.0, "polar_inertia": 0.05, "diametral_inertia": 0.025}],
    "support": [{"nodes": ["shaft:first", "shaft:last"], "fix": ["uy", "uz"]}],
    "rotation": {"speed": 100.0},
    "integrator": {"end_time": 0.01},
}


def test_pictures_of_a_scene_and_its_modes(rotor, tmp_path):
    rotor.picture(tmp_path / "scene.svg")
    assert "</svg>" in (tmp_path / "scene.svg").read_text()
    shapes = butee.Scene(SHAFT).draw_modes(tmp_path / "modes", 3)
    assert {"frequencies.csv", "shapes.csv"} <= {os.path.basename(path) for path in shapes} and all(map(os.path.exists, shapes))
    diagram = butee.Scene(SHAFT).draw_modes(tmp_path / "campbell", campbell=(0.0, 200.0, 4))
    assert str(tmp_path / "campbell" / "campbell.csv") in diagram
    assert len((tmp_path / "campbell" / "campbell.csv").read_text().splitlines()) > 5
    with pytest.raises(butee.InputError, match="FROM"):
        butee.Scene(SHAFT).draw_modes(tmp_path / "other", campbell=(200.0, 0.0, 4))


def test_draw_takes_probes_and_a_span(rotor, tmp_path):
    (script,) = rotor.draw(tmp_path / "part", "displacement", formats="script", probes="rotor", start=0.004, stop=0.006, end_time=0.01)
    with open(script, encoding="utf-8") as file:
        milliseconds = [float(line.split()[0]) for line in file if line[:1].isdigit()]
    assert milliseconds[0] == pytest.approx(4.0) and milliseconds[-1] == pytest.approx(6.0)
    with pytest.raises(butee.InputError, match="rotar"):
        rotor.draw(tmp_path / "part", probes=["rotar"], formats="script", end_time=0.01)


def test_stability_of_chosen_dampings(tmp_path):
    found = butee.stability("newmark", {"gamma": 0.6, "beta": 0.3025}, damping=[0.0, 0.1], stops=[4.0], output=tmp_path / "curves")
    assert [entry["damping_ratio"] for entry in found["damped"]] == [0.0, 0.1]
    assert [entry["stop_ratio"] for entry in found["with_stop"]] == [4.0] and "gamma" in found["parameters"]
    assert (tmp_path / "curves" / "stability.csv").exists()
    with pytest.raises(butee.InputError):
        butee.stability("newmark", damping=[-1.0])


def test_a_comparison_is_kept(rotor, tmp_path):
    method = [{"type": "rodas4", "sweep": "tolerance", "values": [1e-3]}]
    runs = rotor.compare(method, end_time=0.005, quantities="rotor.v", output=tmp_path / "kept", targets=np.array([1e-2]))
    assert (tmp_path / "kept" / "runs.csv").exists() and len(runs) == 1
    again = rotor.compare(method, end_time=0.005, quantities="rotor.v", output=tmp_path / "kept", targets=[1e-2])
    assert again == runs  # continued, not measured again
    with pytest.raises(butee.InputError, match="rotor.w"):
        rotor.compare(method, end_time=0.005, quantities="rotor.w")


def test_modules_of_ones_own_are_listed(tmp_path):
    with pytest.raises(butee.InputError, match="nowhere"):
        butee.plugins(plugins=tmp_path / "nowhere.so")


def test_the_fastest_of_several_runs(rotor):
    one, several = rotor.run(), rotor.run(repeat=20)
    assert np.array_equal(one["rotor.u"], several["rotor.u"])
    for options in ({"repeat": 0}, {"repeat": 2, "resume": True, "output": "nowhere"}):
        with pytest.raises(ValueError, match="repeat"):
            rotor.run(**options)


def test_trust_in_a_study(rotor):
    rows = rotor.study({"contact[0].gap": [3e-4, 4e-4]}, ["trust", "impacts"], periods=2, threads=2)
    period = 2.0 * np.pi / 1256.6
    assert np.allclose(rows["trust"], 2 * period, rtol=1e-12) and rows.units["trust"] == "s"


def test_the_folder_of_a_study(rotor, tmp_path):
    def study(scene, **more):
        return scene.study({"contact[0].gap": [3e-4, 4e-4]}, "impacts", periods=2, output=tmp_path / "rows", format="csv", **more)

    study(rotor)
    assert (tmp_path / "rows" / "study.csv").exists()
    other = rotor.with_values({"load[0].amplitude": 1e5})
    with pytest.raises(butee.InputError, match="has changed"):
        study(other)
    assert np.array_equal(study(other, fresh=True)["impacts"], other.study({"contact[0].gap": [3e-4, 4e-4]}, "impacts", periods=2)["impacts"])
    with pytest.raises(ValueError, match="jpeg"):
        rotor.study({"contact[0].gap": [3e-4]}, "impacts", periods=2, output=tmp_path / "others", format="jpeg")


def test_rows_of_a_folder_are_read_while_it_grows(rotor, program, tmp_path):
    rotor.save(tmp_path / "scene.toml")
    (tmp_path / "study.toml").write_text("""
schema = 1
scene = "scene.toml"
[[vary]]
key = "contact[0].gap"
from = 1e-4
to = 1e-3
count = 8
[study]
periods = 4
collect = ["peak rotor.u", "section rotor.v"]
""")
    subprocess.run([program, "study", "study.toml", "-q", "-o", "whole"], cwd=tmp_path, check=True)
    whole = butee.Study.load(tmp_path / "whole")
    here = rotor.study({"contact[0].gap": whole["contact[0].gap"]}, ["peak rotor.u", "section rotor.v"], periods=4)
    for name in ("run", "peak rotor.u", "section rotor.v", "status"):
        assert np.array_equal(whole[name], here[name]), name
    for format in ("hdf5", "csv"):
        for done, shard in enumerate(("2/4", "1/4", "4/4", "3/4"), 1):
            subprocess.run([program, "study", "study.toml", "-q", "-o", format, "--format", format, "--shard", shard], cwd=tmp_path,
                           check=True)
            part = butee.Study.load(tmp_path / format)
            assert part.rows.size == 2 * done and np.array_equal(part["peak rotor.u"], whole["peak rotor.u"][part["run"]])
        assert np.array_equal(part["run"], np.arange(8))
        made = subprocess.run([program, "plot", format, "--format", "script", "-o", "pictures"], cwd=tmp_path, check=True,
                              capture_output=True, text=True).stdout
        assert "bifurcation-section-rotor.v.gp" in made
    for wrong in ("nowhere", "."):
        with pytest.raises(butee.InputError, match="not a folder of a study"):
            butee.Study.load(tmp_path / wrong)


def test_pictures_of_a_study(rotor):
    gaps, amplitudes = [2e-4, 3e-4, 4e-4], [1e5, 2e5]
    collect = ["section rotor.u", "peak rotor.u"]
    rows = rotor.study({"contact[0].gap": gaps}, collect, periods=4)
    dots = rows.plot("section rotor.u").lines[0]
    assert rows.keys_varied == ["contact[0].gap"]
    assert np.array_equal(dots.get_xdata(), np.repeat(gaps, 4)) and np.array_equal(dots.get_ydata(), rows["section rotor.u"].ravel())
    sweep = rotor.study({"contact[0].gap": gaps}, collect, periods=4, follow=True).plot("peak rotor.u")
    assert [line.get_label() for line in sweep.lines] == ["up", "down"] and "m" in sweep.get_ylabel()
    grid = rotor.study({"contact[0].gap": gaps, "load[0].amplitude": amplitudes}, "peak rotor.u", periods=2)
    mesh = grid.plot("peak rotor.u").collections[0].get_array()
    assert np.array_equal(np.asarray(mesh).reshape(2, 3), grid["peak rotor.u"].reshape(3, 2).T)
    listed = rotor.study({"contact[0].gap": [2e-4, -1.0, 4e-4], "load[0].amplitude": [1e5, 2e5, 3e5]}, "peak rotor.u", plan="list", periods=2)
    points = listed.plot("peak rotor.u").collections[0]
    assert points.get_offsets().shape == (3, 2) and list(np.ma.getmaskarray(points.get_array())) == [False, True, False]
    with pytest.raises(ValueError, match="status"):
        rows.plot("status")


def test_what_the_program_cannot_know_is_said():
    @butee.law("python_only")
    def law(g, stiffness):
        return stiffness * g if g > 0.0 else 0.0

    scene = butee.Scene({**ROTOR, "contact": [{"type": "stop", "nodes": "rotor", "gap": 4e-4, "law": "python_only", "stiffness": 1e10}]})
    for call in (scene.check, scene.picture, scene.trust, scene.compare):
        with pytest.raises(butee.InputError, match="python_only, which is written in Python"):
            call()


#: Options of the commands for one scene, and their equivalents in Python; None: only useful with a terminal or files.
OPTIONS = {
    "run": {"set": "with_values", "plugin": "load", "output": "run", "repeat": "run", "resume": "run", "trust": "trust",
            "plot": "draw", "progress": "run", "quiet": None, "verbose": None},
    "check": {"set": "with_values", "plugin": "load", "picture": "picture", "json": "check"},
    "modes": {"set": "with_values", "plugin": "load", "number": "modes", "closed": "modes", "output": "draw_modes", "json": "modes",
              "plot": "draw_modes", "speed": "whirl", "campbell": "campbell", "order": "campbell", "quiet": None},
    "compare": {"set": "with_values", "plugin": "load", "output": "compare", "fresh": "compare", "quiet": None},
    "plot": {"kind": "draw", "format": "draw", "probe": "draw", "from": "draw", "to": "draw", "output": "draw", "plugin": "load",
             "quiet": None},
    "stability": {"set": "stability", "damping": "stability", "stops": "stability", "output": "stability", "json": "stability",
                  "plugin": "stability", "quiet": None},
    # Job arrays, processes and pipes exist only in the program.
    "study": {"set": "with_values", "plugin": "load", "output": "study", "threads": "study", "format": "study", "fresh": "study",
              "shard": None, "merge": None, "points": None, "results": None, "plot": "study", "plot-format": None,
              "progress": "study", "quiet": None},
}


@pytest.mark.parametrize("command", OPTIONS)
def test_every_option_for_one_scene_has_its_place(program, command):
    text = subprocess.run([program, command, "--help"], check=True, capture_output=True, text=True).stdout
    listed = {word.partition(",")[2].lstrip("-") if word.startswith("-") and not word.startswith("--") else word.lstrip("-")
              for word in (line.split()[0] for line in text.splitlines() if line.startswith("  -"))} - {"help"}
    assert {word.partition(":")[0] for word in listed} == set(OPTIONS[command])
    assert all(callable(getattr(butee.Scene, method)) for method in OPTIONS[command].values() if method)
