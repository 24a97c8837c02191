"""Sobol' indices of the peak of a study by OpenTURNS: the contribution of each key to its variance.

    python3 sobol-openturns.py [SIZE]        (butee in the PATH, or named by BUTEE; 2^SIZE points for each of four samples, 7)
"""

import csv
import io
import os
import pathlib
import subprocess
import sys

import openturns as ot

KEYS = {"load[0].amplitude": (1000.0, 9000.0), "contact[0].gap": (0.5e-3, 1.5e-3)}
study = pathlib.Path(__file__).with_name("sample.toml")


def peaks(points):
    """The peak at each point, from one call of the program, which uses all processors."""
    lines = [",".join(KEYS)] + [",".join(repr(float(value)) for value in point) for point in points]
    answer = subprocess.run([os.environ.get("BUTEE", "butee"), "study", study, "-q", "--points", "-", "--results", "-"],
                            input="\n".join(lines) + "\n", check=True, capture_output=True, text=True).stdout
    return [[float(row["peak rotor.u"])] for row in csv.DictReader(io.StringIO(answer))]


size = 2 ** int(sys.argv[1] if len(sys.argv) > 1 else 7)
inputs = ot.ComposedDistribution([ot.Uniform(*bounds) for bounds in KEYS.values()])
design = ot.SobolIndicesExperiment(inputs, size).generate()
indices = ot.SaltelliSensitivityAlgorithm(design, ot.Sample(peaks(design)), size)
for key, first, total in zip(KEYS, indices.getFirstOrderIndices(), indices.getTotalOrderIndices()):
    print(f"{key}: first order {first:.3f}, total {total:.3f}")
