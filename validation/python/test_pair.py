"""One pair: the proof, the explanation, the drawing."""

import fractions
import xml.etree.ElementTree

import mpmath
import pytest

import exactff
from support import BLINDS, CORNELL, POINT, UP, lamp_above, program

ROOM = exactff.Scene.read(CORNELL)


def test_the_value_of_the_readme():
    f = ROOM.form_factor(POINT, UP, "light", on="floor")
    plain = program("point", CORNELL, "--at", *POINT, "--normal", *UP, "--on", "floor", "--source", "light", "--plain")
    assert f.value == float(f) == float(plain) == 0.010822702782492406
    assert f.lower < f.value < f.upper and f.status is exactff.Status.CERTIFIED
    assert repr(f) == "<exactff.FormFactor to 'light': 0.010822702782492406 (certified)>"
    assert f.visible_fraction is None and f.visible_part is None
    assert ROOM.form_factor(POINT, UP, on="floor").value == f.value  # the only emitter


def test_the_enclosure_is_exact_decimals():
    f = ROOM.form_factor(POINT, UP, "light", on="floor", digits=60)
    ball = f.enclosure
    low = fractions.Fraction(ball.midpoint) - fractions.Fraction(ball.radius)
    high = fractions.Fraction(ball.midpoint) + fractions.Fraction(ball.radius)
    assert 0 < high - low < fractions.Fraction(1, 10**55)
    assert low <= fractions.Fraction(ball.decimals(50)) + fractions.Fraction(1, 10**51)
    assert ball.decimals(10**4) is None
    assert fractions.Fraction(f.lower) < low < high < fractions.Fraction(f.upper)
    with mpmath.workdps(80):
        assert abs(mpmath.mpf(ball.midpoint) - mpmath.mpf(f.value)) < mpmath.mpf(2) ** -58
    assert f.value not in ball and ball.nearest == f.value and ball.lower <= f.value <= ball.upper
    digits = program("point", CORNELL, "--at", *POINT, "--normal", *UP, "--on", "floor", "--source", "light",
                     "--digits", 50, "--plain")
    assert ball.decimals(50) == digits.strip()


def test_balls_add_up_to_one_in_a_closed_room():
    room = exactff.Scene.from_model("closed-room")
    centre = room.receivers("floor", centres=True)
    total = exactff.Scene.form_factor(room, centre.points[0], centre.normals[0], room.names[0], centre.on[0]).enclosure
    for name in room.names[1:]:
        total = total + room.form_factor(centre.points[0], centre.normals[0], name, centre.on[:1].tolist()[0]).enclosure
    assert 1.0 in total and total.upper - total.lower < 1e-15
    assert 0.0 in total - total


def test_fraction_and_visible_part():
    blinds = exactff.Scene.read(BLINDS)
    f = blinds.form_factor([3, 0, 3.3], UP, "window", on="auto", fraction=True)
    assert 0.0 < f.visible_fraction < 1.0 and f.visible_part == "some"
    free = lamp_above().form_factor([0, 0, 0], [0, 0, 1], fraction=True)
    assert (free.visible_fraction, free.visible_part) == (1.0, "all")


def test_explain_and_draw():
    f = ROOM.form_factor([278, 0, 450], UP, "light", on="floor")
    words = f.explain()
    assert "source light" in words and "plane of light" in words and "alone" in words and "tall_block" in words
    assert f"form factor  {f.value!r}  (certified)" in words
    drawing = f.draw()
    assert xml.etree.ElementTree.fromstring(drawing.svg).tag.endswith("svg") and drawing._repr_svg_() == drawing.svg


def test_a_drawing_is_saved(tmp_path):
    drawing = ROOM.form_factor(POINT, UP, "light", on="floor").draw()
    drawing.save(tmp_path / "view.svg")
    assert (tmp_path / "view.svg").read_text(encoding="utf-8") == drawing.svg and "SVG" in repr(drawing)


def test_a_result_outlives_its_scene():
    f = lamp_above((0.5, 0.2)).form_factor([0, 0, 0], [0, 0, 1])
    assert f.draw().svg and "plates" in f.explain()


@pytest.mark.parametrize("arguments, words", [
    (dict(point=[[0, 0, 0], [1, 1, 1]], normal=UP), "form_factor is for one"),
    (dict(point=POINT, normal=[0, 0, 0]), "normals is zero"),
    (dict(point=POINT, normal=UP, source=3), "it is the name of a patch"),
    (dict(point=POINT, normal=UP, source="lamp"), "light"),
])
def test_bad_arguments(arguments, words):
    with pytest.raises(exactff.InputError, match=words):
        ROOM.form_factor(**arguments)


def test_several_emitters_need_a_name():
    with pytest.raises(exactff.InputError, match="64 patches emit"):
        exactff.Scene.from_model("emitters").form_factor(POINT, UP)
