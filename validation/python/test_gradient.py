"""Gradients: arrays with NaN and a status at kinks, and one pair with its proof."""

import numpy as np
import pytest

import exactff
from support import CORNELL, POINT, UP, column, program, same_bits, truth_rows

ROOM = exactff.Scene.read(CORNELL)
S = exactff.DerivativeStatus

LIGHT = [[-1, 1, 2], [1, 1, 2], [1, -1, 2], [-1, -1, 2]]
SHEET = [[0, -0.5, 0.5], [0, 0.5, 0.5], [0, 0.5, 1.5], [0, -0.5, 1.5]]  # seen edge-on from the axis


def with_sheet():
    return exactff.Scene(LIGHT + SHEET, [[0, 1, 2, 3], [4, 5, 6, 7]], patch=[0, 1], names=["light", "sheet"])


def test_it_is_the_program_s_bit_for_bit():
    f = ROOM.form_factors(POINT, UP, ["light"], on="floor", gradient=True)
    line = program("point", CORNELL, "--at", *POINT, "--normal", *UP, "--on", "floor", "--source", "light", "--gradient",
                   "--plain").split()
    assert f.gradient.shape == (1, 3) and f.gradient_status.shape == (1, 3)
    assert same_bits(f.gradient[0], [float(word) for word in line[1:]])
    assert f.gradient_status.tolist() == [[S.CERTIFIED] * 3]
    assert f.value[0] == float(line[0])
    assert ROOM.form_factors(POINT, UP, ["light"], on="floor", full=True).gradient is None


def test_kinks_are_nan_with_a_status():
    scene = with_sheet()
    f = scene.form_factors([[0, 0, 0], [0.25, 0, 0]], [0, 0, 1], ["light"], gradient=True)
    assert np.isnan(f.gradient[0, 0]).all() and np.isfinite(f.gradient[1, 0]).all()
    assert f.gradient_status[0, 0].tolist() == [S.KINK] * 3 and (f.value > 0).all()


def test_one_pair_names_the_faces_of_a_kink():
    g = with_sheet().form_factor([0, 0, 0], [0, 0, 1], "light", gradient=True).gradient
    assert g.kink == "a face is seen edge-on" and g.kink_faces == ("sheet",)
    assert np.isnan(g.position).all() and g.position_status == (S.KINK,) * 3
    f = ROOM.form_factor(POINT, UP, "light", on="floor", gradient=True)
    assert f.gradient.kink is None and f.gradient.kink_faces == ()
    assert f.gradient.normal[1] == f.value  # n is the second axis
    assert f.gradient.position_enclosures[0].nearest == f.gradient.position[0]
    assert ROOM.form_factor(POINT, UP, "light", on="floor").gradient is None


def test_truth_files_have_it(tmp_path):
    receivers = ROOM.receivers("floor", grid=(4, 4))
    path = tmp_path / "truth.csv"
    exactff.truth(ROOM, receivers, path, ["light"], columns=["gradient"], progress=False)
    rows = truth_rows(path)
    f = ROOM.form_factors(receivers.points, receivers.normals, ["light"], receivers.on, gradient=True)
    for axis, name in enumerate(["dF_dx", "dF_dy", "dF_dz"]):
        assert same_bits(column(rows, name, 1)[:, 0], f.gradient[:, 0, axis])


def test_vertices_add_up_to_the_gradient_and_move_the_value():
    scene = exactff.Scene(LIGHT + [[-0.3, -0.3, 1], [0.4, -0.2, 1], [0.1, 0.5, 1.2]], [[0, 1, 2, 3], [4, 5, 6]],
                          patch=[0, 1], names=["light", "plate"])
    g = scene.form_factor([0.1, 0.2, 0], [0, 0, 1], "light", gradient=True, vertices=True).gradient
    v = g.vertices
    assert v.vertex.tolist() == [0, 1, 2, 3, 4, 5, 6] and (v.status == S.CERTIFIED).all()
    assert np.array_equal(v.place, scene.vertices[v.vertex]) and v.frames.tolist() == [[0, 1, 2]]
    assert v.derivative.sum(axis=0) == pytest.approx(-g.position, abs=1e-15)
    assert v.enclosures[4][0].nearest == v.derivative[4, 0]
    assert scene.form_factor([0.1, 0.2, 0], [0, 0, 1], "light", gradient=True).gradient.vertices is None
