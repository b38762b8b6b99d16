"""Scenes: from files, arrays and models; what they contain; errors."""

import json
import types

import numpy as np
import pytest

import exactff
from support import BLINDS, CORNELL, SCENES, program, same_bits, square

VERTICES = np.array(square(0.0) + square(1.0))


def build(faces, **more):
    return exactff.Scene(VERTICES, faces, **more)


def test_read_takes_every_format_and_paths():
    names = ("facet_meshio.ply", "facet_admesh.stl", "facet.vs3")
    facet = [exactff.Scene.read(SCENES / "formats" / name) for name in names]
    assert [len(scene.vertices) for scene in facet] == [len(facet[0].vertices)] * 3
    assert exactff.Scene.read(CORNELL).names[0] == "floor"
    assert "tall_block:1" in exactff.Scene.read(CORNELL, patches="faces").names


def test_a_scene_from_arrays_is_that_of_the_file():
    read = exactff.Scene.read(CORNELL)
    faces = [read.rings(face)[0] for face in range(len(read.areas))]
    materials = {patch.name: patch.materials[0] for patch in read.patches}
    made = exactff.Scene(read.vertices, faces, read.patch_of_face, read.names, materials)
    assert made.names == read.names and made.emitters == read.emitters == ("light",)
    assert same_bits(made.areas, read.areas) and same_bits(made.fronts, read.fronts)
    at = read.receivers("floor", grid=4)
    assert same_bits(*(scene.form_factors(at.points, at.normals, "all", at.on) for scene in (made, read)))


def test_a_divided_scene_has_cells_as_patches():
    room = exactff.Scene.read(CORNELL)
    cells = room.divided(140)
    floor = cells.cells_of("floor")
    assert len(floor) == 16 and floor[2] == "floor:3" and set(floor) <= set(cells.names)
    assert cells.cells_of("light") == ("light",) and cells.cells_of("floor:3") == ("floor:3",)
    assert np.isclose(cells.areas.sum(), room.areas.sum(), rtol=1e-12)
    assert 0 < cells.largest_deviation < 1e-12 and room.largest_deviation == 0
    with pytest.raises(exactff.InputError):
        room.divided(-1)


def test_faces_in_every_form():
    quads = np.array([[0, 1, 2, 3], [4, 5, 6, 7]])
    same = build(quads).hash
    padded = np.array([4, 0, 1, 2, 3, 4, 4, 5, 6, 7])
    for faces in (quads.tolist(), quads.astype(np.uint8), [tuple(row) for row in quads], padded, padded[::1]):
        assert build(faces).hash == same
    mixed = build([[0, 1, 2], [4, 5, 6, 7]])
    assert same_bits(mixed.areas, [0.5, 1.0]) and mixed.rings(1) == [[4, 5, 6, 7]]
    assert build(quads[:, :3]).areas.tolist() == [0.5, 0.5]


def test_patches_and_names():
    quads = [[0, 1, 2, 3], [4, 5, 6, 7]]
    assert build(quads).names == ("default",) and build(quads, names="all").names == ("all",)
    assert build(quads, patch=[7, 3]).names == ("patch_3", "patch_7")
    assert build(quads, patch=[1, 0], names=["a", "b"]).patch_of_face.tolist() == [1, 0]
    assert build(quads, patch=[5, 9], names={5: "x", 9: "y"}).names == ("x", "y")
    assert build(quads, patch=["top", "bottom"]).names == ("top", "bottom")
    lamp = build(quads, patch=["a", "b"], materials={"a": {"radiosity": (1, 2, 3)}, "b": exactff.Material(0.5)})
    assert lamp.emitters == ("a",) and lamp.patches[1].materials[0].reflectance == (0.5, 0.5, 0.5)


@pytest.mark.parametrize("arguments, words", [
    (dict(faces=[[0, 1, 8]]), r"faces\[0\] has the vertex 8 \(vertices are numbered from 0 to 7\)"),
    (dict(faces=[[0, 1, 2], [0, -1, 2]]), r"faces\[1\] has the vertex -1"),
    (dict(faces=[[0, 1]]), r"faces\[0\] has 2 vertices"),
    (dict(faces=np.zeros((1, 3))), "indices are whole numbers"),
    (dict(faces=np.array([4, 0, 1, 2])), "as the number of vertices of face 0"),
    (dict(faces=[[0, 1, 2]], patch=[0, 1]), "there are 1 faces"),
    (dict(faces=[[0, 1, 2]], patch=[2], names=["a"]), "patch 2 has no name"),
    (dict(faces=[[0, 1, 2]], names=["a", "b"]), "no patch of each face"),
    (dict(faces=[[0, 1, 2]], materials={"lamp": {}}), "there is no patch 'lamp'"),
    (dict(faces=[[0, 1, 2]], materials={"default": {"Ke": 1}}), "reflectance, radiosity and name"),
    (dict(faces=[[0, 1, 2]], materials={"default": {"reflectance": 2}}), "from 0 to 1"),
    (dict(faces=[[0, 1, 2]], materials={"default": {"radiosity": np.nan}}), "is nan"),
    (dict(faces=[[0, 2, 1, 3]]), "default"),  # a bow tie
])
def test_bad_arrays_are_refused_with_words(arguments, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.Scene(VERTICES, **arguments)


def test_skipped_faces_warn():
    bow = np.array([[0, 0, 0], [1, 1, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    with pytest.warns(exactff.ModellingWarning):
        scene = exactff.Scene(bow, [[0, 1, 2, 3], [0, 2, 4]], skip_bad_faces=True)
    assert scene.report().left_out == ("default:1",)


def test_files_with_errors(tmp_path):
    bad = tmp_path / "bad.obj"
    bad.write_text("v 0 0 x\nf 1 2 3\n")
    with pytest.raises(exactff.InputError) as caught:
        exactff.Scene.read(bad)
    assert [problem.line for problem in caught.value.problems] == [1, 2, 2] and "bad.obj:1:" in str(caught.value)
    with pytest.raises(exactff.InputError, match="nowhere.obj"):
        exactff.Scene.read("nowhere.obj")
    with pytest.raises(exactff.InputError, match="teapot"):
        exactff.Scene.from_model("teapto")
    with pytest.raises(exactff.InputError, match="choose"):
        exactff.Scene.read(CORNELL, patches="face")


def test_what_solids_bury_is_reported_seen_and_summed():
    box = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    sides = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]]
    upper = box * [0.5, 0.5, 1] + [0.25, 0.25, 1]
    scene = exactff.Scene(np.concatenate([box, upper]), sides + [[v + 8 for v in side] for side in sides],
                          patch=[0] * 6 + [1] * 6, names=["lower", "upper"])
    contacts = {(one.patch, one.under): one.share for one in scene.report().contacts}
    assert contacts == pytest.approx({("lower", "upper"): 0.25 / 6, ("upper", "lower"): 0.25 / 2.5})
    seen = exactff.view(scene, [0.5, 0.5, 1], [0, 0, -1], on="upper:1")
    assert seen.buried_under == "lower:2" and not len(seen) and seen.open.value == 0
    matrix = exactff.view_factor_matrix(scene, backs=True, sky=True, accuracy=1e-3)
    assert [f.value for f in matrix.buried] == pytest.approx([0.25 / 6, 0.1])
    assert (matrix.row_sums[:, 0] <= 1).all() and (matrix.row_sums[:, 1] >= 1).all()


def test_the_report_says_what_info_says():
    for path in (CORNELL, BLINDS):
        scene, info = exactff.Scene.read(path), json.loads(program("info", path, "--json"))
        report = scene.report()
        assert [p.name for p in report.patches] == [p["name"] for p in info["patches"]]
        assert [p.area for p in report.patches] == [p["area"] for p in info["patches"]]
        assert [p.front and list(p.front) for p in report.patches] == [p["front"] for p in info["patches"]]
        assert [p.emits for p in report.patches] == [p["emits"] for p in info["patches"]]
        assert (report.open_edges, list(report.emitters)) == (info["open_edges"], info["emitters"])
        assert [f.message for f in report.findings] == [f["message"] for f in info["findings"]]
        assert scene.hash == info["hash"] and all(p.name in str(report) for p in report.patches)


def test_a_lamp_that_looks_away_is_found_and_turned():
    vertices = square(1.0) + square(0.0, 3.0)
    materials = {"lamp": {"radiosity": 1}}
    wrong = exactff.Scene(vertices, [[0, 1, 2, 3], [4, 5, 6, 7]], ["lamp", "floor"], materials=materials)
    findings = wrong.report().findings
    assert any(f.flag == "--flip lamp" and "lamp" in f.objects for f in findings), findings
    right = wrong.with_flipped("lamp")
    assert right.flipped == ("lamp",) and not right.report().findings and right.fronts[0].tolist() == [0, 0, -1]
    at = ([0, 0, 0], [0, 0, 1])
    assert wrong.form_factors(*at, on="floor") == 0 < right.form_factors(*at, on="floor")
    assert wrong.with_flipped() is wrong and wrong.with_flipped("all").flipped == ("lamp", "floor")


def test_names_and_indices():
    scene = exactff.Scene.read(CORNELL)
    assert scene.face_name(scene.faces_of("tall_block")[0]) == "tall_block:1"
    assert "Scene 'cornell_box.obj': 8 patches" in repr(scene)
    for index in (-1, 10**9):
        with pytest.raises(IndexError, match="there is no face"):
            scene.face_name(index)
    with pytest.raises(exactff.InputError, match="ceiling"):
        scene.faces_of("celing")


def test_receivers_of_every_kind(tmp_path):
    scene = exactff.Scene.read(CORNELL)
    assert len(scene.receivers("floor", grid=3)) == 9 and scene.receivers("floor", grid=(2, 1)).ids == ["r1c1", "r1c2"]
    assert len(scene.receivers(["floor", "back"], centres=True)) == 2
    assert len(scene.receivers("tall_block", vertices=True)) == 20
    drawn = scene.receivers("floor", samples=5, seed=3)
    assert same_bits(drawn.points[:3], scene.receivers("floor", samples=3, seed=3).points)
    with pytest.raises(exactff.InputError, match="give one of grid"):
        scene.receivers("floor")
    file = tmp_path / "r.csv"
    file.write_text("id,x,y,z,nx,ny,nz,on\na,200,0,400,0,1,0,floor\n")
    read = scene.read_receivers(file)
    assert read.ids == ["a"] and read.on.tolist() == [[scene.faces_of("floor")[0]]] and "r.csv" in repr(read)


def test_receivers_on_every_patch_are_those_of_the_program(tmp_path):
    """All have different ids, and the truth file has the program's bytes."""
    scene = exactff.Scene.read(CORNELL)
    for number, (more, flags) in enumerate([(dict(grid=(2, 3)), ["--grid", "2x3"]),
                                            (dict(centres=True, per_face=True), ["--centres", "--per-face"]),
                                            (dict(samples=7, seed=2), ["--samples", 7, "--sample-seed", 2])]):
        at = scene.receivers("all", **more)
        assert len(set(at.ids)) == len(at) and "all, " in repr(at)
        ours, theirs = tmp_path / f"{number}.csv", tmp_path / f"{number}.program.csv"
        exactff.truth(scene, at, ours, "light")
        program("truth", CORNELL, "--on", "all", *flags, "--source", "light", "-o", theirs)
        assert ours.read_bytes() == theirs.read_bytes()
    named = build([[0, 1, 2, 3], [4, 5, 6, 7]], patch=["all", "other"])
    assert len(named.receivers("all", grid=1)) == 1 and len(named.receivers(["all", "other"], grid=1)) == 2


def test_patterns_and_lists_of_names():
    room = exactff.Scene.read(CORNELL)
    blocks = ("short_block", "tall_block")
    turned = room.with_flipped("*_block")
    assert turned.flipped == blocks and turned.hash == room.with_flipped(*blocks).hash == room.with_flipped(blocks).hash
    assert room.with_transparent(["floor"], "[st]*_block").transparent == ("floor",) + blocks
    assert room.with_two_sided(["*_block", "light"]).names[-3:] == tuple(f"{name} (back)" for name in (*blocks, "light"))
    assert room.faces_of("*_block") == room.faces_of("short_block") + room.faces_of("tall_block")
    assert len(room.receivers("*_block", centres=True)) == 10
    at = room.receivers("floor", grid=3)
    patterns, names = (room.form_factors(at.points, at.normals, which, at.on) for which in ("*_block", blocks))
    assert same_bits(patterns, names) and patterns.shape == (9, 2)
    odd = build([[0, 1, 2], [4, 5, 6]], patch=["a*", "ab"])
    assert odd.with_flipped("a*").flipped == ("a*",)
    with pytest.raises(exactff.InputError, match="tall_block"):
        room.with_flipped("tall_blok*")
    with pytest.raises(exactff.InputError, match="named twice"):
        room.form_factors(at.points, at.normals, ["tall_block", "tall_block"])
    assert room.form_factors(at.points, at.normals, ["tall_block", "*_block"]).shape == (9, 2)


def test_triangles_stand_for_bent_faces():
    with pytest.warns(exactff.ModellingWarning, match="--triangulate"):
        bent = exactff.Scene(VERTICES + np.outer(np.arange(8) == 2, [0, 0, 0.25]), [[0, 1, 2, 3], [7, 6, 5, 4]],
                             patch=["sail", "lamp"])
    cut = bent.triangulated()
    assert bent.report().not_planar and not cut.report().not_planar and len(cut.areas) == 4 and cut.names == bent.names
    points = np.random.default_rng(57).uniform(-1, 1, (50, 3)) + [0, 0, 0.5]
    for on in ("sail", "lamp"):
        assert same_bits(*(scene.form_factors(points, [0.1, 0.2, 1], on) for scene in (bent, cut)))
    sails = [scene.with_two_sided("sail") for scene in (bent, cut)]
    assert same_bits(*(scene.form_factors(points, [0.1, 0.2, 1], ["sail (back)", "lamp"]) for scene in sails))


@pytest.mark.parametrize("name", ["s.obj", "s.ply", "s.stl", "s.off", "s.vs3"])
def test_a_written_scene_is_that_of_convert(tmp_path, name):
    room = exactff.Scene.read(CORNELL)
    if name == "s.obj":
        room.write(tmp_path / name)
        assert exactff.Scene.read(tmp_path / name).hash == room.hash and (tmp_path / "s.mtl").exists()
    else:
        with pytest.warns(exactff.ModellingWarning, match="lost|cut"):
            room.write(tmp_path / name)
    other = tmp_path / "other"
    other.mkdir()
    program("convert", CORNELL, other / name)
    assert (other / name).read_bytes() == (tmp_path / name).read_bytes()


def test_written_scenes_replace_nothing_that_is_read(tmp_path):
    exactff.Scene.read(CORNELL).write(tmp_path / "room.obj")
    (tmp_path / "library.mtl").write_bytes((tmp_path / "room.mtl").read_bytes())
    text = (tmp_path / "room.obj").read_text().replace("mtllib room.mtl", "mtllib library.mtl")
    (tmp_path / "room.obj").write_text(text)
    room = exactff.Scene.read(tmp_path / "room.obj")
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    (tmp_path / "link.obj").symlink_to("room.obj")
    for made in (room, room.with_flipped("light"), room.divided(300), room.triangulated()):
        for name in ("room.obj", "link.obj", "library.obj"):
            with pytest.raises(exactff.InputError, match="is read and would be replaced"):
                made.write(tmp_path / name, existing="replace")
    for name, words in (("room.ply", "already exists"), ("s.txt", "extension"), ("no/s.obj", "no/s")):
        (tmp_path / "room.ply").write_text("mine")
        with pytest.raises(exactff.InputError, match=words):
            room.write(tmp_path / name)
    assert (tmp_path / "room.ply").read_text() == "mine"
    assert {name: (tmp_path / name).read_bytes() for name in before} == before
    with pytest.warns(exactff.ModellingWarning, match="lost"):
        room.write(tmp_path / "room.ply", existing="replace", encoding="text")
    assert (tmp_path / "room.ply").read_text().startswith("ply\nformat ascii")
    for wrong in (dict(existing="resume"), dict(encoding="utf-8")):
        with pytest.raises(exactff.InputError, match="choose"):
            room.write(tmp_path / "new.obj", **wrong)


def test_a_mesh_of_meshio_keeps_the_names_of_its_groups(tmp_path):
    meshio = pytest.importorskip("meshio")
    (tmp_path / "room.msh").write_text(
        '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 "a wall"\n2 9 "floor"\n$EndPhysicalNames\n'
        "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
        "$Elements\n3\n1 2 2 9 1 1 2 3\n2 2 2 7 2 1 3 4\n3 2 2 7 2 1 4 2\n$EndElements\n")
    with pytest.raises(exactff.InputError, match="is a Gmsh file"):
        exactff.Scene.read(tmp_path / "room.msh")
    exactff.Scene.from_meshio(tmp_path / "room.msh").write(tmp_path / "room.obj")
    scene = exactff.Scene.read(tmp_path / "room.obj")
    assert {patch.name: len(patch.faces) for patch in scene.patches} == {"floor": 1, "a wall": 2}


def test_polygons_with_names_become_patches(tmp_path):
    surfaces = [types.SimpleNamespace(Name=name, coords=[(0, 0, z), (1, 0, z), (1, 1, z), (0, 1, z)][:corners])
                for name, z, corners in (("floor", 0, 4), ("Roof 1", 1, 3))]
    page = (SCENES.parent / "guide" / "scenes.md").read_text()
    code = page[page.index("from geomeppy") :].split("```")[0]
    code = code[code.index("corners ="):].replace("house.", f"{tmp_path}/house.")
    exec(code, {"exactff": exactff, "surfaces": surfaces})
    scene = exactff.Scene.read(tmp_path / "house.obj")
    assert scene.names == ("floor", "Roof 1") and scene.areas.tolist() == [1.0, 0.5]


def test_patches_come_from_geometry_and_selectors():
    room = exactff.Scene.read(CORNELL, patches="parts")
    assert "tall_block/1" in room.names and len(room.cells_of("tall_block")) == 1
    planes = exactff.Scene.read(CORNELL).with_patches("planes")
    assert len(planes.cells_of("tall_block")) == 5
    named = planes.with_names({"low": "box:0,0,0,600,1,600", "top": "normal:0,1,0:10 & tall_block"})
    assert [len(named.faces_of(name)) for name in ("low", "top")] == [1, 1]
    row = next(patch for patch in named.patches if patch.name == "low")
    assert row.low[1] == row.high[1] == row.centre[1] == 0.0
    with pytest.raises(exactff.InputError, match="not a way to make patches"):
        planes.with_patches("groupes")
    with pytest.raises(exactff.InputError, match="finds no face"):
        planes.with_names({"x": "box:0,0,0,1,1,1"})


def test_a_room_that_almost_closes_is_welded():
    generator = np.random.default_rng(7)
    corners = np.array([[x, y, z] for x in (0, 4) for y in (0, 5) for z in (0, 3)], float)
    quads = np.array([[0, 2, 6, 4], [1, 5, 7, 3], [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6]])
    vertices = corners[quads.ravel()] + generator.uniform(-1e-6, 1e-6, (24, 3))
    almost = exactff.Scene(vertices, np.arange(24).reshape(6, 4), patch=np.arange(6))
    gap = almost.report().gap
    assert gap.open_edges == 0 and gap.open_edges_before == 24 and 5e-7 < gap.length < 4e-6
    assert "almost" not in str(almost.report()) and "gap: " in str(almost.report())
    welding = almost.welded(4e-6)
    assert welding.corners_before == 24 and welding.corners == 8 and welding.largest_move < 4e-6
    assert welding.vanished == welding.sheets == () and welding.scene.report().open_edges == 0
    assert welding.scene.welded(4e-6).largest_move == 0.0
    assert welding.scene.gap() is None
    with pytest.raises(exactff.InputError):
        almost.welded(0.0)


def test_lightmaps_have_receivers_at_texels(tmp_path):
    (tmp_path / "s.obj").write_text("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 1 .5\n"
                                    "vt 0 .5\ng floor\nf 1/1 2/2 3/3 4/4\ng lamp\nf 5 7 6\n")
    scene = exactff.Scene.read(tmp_path / "s.obj")
    assert scene.texture(0).tolist() == [[0, 0], [1, 0], [1, 0.5], [0, 0.5]] and scene.texture(1).shape == (0, 2)
    lightmap = scene.lightmap(4, 4)
    assert (lightmap.faces, lightmap.without, lightmap.overlapping) == (1, 1, 0)
    assert lightmap.rows.tolist() == [2] * 4 + [3] * 4 and lightmap.columns.tolist() == [0, 1, 2, 3] * 2
    r = lightmap.receivers
    assert r.points[0].tolist() == [0.25, 1.5, 0] and r.ids[0] == "x0y2" and (r.on == 0).all()
    image = np.zeros((4, 4))
    image[lightmap.rows, lightmap.columns] = scene.form_factors(r.points, r.normals, "lamp", r.on)[:, 0]
    assert image[3, 0] == scene.form_factor([0.25, 0.5, 0], [0, 0, 1], "lamp", on="floor").value > 0
    for arguments in [dict(on="lamp"), dict(on=[]), dict(on="none"), dict(uv=1), dict(uv=2), dict(width=0)]:
        with pytest.raises(exactff.InputError):
            scene.lightmap(**{"width": 4, "height": 4, **arguments})
