"""Approximate methods, truth files and checks."""

import numpy as np
import pytest

import exactff
from support import CORNELL, column, program, same_bits, truth_rows

ROOM = exactff.Scene.read(CORNELL)
GRID = ROOM.receivers("floor", grid=(6, 5))
AT = (GRID.points, GRID.normals)
TRUE = ROOM.form_factors(*AT, "light", GRID.on, full=True)


def test_every_method_is_near_the_truth():
    assert exactff.methods.names()[0] == "exact" and len(exactff.methods.names()) == 7
    for name in exactff.methods.names():
        found = exactff.methods.evaluate(name, ROOM, *AT, "light", GRID.on)
        assert found.shape == (30, 1) and np.abs(found - TRUE.value).max() < 2e-3, name
        assert name in exactff.methods.describe(name)
    assert same_bits(exactff.methods.evaluate("exact", ROOM, *AT, "light", GRID.on), TRUE.value)


def test_threads_change_no_estimate():
    text = "hemicube:resolution=64"
    one = exactff.methods.evaluate(text, ROOM, *AT, ["light", "back"], GRID.on, threads=1)
    assert same_bits(one, exactff.methods.evaluate(text, ROOM, *AT, ["light", "back"], GRID.on, threads=3))
    other = exactff.methods.evaluate("hemicube", ROOM, *AT, ["light", "back"], GRID.on)
    assert one.shape == (30, 2) and not same_bits(one, other)


@pytest.mark.parametrize("text, words", [("hemicub", "hemicube"), ("hemicube:resolution=3", "resolution"),
                                         ("hemicube:size=4", "size")])
def test_unknown_methods_and_settings(text, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.methods.evaluate(text, ROOM, *AT)


def test_a_truth_file_has_the_bytes_of_the_program(tmp_path):
    program("truth", CORNELL, "--on", "floor", "--grid", "6x5", "--source", "light", "--uv", "--unoccluded", "-o",
            tmp_path / "program.csv")
    told = []
    summary = exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light", uv=True, unoccluded=True,
                            progress=lambda done, total: told.append((done, total)))
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    assert (summary.rows, summary.certified + summary.zero, summary.not_certified) == (30, 30, 0)
    assert told[-1] == (30, 30)
    with pytest.raises(exactff.InputError, match="python.csv"):
        exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light")
    again = exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light", uv=True, unoccluded=True, existing="resume")
    assert again.resumed == 30
    with pytest.raises(exactff.InputError, match="choose"):
        exactff.truth(ROOM, GRID, tmp_path / "python.csv", existing="overwrite")


def test_a_truth_file_of_arrays(tmp_path):
    receivers = ROOM.receivers_at(*AT, on="floor", ids=[f"p{i}" for i in range(30)])
    exactff.truth(ROOM, receivers, tmp_path / "t.csv")
    rows = truth_rows(tmp_path / "t.csv")
    assert same_bits(column(rows, "exact", 1), TRUE.value) and rows[3]["receiver"] == "p3" and rows[3]["on"] == "floor"


def test_arrays_are_checked():
    exact = exactff.check(TRUE, TRUE.value, max_abs=0.0)
    assert exact and exact.passed and exact.rows == 30 and exact.absolute.max == 0.0
    wrong = TRUE.value.copy()
    wrong[7, 0] += 0.25
    report = exactff.check(TRUE, wrong, max_abs=1e-3, quantiles={0.9: 1e-6}, worst=1)
    assert not report and [v.passed for v in report.verdicts if v.criterion == "max-abs"] == [False]
    assert [v.passed for v in report.verdicts if v.criterion == "quantile 0.9"] == [True]
    assert report.worst[0].receiver == "7" and abs(report.worst[0].error - 0.25) < 1e-15 and "max-abs" in report.message
    with pytest.raises(AssertionError, match="max-abs"):
        report.raise_if_failed()
    wrong[7, 0] = np.nan
    assert exactff.check(TRUE.value, wrong).not_finite == 1 and not exactff.check(TRUE.value, wrong)
    assert report.json["passed"] is False


def test_values_are_checked_with_a_truth_file(tmp_path):
    file, mine = tmp_path / "t.csv", tmp_path / "mine.csv"
    exactff.truth(ROOM, GRID, file, "light")
    mine.write_text("receiver,value\n" + "".join(f"{i},{v!r}\n" for i, v in zip(GRID.ids, TRUE.value[:, 0].tolist())))
    assert exactff.check(file, mine, max_abs=0.0, eps_b=0.0)
    assert exactff.check(file, TRUE.value, max_abs=0.0)
    assert exactff.check(str(file), TRUE.value.astype(np.float32), max_rel=1e-6)
    program("check", file, mine, "--max-abs", 0)
    with pytest.raises(exactff.InputError, match="30 rows, and there are 29 values"):
        exactff.check(file, TRUE.value[:29])


@pytest.mark.parametrize("arguments, words", [
    ((TRUE, TRUE.value[:3]), "same shape"), ((TRUE.value, "mine.csv"), "truth is not"),
    ((TRUE.value, TRUE.value.astype(complex)), "complex128"), (("nowhere.csv", "mine.csv"), "nowhere.csv"),
])
def test_bad_checks(arguments, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.check(*arguments)
