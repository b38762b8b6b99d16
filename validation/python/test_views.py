"""View factors from patch to patch, and the whole view."""

import csv
import math
import pickle

import numpy as np
import pytest

import exactff
from support import CORNELL, POINT, SCENES, UP, lamp_above, program, same_bits

L_ROOM = str(SCENES / "formats" / "test4.vs3")
ROOM = exactff.Scene.read(CORNELL)


def test_a_view_factor_is_the_programs():
    scene = exactff.Scene.read(L_ROOM)
    f = exactff.view_factor(scene, "srf-1", "srf-6", 1e-8)
    line = program("matrix", L_ROOM, "--from", "srf-1", "--to", "srf-6", "--accuracy", "1e-8", "--plain").split("\t")
    assert (f.lower, f.upper, f.claim) == (float(line[2]), float(line[3]), line[4].strip())
    assert f.lower <= 0.1823559036685958 <= f.upper and f.lower <= float(f) <= f.upper
    assert f.accurate and f.area_from == 9.0 and f.upper - f.lower <= 1.01e-8
    proved = exactff.view_factor(scene, "srf-1", "srf-6", 1e-8, certify=True)
    assert proved.claim == "certified" and proved.lower <= 0.1823559036685958 <= proved.upper and proved.accurate
    zero = exactff.view_factor(scene, "srf-1", "srf-1")
    assert zero.claim == "zero" and zero.upper == 0.0


def test_a_matrix_is_the_programs(tmp_path):
    scene = exactff.Scene.read(L_ROOM)
    told = []
    matrix = exactff.view_factor_matrix(scene, accuracy=1e-4, progress=lambda done, total: told.append((done, total)))
    program("matrix", L_ROOM, "--accuracy", "1e-4", "-o", tmp_path / "m.csv")
    with open(tmp_path / "m.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    between = [row for row in rows if not row["to"].startswith("(")]
    for array, column in (matrix.value, "factor"), (matrix.lower, "lower"), (matrix.upper, "upper"):
        assert array.shape == (8, 8) and same_bits(array.ravel(), [float(row[column]) for row in between])
    assert list(matrix.claim.ravel()) == [row["claim"] for row in between] and matrix.accurate.all()
    assert set(matrix.limit.ravel()) == {"none"}
    assert matrix.from_names == matrix.to_names == scene.names
    assert told[-1][0] == told[-1][1] and matrix.row_sums.shape == (8, 2)
    assert (matrix.row_sums[:, 0] <= 1).all() and (matrix.row_sums[:, 1] >= 1).all()
    assert matrix["srf-1", "srf-6"].value == matrix.value[0, 5]
    with pytest.raises(KeyError):
        matrix["srf-1", "srf-9"]
    power = matrix.areas_from[:, None] * matrix.value
    np.testing.assert_allclose(power, power.T, atol=1e-3)  # A_i F_ij = A_j F_ji
    np.testing.assert_array_equal(matrix.areas_from, matrix.areas_to)


def test_directions_computed_apart_test_each_other():
    scene = exactff.Scene.read(L_ROOM)
    names = ["srf-1", "srf-6", "srf-2"]
    matrix = exactff.view_factor_matrix(scene, names, names, accuracy=1e-4, both_directions=True)
    assert matrix.reciprocity is not None and matrix.reciprocity.apart == ()
    assert 1 <= matrix.reciprocity.pairs <= 3
    worst = matrix.reciprocity.worst
    assert {worst.from_name, worst.to_name} <= set(names) and 0 < worst.distance <= worst.radius
    assert exactff.view_factor_matrix(scene, names, names, accuracy=1e-4).reciprocity is None


def test_backs_become_patches(tmp_path):
    scene = exactff.Scene.read(L_ROOM)
    both = scene.with_two_sided("srf-1")
    assert both.names == scene.names + ("srf-1 (back)",) and scene.with_two_sided() is scene
    f = exactff.view_factor_matrix(both, "srf-6", accuracy=1e-4)
    written = tmp_path / "f.csv"
    program("matrix", L_ROOM, "--from", "srf-6", "--two-sided", "srf-1", "--accuracy", "1e-4", "-o", str(written))
    with open(written, encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert [row["to"] for row in rows] == list(f.to_names)
    assert [float(row["upper"]) for row in rows] == list(f.upper[0])
    with pytest.raises(exactff.InputError, match="srf-99"):
        scene.with_two_sided("srf-99")


def test_a_matrix_is_saved_as_the_program_writes_it(tmp_path):
    scene = exactff.Scene.read(L_ROOM)
    matrix = exactff.view_factor_matrix(scene, "srf-[1-8]", "srf-?", accuracy=1e-3, backs=True, sky=True)
    flags = {".csv": "-o", ".npz": "--npz", ".idf": "--energyplus", ".out": "--view3d"}
    common = ["--accuracy", "1e-3", "--backs", "--to", "all,sky"]
    program("matrix", L_ROOM, *common, *(word for end, flag in flags.items() for word in (flag, tmp_path / f"p{end}")))
    for end in flags:
        matrix.save(tmp_path / f"m{end}")
        assert (tmp_path / f"m{end}").read_bytes() == (tmp_path / f"p{end}").read_bytes(), end
    row = exactff.view_factor_matrix(scene, "srf-1", accuracy=1e-3)
    row.save(tmp_path / "m.vtp")
    program("matrix", L_ROOM, "--from", "srf-1", "--accuracy", "1e-3", "--vtk", tmp_path / "p.vtp")
    assert (tmp_path / "m.vtp").read_bytes() == (tmp_path / "p.vtp").read_bytes()
    matrix.save(tmp_path / "zone.idf", zone="Attic")
    assert "Attic" in (tmp_path / "zone.idf").read_text()
    for name, words in (("m.vtp", "already exists"), ("x.xlsx", "extension"), ("x.vtp", "8 rows"), ("no/m.csv", "no/m")):
        with pytest.raises(exactff.InputError, match=words):
            matrix.save(tmp_path / name)
    with pytest.raises(exactff.InputError, match="same patches"):
        row.save(tmp_path / "x.idf")
    again = pickle.loads(pickle.dumps(matrix))
    assert same_bits(again.value, matrix.value) and again["srf-1", "srf-2"] == matrix["srf-1", "srf-2"]
    with pytest.raises(exactff.InputError, match="copied"):
        again.save(tmp_path / "x.csv")


def test_the_sky_alone():
    lamp = lamp_above((0.5, 0.5))
    whole = exactff.view_factor_matrix(lamp, accuracy=1e-3, backs=True, sky=True)
    for more in (dict(sky=True), dict(backs=True), dict(backs=True, sky=True)):
        alone = exactff.view_factor_matrix(lamp, "all", [], accuracy=1e-3, **more)
        assert alone.value.shape == (2, 0) and alone.from_names == ("lamp", "plates") and alone.to_names == ()
        assert same_bits(alone.areas_from, whole.areas_from) and alone.areas_to.shape == (0,)
        assert (alone.open, alone.back) == (whole.open if "sky" in more else None, whole.back if "backs" in more else None)


def test_a_budget_that_is_used_up_warns():
    with pytest.warns(exactff.ModellingWarning, match="wider than the accuracy 1e-09"):
        f = exactff.view_factor(ROOM, "floor", "tall_block", 1e-9, budget=2)
    assert not f.accurate and f.upper - f.lower > 1e-9 and f.limit == "budget"


@pytest.mark.parametrize("call", [
    lambda: exactff.view_factor(ROOM, "floor", "nobody"),
    lambda: exactff.view_factor(ROOM, "floor", 3),
    lambda: exactff.view_factor(ROOM, "floor", "light", 0.0),
    lambda: exactff.view_factor(ROOM, "floor", "light", float("nan")),
    lambda: exactff.view_factor(ROOM, "floor", "light", budget=0),
    lambda: exactff.view_factor(ROOM, "floor", "light", budget=1.5),
    lambda: exactff.view_factor_matrix(ROOM, ["floor", None]),
    lambda: exactff.view(ROOM, POINT, [0, 0, 0]),
    lambda: exactff.view(ROOM, [POINT, POINT], UP),
    lambda: exactff.view(ROOM, POINT, UP, on="nobody"),
    lambda: exactff.view(ROOM, POINT, UP, patches="pieces"),
])
def test_bad_arguments_are_refused(call):
    with pytest.raises(exactff.InputError):
        call()


def test_a_view_has_the_bits_of_its_pairs():
    seen = exactff.view(ROOM, POINT, UP, on="floor")
    for name in ROOM.names:
        pair = ROOM.form_factor(POINT, UP, name, on="floor")
        assert (name in seen) == (pair.value > 0.0)
        if name in seen:
            f = seen[name].form_factor
            assert (f.value, f.lower, f.upper, f.status) == (pair.value, pair.lower, pair.upper, pair.status)
    lines = dict(line.split("\t") for line in program("view", CORNELL, "--at", *POINT, "--normal", *UP, "--on", "floor",
                                                      "--plain").splitlines())
    assert list(seen) == [name for name in lines if not name.startswith("(")]
    assert (seen.back.value, seen.open.value) == (float(lines["(back)"]), float(lines["(open)"]))
    total = sum(float(patch.share) for patch in seen.values()) + float(seen.back) + float(seen.open)
    assert abs(total - 1.0) < 1e-14 and repr(seen).startswith("<exactff.View of ")


def test_of_coincident_faces_a_front_is_seen():
    twins = exactff.Scene.read(str(SCENES.parent / "regression" / "sheets_in_one_plane.obj"))
    seen = exactff.view(twins, [0.5, 0.5, 0.5], [0, 0, 1], on="o0")
    assert [name for name in seen if seen[name].stacked] == ["o2"]
    assert 0.0 < float(seen["o2"].share) < float(seen["o2"].form_factor)
    assert abs(sum(float(patch.share) for patch in seen.values()) + float(seen.back) + float(seen.open) - 1.0) < 1e-15


def test_a_view_by_faces():
    seen = exactff.view(ROOM, POINT, UP, on="auto", patches="faces")
    assert all(":" in name or name in ROOM.names for name in seen) and len(seen) > len(exactff.view(ROOM, POINT, UP))


def test_sums_are_those_of_the_command(tmp_path):
    scene = exactff.Scene.read(L_ROOM)
    matrix = exactff.view_factor_matrix(scene, accuracy=1e-3, sums=["srf-[12]"])
    for i, f in enumerate(matrix.sums["srf-[12]"]):
        assert f.value == pytest.approx(matrix[matrix.from_names[i], "srf-1"].value
                                        + matrix[matrix.from_names[i], "srf-2"].value, abs=1e-12)
        assert f.lower <= f.value <= f.upper
    matrix.save(tmp_path / "m.csv")
    program("matrix", L_ROOM, "--accuracy", "1e-3", "--sum", "srf-[12]", "-o", tmp_path / "program.csv")
    assert (tmp_path / "m.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    with pytest.raises(exactff.InputError, match="sums"):
        matrix.balanced()
    with pytest.raises(exactff.InputError, match="is no column"):
        exactff.view_factor_matrix(scene, to_patches=["srf-1"], sums=["srf-2"])


def test_a_balanced_matrix_closes_to_the_bit(tmp_path):
    scene = exactff.Scene.read(L_ROOM)
    matrix = exactff.view_factor_matrix(scene, accuracy=1e-3, backs=True, sky=True)
    found = matrix.balanced()
    power = found.areas_from[:, None] * found.value
    assert same_bits(power, power.T) and not same_bits(found.value, matrix.value)
    assert (found.lower <= found.value).all() and (found.value <= found.upper).all()
    for row, back, free in zip(found.value.tolist(), found.back, found.open):
        assert abs(math.fsum([*row, back.value, free.value]) - 1.0) <= 2.0**-51
    assert found["srf-1", "srf-6"].value == found.value[0, 5]
    found.save(tmp_path / "m.csv")
    program("matrix", L_ROOM, "--accuracy", "1e-3", "--balance", "-o", tmp_path / "program.csv")
    assert (tmp_path / "m.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    found.save(tmp_path / "m.npz")
    with np.load(tmp_path / "m.npz") as file:
        assert same_bits(file["data"], found.value[found.claim != "zero"])
        assert same_bits(file["factor"], matrix.value[matrix.claim != "zero"])
        assert same_bits(file["open"], np.array([f.value for f in found.open]))
    with pytest.raises(exactff.InputError, match="what meets backs is not computed"):
        exactff.view_factor_matrix(scene, accuracy=1e-1).balanced()


def test_exchange_factors_are_those_of_a_dense_solver(tmp_path):
    matrix = exactff.view_factor_matrix(ROOM, accuracy=1e-2, backs=True, sky=True).balanced()
    found = matrix.exchange(save=tmp_path / "b.csv")
    rho = 1.0 - found.emissivities
    assert found.names == matrix.from_names and found.value.shape == (3, len(rho[0]), len(rho[0]))
    for c in range(3):
        for factors, bound in (matrix.value, found.value), (matrix.lower, found.lower), (matrix.upper, found.upper):
            b = np.linalg.solve(np.eye(len(rho[c])) - factors * rho[c], factors * found.emissivities[c])
            np.testing.assert_allclose(bound[c], np.minimum(b, 1.0), rtol=1e-9, atol=1e-12)
        sums = found.value[c].sum(1) + found.back[c, :, 0] + found.open[c, :, 0]
        np.testing.assert_allclose(sums, 1.0, atol=1e-13)
        np.testing.assert_allclose(found.conductors[c],
                                   found.emissivities[c, :, None] * found.areas[:, None] * found.value[c], rtol=1e-12, atol=1e-12)
        assert same_bits(found.conductors[c], found.conductors[c].T)
    program("matrix", CORNELL, "--accuracy", "1e-2", "--balance", "--exchange", tmp_path / "program.csv")
    assert (tmp_path / "b.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()


def test_files_of_other_programs_are_those_of_the_program(tmp_path):
    matrix = exactff.view_factor_matrix(exactff.Scene.read(L_ROOM), accuracy=1e-2, backs=True, sky=True).balanced()
    for name, file in ("openfoam", "F"), ("calculix", "m.vwf"), ("moose", "m.csv"), ("nek", "m.nek"), ("esatan", "m.gr"):
        (ours := tmp_path / name).mkdir()
        (theirs := tmp_path / f"{name} of the program").mkdir()
        matrix.save(ours / file, format=name)
        program("matrix", L_ROOM, "--accuracy", "1e-2", "--balance", f"--{name}", theirs / file)
        assert sorted(p.name for p in ours.iterdir()) == sorted(p.name for p in theirs.iterdir())
        for path in ours.iterdir():
            assert path.read_bytes() == (theirs / path.name).read_bytes()
    (tmp_path / "mapDist").touch()
    with pytest.raises(exactff.InputError, match="mapDist"):
        matrix.save(tmp_path / "F", format="openfoam")
    with pytest.raises(exactff.InputError, match="give csv, npz, vtk, view3d, energyplus, openfoam"):
        matrix.save(tmp_path / "m.gr", format="foam")


def test_temperatures_are_those_of_the_program(tmp_path):
    cavity = SCENES / "triangular_cavity.obj"
    matrix = exactff.view_factor_matrix(exactff.Scene.read(str(cavity)), accuracy=1e-3, backs=True, sky=True).balanced()
    found = matrix.temperatures({"bottom": 300.0}, {"side": 6e6, "slope": 5e6, "ends": 0.0}, save=tmp_path / "t.csv")
    program("radiosity", cavity, "--temperatures", SCENES / "triangular_cavity.csv", "--accuracy", "1e-3", "-o",
            tmp_path / "program.csv")
    assert (tmp_path / "t.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    assert found.names == matrix.from_names and found.value[0] == 300.0 and (found.lower <= found.value).all()
    assert abs(found.heat.sum() - found.unbalanced[0]) < 1e-6 and found.to_open[2] == 0.0
    for known, heats, message in (({}, {"*": 1.0}, "no bound"), ({"floor": 3.0}, {}, "floor"), ({"bottom": -1.0}, {}, "T is -1"),
                                  ({"bottom": 300.0}, {"ends": 0.0}, "neither T nor Q has 'side'"),
                                  ({"*": 300.0}, {"ends": 0.0}, "two rows")):
        with pytest.raises(exactff.InputError, match=message):
            matrix.temperatures(known, heats)
