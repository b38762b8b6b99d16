"""What arrays mean: shapes, strides, own faces, and what is refused."""

import fractions

import numpy as np
import pytest

import exactff
from support import CORNELL, POINT, UP, lamp_above, same_bits

ROOM = exactff.Scene.read(CORNELL)
GRID = ROOM.receivers("floor", grid=(4, 3))
POINTS, NORMALS, ON = GRID.points, GRID.normals, GRID.on
TRUE = ROOM.form_factors(POINTS, NORMALS, "light", ON)


def values(points, normals=NORMALS, on=ON, **more):
    return ROOM.form_factors(points, normals, "light", on, **more)


def test_any_stride_and_order():
    wide = np.zeros((24, 9))
    wide[::2, 1:7:2] = POINTS
    assert same_bits(values(wide[::2, 1:7:2]), TRUE)
    assert same_bits(values(np.asfortranarray(POINTS)), TRUE)
    assert same_bits(values(POINTS[::-1].copy()[::-1], NORMALS[::-1][::-1]), TRUE)
    assert same_bits(values(POINTS[::-1], NORMALS[::-1], ON[::-1])[::-1], TRUE)
    unaligned = np.zeros(POINTS.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(POINTS.shape)
    unaligned[...] = POINTS
    assert not unaligned.flags.aligned and same_bits(values(unaligned), TRUE)
    fixed = POINTS.copy()
    fixed.flags.writeable = False
    assert same_bits(values(fixed), TRUE)


def test_broadcasting_and_leading_shapes():
    assert same_bits(values(POINTS, UP), TRUE)
    assert values(POINTS.reshape(3, 4, 3), UP, ON.reshape(3, 4)).shape == (3, 4, 1)
    assert same_bits(values(POINTS.reshape(3, 4, 3), UP, ON.reshape(3, 4, 1)).reshape(12, 1), TRUE)
    one = values(POINTS[0], NORMALS[0], int(ON[0, 0]))
    assert one.shape == (1,) and same_bits(one, TRUE[0])
    many = ROOM.form_factors(POINT, [UP, [0, 0, 1], [1, 1, 1]], None, "floor")
    assert many.shape == (3, 1) and len(set(many.ravel())) == 3
    assert values(np.empty((0, 3)), UP, None).shape == (0, 1)
    assert values(POINTS.tolist(), NORMALS.tolist(), ON.tolist()).shape == (12, 1)


def test_lossless_types_are_taken():
    whole = np.array([[200, 0, 400]])
    true = ROOM.form_factors(whole.astype(float), [UP], None, "floor")
    for kind in (np.float32, np.float16, np.int16, np.int32, np.int64, np.uint8, np.uint64, ">f8", ">i4"):
        scaled = np.array([[200, 0, 200]]).astype(kind)
        expected = ROOM.form_factors([[200.0, 0.0, 200.0]], [UP], None, "floor")
        assert same_bits(ROOM.form_factors(scaled, [[0, 1, 0]], None, "floor"), expected), kind
    assert same_bits(ROOM.form_factors(whole, np.array([[0, 1, 0]], np.int8), None, "floor"), true)


@pytest.mark.parametrize("points, words", [
    ([[np.nan, 0, 0]], r"points\[0, 0\] is nan \(a coordinate is a finite number\)"),
    ([[0, 0, 0], [0, np.inf, 0]], r"points\[1, 1\] is inf"),
    (np.zeros((1, 3), complex), "complex128 is not taken"),
    (np.zeros((1, 3), np.longdouble), "rounded to double precision"),
    (np.array([[2**53 + 1, 0, 0]]), r"points\[0, 0\] is a whole number beyond 2\^53"),
    (np.array([[fractions.Fraction(1, 3), 0, 0]]), "object is not taken"),
    ([["1", "2", "3"]], "text is no number"),
    ([[1, 2, 3], [1, 2]], "different lengths"),
    (np.ma.masked_array([[1.0, 2, 3]], [[True, False, False]]), "masked"),
    (np.zeros((4, 2)), r"shape \(4, 2\)"),
    (None, "object is not taken"),
])
def test_bad_points_are_refused_with_words(points, words):
    with pytest.raises(exactff.InputError, match=words):
        values(points, UP, None)


@pytest.mark.parametrize("changed, words", [
    (dict(normals=[[0, 0, 0]]), r"normals\[0\] is zero"),
    (dict(normals=np.zeros((12, 3)) + [0, 0, np.nan]), r"normals\[0, 2\] is nan"),
    (dict(normals=np.ones((5, 3))), "do not fit together"),
    (dict(on=np.full(12, 99)), r"on\[0\] is 99 \(faces are numbered from 0 to"),
    (dict(on=np.zeros(12)), "indices are whole numbers"),
    (dict(on=["floor"] * 5), "on has 5 entries"),
    (dict(on="auto:-1"), "distance of at least 0"),
    (dict(threads=-1), "threads is -1"),
    (dict(precision_cap=2), "precision_cap is 2"),
    (dict(transparent=[3]), "is no name"),
])
def test_bad_options_are_refused_with_words(changed, words):
    arguments = dict(points=POINTS, normals=NORMALS, on=ON)
    with pytest.raises(exactff.InputError, match=words):
        values(**{**arguments, **changed})


@pytest.mark.parametrize("sources, words", [
    ("lihgt", "light"), (["light", "light"], "named twice"), ([], "sources is empty"), (["light", 3], "is no name"),
])
def test_bad_sources_are_refused_with_words(sources, words):
    with pytest.raises(exactff.InputError, match=words):
        ROOM.form_factors(POINTS, NORMALS, sources, ON)


def test_problems_say_what_why_and_what_to_do():
    with pytest.raises(ValueError) as caught:
        values([[np.nan, 0, 0]], UP, None)
    problem = caught.value.problems[0]
    assert (problem.what, problem.why) == ("points[0, 0] is nan", "a coordinate is a finite number")
    assert problem.suggestion and problem.message == str(caught.value)


def test_own_faces_in_every_form():
    floor = ROOM.faces_of("floor")[0]
    for on in ("floor", "floor:1", floor, np.full(12, floor), np.full((12, 2), [floor, -1]), ["floor"] * 12,
               [[floor]] * 12, [floor] * 12, "auto", "auto:0.5"):
        assert same_bits(values(POINTS, NORMALS, on), TRUE), on
    assert np.array_equal(ROOM.faces_at(POINTS, NORMALS), ON)
    below = POINTS[:3] - [0.0, 1e-9, 0.0]  # their own floor hides the light
    with pytest.warns(exactff.ModellingWarning, match="behind"):
        mixed = values(below[[0, 1, 0]], NORMALS[:3], ["floor", None, [floor]])
    assert (mixed.ravel() > 0.0).tolist() == [True, False, True] and TRUE[:2].all()


def test_transparent_for_one_call():
    scene = lamp_above((0.5, 2.0))
    at = ([[0.0, 0.0, 0.0]], [0.0, 0.0, 1.0])
    assert not scene.form_factors(*at).any()
    clear = scene.form_factors(*at, transparent="plates")
    assert same_bits(clear, lamp_above().form_factors(*at))
    assert same_bits(clear, scene.with_transparent("plates").form_factors(*at))
    assert not scene.form_factors(*at).any() and scene.transparent == ()
