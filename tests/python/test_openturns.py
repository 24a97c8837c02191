"""The examples with OpenTURNS, compared with directly computed variances of the same numbers."""

import re

import numpy as np

import butee
from conftest import SOURCE
from test_documentation import run_example


def indices(out):
    return {key: (float(first), float(total)) for key, first, total in re.findall(r"(\S+): first order (\S+), total (\S+)", out)}


def test_example_sobol(tmp_path):
    found = indices(run_example("sobol_openturns.py", tmp_path, "5"))
    assert set(found) == {"load[0].amplitude", "contact[0].gap", "contact[0].stiffness"}
    assert (tmp_path / "sobol_openturns.png").exists()


def test_example_of_a_driver(tmp_path):
    drivers = SOURCE / "apps" / "studies" / "drivers"
    found = indices(run_example(drivers / "sobol-openturns.py", tmp_path, "7"))
    # The same indices from a grid: variances of the means over the other key.
    scene = butee.Scene.load(SOURCE / "apps" / "studies" / "rattle-scene.toml")
    middle = (np.arange(40) + 0.5) / 40
    rows = scene.study({"load[0].amplitude": 1000.0 + 8000.0 * middle, "contact[0].gap": 0.5e-3 + 1e-3 * middle}, "peak rotor.u",
                       settle=100, periods=20)
    peaks = rows["peak rotor.u"].reshape(40, 40)
    for axis, key in enumerate(("load[0].amplitude", "contact[0].gap")):
        expected = peaks.mean(axis=1 - axis).var() / peaks.var()
        # Saltelli's estimate from 128 points has a standard deviation of about 0.1.
        assert abs(found[key][0] - expected) < 0.35, (key, found, expected)
