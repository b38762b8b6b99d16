"""Truth files, and comparisons of other values with true ones."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any, Literal, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _arguments, _exactff
from ._arguments import Names, Path, Progress, refuse, require_free, shown, warn
from ._geometry import Receivers
from ._pair import FormFactors, Status
from ._scene import Scene


class TruthSummary(NamedTuple):
    """What :func:`truth` has written."""

    rows: int
    certified: int
    zero: int
    underflow: int
    not_certified: int
    resumed: int  #: rows that were already finished
    seconds: float  #: wall time of computing the other rows


def truth(scene: Scene, receivers: Receivers, path: Union[str, os.PathLike[str]], sources: Names = None, *,
          columns: Sequence[str] = (), measures: Sequence[Literal["solid-angle", "overcast", "sphere"]] = (),
          up: ArrayLike = (0.0, 0.0, 1.0),
          existing: Literal["refuse", "resume", "replace"] = "refuse", threads: int = 0,
          progress: Progress = None) -> TruthSummary:
    """Writes a truth file: the bytes that ``exactff truth`` writes for the same scene, receivers and sources.

    Parameters
    ----------
    sources : as in :meth:`Scene.form_factors`; the rows of "sky" are the last of each receiver
    receivers : from :meth:`Scene.receivers`, :meth:`Scene.read_receivers` or :meth:`Scene.receivers_at`
    columns : additional columns, by their flags without dashes: ``["fraction", "gradient", "unit-normals"]``
    measures, up : further columns, as in :meth:`Scene.form_factors`; "sphere" is the form factor from a small sphere
    existing : what to do if there is a file or a journal of an interrupted run: "refuse", "resume" or "replace"

    After Ctrl-C or a crash, finished rows are kept in ``PATH.part``; ``existing="resume"`` continues.
    """
    if existing not in ("refuse", "resume", "replace"):
        refuse(f"existing is {existing!r}", "", "choose 'refuse', 'resume' or 'replace'")
    more = [_arguments.measure_tuple("form-factor" if one == "sphere" else one, up, one == "sphere") for one in measures]
    count = _arguments.thread_count(threads)
    require_free(path, "replace", scene._read)
    with shown(progress, "row") as tell:
        rows, by_status, resumed, seconds = _exactff.write_truth(
            scene._scene, scene.name, receivers._list, receivers.name, scene._sources(sources, sky=True), os.fspath(path),
            existing, list(columns), more, count, tell)
    certified, zero, underflow, not_certified = by_status
    if not_certified:
        warn(f"{not_certified} of {rows} rows are not certified")
    return TruthSummary(rows, certified, zero, underflow, not_certified, resumed, seconds)


class Distribution(NamedTuple):
    """Statistics of the magnitudes of errors. A quantile is by nearest rank."""

    median: float
    p90: float
    p99: float
    p999: float
    max: float
    rms: float


class Verdict(NamedTuple):
    """One limit, and whether it holds."""

    criterion: str
    source: str  #: empty: all sources together
    measured: float
    limit: float
    passed: bool
    sentence: str


class RowError(NamedTuple):
    """The error of one value. For arrays, `receiver` is the name that was given, or the index of the receiver."""

    receiver: str
    source: str
    truth: float
    value: float
    error: float
    relative: float


class Improvement(NamedTuple):
    """An error that is smaller than the recorded one by more than the slack."""

    criterion: str
    source: str  #: empty: all sources together
    recorded: float
    now: float


@dataclass(frozen=True, repr=False)
class CheckReport:
    """The result of :func:`check`. ``bool(report)`` tells whether it passed; tests call :meth:`raise_if_failed`."""

    passed: bool
    rows: int
    not_finite: int  #: values that are NaN or infinite
    leaks: int  #: rows where the truth is 0 and the value is not
    bias: float  #: signed mean error
    absolute: Distribution
    relative: Distribution
    verdicts: tuple[Verdict, ...]
    worst: tuple[RowError, ...]  #: worst first
    warnings: tuple[str, ...]
    improvements: tuple[Improvement, ...]  #: over the baseline; ``write_baseline`` keeps them
    message: str  #: the limits that are exceeded, and the worst rows
    json: Mapping[str, Any]  #: everything, as ``exactff check --json`` writes it

    def __bool__(self) -> bool:
        return self.passed

    def raise_if_failed(self) -> None:
        """Raises AssertionError unless all limits hold. Its text is `message`: the limits that are exceeded, and the
        worst rows with their receivers. For tests; pytest shows the line of the test that calls this."""
        __tracebackhide__ = True
        if not self.passed:
            raise AssertionError(self.message)

    def __repr__(self) -> str:
        failed = [verdict.sentence for verdict in self.verdicts if not verdict.passed]
        more = f"; and {len(failed) - 1} more" if len(failed) > 1 else ""
        result = f"failed ({failed[0]}{more})" if failed else f"passed, largest error {self.absolute.max:.3g}"
        return f"<exactff.CheckReport of {self.rows} values: {result}>"


def check(truth: Union[Path, FormFactors, ArrayLike], values: Union[Path, ArrayLike], *,
          max_abs: Optional[float] = None, max_rel: Optional[float] = None, rms: Optional[float] = None,
          eps_b: Optional[float] = None, quantiles: Optional[Mapping[float, float]] = None, per_source: bool = False,
          relative_floor: float = 0.0, worst: int = 10, truth_column: str = "", value_column: str = "",
          match: Literal["receiver", "position"] = "receiver", tolerance: float = 0.0, partial: bool = False,
          receivers: Union[Receivers, Sequence[str]] = (), baseline: Optional[Path] = None,
          write_baseline: Optional[Path] = None, slack: float = 1e-9, junit: Optional[Path] = None) -> CheckReport:
    """Compares values with true ones. In a test: ``exactff.check(...).raise_if_failed()``.

    Parameters
    ----------
    truth : a truth file, or another table that exactff wrote; or the result of :meth:`Scene.form_factors`, best with ``full=True``
    values : a file of any kind that ``exactff check`` reads (only with a truth file), matched by receiver or by
        position; or an array: for a truth file one
        value for each row, in order; otherwise of the same shape. NaN and infinite values count as failures.
    max_abs, max_rel, rms : limits of the errors; an error equal to its limit passes
    eps_b : limit of the error in radiosity, the error times the largest rho B; needs a truth file
    quantiles : {0.99: 1e-3}: at least this share of the errors is at most that
    per_source : every source must meet every limit
    relative_floor : relative errors are relative to the truth or to this, whichever is larger
    match, tolerance, partial, truth_column, value_column : as of ``exactff check``
    receivers : names for the report, of arrays: the :class:`Receivers` themselves, or one name for each
    baseline : a file of recorded errors; an error that is worse by more than the share `slack` of it is a failure
    write_baseline : record these errors in the file, which is not that of `baseline`, unless one got worse or a value
        is not finite
    junit : write the verdicts as JUnit XML, for Jenkins, GitLab and others

    Without any limit only finiteness is checked. Raises InputError for files, arrays and limits that cannot be used.
    Errors of values that are not certified are measured from the nearest point of their enclosure.
    """
    read = [one for one in (truth, values) if isinstance(one, (str, os.PathLike))]
    for file, others in ((write_baseline, read), (junit, [*read, *([] if baseline is None else [baseline])])):
        if file is not None:
            require_free(file, "replace", others)
    limits = _exactff.Limits(max_abs, max_rel, rms, eps_b, list((quantiles or {}).items()), per_source, relative_floor,
                             worst)
    matching = _matching(truth_column, value_column, match, tolerance, partial)
    files = _exactff.CheckFiles(baseline, write_baseline, junit, slack)
    names = list(receivers.ids if isinstance(receivers, Receivers) else receivers)
    if not isinstance(truth, (str, os.PathLike)):
        return _arrays_report(truth, values, names, limits, files)
    if names:
        refuse("receivers is given with a truth file", "its rows name their receivers", "leave it out")
    if isinstance(values, (str, os.PathLike)):
        return _report(_exactff.check_files(os.fspath(truth), os.fspath(values), matching, limits, files))
    return _report(_exactff.check_values(os.fspath(truth), np.ascontiguousarray(_any_numbers(values)).ravel(),
                                         truth_column, limits, files))


@dataclass(frozen=True, repr=False)
class Scoreboard:
    """The result of :func:`scoreboard`. ``bool(board)`` tells whether every program passed."""

    reports: Mapping[str, CheckReport]  #: by the program's name, in the order of the candidates
    seconds: Mapping[str, float]  #: as they were given
    markdown: str  #: a table with a row for each program

    def __bool__(self) -> bool:
        return all(self.reports.values())

    def __repr__(self) -> str:
        passed = sum(map(bool, self.reports.values()))
        return f"<exactff.Scoreboard: {passed} of {len(self.reports)} passed>"


def scoreboard(truth: Path, candidates: Sequence[Path], *, folder: Optional[Path] = None,
               seconds: Optional[Mapping[str, float]] = None, max_abs: Optional[float] = None,
               max_rel: Optional[float] = None, rms: Optional[float] = None, eps_b: Optional[float] = None,
               quantiles: Optional[Mapping[float, float]] = None, per_source: bool = False,
               relative_floor: float = 0.0, worst: int = 10, truth_column: str = "", value_column: str = "",
               match: Literal["receiver", "position"] = "receiver", tolerance: float = 0.0,
               partial: bool = False) -> Scoreboard:
    """Compares the files of several programs with one truth, or with the folder of a suite: a row for each program.

    folder : where index.html, scoreboard.json and junit.xml are written; it appears complete or not at all
    seconds : the times of programs by name, ``{"mine": 3.2}``
    The other parameters are those of :func:`check`.
    """
    paths = [os.fspath(one) for one in candidates]
    names = _exactff.program_names(paths)
    times = dict(seconds or {})
    for name in times:
        if name not in names:
            refuse(f"seconds names {name!r}", "there is no such program", f"the programs are {', '.join(names)}")
    if not paths:
        refuse("there are no candidates", "a scoreboard has a row for each", "give their files")
    limits = _exactff.Limits(max_abs, max_rel, rms, eps_b, list((quantiles or {}).items()), per_source, relative_floor,
                             worst)
    matching = _matching(truth_column, value_column, match, tolerance, partial)
    markdown, programs = _exactff.scoreboard(os.fspath(truth), paths, matching, limits, [times.get(n) for n in names],
                                             None if folder is None else os.fspath(folder))
    return Scoreboard({name: _report(report) for name, _, report in programs}, times, markdown)


def _matching(truth_column: str, value_column: str, match: str, tolerance: float,
              partial: bool) -> _exactff.Matching:
    if match not in ("receiver", "position"):
        refuse(f"match is {match!r}", "", "choose 'receiver' or 'position'")
    return _exactff.Matching(truth_column, value_column, match == "position", partial, tolerance)


def _any_numbers(values: Any) -> Any:
    """Candidates of any precision; NaN is theirs to have."""
    array = np.asarray(values)
    if array.dtype.kind not in "iuf" or array.dtype.itemsize > 8:
        refuse(f"values: the type {array.dtype} is not taken", "form factors are real numbers in double precision",
               "convert it yourself: values.astype(numpy.float64)")
    return array.astype(np.float64)


def _arrays_report(truth: Any, values: Any, receivers: Sequence[str], limits: _exactff.Limits,
                   files: _exactff.CheckFiles) -> CheckReport:
    if isinstance(values, (str, os.PathLike)):
        refuse("values is a file, and truth is not", "rows of a file are matched with a truth file",
               "write the truth with exactff.truth, or give arrays")
    candidates = _any_numbers(values)
    if not isinstance(truth, FormFactors):
        exact = _any_numbers(truth)
        certified = np.full(exact.shape, Status.CERTIFIED, np.int8)
        columns = exact.shape[-1] if exact.ndim > 1 else 1
        names = tuple(str(s) for s in range(columns)) if columns > 1 else ("",)
        truth = FormFactors(exact, exact, exact, certified, np.zeros(exact.shape, np.int32), None, names)
    if candidates.shape != truth.value.shape:
        refuse(f"values has the shape {candidates.shape}, and truth {truth.value.shape}", "each value has its truth",
               "give arrays of the same shape")
    table = (-1, len(truth.sources))
    parts = [np.reshape(part, table) for part in (truth.value, truth.lower, truth.upper, truth.status)]
    if receivers and len(receivers) != len(parts[0]):
        refuse(f"receivers has {len(receivers)} names, and there are {len(parts[0])} receivers", "each has one",
               "give as many, or none")
    ids = [name or str(i) for i, name in enumerate(receivers)]
    return _report(_exactff.check_arrays(parts[0], parts[1], parts[2], parts[3], ids, list(truth.sources),
                                         np.ascontiguousarray(candidates).ravel(), limits, files))


def _report(result: Any) -> CheckReport:
    passed, statistics, verdicts, worst, warnings, improvements, message, text = result
    rows, not_finite, leaks, bias, absolute, relative = statistics
    return CheckReport(passed, rows, not_finite, leaks, bias, Distribution(*absolute), Distribution(*relative),
                       tuple(Verdict(*v) for v in verdicts), tuple(RowError(*row) for row in worst), tuple(warnings),
                       tuple(Improvement(*one) for one in improvements), message, json.loads(text))
