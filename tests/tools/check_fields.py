#!/usr/bin/env python3
"""Opens the field file of a run as a user would, with h5py and, where it is installed, with VTK's reader of XDMF.

   check_fields.py FOLDER [--picture FILE.png]

FOLDER holds the field file and the tables of one run; the deck asked for U, S and the contact fields in both. The picture needs
VTK: the deformed bodies by von Mises' stress, with the tractions upon the slave.
"""
import glob
import os
import sys
import xml.etree.ElementTree as ET

import h5py
import numpy

TOLERANCE = 1e-9  # of the largest value: the tables have 10 digits or more
FAILURES = []


def expect(condition, text):
    if not condition:
        FAILURES.append(text)
        print("FAILED:", text)


def table(folder, name):
    """Columns of a table, and their dimensions."""
    path = os.path.join(folder, name + ".tab")
    columns = dimensions = None
    for line in open(path, encoding="utf-8"):
        if line.startswith("# columns:"):
            columns = line.split()[2:]
        elif line.startswith("# dimensions:"):
            dimensions = line.split()[2:]
    rows = numpy.loadtxt(path, ndmin=2)
    return dict(zip(columns, rows.T)), dict(zip(columns, dimensions))


def same(found, wanted, what):
    scale = numpy.abs(wanted).max()
    off = numpy.abs(numpy.asarray(found, float) - wanted).max() if found.shape == wanted.shape else numpy.inf
    print(f"{what}: {wanted.size} values, off by {off:.1e} of {scale:.3e}")
    expect(off <= TOLERANCE * scale, what)


def check_h5(folder, path):
    with h5py.File(path) as file:
        expect(isinstance(file.attrs["program"], str) and file.attrs["program"].startswith("atrito "), "attribute program")
        expect(isinstance(file.attrs["heading"], str), "attribute heading")
        expect(file.attrs["converged"] == 1, "attribute converged")
        datasets = []
        file.visititems(lambda name, item: datasets.append(item) if isinstance(item, h5py.Dataset) else None)
        for item in datasets:
            expect(isinstance(item.attrs["name"], str) and item.attrs["name"], item.name + ": name")
            expect(isinstance(item.attrs["dimension"], str) and item.attrs["dimension"], item.name + ": dimension")
            expect(item.compression == "gzip" and item.shuffle, item.name + ": not compressed")
        step = file["step_1"]
        values, _ = table(folder, "nodes")
        same(file["mesh/coordinates"][:, 0], values["x"], "x")
        same(step["nodes/U"][:, :2], numpy.stack([values["u1"], values["u2"]], 1), "U")
        expect(not step["nodes/U"][:, 2].any() and step["nodes/U"].attrs["dimension"] == "L", "U is a vector of the plane [L]")
        for group, name in (("stress_points", "stress"), ("pair_1", "contact")):
            values, dimensions = table(folder, name)
            first = values["pair"] == 1 if "pair" in values else slice(None)
            for column in step[group]:
                if column in values:
                    same(step[group][column][()], values[column][first], group + "/" + column)
                    expect(step[group][column].attrs["dimension"] == dimensions[column], column + ": dimension")


def check_xdmf(folder, path):
    """Every item has the shape and the kind of number of its dataset."""
    for item in ET.parse(path).iter("DataItem"):
        name, inside = item.text.split(":")
        with h5py.File(os.path.join(folder, name)) as file:
            data = file[inside]
            shape = tuple(int(n) for n in item.get("Dimensions").split())
            kind = {"Float": "f8", "Int": "i4"}[item.get("NumberType")]
            expect(shape == data.shape and data.dtype.str[1:] == kind, inside + ": not as in the .xdmf")


def read_blocks(path):
    import vtk

    reader = vtk.vtkXdmfReader()
    reader.SetFileName(path)
    reader.Update()
    step = reader.GetOutputDataObject(0)
    names = [step.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()) for i in range(step.GetNumberOfBlocks())]
    return {name: step.GetBlock(i) for i, name in enumerate(names)}


def check_vtk(folder, path, blocks):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    values, _ = table(folder, "nodes")
    bodies = [block for name, block in blocks.items() if name.startswith("bodies")]
    expect(len(bodies) > 0 and "pair 1" in blocks and "stress points" in blocks, "the blocks of the .xdmf")
    kinds = {"Q1": vtk.VTK_QUAD, "Q2": vtk.VTK_BIQUADRATIC_QUAD}
    for name, block in blocks.items():
        if name.startswith("bodies"):
            expect(block.GetCellType(0) == kinds[name.split()[1]], name + ": kind of cell")
            size = vtk.vtkCellSizeFilter()
            size.SetInputData(block)
            size.Update()
            area = vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Area"))
            print(f"VTK {name}: {block.GetNumberOfCells()} cells, area {area.sum():.12g}")
            expect((area > 0).all(), name + ": a cell without area")
        warp = vtk.vtkWarpVector()
        if name.startswith("bodies"):
            warp.SetInputData(block)
            warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "U")
            warp.Update()
            moved = vtk_to_numpy(warp.GetOutput().GetPoints().GetData())
            same(moved[:, 0], values["x"] + values["u1"], "VTK, warped x")
            same(moved[:, 1], values["y"] + values["u2"], "VTK, warped y")
    values, _ = table(folder, "contact")
    pressure = vtk_to_numpy(blocks["pair 1"].GetPointData().GetArray("pressure"))
    same(pressure, values["pressure"][values["pair"] == 1], "VTK, pressure")


def stress_on_cells(block, points):
    """Von Mises' stress: at the nodes where it is there, else the mean of an element's points."""
    import vtk
    from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

    if block.GetPointData().HasArray("mises"):
        return False
    element = vtk_to_numpy(block.GetCellData().GetArray("element"))
    owner = vtk_to_numpy(points.GetPointData().GetArray("element"))
    mises = vtk_to_numpy(points.GetPointData().GetArray("mises"))
    array = numpy_to_vtk(numpy.array([mises[owner == e].mean() for e in element]), deep=True)
    array.SetName("mises")
    block.GetCellData().AddArray(array)
    return True


def draw(blocks, picture):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    bodies = [block for name, block in blocks.items() if name.startswith("bodies")]
    pair = blocks["pair 1"]
    box = vtk.vtkBoundingBox()
    for block in bodies:
        box.AddBounds(block.GetBounds())
    size = box.GetDiagonalLength()
    largest = max(numpy.abs(vtk_to_numpy(b.GetPointData().GetArray("U"))).max() for b in bodies)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    colours = vtk.vtkLookupTable()
    colours.SetHueRange(0.667, 0.0)
    on_cells = [stress_on_cells(block, blocks["stress points"]) for block in bodies][0]
    data = [(b.GetCellData() if on_cells else b.GetPointData()).GetArray("mises").GetRange() for b in bodies]
    limits = (min(r[0] for r in data), max(r[1] for r in data))
    for block in bodies:
        fine = vtk.vtkDataSetSurfaceFilter()
        warp = vtk.vtkWarpVector()
        warp.SetInputData(block)
        warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "U")
        warp.SetScaleFactor(0.05 * size / largest)
        fine.SetInputConnection(warp.GetOutputPort())
        fine.SetNonlinearSubdivisionLevel(2)
        mapper = vtk.vtkDataSetMapper()
        mapper.SetInputConnection(fine.GetOutputPort())
        (mapper.SetScalarModeToUseCellFieldData if on_cells else mapper.SetScalarModeToUsePointFieldData)()
        mapper.SelectColorArray("mises")
        mapper.SetLookupTable(colours)
        mapper.SetScalarRange(limits)
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        renderer.AddActor(actor)
        edges = vtk.vtkExtractEdges()
        edges.SetInputConnection(warp.GetOutputPort())
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(edges.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.3, 0.3, 0.3)
        renderer.AddActor(actor)
    pressure = pair.GetPointData().GetArray("pressure").GetRange()[1]
    arrow = vtk.vtkArrowSource()
    arrow.SetTipResolution(16)
    glyph = vtk.vtkGlyph3D()
    warp = vtk.vtkWarpVector()
    warp.SetInputData(pair)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "U")
    warp.SetScaleFactor(0.05 * size / largest)
    glyph.SetInputConnection(warp.GetOutputPort())
    glyph.SetSourceConnection(arrow.GetOutputPort())
    glyph.SetInputArrayToProcess(1, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "traction")
    glyph.SetVectorModeToUseVector()
    glyph.SetScaleModeToScaleByVector()
    glyph.SetScaleFactor(0.25 * size / pressure)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(glyph.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0, 0, 0)
    actor.SetPosition(0, 0, 0.01 * size)
    renderer.AddActor(actor)
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(colours)
    bar.SetTitle("mises")
    bar.GetTitleTextProperty().SetColor(0, 0, 0)
    bar.GetLabelTextProperty().SetColor(0, 0, 0)
    bar.SetPosition(0.8, 0.1)
    bar.SetWidth(0.15)
    renderer.AddViewProp(bar)
    renderer.ResetCamera()
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1200, 800)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def main():
    folder = sys.argv[1]
    path = glob.glob(os.path.join(folder, "*.xdmf"))[0]
    check_h5(folder, path[: -len(".xdmf")] + ".h5")
    check_xdmf(folder, path)
    try:
        import vtk  # noqa: F401
    except ImportError:
        print("VTK is not installed: the .xdmf was read as XML only")
    else:
        blocks = read_blocks(path)
        check_vtk(folder, path, blocks)
        if "--picture" in sys.argv:
            draw(blocks, sys.argv[sys.argv.index("--picture") + 1])
    print("all hold" if not FAILURES else f"{len(FAILURES)} failed")
    return 1 if FAILURES else 0


if __name__ == "__main__":
    sys.exit(main())
