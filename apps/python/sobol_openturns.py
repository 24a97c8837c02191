"""Sobol' indices of a beam's peak by OpenTURNS (Debian: python3-openturns): the contribution of each key to its variance.

    python3 sobol_openturns.py [SIZE]        (2^SIZE points for each of five samples; 9: some ten seconds)
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np
import openturns as ot

import butee

MODELS = pathlib.Path(__file__).parents[1] / "models"
KEYS = {"load[0].amplitude": (250.0, 350.0), "contact[0].gap": (0.008, 0.012), "contact[0].stiffness": (0.5e6, 2.0e6)}
scene = butee.Scene.load(MODELS / "beam1.toml", {"integrator.type": "auto"})


def peaks(points):
    """The peak displacement of the middle at each point, m; all points in one call, on all processors."""
    values = dict(zip(KEYS, np.array(points).T))
    rows = scene.study(values, "peak mid.u", plan="list")
    assert not rows.failed
    return rows["peak mid.u"][:, np.newaxis]


size = 2 ** int(sys.argv[1] if len(sys.argv) > 1 else 9)
inputs = ot.ComposedDistribution([ot.Uniform(*bounds) for bounds in KEYS.values()])
design = ot.SobolIndicesExperiment(inputs, size).generate()
indices = ot.SaltelliSensitivityAlgorithm(design, ot.Sample(peaks(design)), size)
first, total = indices.getFirstOrderIndices(), indices.getTotalOrderIndices()
for key, one, all_of_it in zip(KEYS, first, total):
    print(f"{key}: first order {one:.3f}, total {all_of_it:.3f}")

place = np.arange(len(KEYS))
plt.bar(place - 0.2, list(first), width=0.4, label="first order")
plt.bar(place + 0.2, list(total), width=0.4, label="total")
plt.xticks(place, list(KEYS))
plt.ylabel("Sobol' index of the peak")
plt.legend()
plt.savefig("sobol_openturns.png", dpi=150)
