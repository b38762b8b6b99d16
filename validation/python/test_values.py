"""Bit for bit the values of the program."""

import numpy as np
import pytest

import exactff
from support import BLINDS, CORNELL, UP, column, lamp_above, open_scene, program, same_bits, square, truth_rows

STATUS = {"certified": 0, "zero": 1, "underflow": 2, "not certified": 3}

CASES = [
    (CORNELL, "floor", "12x12", ["light", "tall_block"]),
    (BLINDS, "floor", "5x5", ["window"]),
    ("@soup:n=60,seed=3", "floor", "6x6", ["source"]),
    ("@lattice:n=80,seed=5", "floor", "8x8", ["source"]),
    ("@tiles:n=40", "floor", "8x8", ["source"]),
    ("@karkanis:n=30,seed=2", "floor", "5x5", ["source"]),
    ("@closed-room", "floor", "6x6", ["lamp"]),
]


@pytest.mark.filterwarnings("ignore:.*have no area:exactff.ModellingWarning")
@pytest.mark.parametrize("scene, on, grid, sources", CASES, ids=lambda case: str(case).split("/")[-1])
def test_values_are_those_of_a_truth_file(tmp_path, scene, on, grid, sources):
    file = tmp_path / "truth.csv"
    named = [word for source in sources for word in ("--source", source)]
    program("truth", scene, "--on", on, "--grid", grid, *named, "--fraction", "-o", file)
    rows = truth_rows(file)
    opened = open_scene(scene)
    receivers = opened.receivers(on, grid=tuple(map(int, grid.split("x"))))
    found = opened.form_factors(receivers.points, receivers.normals, sources, receivers.on, fraction=True)
    count = len(sources)
    assert found.value.dtype == np.float64 and found.value.shape == (len(receivers), count)
    assert same_bits(receivers.points[:, 0], [float(row["x"]) for row in rows[::count]])
    for name, values in [("exact", found.value), ("lower", found.lower), ("upper", found.upper),
                         ("visible_fraction", found.visible_fraction)]:
        assert same_bits(values, column(rows, name, count)), name
    assert [STATUS[row["status"]] for row in rows] == found.status.ravel().tolist()
    assert found.value.any() and found.sources == tuple(sources)
    plain = opened.form_factors(receivers.points, receivers.normals, sources, receivers.on)
    assert same_bits(plain, found.value)


def test_the_sky_is_a_source_as_in_truth_files(tmp_path):
    lamp = lamp_above((0.5, 1.0))
    at = lamp.receivers("plates", grid=4)
    values = lamp.form_factors(at.points, at.normals, ["sky", "lamp"], at.on, full=True)
    assert values.sources == ("sky", "lamp") and values.value.shape == (16, 2)
    assert np.allclose(values.value.sum(axis=1), 1) and (values.lower <= values.value).all()
    exactff.truth(lamp, at, tmp_path / "t.csv", ["sky", "lamp"])
    rows = truth_rows(tmp_path / "t.csv")
    assert [row["source"] for row in rows[:2]] == ["lamp", "sky"]
    assert same_bits(column(rows, "exact", 2), values.value[:, ::-1])
    assert same_bits(column(rows, "lower", 2), values.lower[:, ::-1])
    alone = lamp.form_factors(at.points, at.normals, "sky", at.on)
    assert same_bits(alone[:, 0], values.value[:, 0])
    view = exactff.view(lamp, at.points[0], at.normals[0], at.on[0])
    assert same_bits(view.open.value, alone[0, 0])
    for asked in ("fraction", "gradient"):
        with pytest.raises(exactff.InputError, match="sky"):
            lamp.form_factors(at.points, at.normals, "sky", at.on, **{asked: True})
    named = exactff.Scene(square(0.0), [[0, 1, 2, 3]], patch=["sky"])
    assert same_bits(named.form_factors([[0, 0, -1]], [0, 0, 1], "sky"), [[0.0]]), "a patch of this name has priority"


def test_unit_normals_are_those_of_truth_files(tmp_path):
    room = exactff.Scene.read(CORNELL)
    at = room.receivers("tall_block", centres=True)
    assert np.hypot.reduce(at.normals, axis=1).max() > 1e4
    exactff.truth(room, at, tmp_path / "t.csv", columns=["unit-normals"])
    rows = truth_rows(tmp_path / "t.csv")
    unit = np.stack([column(rows, name, 1)[:, 0] for name in ("ux", "uy", "uz")], axis=1)
    assert same_bits(at.unit_normals, unit) and np.allclose((unit**2).sum(axis=1), 1)
    assert "\"name\":\"nx\",\"type\":\"number\",\"unit\":\"of any length\"" in (tmp_path / "t.csv").read_text()


def test_threads_and_size_of_a_batch_change_no_bit():
    scene = exactff.Scene.read(CORNELL)
    receivers = scene.receivers("floor", grid=(20, 20))
    one = scene.form_factors(receivers.points, receivers.normals, "all", receivers.on, threads=1)
    assert one.shape == (400, 8)
    for threads in (0, 2, 5):
        many = scene.form_factors(receivers.points, receivers.normals, "all", receivers.on, threads=threads)
        assert same_bits(one, many)
    parts = [scene.form_factors(receivers.points[i], receivers.normals[i], "all", receivers.on[i : i + 1].ravel())
             for i in range(5)]
    assert same_bits(one[:5], parts)


def tiny_lamp(side):
    return exactff.Scene(square(1.0, side), [[3, 2, 1, 0]], names="lamp")


def test_every_status():
    status = exactff.Status
    seen = lamp_above().form_factors([0, 0, 0], [0, 0, 1], full=True)
    assert seen.status.tolist() == [status.CERTIFIED] and seen.lower[0] < seen.value[0] < seen.upper[0]
    hidden = lamp_above((0.5, 2.0)).form_factors([0, 0, 0], [0, 0, 1], full=True, fraction=True)
    assert hidden.status.tolist() == [status.ZERO]
    assert (hidden.value[0], hidden.upper[0], hidden.visible_fraction[0]) == (0.0, 0.0, 0.0)
    far = tiny_lamp(2e-170).form_factors([0, 0, 0], [0, 0, 1], "lamp", full=True)
    assert far.status.tolist() == [status.UNDERFLOW] and far.value[0] == 0.0 < far.upper[0]


def test_values_that_are_not_certified_warn_and_keep_valid_bounds():
    scene = tiny_lamp(2e-30)
    true = scene.form_factors([0, 0, 0], [0, 0, 1], "lamp")
    with pytest.warns(exactff.ModellingWarning, match="1 of 1 values are not certified"):
        capped = scene.form_factors([0, 0, 0], [0, 0, 1], "lamp", full=True, precision_cap=40)
    assert capped.status.tolist() == [exactff.Status.NOT_CERTIFIED] and capped.precision_bits.tolist() == [40]
    assert capped.lower[0] <= true[0] <= capped.upper[0]
    assert str(exactff.Status(3)) == "not certified"


def test_other_measures_are_those_of_a_truth_file(tmp_path):
    file = tmp_path / "truth.csv"
    program("truth", BLINDS, "--on", "floor", "--grid", "3x3", "--source", "window", "--source", "sky", "--measure",
            "solid-angle,overcast,sphere", "--up", 1, 2, 3, "-o", file)
    rows = truth_rows(file)
    scene = open_scene(BLINDS)
    receivers = scene.receivers("floor", grid=(3, 3))
    sources = ["window", "sky"]

    def found(normals, **measure):
        return scene.form_factors(receivers.points, normals, sources, receivers.on, **measure)

    for name, values in [("solid_angle", found(receivers.normals, measure="solid-angle")),
                         ("overcast", found(receivers.normals, measure="overcast", up=(1, 2, 3))),
                         ("sphere", found(None))]:
        assert values.any() and same_bits(values, column(rows, name, 2)), name
    again = tmp_path / "again.csv"
    exactff.truth(scene, receivers, again, sources, measures=["solid-angle", "overcast", "sphere"], up=(1, 2, 3))
    assert [row["overcast"] for row in truth_rows(again)] == [row["overcast"] for row in rows]
    point, normal = receivers.points[0], receivers.normals[0]
    pair = scene.form_factor(point, normal, "window", int(receivers.on[0, 0]), measure="solid-angle")
    assert pair.value == float(rows[0]["solid_angle"])
    seen = exactff.view(scene, point, None, measure="solid-angle")
    total = sum(patch.share.value for patch in seen.values()) + seen.back.value + seen.open.value
    assert total == pytest.approx(4.0 * np.pi, abs=1e-13)
    with pytest.raises(exactff.InputError, match="needs a surface with a normal"):
        scene.form_factor(point, None, "window", measure="overcast")
