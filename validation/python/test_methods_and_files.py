"""Approximate methods, truth files and checks."""

import sys

import numpy as np
import pytest

import exactff
from support import CORNELL, SOURCE, column, program, run, same_bits, truth_rows

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


@pytest.mark.parametrize("text, words", [("hemicub", "hemicube"), ("hemicube:resolution=3", "resolution"),
                                         ("hemicube:size=4", "size")])
def test_unknown_methods_and_settings(text, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.methods.evaluate(text, ROOM, *AT)


def test_a_truth_file_has_the_bytes_of_the_program(tmp_path):
    program("truth", CORNELL, "--on", "floor", "--grid", "6x5", "--source", "light", "--uv", "--unoccluded", "-o",
            tmp_path / "program.csv")
    told = []
    summary = exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light", columns=["uv", "unoccluded"],
                            progress=lambda done, total: told.append((done, total)))
    assert (tmp_path / "python.csv").read_bytes() == (tmp_path / "program.csv").read_bytes()
    assert (summary.rows, summary.certified + summary.zero, summary.not_certified) == (30, 30, 0)
    assert told[-1] == (30, 30)
    with pytest.raises(exactff.InputError, match="python.csv"):
        exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light")
    again = exactff.truth(ROOM, GRID, tmp_path / "python.csv", "light", columns=["uv", "unoccluded"], existing="resume")
    assert again.resumed == 30
    with pytest.raises(exactff.InputError, match="choose"):
        exactff.truth(ROOM, GRID, tmp_path / "python.csv", existing="overwrite")
    (tmp_path / "lights.mtl").write_text("newmtl lamp\nKe 1 1 1\n")
    (tmp_path / "s.obj").write_text("mtllib lights.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng floor\nusemtl lamp\nf 1 2 3\n")
    scene = exactff.Scene.read(tmp_path / "s.obj")
    for name in ("s.obj", "lights.mtl"):
        before = (tmp_path / name).read_bytes()
        with pytest.raises(exactff.InputError, match=f"{name}: is read"):
            exactff.truth(scene.with_flipped("floor"), scene.receivers("floor", grid=2), tmp_path / name, "floor",
                          existing="replace")
        assert (tmp_path / name).read_bytes() == before


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


def test_matrices_and_scoreboards(tmp_path):
    program("matrix", CORNELL, "-o", tmp_path / "m.csv", "--energyplus", tmp_path / "m.idf", "--force")
    assert exactff.check(tmp_path / "m.csv", tmp_path / "m.idf", max_abs=0.0)
    for name, off in (("right", 0.0), ("wrong", 0.25)):
        exactff.truth(ROOM, GRID, tmp_path / "t.csv", "light", existing="replace")
        (tmp_path / f"{name}.csv").write_text(
            "receiver,value\n" + "".join(f"{i},{v + off!r}\n" for i, v in zip(GRID.ids, TRUE.value[:, 0].tolist())))
    files = [tmp_path / "right.csv", tmp_path / "wrong.csv"]
    board = exactff.scoreboard(tmp_path / "t.csv", files, max_abs=0.1, seconds={"wrong": 2.0}, folder=tmp_path / "board")
    assert not board and [bool(report) for report in board.reports.values()] == [True, False]
    assert "| right   | passed |" in board.markdown and "2 s |" in board.markdown and "1 of 2 passed" in repr(board)
    assert sorted(file.name for file in (tmp_path / "board").iterdir()) == ["index.html", "junit.xml", "scoreboard.json"]
    with pytest.raises(exactff.InputError, match="seconds names 'other'"):
        exactff.scoreboard(tmp_path / "t.csv", files, seconds={"other": 1.0})


def test_the_program_of_the_suite_answers_the_plain_level(tmp_path):
    suite = SOURCE / "data" / "suite"
    (tmp_path / "midpoints.csv").write_text(run(sys.executable, suite / "midpoints.py", cwd=SOURCE))
    board = exactff.scoreboard(suite, [tmp_path / "midpoints.csv"], max_abs=0.2)
    assert board and "70 of 70: 3 digits" in board.markdown and "not asked" in board.markdown


def test_reports_name_receivers():
    wrong = TRUE.value.copy()
    wrong[7, 0] += 0.25
    report = exactff.check(TRUE, wrong, max_abs=1e-3, rms=1.0, receivers=GRID)
    assert report.worst[0].receiver == GRID.ids[7] == "r2c2" and "at receiver 'r2c2'" in report.message
    assert exactff.check(TRUE, wrong, receivers=[f"p{i}" for i in range(30)]).worst[0].receiver == "p7"
    unnamed = ROOM.receivers_at(*AT, on="floor")
    assert exactff.check(TRUE, wrong, receivers=unnamed).worst[0].receiver == "7"
    with pytest.raises(exactff.InputError, match="receivers has 2 names, and there are 30"):
        exactff.check(TRUE, wrong, receivers=["a", "b"])
    assert len(repr(report)) < 160 and "of 30 values: failed (max-abs: 0.25 is above" in repr(report)
    assert repr(exactff.check(TRUE, TRUE.value)) == "<exactff.CheckReport of 30 values: passed, largest error 0>"


def test_a_baseline_is_never_loosened(tmp_path):
    file, junit = tmp_path / "accuracy.json", tmp_path / "check.xml"

    def check(error, **more):
        values = TRUE.value.copy()
        values[7, 0] += error
        return exactff.check(TRUE, values, receivers=GRID, **more)

    with pytest.raises(exactff.InputError, match="does not exist"):
        check(0.1, baseline=file)
    assert check(0.1, write_baseline=file)
    first, tighter = file.read_text(), tmp_path / "tighter.json"
    for outputs in ({"write_baseline": file}, {"junit": file}, {"junit": tighter, "write_baseline": tighter}):
        with pytest.raises(exactff.InputError, match="is read|two outputs"):
            check(0.05, baseline=file, **outputs)
    worse = check(0.2, baseline=file, write_baseline=tighter, junit=junit)
    assert not worse and file.read_text() == first and not tighter.exists() and not worse.improvements
    assert "baseline max-abs" in junit.read_text() and "r2c2" in junit.read_text()
    assert check(0.11, baseline=file, slack=0.2)
    better = check(0.05, baseline=file, write_baseline=tighter)
    assert better and better.improvements[0][:2] == ("baseline max-abs", "") and tighter.read_text() != first
    assert not check(0.1, baseline=tighter) and not check(np.nan, write_baseline=tmp_path / "none.json")
    assert not (tmp_path / "none.json").exists()


def test_receivers_and_values_in_one_file(tmp_path):
    """What `truth --npz` writes, read by NumPy."""
    program("truth", CORNELL, "--on", "all", "--grid", "16x16", "--source", "light,back", "--fraction", "--unoccluded",
            "--total", "radiance", "-o", tmp_path / "t.csv", "--npz", tmp_path / "t.npz")
    at = ROOM.receivers("all", grid=16)
    with np.load(tmp_path / "t.npz") as all_of_it:
        arrays = dict(all_of_it)
    assert same_bits(arrays["points"], at.points)
    lengths = np.linalg.norm(at.normals, axis=1, keepdims=True)
    assert arrays["normals"] == pytest.approx(at.normals / lengths, abs=1e-15)
    rows = truth_rows(tmp_path / "t.csv")
    assert [arrays["faces"][k] for k in arrays["on"]] == [row["on"] for row in rows[::2]]
    assert arrays["on"].dtype == np.int32 and list(arrays["sources"]) == ["light", "back"]
    exact = ROOM.form_factors(at.points, at.normals, ["light", "back"], at.on, fraction=True)
    assert same_bits(arrays["F"], exact.value) and same_bits(arrays["visible_fraction"], exact.visible_fraction)
    assert same_bits(arrays["unoccluded"], column(rows, "unoccluded", 2))
    assert same_bits(arrays["total"][:, 1], column(rows, "total_g", 2)[:, 0])
    assert arrays["about"][0].startswith("exactff ") and any("hash" in line for line in arrays["about"])


@pytest.mark.parametrize("arguments, words", [
    ((TRUE, TRUE.value[:3]), "same shape"), ((TRUE.value, "mine.csv"), "truth is not"),
    ((TRUE.value, TRUE.value.astype(complex)), "complex128"), (("nowhere.csv", "mine.csv"), "nowhere.csv"),
])
def test_bad_checks(arguments, words):
    with pytest.raises(exactff.InputError, match=words):
        exactff.check(*arguments)
