"""Scenes from meshes of other programs: arrays, what meshio reads, objects of other packages; and `python3 -m exactff`."""

import itertools
import subprocess
import sys
import types

import numpy as np
import pytest

import exactff
from support import CORNELL, same_bits

POINTS = np.array(list(itertools.product((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))))[:, ::-1]  # of a unit cube, x first
HEXAHEDRON = [[0, 1, 3, 2, 4, 5, 7, 6]]
TETRAHEDRA = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]]
WEDGES = [[0, 1, 3, 4, 5, 7], [0, 3, 2, 4, 7, 6]]
APEX = [[0.5, 0.5, 0.5]]
PYRAMIDS = [[0, 1, 3, 2, 8], [4, 6, 7, 5, 8], [0, 4, 5, 1, 8], [2, 3, 7, 6, 8], [0, 2, 6, 4, 8], [1, 5, 7, 3, 8]]


def volume(scene):
    """Of what the fronts enclose: positive if they look outward."""
    total = 0.0
    for face in range(len(scene.areas)):
        corners = scene.vertices[scene.rings(face)[0]]
        for b, c in zip(corners[1:], corners[2:]):
            total += np.dot(corners[0], np.cross(b, c))
    return total / 6


def turned(cells):
    """Inside out."""
    return [[cell[i] for i in {4: (1, 0, 2, 3), 5: (3, 2, 1, 0, 4), 6: (3, 4, 5, 0, 1, 2),
                               8: (4, 5, 6, 7, 0, 1, 2, 3)}[len(cell)]] for cell in cells]


def midpoints(points, cells, edges):
    """Points and cells with nodes in the middle of edges, moved outward: curved cells."""
    points, rows = list(map(tuple, points)), []
    for cell in cells:
        row = list(cell)
        for a, b in edges:
            points.append(tuple((np.array(points[cell[a]]) + points[cell[b]]) / 2 * 1.01))
            row.append(len(points) - 1)
        rows.append(row)
    return points, rows


@pytest.mark.parametrize("kind, cells, faces", [("tetra", TETRAHEDRA, 12), ("hexahedron", HEXAHEDRON, 6), ("wedge", WEDGES, 8),
                                                ("pyramid", PYRAMIDS, 6)])
def test_outer_faces_of_volumes_look_outward(kind, cells, faces):
    points = np.concatenate([POINTS, APEX])
    for some in (cells, turned(cells), turned(cells[:1]) + cells[1:]):
        scene = exactff.Scene.from_mesh(points, [(kind, some)])
        assert len(scene.areas) == faces and scene.report().open_edges == 0
        assert volume(scene) == 1.0
        assert len(scene.vertices) == 8  # the apex is not on a face of the cube


def test_curved_cells_count_by_their_corners():
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    points, rows = midpoints(POINTS, TETRAHEDRA, edges)
    with pytest.warns(exactff.ModellingWarning, match="curved cells count as straight ones between their 4 corners"):
        scene = exactff.Scene.from_mesh(points, {"tetra10": rows})
    assert scene.hash == exactff.Scene.from_mesh(POINTS, {"tetra": TETRAHEDRA}).hash
    with pytest.warns(exactff.ModellingWarning, match="curved cells"):
        one = exactff.Scene.from_mesh(points, [("triangle6", [[0, 1, 3, 8, 9, 10]])])
    assert one.areas.tolist() == [0.5]


def test_surface_cells_name_the_outer_faces_that_they_cover():
    quads = [[0, 1, 3, 2], [4, 5, 7, 6]]  # bottom: inward in this order; top: outward
    cells = [("quad", quads), ("line", [[0, 1]]), ("hexahedron", HEXAHEDRON)]
    scene = exactff.Scene.from_mesh(POINTS, cells, ["bottom", "top", "edge", "sides"])
    assert set(scene.names) == {"bottom", "top", "sides"}
    assert volume(scene) == 1.0 and len(scene.faces_of("sides")) == 4
    assert scene.fronts[scene.faces_of("bottom")[0]].tolist() == [0, 0, -1]
    by_block = exactff.Scene.from_mesh(POINTS, cells, [[3, 5], [0], [7]], {0: "edge", 3: "bottom", 5: "top", 7: "sides"})
    assert by_block.hash == scene.hash
    two = np.concatenate([POINTS, POINTS[4:] + [0, 0, 1]])
    stack = [("quad", [[4, 5, 7, 6]]), ("hexahedron", [HEXAHEDRON[0], [4, 5, 7, 6, 8, 9, 11, 10]])]
    with pytest.warns(exactff.ModellingWarning, match="surface cells inside the volume, between two of its cells: 1;"):
        assert len(exactff.Scene.from_mesh(two, stack).areas) == 11


def test_collapsed_and_mixed_cells():
    """Two hexahedra with four corners in two points: the wedges."""
    collapsed = [[0, 1, 3, 3, 4, 5, 7, 7], [0, 3, 2, 2, 4, 7, 6, 6]]
    scene = exactff.Scene.from_mesh(POINTS, [("hexahedron", collapsed)])
    assert volume(scene) == 1.0 and len(scene.areas) == 8 and scene.report().open_edges == 0
    mixed = exactff.Scene.from_mesh(POINTS, [("wedge", WEDGES[:1]), ("hexahedron", collapsed[1:])])
    assert volume(mixed) == 1.0 and mixed.report().open_edges == 0
    flat = [[0, 1, 3, 2, 0, 1, 3, 2]]
    with pytest.warns(exactff.ModellingWarning, match="1 of 1 volume cells have no volume"):
        exactff.Scene.from_mesh(POINTS, [("hexahedron", HEXAHEDRON), ("tetra", [[0, 1, 3, 2]])])
    with pytest.raises(exactff.InputError, match="no faces"), pytest.warns(exactff.ModellingWarning, match="no volume"):
        exactff.Scene.from_mesh(POINTS, [("hexahedron", flat)])


@pytest.mark.parametrize("cells, words", [
    ([("triangle", [[0, 1, 8]])], r"cell 0 has the vertex 8 \(points are numbered from 0 to 7\)"),
    ([("line", [[0, 1]]), ("tetra", [[0, 1, 2, 3], [0, 1, 2, -1]])], "cell 2 has the vertex -1"),
    ([("tetra", TETRAHEDRA + [[7, 3, 1, 0]])], "the cells 0 and 6 have the same corners"),
    ([("tetra", [[0, 1, 3, 7], [0, 1, 3, 6], [0, 1, 3, 5]])], "the volume cells 0, 1 and 2 have a face in common"),
    ([("hexa_prism", [[0, 1, 2, 3, 4, 5]])], r"cells\[0\] \(hexa_prism\): cells of this type are not taken"),
    ([("polyhedron8", [[[0, 1, 2], [0, 2, 3]]])], "cells of this type are not taken"),
    ([("quad", [[0, 1, 2]])], "each row is a cell of 4 corners"),
    ([("tetra", HEXAHEDRON)], "each row is a cell of 4 corners"),
    ([("triangle", [[0.0, 1.0, 2.0]])], "indices are whole numbers"),
    ([("line", [[0, 1]])], "the mesh has no faces"),
    ([], "the mesh has no faces"),
])
def test_meshes_that_mean_nothing_are_refused(cells, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.Scene.from_mesh(POINTS, cells)


def test_points_count_where_cells_use_them():
    points = np.concatenate([POINTS, [[np.nan] * 3]])
    assert len(exactff.Scene.from_mesh(points, [("hexahedron", HEXAHEDRON)]).vertices) == 8
    with pytest.raises(exactff.InputError, match=r"points\[8, 0\] is nan"):
        exactff.Scene.from_mesh(points, [[0, 1, 8]])
    with pytest.raises(exactff.InputError, match="shape"):
        exactff.Scene.from_mesh(POINTS[:, :1], [[0, 1, 3]])
    plane = exactff.Scene.from_mesh(POINTS[:4, :2].astype(np.float32), [[0, 1, 3, 2], [0, 1, 3]], ["a", "b"])
    assert plane.vertices.tolist() == POINTS[:4].tolist() and plane.names == ("a", "b")
    with pytest.raises(exactff.InputError, match="patch"):
        exactff.Scene.from_mesh(POINTS, [("hexahedron", HEXAHEDRON)], ["a", "b"])
    with pytest.raises(exactff.InputError, match="the patch of each face is 'lid'.*names='lid' alone"):
        exactff.Scene.from_mesh(POINTS, [[0, 1, 3], [0, 1, 2], [1, 2, 3]], "lid")
    assert exactff.Scene.from_mesh(POINTS, [[0, 1, 3]], names="lid").names == ("lid",)


def test_arrays_may_have_a_unit():
    triangle = exactff.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert (triangle.unit, triangle.with_unit("mm").unit) == ("", "mm")
    assert (triangle.with_unit("mm").vertices == triangle.vertices).all()
    with pytest.raises(exactff.InputError, match="no unit of length"):
        triangle.with_unit("mile")


def test_objects_of_other_packages_are_taken_by_their_arrays():
    triangles = np.array([[0, 1, 3], [0, 3, 2]])
    trimesh = types.SimpleNamespace(vertices=POINTS, faces=triangles)
    pyvista = types.SimpleNamespace(points=POINTS.astype(np.float32), faces=np.column_stack([[3, 3], triangles]).ravel())
    scenes = [exactff.Scene.from_mesh(mesh, patches=np.array([4, 2])) for mesh in (trimesh, pyvista)]
    assert scenes[0].hash == scenes[1].hash and set(scenes[0].names) == {"patch_2", "patch_4"}
    grid = types.SimpleNamespace(points=POINTS, cells=[8, *HEXAHEDRON[0]], extract_surface=None)
    with pytest.raises(exactff.InputError, match=r"extract_surface\(\)"):
        exactff.Scene.from_mesh(grid)
    with pytest.raises(exactff.InputError, match="a dict has no faces"):
        exactff.Scene.from_mesh({})


# --- meshio ---


def room(meshio):
    """A cube of tetrahedra with a lamp of two triangles above it, which look down."""
    points = np.concatenate([POINTS, POINTS[4:] + [0.25, 0.0, 1.0]])
    cells = [("tetra", np.array(TETRAHEDRA)), ("triangle", np.array([[8, 11, 9], [8, 10, 11]]))]
    tags = {"gmsh:physical": [np.full(6, 7, np.int32), np.full(2, 9, np.int32)],
            "gmsh:geometrical": [np.full(6, 1, np.int32), np.full(2, 2, np.int32)]}
    entities = {"gmsh:dim_tags": np.array([[3, 1]] * 8 + [[2, 2]] * 4, np.int32)}
    return meshio.Mesh(points, cells, entities, tags, {"a box": np.array([7, 3]), "lamp": np.array([9, 2])})


@pytest.mark.parametrize("name, options", [("room.msh", {"file_format": "gmsh22"}), ("room.msh", {"file_format": "gmsh"}),
                                           ("room.inp", {}), ("room.nas", {}), ("room.vtk", {}), ("room.vtu", {})])
def test_files_that_meshio_writes_are_the_same_scene(tmp_path, name, options):
    """Each has its own way to tell groups."""
    meshio = pytest.importorskip("meshio")
    made = room(meshio)
    names = ("a box", "lamp")
    if name == "room.inp":
        made = meshio.Mesh(made.points, made.cells, cell_sets={
            "box": [np.arange(6), np.empty(0, int)], "lamp": [np.empty(0, int), np.arange(2)]})
        names = ("box", "lamp")
    elif name == "room.nas":
        made = meshio.Mesh(made.points, made.cells, cell_data={"nastran:ref": made.cell_data["gmsh:physical"]})
        names = ("ref_7", "ref_9")
    elif name.startswith("room.vt"):
        made = meshio.Mesh(made.points, made.cells, cell_data={"part": made.cell_data["gmsh:physical"]})
        names = ("part_7", "part_9")
    made.write(tmp_path / name, **options)
    if name.startswith("room.vt"):
        with pytest.warns(exactff.ModellingWarning, match="cells of equal 'part'"):
            scene = exactff.Scene.from_meshio(tmp_path / name)
    else:
        scene = exactff.Scene.from_meshio(tmp_path / name)
    assert set(scene.names) == set(names) and len(scene.faces_of(names[0])) == 12
    box = exactff.Scene.from_mesh(scene.vertices, [scene.rings(face)[0] for face in scene.faces_of(names[0])])
    assert volume(box) == 1.0 and box.report().open_edges == 0
    scene.write(tmp_path / "room.obj")
    obj = exactff.Scene.read(tmp_path / "room.obj")
    at = obj.receivers(names[0], centres=True, per_face=True)
    values = [one.form_factors(at.points, at.normals, names[1]) for one in (scene, obj)]
    assert same_bits(*values) and values[0].max() > 0.1


def test_the_smallest_set_of_a_cell_names_it():
    quads = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4]]
    mesh = types.SimpleNamespace(points=POINTS, cells=[types.SimpleNamespace(type="quad", data=quads)], cell_data={}, field_data={},
                                 cell_sets={"fin": [[1]], "all": [np.arange(2)], "none": [None], "gmsh:bounding_entities": [[5]]})
    with pytest.warns(exactff.ModellingWarning, match="cells in several sets: 1; the smallest"):
        scene = exactff.Scene.from_mesh(mesh)
    assert scene.names == ("all", "fin", "default")
    mesh.cell_sets["all"] = [[3]]
    with pytest.raises(exactff.InputError, match="the set 'all' has cells that the mesh does not have"):
        exactff.Scene.from_meshio(mesh)
    mesh.cell_data = {"cell_tags": [np.array([-1, -2, 0])]}
    mesh.cell_sets, mesh.cell_tags = {}, {-1: ["fin"], -2: ["fin", "tip"]}
    with pytest.warns(exactff.ModellingWarning, match="cells in several sets: 1"):
        assert exactff.Scene.from_meshio(mesh).names == ("fin", "tip", "default")
    assert exactff.Scene.from_meshio(mesh, "cell_tags", {-1: "one"}).names == ("one", "cell_tags_-2", "default")
    with pytest.raises(exactff.InputError, match="the mesh has no 'part'.*choose from"):
        exactff.Scene.from_meshio(mesh, "part")
    with pytest.raises(exactff.InputError, match="a list is no mesh of meshio"):
        exactff.Scene.from_meshio([mesh])  # type: ignore[arg-type]


def test_a_package_that_meshio_lacks_is_named(tmp_path, monkeypatch):
    pytest.importorskip("meshio")
    monkeypatch.setitem(sys.modules, "h5py", None)
    (tmp_path / "room.med").write_text("x")
    with pytest.raises(exactff.InputError, match="room.med: meshio lacks a package.*h5py.*install it"):
        exactff.Scene.from_meshio(tmp_path / "room.med")


# --- python3 -m exactff ---


def convert(*arguments, code=0):
    done = subprocess.run([sys.executable, "-B", "-m", "exactff", "convert", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stdout + done.stderr


def test_convert_takes_what_the_program_and_meshio_read(tmp_path):
    meshio = pytest.importorskip("meshio")
    room(meshio).write(tmp_path / "room.msh", file_format="gmsh22")
    assert convert(tmp_path / "room.msh", tmp_path / "room.obj") == f"wrote {tmp_path / 'room.obj'}\n"
    assert set(exactff.Scene.read(tmp_path / "room.obj").names) == {"a box", "lamp"}
    assert "or replace it with --force" in convert(tmp_path / "room.msh", tmp_path / "room.obj", code=2)
    assert "warning: " in convert(CORNELL, tmp_path / "room.obj.stl")
    before = (tmp_path / "room.obj").read_bytes()
    assert "is read and would be replaced" in convert(tmp_path / "room.obj", tmp_path / "room.obj", "--force", code=2)
    assert (tmp_path / "room.obj").read_bytes() == before
    for name, text, words in (("cut.msh", "$MeshFormat\n4.1 0 8\n", "meshio cannot read it"), ("bad.vtk", "no\n", "meshio cannot read it"),
                              ("no.inp", None, "no such file"), ("what.xyz", "1 2 3\n", "what.xyz")):
        if text is not None:
            (tmp_path / name).write_text(text)
        said = convert(tmp_path / name, tmp_path / "new.obj", code=2)
        assert said.startswith("error: ") and words in said and said.count("\n") == 1
    assert not (tmp_path / "new.obj").exists()
