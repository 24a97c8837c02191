"""Checks /probes of a fields.h5 against a history.csv: check_probes.py FIELDS.H5 HISTORY.CSV whole|part|growing

part: the rows that both hold are compared; growing: as well, and a try that meets the writer's, or comes before its
first flush, is repeated."""
import sys
import time

import h5py
import numpy as np

UNITS = {"t": "s", "h": "s", "u": "m", "v": "m/s", "a": "m/s2", "theta": "rad", "contact_force": "N", "V": "N", "M": "N m"}

for tries_left in range(200 if sys.argv[3] == "growing" else 1)[::-1]:
    try:
        with h5py.File(sys.argv[1], "r") as h5:
            columns = {name: dataset[:] for name, dataset in h5["probes"].items()}
            units = {name: dataset.attrs["unit"].decode() for name, dataset in h5["probes"].items()}
        lengths = {len(values) for values in columns.values()}
        if sys.argv[3] != "growing" or (len(lengths) == 1 and lengths != {0}):
            break
    except OSError:
        if tries_left == 0:
            raise
    time.sleep(0.05)
with open(sys.argv[2]) as file:
    lines = file.read().split("\n")[:-1]  # ignore an incomplete last line
header = lines[0].split(",")
history = [[float(cell) if cell else np.nan for cell in line.split(",")] for line in lines[1:]]

assert set(columns) == set(header), (sorted(columns), header)
for name in header:
    assert units[name] == UNITS[name.split(".")[-1]], (name, units[name])
lengths = {len(values) for values in columns.values()}
assert len(lengths) == 1, lengths
rows = lengths.pop()
if sys.argv[3] == "whole":
    assert rows == len(history), (rows, len(history))
else:
    rows = min(rows, len(history))
assert rows > 0
for i, name in enumerate(header):
    expected = np.array([row[i] for row in history[:rows]])
    assert np.array_equal(columns[name][:rows], expected, equal_nan=True), name
print(f"{rows} rows of {len(header)} columns agree")
