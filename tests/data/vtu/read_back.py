"""Reads with VTK and meshio (pip install vtk meshio) what `FOIL2D_KEEP=<folder> cargo test --test results` leaves in a folder, and holds
both against each other, the three encodings against each other, and the table that the library wrote beside them."""

import csv
import sys
from pathlib import Path

import meshio
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy


def with_vtk(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    if reader.GetErrorCode():
        raise SystemExit(f"{path}: VTK's error {reader.GetErrorCode()}")
    return reader.GetOutput()


def arrays(data):
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}


def check_part(folder, name, ending):
    grids = {encoding: with_vtk(folder / f"{encoding}_{ending}") for encoding in ["Ascii", "Base64", "Appended"]}
    first = grids["Ascii"]
    for encoding, grid in grids.items():
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(first.GetPoints().GetData()))
        for data in ["GetPointData", "GetCellData"]:
            one, other = arrays(getattr(first, data)()), arrays(getattr(grid, data)())
            assert one.keys() == other.keys() and all(np.array_equal(one[key], other[key]) for key in one), encoding
    print(f"{name}: {first.GetNumberOfPoints()} points, {first.GetNumberOfCells()} cells in all encodings; "
          f"{sorted(arrays(first.GetPointData()))} {sorted(arrays(first.GetCellData()))}")
    return first


def main(folder):
    series = folder / "series"
    for step, row in enumerate(csv.DictReader(open(series / "Ascii.csv"))):
        flexible = check_part(series, f"flexible {step}", f"flexible_{step:06}.vtu")
        check_part(series, f"rigid {step}", f"rigid_{step:06}.vtu")
        check_part(series, f"contacts {step}", f"contacts_{step:06}.vtu")
        data = arrays(flexible.GetPointData())
        tensor = data["cauchy_stress"]
        names = [flexible.GetPointData().GetArray("cauchy_stress").GetComponentName(i) for i in range(6)]
        assert names == ["XX", "YY", "ZZ", "XY", "YZ", "XZ"], names
        xx, yy, zz, xy = tensor[:, 0], tensor[:, 1], tensor[:, 2], tensor[:, 3]
        von_mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)
        print(f"  von Mises from the tensor within {np.abs(von_mises - data['von_mises']).max() / von_mises.max():.1e}")
        for key, value in [("largest von Mises (Pa)", data["von_mises"].max()), ("contact force y (N)", data["contact_force"][:, 1].sum())]:
            expected = float(row[key])
            print(f"  {key}: VTK {value:.12g}, library {expected:.12g}")
            assert abs(value - expected) <= 1e-12 * abs(expected)
    # meshio takes one piece a file
    for body in ["small", "large"]:
        path = folder / body / "turned.vtu"
        grid, mesh = with_vtk(path), meshio.read(path)
        assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), mesh.points)
        for key, value in arrays(grid.GetPointData()).items():
            assert np.array_equal(np.squeeze(mesh.point_data[key]), value), key
        print(f"{path.name} of {body} strain: meshio reads {len(mesh.points)} points, {sum(len(c.data) for c in mesh.cells)} cells, the same as VTK")
    print("all agree")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
