"""Common fixtures of the tests of the Python package."""

import pathlib

import matplotlib
import pytest

import butee

matplotlib.use("Agg")

SOURCE = pathlib.Path(__file__).parents[2]
MODELS = SOURCE / "apps" / "models"

#: A rotor of 100 kg on 1e9 N/m and 50 N s/m, with stops of 1e10 N/m behind 4e-4 m.
ROTOR = {
    "schema": 1,
    "title": "rotor",
    "element": [
        {"type": "mass", "name": "rotor", "mass": 100.0},
        {"type": "spring", "node": "rotor", "stiffness": 1.0e9, "damping": 50.0},
    ],
    "contact": [{"type": "stop", "nodes": "rotor", "gap": 4.0e-4, "law": "linear", "stiffness": 1.0e10}],
    "load": [{"type": "harmonic", "node": "rotor", "amplitude": 201240.0, "angular_frequency": 1256.6}],
    "integrator": {"tolerance": 1.0e-4, "end_time": 0.05},
    "output": {"interval": 2.0e-5, "impacts": True, "energy": True,
               "probe": [{"label": "rotor", "node": "rotor", "quantities": ["u", "v", "contact_force"]}]},
}


@pytest.fixture
def rotor():
    return butee.Scene(ROTOR)


@pytest.fixture
def models():
    return MODELS


@pytest.fixture
def program():
    return butee._program.program()
