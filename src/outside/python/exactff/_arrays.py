"""From what users give to arrays that the compiled module takes. Nothing is rounded without a word."""

from __future__ import annotations

import math
from typing import Any, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import refuse

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


def receivers(points: ArrayLike, normals: ArrayLike) -> tuple[tuple[int, ...], Floats, Floats]:
    """The shape that both have together without the last axis, and both as (n, 3)."""
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
