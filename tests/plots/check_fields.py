"""Checks fields.h5 and fields.xdmf of a result folder against its history.csv: check_fields.py FOLDER"""
import csv
import os
import sys
import xml.etree.ElementTree as tree

import h5py
import numpy as np

folder = os.path.abspath(sys.argv[1])
with open(folder + "/history.csv") as file:
    rows = list(csv.reader(file))
history = {name: np.array([float(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])}

with h5py.File(folder + "/fields.h5", "r") as h5:
    names = [name.decode() for name in h5["nodes/name"]]
    records, nodes = h5["fields/u"].shape
    assert h5["fields/u"].compression == "gzip" and h5["fields/u"].attrs["unit"].decode() == "m"
    assert np.array_equal(h5["time"][:], history["t"])
    middle, rotor = names.index("string:5"), names.index("rotor")
    u, state = h5["fields/u"][:], h5["fields/stop_state"][:]
    assert np.array_equal(u[:, middle], history["mid.u"])
    assert np.array_equal(u[:, rotor], history["rotor.u"])
    assert np.array_equal(h5["fields/contact_force"][:, middle], history["mid.contact_force"])
    position, time = h5["nodes/position"][:], h5["time"][:]
    print(f"h5py: {records} records of {nodes} nodes agree")

    grids = tree.parse(folder + "/fields.xdmf").getroot().findall("./Domain/Grid/Grid")
    assert len(grids) == records
    for record, grid in enumerate(grids):
        assert float(grid.find("Time").get("Value")) == time[record]
        for item in grid.iter("DataItem"):
            if item.get("Format") != "HDF":
                continue
            file, path = item.text.split(":")
            assert file == "fields.h5"
            size = tuple(int(n) for n in item.get("Dimensions").split())
            kept = h5[path].shape
            assert len(size) == len(kept) and size[1:] == kept[1:] and size[0] <= kept[0], (path, size, kept)
        slab = grid.find("./Attribute[@Name='u']/DataItem/DataItem").text.split()
        assert slab == [str(record), "0", "1", "1", "1", str(nodes)]
    print(f"xdmf: {records} grids agree")

try:
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError:
    print("vtk: has no reader of XDMF here")
    sys.exit(0)
reader = vtkXdmfReader()
reader.SetFileName(folder + "/fields.xdmf")
reader.UpdateInformation()
for record in (0, 1, records // 2, records - 1):
    reader.UpdateTimeStep(time[record])
    grid = reader.GetOutputDataObject(0)
    assert grid.GetNumberOfPoints() == nodes
    kinds = [grid.GetCell(i).GetClassName() for i in range(grid.GetNumberOfCells())]
    assert kinds == ["vtkPolyLine", "vtkPolyVertex"], kinds
    assert np.allclose(vtk_to_numpy(grid.GetPoints().GetData()), position)
    values = grid.GetPointData()
    moved = vtk_to_numpy(values.GetArray("displacement"))
    assert np.array_equal(moved[:, 1], u[record]) and not moved[:, [0, 2]].any()
    assert np.array_equal(vtk_to_numpy(values.GetArray("stop_state")), state[record])
print("vtk: 4 records agree")
