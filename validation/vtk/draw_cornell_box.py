#!/usr/bin/env python3
"""Draws a map of form factors over the floor and the walls of the Cornell box, by VTK without a screen.

usage: draw_cornell_box.py MAP.vtp PICTURE.png

MAP.vtp is a file of `exactff truth --vtk`, and the scene is the file beside it. validation/gallery.sh has the commands.
"""
import pathlib
import sys

import vtkmodules.vtkRenderingFreeType  # noqa: F401  (the font)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer)
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkImagingCore import vtkImageShrink3D
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
                                         vtkWindowToImageFilter)

WIDTH, HEIGHT, MAP = 1200, 1000, 0.84  # the map takes this share of the width, the scale the rest
FINER = 3  # the picture is drawn this many times as large; each pixel is the mean of its parts, so that edges are smooth
MOST = 0.03  # of the scale. More have only cells on the top of the tall block, which is not seen, and a few on the other
INK = (0.13, 0.14, 0.16)
# From dark to light, each step lighter than the one before, so that the picture can be printed in grey.
COLOURS = [(0.00, (0.05, 0.03, 0.15)), (0.20, (0.29, 0.07, 0.43)), (0.40, (0.58, 0.15, 0.40)),
           (0.60, (0.86, 0.32, 0.23)), (0.80, (0.98, 0.62, 0.10)), (1.00, (0.99, 0.96, 0.68))]


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def colours(most):
    table = vtkLookupTable()
    table.SetNumberOfTableValues(256)
    for k in range(256):
        at = k / 255
        above = next(i for i in range(1, len(COLOURS)) if at <= COLOURS[i][0])
        (low, one), (high, other) = COLOURS[above - 1:above + 1]
        share = (at - low) / (high - low)
        table.SetTableValue(k, *(a + share * (b - a) for a, b in zip(one, other)), 1.0)
    table.SetTableRange(0.0, most)
    return table


def actor(data, table=None):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    if table is None:
        mapper.ScalarVisibilityOff()
    else:
        mapper.SetScalarModeToUseCellFieldData()
        mapper.SelectColorArray("exact")
        mapper.SetLookupTable(table)
        mapper.SetUseLookupTableScalarRange(True)
    made = vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().LightingOff()
    if table is not None:
        mapper.SetResolveCoincidentTopologyToPolygonOffset()  # lines on the surface are seen
        mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(2, 2)
    return made


def filled(data, colour, behind):
    made = actor(data)
    made.GetProperty().SetColor(colour)
    made.GetMapper().SetResolveCoincidentTopologyToPolygonOffset()
    made.GetMapper().SetRelativeCoincidentTopologyPolygonOffsetParameters(behind, behind)
    return made


def patch(scene, name):
    names = scene.GetFieldData().GetAbstractArray("patch names")
    index = [names.GetValue(k) for k in range(names.GetNumberOfValues())].index(name)
    threshold = vtkThreshold()
    threshold.SetInputData(scene)
    threshold.SetInputArrayToProcess(0, 0, 0, 1, "patch")  # 1: of the cells
    threshold.SetLowerThreshold(index)
    threshold.SetUpperThreshold(index)
    threshold.SetThresholdFunction(vtkThreshold.THRESHOLD_BETWEEN)
    surface = vtkGeometryFilter()
    surface.SetInputConnection(threshold.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def edges(data, colour, width):
    found = vtkFeatureEdges()
    found.SetInputData(data)
    found.ColoringOff()
    found.Update()
    made = actor(found.GetOutput())
    made.GetProperty().SetColor(colour)
    made.GetProperty().SetLineWidth(FINER * width)
    return made


def scale(table):
    bar = vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("F(x, light)\n ")
    bar.SetNumberOfLabels(4)
    bar.SetMaximumNumberOfColors(256)
    bar.SetLabelFormat("%.2f")
    bar.UnconstrainedFontSizeOn()
    for text in bar.GetTitleTextProperty(), bar.GetLabelTextProperty():
        text.SetColor(INK)
        text.SetFontFamilyToArial()
        text.SetFontSize(FINER * 20)
        text.BoldOff()
        text.ItalicOff()
        text.ShadowOff()
    bar.SetPosition(0.15, 0.2)
    bar.SetWidth(0.7)
    bar.SetHeight(0.6)
    return bar


def main(map_path, picture):
    cells = read(map_path)
    scene = read(map_path.with_name(map_path.stem + "_scene.vtp"))
    table = colours(MOST)
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.SetViewport(0, 0, MAP, 1)
    renderer.AddActor(actor(cells, table))
    renderer.AddActor(filled(patch(scene, "light"), (1.0, 0.99, 0.92), -4))  # cells of the ceiling reach over its edge
    renderer.AddActor(filled(patch(scene, "left"), INK, 4))  # two triangles: cells with centres beside them are missing
    for name in "floor", "ceiling", "back", "left", "right", "short_block", "tall_block":
        renderer.AddActor(edges(patch(scene, name), (0.62, 0.60, 0.64), 1.5))
    camera = renderer.GetActiveCamera()
    camera.SetPosition(278, 300, -820)
    camera.SetFocalPoint(278, 262, 280)
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(42)
    renderer.ResetCameraClippingRange()
    beside = vtkRenderer()
    beside.SetBackground(1, 1, 1)
    beside.SetViewport(MAP, 0, 1, 1)
    beside.AddActor2D(scale(table))
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(FINER * WIDTH, FINER * HEIGHT)
    window.AddRenderer(renderer)
    window.AddRenderer(beside)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    shrunk = vtkImageShrink3D()
    shrunk.SetInputConnection(image.GetOutputPort())
    shrunk.SetShrinkFactors(FINER, FINER, 1)
    shrunk.AveragingOn()
    writer = vtkPNGWriter()
    writer.SetInputConnection(shrunk.GetOutputPort())
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(picture))
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
