"""What users give: arrays, of which nothing is rounded without a word, files, progress; and errors and warnings."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import math
import os
import sys
import time
import warnings
from types import FrameType
from typing import Any, Callable, Iterator, Literal, NamedTuple, NoReturn, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _exactff


class Problem(NamedTuple):
    """One problem in the input: where it is, what is wrong, why it matters, and what to do. Parts may be empty."""

    file: str
    line: int
    what: str
    why: str
    suggestion: str
    message: str


class InputError(ValueError):
    """Bad input: a file, an array, a name or an option. ``str(error)`` has one line for each problem."""

    _problems: tuple[tuple[str, int, str, str, str, str], ...] = ()

    @property
    def problems(self) -> tuple[Problem, ...]:
        """All problems that were found, in the order of the input."""
        return tuple(Problem(*fields) for fields in self._problems)


class ModellingWarning(UserWarning):
    """The input is legal, but may not be what was meant: a point a hair behind its floor, say. Also: a value that is
    not certified."""


_exactff._set_input_error(InputError)


def refuse(what: str, why: str = "", suggestion: str = "") -> NoReturn:
    """Raises an InputError in the wording of the library."""
    message = what + (f" ({why})" if why else "") + (f"; {suggestion}" if suggestion else "")
    error = InputError(message)
    error._problems = (("", 0, what, why, suggestion, message),)
    raise error


def warn(message: str) -> None:
    """Warns at the line of the user's program that called into the package."""
    frame: Optional[FrameType] = sys._getframe(1)
    level = 2
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, ModellingWarning, stacklevel=level)


Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Names = Union[str, Sequence[str], None]

_LARGEST_WHOLE = 2**53  # every smaller whole number is a double


def _place(name: str, where: tuple[Any, ...]) -> str:
    return f"{name}[{', '.join(str(int(i)) for i in where)}]" if where else name


def _first(name: str, bad: NDArray[np.bool_]) -> str:
    return _place(name, tuple(np.argwhere(bad)[0]))


def _array(value: Any, name: str) -> NDArray[Any]:
    if isinstance(value, np.ma.MaskedArray) and np.any(np.asarray(value.mask)):
        refuse(f"{name}: the array has masked elements", "a masked element has no value", "give an array without them")
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        refuse(f"{name}: the rows have different lengths, or are no numbers", "an array is needed",
               "give equal rows of numbers")
    return array


def _refuse_type(array: NDArray[Any], name: str) -> None:
    why = {"c": "a coordinate is a real number", "b": "a truth value is no coordinate",
           "O": "elements may be numbers of any kind, or rows of different lengths", "U": "text is no number",
           "S": "text is no number", "M": "a date is no number", "m": "a duration is no number",
           "f": "it would be rounded to double precision"}.get(array.dtype.kind, "it holds no numbers")
    refuse(f"{name}: the type {array.dtype} is not taken", why, f"convert it yourself: {name}.astype(numpy.float64)")


def numbers(value: ArrayLike, name: str) -> Floats:
    """The same numbers as float64, finite; refuses types whose numbers would be rounded."""
    array = _array(value, name)
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind in "iu" and (size > 4):
        large = (array > _LARGEST_WHOLE) | (array < -_LARGEST_WHOLE) if kind == "i" else array > _LARGEST_WHOLE
        if large.any():
            refuse(f"{_first(name, large)} is a whole number beyond 2^53", "not every such number is a double",
                   f"convert it yourself: {name}.astype(numpy.float64)")
    elif kind not in "iuf" or size > 8:
        if not (array.size == 0 and kind == "O"):
            _refuse_type(array, name)
    result = np.require(array, np.float64, ["ALIGNED"])
    finite = np.isfinite(result)
    if not finite.all():
        refuse(f"{_first(name, ~finite)} is {result[~finite][0]}", "a coordinate is a finite number",
               "remove such rows, or correct them")
    return result


def vectors(value: ArrayLike, name: str) -> Floats:
    """An array (..., 3)."""
    array = numbers(value, name)
    if array.ndim == 0 or array.shape[-1] != 3:
        refuse(f"{name} has the shape {array.shape}", "each row is x, y, z", "give an array of shape (n, 3)")
    return array


Measure = Literal["form-factor", "solid-angle", "overcast"]


def measure_tuple(measure: str, up: ArrayLike, sphere: bool) -> tuple[str, tuple[float, float, float], bool]:
    """Checks what is integrated."""
    if measure not in ("form-factor", "solid-angle", "overcast"):
        refuse(f"measure is {measure!r}", "", "choose 'form-factor', 'solid-angle' or 'overcast'")
    x, y, z = (float(c) for c in vectors(up, "up").reshape(-1, 3)[0])
    return measure, (x, y, z), sphere


def receivers(points: ArrayLike, normals: Optional[ArrayLike]) -> tuple[tuple[int, ...], Floats, Floats]:
    """The shape that both have together without the last axis, and both as (n, 3). Without normals they are 0."""
    if normals is None:
        p = vectors(points, "points")
        rows = _rows(p, p.shape[:-1], (3,))
        return p.shape[:-1], rows, np.zeros_like(rows)
    p, n = vectors(points, "points"), vectors(normals, "normals")
    zero = np.asarray(~n.any(axis=-1))
    if zero.any():
        refuse(f"{_first('normals', zero)} is zero", "a receiver looks along its normal", "give it a direction")
    try:
        shape = np.broadcast_shapes(p.shape[:-1], n.shape[:-1])
    except ValueError:
        refuse(f"points {p.shape} and normals {n.shape} do not fit together", "each point has a normal",
               "give as many normals as points, or one for all")
    return shape, _rows(p, shape, (3,)), _rows(n, shape, (3,))


def _rows(array: NDArray[Any], shape: tuple[int, ...], row: tuple[int, ...]) -> NDArray[Any]:
    whole = np.broadcast_to(array, shape + row)
    return whole if len(shape) == 1 else whole.reshape((math.prod(shape),) + row)


def whole_numbers(value: Any, name: str) -> Ints:
    """The same numbers as int64; refuses other types than integers."""
    array = _array(value, name)
    if array.size == 0 and array.dtype.kind in "fO":
        array = array.astype(np.int64)
    if array.dtype.kind not in "iu":
        refuse(f"{name}: the type {array.dtype} is not taken", "indices are whole numbers",
               "give an array of integers")
    if array.dtype.kind == "u" and array.size and int(array.max()) > np.iinfo(np.int64).max:
        refuse(f"{name} has an index of {int(array.max())}", "there are not so many", "check the array")
    return np.require(array, np.int64, ["ALIGNED"])


def face_rows(value: Ints, shape: tuple[int, ...], faces: int) -> Ints:
    """Own faces of each receiver as (n, k), from an array of the receivers' shape, or with one more axis; -1: none."""
    if value.size and (int(value.max()) >= faces or int(value.min()) < -1):
        bad = (value >= faces) | (value < -1)
        refuse(f"{_first('on', bad)} is {value[bad][0]}",
               f"faces are numbered from 0 to {faces - 1}; -1 stands for none", "check the array")
    try:
        if value.ndim <= len(shape):
            return _rows(value[..., np.newaxis], shape, (1,))
        return _rows(value, shape, (value.shape[-1],))
    except ValueError:
        refuse(f"on has the shape {value.shape}, and there are receivers of shape {shape}",
               "it gives the faces of each receiver", "give an array of the same shape, or with one more axis")


def thread_count(threads: int) -> int:
    """Checks the number of threads."""
    if not isinstance(threads, (int, np.integer)) or isinstance(threads, bool) or not 0 <= threads <= 4096:
        refuse(f"threads is {threads!r}", "it is a whole number up to 4096; 0: as many as this process may use",
               "leave it at 0")
    return int(threads)


Path = Union[str, "os.PathLike[str]"]


def check_existing(existing: str) -> None:
    """Refuses other words than "refuse" and "replace"."""
    if existing not in ("refuse", "replace"):
        refuse(f"existing is {existing!r}", "", "choose 'refuse' or 'replace'")


def require_free(path: Path, existing: str, read: Sequence[Path] = ()) -> None:
    """Refuses a file that exists, unless it may be replaced; and always one that was read."""
    name = os.fspath(path)
    if not os.path.isfile(name):
        return
    if any(os.path.samefile(name, file) for one in read for file in _read_with(os.fspath(one))):
        refuse(f"{name}: is read and would be replaced", "its contents would be lost", "name another file")
    if existing != "replace":
        refuse(f"{name}: already exists", "it may hold something else",
               "name another file, or replace it with existing='replace'")


def require_table(path: Path) -> None:
    """Refuses other extensions than those of tables."""
    if os.path.splitext(os.fspath(path))[1] not in (".csv", ".npz", ".jsonl"):
        refuse(f"{os.fspath(path)}: cannot hold a table", "the extension says how it is written",
               "name a file .csv, .npz or .jsonl")


def _read_with(path: str) -> Iterator[str]:
    """The file and, of an OBJ file, its MTL files, as far as they still exist."""
    if not os.path.isfile(path):
        return
    yield path
    if not path.lower().endswith(".obj"):
        return
    with open(path, encoding="utf-8", errors="surrogateescape") as lines:
        for line in lines:
            if line.lstrip().startswith("mtllib"):
                names = line.strip()[len("mtllib"):].strip()
                for name in {names, *names.split()}:
                    library = os.path.join(os.path.dirname(path), name)
                    if os.path.isfile(library):
                        yield library


Progress = Union[None, bool, Callable[[int, int], object]]
_Tell = Optional[Callable[[int, int], object]]

_PATIENCE = 1.0  # seconds before a bar appears


class _Bar:
    def __init__(self, unit: str, at_once: bool) -> None:
        self._unit = unit
        self._start = time.monotonic() - (_PATIENCE if at_once else 0.0)
        self._bar: Any = None

    def __call__(self, done: int, total: int) -> None:
        if self._bar is None:
            if time.monotonic() - self._start < _PATIENCE:
                return
            self._bar = importlib.import_module("tqdm.auto").tqdm(total=total, unit=self._unit)
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def _has_tqdm() -> bool:
    return importlib.util.find_spec("tqdm") is not None


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextlib.contextmanager
def shown(progress: Progress, unit: str) -> Iterator[_Tell]:
    """What to call with (done, total): a function of the user's, a bar, or nothing."""
    if callable(progress):
        yield progress
        return
    if progress is False or (progress is None and not (_is_watched() and _has_tqdm())):
        yield None
        return
    if not _has_tqdm():
        refuse("progress=True needs tqdm, which is not installed", "it draws the bar",
               "install python3-tqdm, or give a function of (done, total)")
    bar = _Bar(unit, at_once=progress is True)
    try:
        yield bar
    finally:
        bar.close()
