"""Reads what the program writes for --vtk and --npy by VTK, meshio and NumPy, and compares it with its CSV files.

usage: vtk_test.py PROGRAM DATA-FOLDER [GROUP]

Every number must be the same to the last bit.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

import meshio
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

PROGRAM, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
CORNELL = str(DATA / "scenes/cornell_box.obj")
STATUS = {"certified": 0, "zero": 1, "underflow": 2, "not certified": 3}
VERTEX, TRIANGLE, POLYGON, QUADRILATERAL = 1, 5, 7, 9  # types of cells


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


class Read:
    """A file as VTK reads it."""

    def __init__(self, path):
        reader = vtkXMLPolyDataReader() if path.suffix == ".vtp" else vtkXMLUnstructuredGridReader()
        problems = []
        reader.AddObserver("ErrorEvent", lambda *_: problems.append("error"))
        reader.AddObserver("WarningEvent", lambda *_: problems.append("warning"))
        reader.SetFileName(str(path))
        reader.Update()
        self.data = reader.GetOutput()
        assert not problems, f"VTK complains of {path}"
        cells = self.data.GetCellData()
        self.names = [cells.GetAbstractArray(k).GetName() for k in range(cells.GetNumberOfArrays())]
        self.points = vtk_to_numpy(self.data.GetPoints().GetData()) if self.data.GetNumberOfPoints() else []

    def __len__(self):
        return self.data.GetNumberOfCells()

    def array(self, name):
        return self._values(self.data.GetCellData().GetAbstractArray(name))

    def of_file(self, name):
        return self._values(self.data.GetFieldData().GetAbstractArray(name))

    def corners(self, cell):
        ids = self.data.GetCell(cell).GetPointIds()
        return [ids.GetId(k) for k in range(ids.GetNumberOfIds())]

    def type(self, cell):
        return self.data.GetCellType(cell)

    @staticmethod
    def _values(array):
        if hasattr(array, "GetValue") and array.GetDataTypeAsString() == "string":
            return [array.GetValue(k) for k in range(array.GetNumberOfValues())]
        return vtk_to_numpy(array)


def floats(rows, *columns):
    values = [[float(row[column]) for column in columns] for row in rows]
    return numpy.array(values).reshape(len(rows), len(columns)) if len(columns) > 1 else numpy.array(values)[:, 0]


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return pathlib.Path(self.folder.name) / name

    def run_program(self, *words):
        ended = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        return ended.stdout

    def same(self, one, other):
        """To the last bit; NaN is NaN."""
        one, other = numpy.asarray(one), numpy.asarray(other)
        self.assertEqual(one.shape, other.shape)
        self.assertEqual(one.dtype, other.dtype)
        self.assertTrue(((one == other) & (numpy.signbit(one) == numpy.signbit(other)) |
                         ((one != one) & (other != other))).all())

    def check_exact(self, array, rows, name=""):
        """`rows` are those of one source."""
        suffix = f" ({name})" if name else ""
        for quantity in "exact", "lower", "upper":
            self.same(array(quantity + suffix), floats(rows, quantity))
        self.same(array("status" + suffix), numpy.array([STATUS[row["status"]] for row in rows], dtype="uint8"))
        self.same(array("radiosity" + suffix), floats(rows, "radiosity_r", "radiosity_g", "radiosity_b"))
        if "visible_fraction" in rows[0]:
            self.same(array("visible fraction" + suffix), floats(rows, "visible_fraction"))

    def check_places(self, array, rows):
        self.same(array("point"), floats(rows, "x", "y", "z"))
        self.same(array("normal"), floats(rows, "nx", "ny", "nz"))
        self.assertEqual(list(array("receiver")), list(range(len(rows))))

    def check_cells(self, read):
        """Each cell surrounds its receiver, in its plane, counter-clockwise around its normal."""
        for cell, (point, normal) in enumerate(zip(read.array("point"), read.array("normal"))):
            corners = read.points[read.corners(cell)]
            self.assertEqual(len(corners), 4)
            size = numpy.abs(corners - point).max()
            self.assertLess(numpy.abs(corners.mean(axis=0) - point).max(), 1e-9 * size)
            for k in range(4):
                turn = numpy.cross(corners[k] - point, corners[(k + 1) % 4] - point)
                self.assertGreater(turn @ normal, 0.99 * numpy.linalg.norm(turn) * numpy.linalg.norm(normal))


class TruthFiles(Case):
    def truth(self, extension, *words):
        self.run_program("truth", *words, "-o", self.path("t.csv"), "--vtk", self.path("t" + extension), "--npy",
                         self.path("t.npy"), "--force")
        return rows_of(self.path("t.csv"))

    GRID = (CORNELL, "--on", "floor,short_block,back", "--grid", "5x4")

    def test_every_number_of_one_source(self):
        for extension in ".vtp", ".vtu":
            rows = self.truth(extension, *self.GRID, "--fraction")
            read = Read(self.path("t" + extension))
            self.assertEqual(len(read), len(rows))
            self.check_exact(read.array, rows)
            self.check_places(read.array, rows)
            self.check_cells(read)
            self.assertEqual(read.data.GetCellData().GetScalars().GetName(), "exact")
            self.assertGreater(read.array("exact").max(), 0.0)

    def test_every_number_of_several_sources(self):
        rows = self.truth(".vtp", *self.GRID, "--source", "light,ceiling,left", "--fraction")
        read = Read(self.path("t.vtp"))
        radiosity = 0.0
        for s, name in enumerate(("light", "ceiling", "left")):
            self.check_exact(read.array, rows[s::3], name)
            radiosity = radiosity + floats(rows[s::3], "radiosity_r", "radiosity_g", "radiosity_b")
        self.same(read.array("radiosity"), radiosity)
        self.check_places(read.array, rows[::3])
        self.same(numpy.load(self.path("t.npy")), floats(rows, "exact").reshape(-1, 3))

    def test_receivers_without_cells_are_vertices(self):
        for flag in "--vertices", "--centres":
            for extension in ".vtp", ".vtu":
                rows = self.truth(extension, CORNELL, "--on", "short_block", flag)
                read = Read(self.path("t" + extension))
                self.assertEqual({read.type(cell) for cell in range(len(read))}, {VERTEX})
                self.same(read.points[[read.corners(cell)[0] for cell in range(len(read))]], floats(rows, "x", "y", "z"))
                self.check_exact(read.array, rows)

    def test_meshio_reads_the_same(self):
        rows = self.truth(".vtu", *self.GRID, "--source", "light,ceiling", "--fraction")
        mesh = meshio.read(self.path("t.vtu"))
        self.assertEqual([block.type for block in mesh.cells], ["quad"])
        self.check_exact(lambda name: mesh.cell_data[name][0], rows[::2], "light")
        self.check_places(lambda name: mesh.cell_data[name][0], rows[::2])
        self.same(mesh.points, numpy.array(Read(self.path("t.vtu")).points))
        scene = meshio.read(self.path("t_scene.vtu"))
        self.assertEqual(sum(len(block.data) for block in scene.cells), len(Read(self.path("t_scene.vtu"))))
        self.truth(".vtu", CORNELL, "--on", "short_block", "--centres")
        self.assertEqual([block.type for block in meshio.read(self.path("t.vtu")).cells], ["vertex"])

    def test_the_scene_has_its_patches(self):
        self.truth(".vtp", *self.GRID)
        scene = Read(self.path("t_scene.vtp"))
        names = scene.of_file("patch names")
        self.assertEqual(names, ["floor", "ceiling", "light", "back", "right", "left", "short_block", "tall_block"])
        light = scene.array("patch") == names.index("light")
        self.assertEqual(scene.array("Ke")[light].tolist(), [[17.0, 12.0, 4.0]])
        self.assertEqual(scene.array("Ke")[~light].max(), 0.0)
        self.assertEqual(sorted({name for name in scene.array("name") if name.startswith("left")}), ["left:1", "left:2"])
        area = 0.0
        for cell in range(len(scene)):
            corners = scene.points[scene.corners(cell)]
            fan = [numpy.cross(corners[k] - corners[0], corners[k + 1] - corners[0]) for k in range(1, len(corners) - 1)]
            area += numpy.linalg.norm(sum(fan)) / 2
        self.assertAlmostEqual(area, 1.9207e6, delta=50)  # as exactff info says

class CompareFiles(Case):
    def compare(self, file, *words):
        self.run_program("compare", CORNELL, "--on", "floor,right", "--grid", "4x3", *words, "-o", self.path("report"),
                         "--vtk", self.path(file))
        return Read(self.path(file))

    def check_settings(self, read, exact):
        """All values are there, and each error is the value minus the exact one."""
        values = [name for name in read.names if name.startswith("value ")]
        self.assertEqual(["error" + name[5:] for name in values], [name for name in read.names if name[:6] == "error "])
        for name in values:
            self.same(read.array("error" + name[5:]), read.array(name) - exact)
        return values

    def test_the_sweep_is_that_of_the_tables(self):
        read = self.compare("map.vtp", "--no-methods")
        exact = rows_of(self.path("report") / "exact.csv")
        self.check_exact(read.array, exact)
        self.check_cells(read)
        values = self.check_settings(read, floats(exact, "exact"))
        table = rows_of(self.path("report") / "values.csv")
        for row in table:
            name = (f"sweep:eps_B={row['eps_b']},eps_A={row['eps_a']},rays={row['rays_per_leaf']},"
                    f"pattern={row['pattern']},variant={row['variant']},seed={row['seed']}")
            self.assertIn("value " + name, values)
            place = [e["receiver"] for e in exact].index(row["receiver"])
            self.assertEqual(read.array("value " + name)[place], float(row["approximate"]))
            self.assertEqual(read.array("error " + name)[place], float(row["error"]))
        self.assertEqual(len(values) * len(exact), len(table))

    def test_a_method_has_one_setting_at_every_receiver(self):
        words = ["--method", "hemicube:resolution=16|32|64", "--method", "area-sampling:samples=4|16",
                 "--method-receivers", "5"]
        read = self.compare("map.vtu", "--source", "light,ceiling", *words)
        exact = rows_of(self.path("report") / "exact.csv")
        for s, name in enumerate(("light", "ceiling")):
            self.check_exact(read.array, exact[s::2], name)
        values = self.check_settings(read, read.array("exact"))
        self.assertEqual(len(values), 2)
        self.assertTrue(values[0].startswith("value hemicube:resolution=32"), values)
        sums = floats(exact[::2], "exact") + floats(exact[1::2], "exact")
        self.assertLess(numpy.abs(read.array("exact") - sums).max(), 1e-15)
        self.assertLess(numpy.abs(read.array("error" + values[0][5:])).max(), 0.05)
        self.assertGreater(numpy.abs(read.array("error" + values[0][5:])).max(), 0.0)
        mesh = meshio.read(self.path("map.vtu"))
        for name in read.names:
            self.same(mesh.cell_data[name][0], read.array(name))

class OddFiles(Case):
    SQUARE = "v {0} 0 0\nv {1} 0 0\nv {1} 0 1\nv {0} 0 1\n"

    def test_names_that_are_no_xml(self):
        names = ["a<b>&\"c'", "]]>", "é日本", "two_words", "--", "(1)", "100%"]
        text = "".join(self.SQUARE.format(2 * k, 2 * k + 1) + f"g {name}\nf {4 * k + 4} {4 * k + 3} {4 * k + 2} {4 * k + 1}\n"
                       for k, name in enumerate(names))
        self.path("odd.obj").write_text(text, encoding="utf-8")
        self.run_program("truth", self.path("odd.obj"), "--receivers", self.receivers(), "--source", "all", "-o",
                         self.path("t.csv"), "--vtk", self.path("t.vtp"))
        self.assertEqual(Read(self.path("t_scene.vtp")).of_file("patch names"), names)
        read = Read(self.path("t.vtp"))
        for name in names:
            self.assertIn(f"exact ({name})", read.names)
        self.assertEqual(read.array("id"), ["one & only", "<two>"])
        self.run_program("truth", self.path("odd.obj"), "--receivers", self.receivers(), "--source", "all", "-o",
                         self.path("u.csv"), "--vtk", self.path("u.vtu"))
        self.assertEqual([name for name in read.names if name not in ("id", "on")],
                         list(meshio.read(self.path("u.vtu")).cell_data))

    def test_names_that_control_a_terminal_stay_apart(self):
        text = b"".join(self.SQUARE.format(2 * k, 2 * k + 1).encode() + b"g " + name + b"\nf -1 -2 -3 -4\n"
                        for k, name in enumerate((b"a\x1b", b"a\\x1b", b"a\xe9")))
        self.path("odd.obj").write_bytes(text)
        self.run_program("truth", self.path("odd.obj"), "--receivers", self.receivers(), "--source", "all", "-o",
                         self.path("t.csv"), "--vtk", self.path("t.vtp"))
        exact = [name for name in Read(self.path("t.vtp")).names if name.startswith("exact")]
        self.assertEqual(exact, ["exact (a\\x1b)", "exact (a\\x1b) 2", "exact (aé)"])

    def receivers(self):
        self.path("r.csv").write_text("id,x,y,z,nx,ny,nz,on\none & only,0,-1,0,0,1,0,\n<two>,3,-2,0,0,1,0,\n")
        return self.path("r.csv")

    def test_all_magnitudes(self):
        for scale in "1e-310", "1e-160", "1e150", "1.7e308":
            self.path("s.obj").write_text(
                f"v 0 0 0\nv {scale} 0 0\nv {scale} 0 {scale}\nv 0 0 {scale}\ng s\nf 4 3 2 1\n"
                f"v 0 {scale} 0\nv {scale} {scale} 0\nv {scale} {scale} {scale}\ng t\nf 5 6 7\n")
            self.run_program("truth", self.path("s.obj"), "--on", "s,t", "--grid", "3x3", "--source", "s,t", "-o",
                             self.path("t.csv"), "--vtk", self.path("t.vtp"), "--force")
            read = Read(self.path("t.vtp"))
            self.assertTrue(numpy.isfinite(read.points).all())
            self.check_exact(read.array, rows_of(self.path("t.csv"))[::2], "s")


class MatrixFiles(Case):
    SCENE = DATA / "scenes/formats/test4.vs3"

    def matrix(self, *words):
        self.run_program("matrix", self.SCENE, "--accuracy", "1e-4", "-o", self.path("m.csv"), *words)
        return rows_of(self.path("m.csv"))

    def test_arrays_of_a_sparse_matrix(self):
        rows = self.matrix("--backs", "--npz", self.path("m.npz"))
        with numpy.load(self.path("m.npz")) as file:
            arrays = {name: file[name] for name in file.files}
        shape = tuple(arrays["shape"])
        self.assertEqual(shape, (8, 8))
        between = [row for row in rows if row["to"] not in ("(back)", "(open)")]
        dense, radius, claim = numpy.zeros(shape), numpy.zeros(shape), numpy.full(shape, "zero", dtype="U20")
        for i in range(shape[0]):
            part = slice(arrays["indptr"][i], arrays["indptr"][i + 1])
            dense[i, arrays["indices"][part]] = arrays["data"][part]
            radius[i, arrays["indices"][part]] = arrays["radius"][part]
            claim[i, arrays["indices"][part]] = arrays["claim"][part]
        self.same(dense.ravel(), floats(between, "factor"))
        self.assertTrue((dense.ravel() - radius.ravel() <= floats(between, "lower")).all())
        self.assertTrue((dense.ravel() + radius.ravel() >= floats(between, "upper")).all())
        self.assertLess(radius.max(), 1.1e-4)
        self.assertEqual(list(claim.ravel()), [row["claim"] for row in between])
        self.assertEqual(list(arrays["from"]), [row["from"] for row in between[::8]])
        self.assertEqual(list(arrays["to"]), [row["to"] for row in between[:8]])
        self.same(arrays["area_from"], floats(between[::8], "area_from"))
        self.same(arrays["area_to"], floats(between[:8], "area_to"))
        self.same(arrays["back"], floats([row for row in rows if row["to"] == "(back)"], "factor"))
        self.assertNotIn("open", arrays)
        try:
            import scipy.sparse
        except ImportError:
            return
        self.same(scipy.sparse.load_npz(self.path("m.npz")).toarray(), dense)

    def test_a_row_on_the_scene(self):
        rows = self.matrix("--from", "srf-1", "--vtk", self.path("row.vtp"))
        read = Read(self.path("row.vtp"))
        place = {row["to"]: k for k, row in enumerate(rows)}
        names = read.of_file("patch names")
        order = [place[names[patch]] for patch in read.array("patch")]
        for name, column in ("factor", "factor"), ("lower", "lower"), ("upper", "upper"):
            self.same(read.array(name), floats(rows, column)[order])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
