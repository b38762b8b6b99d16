"""Radiosities after all bounces."""

import csv

import numpy as np
import pytest

import exactff
from support import CORNELL, program, same_bits

BOX = exactff.Scene.read(CORNELL)
CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
SIDES = [[0, 1, 2, 3], [4, 7, 6, 5], [0, 4, 5, 1], [3, 2, 6, 7], [0, 3, 7, 4], [1, 5, 6, 2]]  # fronts look inward


def cube(reflectance, emission):
    """A closed room, every side a patch."""
    names = [f"side {i}" for i in range(6)]
    materials = {name: {"reflectance": reflectance, "radiosity": emission} for name in names}
    return exactff.Scene(CORNERS, SIDES, list(range(6)), names, materials)


def test_radiosities_are_the_programs(tmp_path):
    scene = cube([0.5, 0.25, 0.0], [1.0, 2.0, 3.0])
    told = []
    found = exactff.radiosity(scene, accuracy=1e-4, progress=lambda done, total: told.append((done, total)))
    (tmp_path / "cube.mtl").write_text("newmtl m\nKd 0.5 0.25 0\nKe 1 2 3\n")
    (tmp_path / "cube.obj").write_text(
        "mtllib cube.mtl\nusemtl m\n" + "".join("v {} {} {}\n".format(*v) for v in CORNERS)
        + "".join("g side{}\nf {} {} {} {}\n".format(i, *(k + 1 for k in f)) for i, f in enumerate(SIDES)))
    program("radiosity", tmp_path / "cube.obj", "--accuracy", "1e-4", "-o", tmp_path / "b.csv")
    with open(tmp_path / "b.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for array, column in ((found.value, "radiosity"), (found.lower, "lower"), (found.upper, "upper"),
                          (found.irradiance, "irradiance"), (found.irradiance_upper, "irradiance_upper")):
        assert array.shape == (6, 3) and same_bits(array.ravel(), [float(row[column]) for row in rows])
    assert {row["claim"] for row in rows} == {found.claim} == {"estimated"}
    assert told[-1][0] == told[-1][1]
    truth = np.array([2.0, 8.0 / 3.0, 3.0])  # E / (1 - rho)
    assert (found.lower <= truth).all() and (truth <= found.upper).all() and (found.upper - found.lower < 1e-2).all()
    assert found.reasons_against_balance == () and (found.balance.back == 0.0).all()
    gone = found.balance.absorbed + found.balance.back + found.balance.open
    assert (gone[:, 0] <= found.balance.emitted[:, 1]).all() and (found.balance.emitted[:, 0] <= gone[:, 1]).all()


def test_bounds_are_as_narrow_as_is_asked():
    scene = cube([0.5, 0.75, 0.0], [1.0, 3.0, 0.1])
    found = exactff.radiosity(scene, width=1e-3, accuracy=0.05)
    assert found.computed_again > 0 and found.widest <= 1e-3
    assert (found.upper - found.lower <= 1e-3 * found.lower.max(axis=0)).all()
    truth = np.array([2.0, 12.0, 0.1])
    assert (found.lower <= truth).all() and (truth <= found.upper).all()
    with pytest.warns(exactff.ModellingWarning, match="the widest bounds are .* of the brightest radiosity wide, not 1e-07"):
        dark = cube([0.25, 0.25, 0.25], [1.0, 1.0, 1.0])
        assert exactff.radiosity(dark, width=1e-7, accuracy=0.01, budget=2).widest > 1e-7


def test_backs_are_told_from_the_sky_on_request():
    squares = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    shed = exactff.Scene(squares, [[0, 1, 2, 3], [4, 5, 6, 7]], [0, 1], ["floor", "roof"],
                         {"floor": {"radiosity": 1.0}})  # the roof's front is above
    together, apart = (exactff.radiosity(shed, accuracy=1e-4, backs=backs).balance for backs in (False, True))
    np.testing.assert_allclose(together.lost, 1.0, atol=1e-9)
    assert (together.back[:, 0] == 0.0).all()
    np.testing.assert_allclose(apart.back, 0.19982489569838738, atol=1e-3)


def test_without_a_bound_there_is_a_warning():
    with pytest.warns(exactff.ModellingWarning, match="no bound for red .Kd is 1 or more on side 0"):
        found = exactff.radiosity(cube([1.0, 0.5, 0.5], [1.0, 1.0, 1.0]), accuracy=1e-2)
    assert np.isinf(found.upper[:, 0]).all() and np.isfinite(found.upper[:, 1:]).all()
    assert found.no_bound[0] and not found.no_bound[1]


@pytest.mark.parametrize("call", [
    lambda: exactff.radiosity(BOX, accuracy=0.0),
    lambda: exactff.radiosity(BOX, budget=0),
    lambda: exactff.radiosity(BOX, width=0.0),
    lambda: exactff.radiosity(BOX, threads=-1),
])
def test_bad_arguments_are_refused(call):
    with pytest.raises(exactff.InputError):
        call()
