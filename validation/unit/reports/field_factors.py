#!/usr/bin/env python3
"""Tests what validation/field/field.py reads and writes, without OpenFOAM and CalculiX.

Usage: field_factors.py PROGRAM FIELD-FOLDER DATA-FOLDER

The recorded output is that of OpenFOAM 1912 and CalculiX 2.20 for data/field/plates.obj, one cell for each face.
"""

import base64
import pathlib
import re
import sys
import tempfile
import unittest

import numpy

program, folder, data = map(pathlib.Path, sys.argv[1:4])
sys.path.insert(0, str(folder))
import field  # noqa: E402

F = """FoamFile
{
    class       scalarListList;
}
// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //


4
(
1(0.3183098861837907)
1(0.3183098861837907)
1(1.273239544735163)
1(1.273239544735163)
)


// ************************************************************************* //
"""
SEEN = F.replace("1(0.3183098861837907)", "1(3)", 1).replace("1(0.3183098861837907)", "1(2)", 1).replace(
    "1(1.273239544735163)", "1(1)", 1).replace("1(1.273239544735163)", "1(0)", 1)
VWF = base64.b64decode(
    "UAAAAFZlcnNpb24gMi4yMCAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgICAgIC"
    "AgUAAAACAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAACAAAABgAAAAAAAAAAAAAAAAAAAAAAAAANlqb8UAWOE/2WpvxQBY4T8A"
    "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAIIoMe7e38c/gigx7t7fxz8AAAAAAAAAAAAAAAAAAAAAYAAAACAAAADgtXNECAjqP+C1c0"
    "QICOo/Tiohdf5P3T9OKiF1/k/dPyAAAAA=")


def plates(across, block=1):
    with tempfile.TemporaryDirectory() as name:
        return field.Scene(program, data / "field/plates.obj", pathlib.Path(name)).cells(across, block)


class FieldFactors(unittest.TestCase):
    def test_factors_of_patches_are_weighted_by_area(self):
        faces = numpy.array([[0, 0.25, 0.5], [0, 0, 0.25], [0.125, 0.5, 0]])
        patches = field.of_patches(faces, numpy.array([1.0, 3.0, 2.0]), numpy.array([0, 0, 1]))
        numpy.testing.assert_allclose(patches, [[0.0625, 0.3125], [0.625, 0]])

    def test_openfoam_factors_are_read(self):
        with tempfile.TemporaryDirectory() as name:
            case = pathlib.Path(name)
            field.write_case(case, plates(1))
            faces = re.findall(r"4\((\d+) (\d+) (\d+) (\d+)\)", (case / "constant/polyMesh/faces").read_text())
            (case / "constant/F").write_text(F)
            (case / "constant/globalFaceFaces").write_text(SEEN)
            matrix = field.read_factors(case, 4)
        corners = plates(1).points[numpy.array(faces, int)]
        outward = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
        self.assertEqual(list(numpy.sign(outward)), [-1, 1, -1, 1])
        # Centre to centre: the area of the other face over pi times the squared distance.
        expected = numpy.array([[0, 0, 0, 1], [0, 0, 1, 0], [0, 4, 0, 0], [4, 0, 0, 0]]) / numpy.pi
        numpy.testing.assert_allclose(matrix, expected)

    def test_calculix_factors_are_read(self):
        with tempfile.TemporaryDirectory() as name:
            path = pathlib.Path(name) / "scene.vwf"
            path.write_bytes(VWF)
            matrix = field.read_vwf(path, 4)
        self.assertEqual([list(numpy.nonzero(row)[0]) for row in matrix], [[3], [2], [1], [0]])
        numpy.testing.assert_allclose(matrix[[0, 1, 2, 3], [3, 2, 1, 0]], [0.1865195] * 2 + [0.54199256] * 2, rtol=1e-7)


unittest.main(argv=sys.argv[:1])
