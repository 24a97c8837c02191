"""Checks the rows of a study.h5 against those of a study.csv: check_study.py STUDY.H5 STUDY.CSV"""
import csv
import sys

import h5py
import numpy as np

with h5py.File(sys.argv[1], "r", swmr=True) as h5:
    rows = h5["rows"][:]
    names = h5["rows"].attrs["columns"].decode().split("\n")
    units = h5["rows"].attrs["units"].decode().split("\n")
with open(sys.argv[2], newline="") as file:
    table = list(csv.DictReader(file))

assert len(rows) == len(table) > 0
assert names == list(rows.dtype.names[:-1]), rows.dtype.names
assert len(units) == len(names)
assert dict(zip(names, units))["peak m.u"] == "m", units
skipped = {"wall_seconds", "factorizations", "solves", "assemblies"}
compared = 0
for row, line in zip(rows, table):
    for name in set(names) - skipped:
        value = row[name]
        if isinstance(value, bytes):
            assert value.decode() == line[name], name
        elif np.ndim(value) == 1:
            assert [float(line[f"{name}[{k + 1}]"]) for k in range(len(value))] == list(value), name
        else:
            assert float(line[name]) == value, name
        compared += 1
assert compared > 100
