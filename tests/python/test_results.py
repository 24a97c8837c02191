"""Results equal those of `butee run` bit for bit, and are views of the run's memory."""

import csv
import gc
import json
import pickle
import subprocess

import numpy as np
import pytest

import butee

TIMES = ("setup_seconds", "wall_seconds")


def columns_of(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}


def without_times(summary):
    return {key: value for key, value in summary.items() if key not in TIMES}


def same_bits(array, texts):
    numbers = np.array([float(text) if text else np.nan for text in texts])
    return np.array_equal(array.view(np.uint64), numbers.view(np.uint64)) or np.array_equal(array, numbers, equal_nan=True)


@pytest.fixture(scope="module", params=["rotor", "damped", "beam3"])
def both(request, tmp_path_factory):
    """A run in Python, and the result folder of the program for the same scene."""
    from conftest import MODELS, ROTOR

    folder = tmp_path_factory.mktemp("results")
    if request.param == "rotor":
        scene = butee.Scene(ROTOR)
    elif request.param == "damped":
        stop = {**ROTOR["contact"][0], "damping": {"type": "kelvin_voigt", "coefficient": 2.0e4}}
        scene = butee.Scene({**ROTOR, "contact": [stop]})
    else:
        scene = butee.Scene.load(MODELS / "beam3.toml", ["integrator.end_time=0.05", "output.energy=true", "output.impacts=true"])
    scene.save(folder / "scene.toml")
    program = butee._program.program()
    subprocess.run([program, "run", "scene.toml", "-o", "results", "-q"], cwd=folder, check=True)
    return scene.run(), folder / "results"


def test_history_is_the_programs(both):
    result, folder = both
    columns = columns_of(folder / "history.csv")
    assert list(columns) == result.columns == list(result)
    assert len(result.t) > 50
    for name, texts in columns.items():
        assert same_bits(result[name], texts), name


def test_energy_is_the_programs(both):
    result, folder = both
    columns = columns_of(folder / "energy.csv")
    assert list(columns) == list(result.energy)
    for name, texts in columns.items():
        assert same_bits(result.energy[name], texts), name


def test_impacts_are_the_programs(both):
    result, folder = both
    columns = columns_of(folder / "impacts.csv")
    assert list(columns) == list(result.impacts.dtype.names)
    assert len(result.impacts) > 0
    assert list(result.impacts["node"]) == columns.pop("node")
    assert list(result.impacts["dof"]) == columns.pop("dof") == ["u"] * len(result.impacts)
    assert list(result.impacts["side"]) == [int(side) for side in columns.pop("side")]
    for name, texts in columns.items():
        assert same_bits(np.ascontiguousarray(result.impacts[name]), texts), name


def test_wear_is_the_programs(both):
    result, folder = both
    if not (folder / "wear.csv").exists():
        assert result.wear == []
        return
    columns = columns_of(folder / "wear.csv")
    assert len(result.wear) == len(columns["node"]) > 0
    for i, row in enumerate(result.wear):
        assert list(row) == list(columns)
        assert all(row[name] == (texts[i] if name in ("node", "kind") else float(texts[i])) for name, texts in columns.items())
        assert row["dissipated"] > 0.0
    assert pickle.loads(pickle.dumps(result)).wear == result.wear


def test_summary_is_the_programs(both):
    result, folder = both
    assert without_times(result.summary) == without_times(json.loads((folder / "summary.json").read_text()))


def test_output_writes_the_programs_files(rotor, program, tmp_path):
    rotor.save(tmp_path / "scene.toml")
    subprocess.run([program, "run", "scene.toml", "-o", "theirs", "-q"], cwd=tmp_path, check=True)
    rotor.run(output=tmp_path / "ours")
    names = {file.name for file in (tmp_path / "theirs").iterdir()}
    assert {file.name for file in (tmp_path / "ours").iterdir()} == names
    for name in names - {"summary.json", "model.toml"}:
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    with pytest.raises(butee.InputError, match="foreign"):
        (tmp_path / "foreign").mkdir()
        (tmp_path / "foreign" / "thesis.txt").write_text("mine")
        rotor.run(output=tmp_path / "foreign")


def test_columns_are_views_of_one_memory(rotor):
    result = rotor.run()
    first, second = result["rotor.u"], result["rotor.u"]
    assert np.shares_memory(first, second)
    assert first.base is result and not first.flags.writeable and not first.flags.owndata
    assert np.shares_memory(result.t, result["t"]) and not np.shares_memory(result.t, first)
    with pytest.raises(ValueError):
        first[0] = 1.0
    with pytest.raises(ValueError):
        first.flags.writeable = True
    assert first.dtype == np.float64 and first.flags.c_contiguous


def test_views_outlive_everything_else(rotor):
    result = rotor.run()
    copy, view, energy = result["rotor.u"].copy(), result["rotor.u"][::2], result.energy["kinetic"]
    kinetic = energy.copy()
    del rotor, result
    gc.collect()
    filling = [np.full(copy.size, float(i)) for i in range(200)]  # would reuse the memory if it were freed
    assert np.array_equal(view, copy[::2]) and np.array_equal(energy, kinetic)
    assert len(filling) == 200


def test_a_result_is_freed_with_its_last_view(rotor):
    import weakref

    result = rotor.run()
    gone = weakref.ref(result)
    view = result["rotor.u"]
    del result
    assert gone() is not None
    del view
    assert gone() is None


def test_unknown_columns_are_named(rotor):
    result = rotor.run(end_time=0.001)
    with pytest.raises(KeyError, match="did you mean"):
        result["rotr.u"]
    assert "rotor.u" in result and "x" not in result and 5 not in result


def test_results_are_pickled(rotor):
    result = rotor.run()
    copy = pickle.loads(pickle.dumps(result))
    for name in result:
        assert np.array_equal(copy[name], result[name])
    assert copy.summary == result.summary and np.array_equal(copy.impacts["t_in"], result.impacts["t_in"])
    assert np.array_equal(copy.energy["work"], result.energy["work"]) and copy.title == result.title


def test_energy_and_impacts_are_there_only_where_asked_for(rotor):
    rotor.update({"output.energy": False, "output.impacts": False})
    result = rotor.run(end_time=0.01)
    assert result.energy is None and len(result.impacts) == 0


def test_peaks_bound_the_rows(rotor):
    result = rotor.run()
    for column in ("rotor.u", "rotor.contact_force"):
        assert result.peaks[column] >= np.abs(result[column]).max() > 0.0


def test_a_failed_run_keeps_what_it_computed(rotor):
    rotor.update({"integrator.type": "rk4", "integrator.time_step": 2.0e-3, "integrator.tolerance": None})
    with pytest.raises(butee.RunError) as caught:
        rotor.run()
    result = caught.value.result
    assert not result.completed and result.message in str(caught.value)
    assert result.summary["status"] == "failed" and 0 < result.t.size < 2501


def test_data_frames(rotor):
    pandas = pytest.importorskip("pandas")
    result = rotor.run(end_time=0.01)
    frame = result.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t"
    assert np.array_equal(frame["rotor.u"].to_numpy(), result["rotor.u"])


def test_pictures(rotor):
    result = rotor.run(end_time=0.01)
    axes = result.plot()
    assert len(axes) == 3
    line = axes[0].get_lines()[0]
    assert np.array_equal(line.get_xdata(), result.t) and np.array_equal(line.get_ydata(), result["rotor.u"])
