"""Scenes from arrays: vertices, faces, patches and materials."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from . import _exactff
from ._arrays import Floats, Ints, numbers, vectors, whole_numbers
from ._errors import refuse
from ._report import Material

MaterialLike = Union[Material, Mapping[str, Any]]


def build(vertices: Any, faces: Any, patch: Any, names: Any, materials: Optional[Mapping[str, MaterialLike]],
          skip_bad_faces: bool) -> _exactff.Scene:
    """Checks the arrays and makes the scene."""
    points = vectors(vertices, "vertices")
    if points.ndim != 2:
        refuse(f"vertices has the shape {points.shape}", "each row is a vertex", "give an array of shape (n, 3)")
    corners, starts = _faces(faces)
    bad = (corners < 0) | (corners >= len(points))
    if bad.any():
        at = int(np.argmax(bad))
        face = int(np.searchsorted(starts, at, side="right")) - 1
        refuse(f"faces[{face}] has the vertex {int(corners[at])}", f"vertices are numbered from 0 to {len(points) - 1}",
               "correct the index")
    patch_of_face, patch_names = _patches(patch, names, len(starts) - 1)
    rows = _materials(materials, patch_names)
    return _exactff.Scene.build(points, corners, starts, patch_of_face, patch_of_face, patch_names, rows,
                                skip_bad_faces)


def _faces(faces: Any) -> tuple[Ints, Ints]:
    """All corners in a row, and where each face begins in it."""
    if not isinstance(faces, np.ndarray):
        faces = list(faces)
        if faces and all(isinstance(one, (int, np.integer)) for one in faces):
            faces = np.array(faces)
        elif len({np.size(face) for face in faces}) == 1:
            faces = whole_numbers(faces, "faces")
    if isinstance(faces, np.ndarray) and faces.ndim == 1 and faces.dtype != object:
        return _padded_faces(whole_numbers(faces, "faces"))
    if isinstance(faces, np.ndarray) and faces.ndim == 2:
        table = whole_numbers(faces, "faces")
        lengths: Ints = np.full(len(table), table.shape[1])
        corners: Ints = table.ravel()
    else:
        lengths = np.array([np.size(face) for face in faces], dtype=np.int64)
        corners = whole_numbers([corner for face in faces for corner in _row(face)], "corners of faces")
    few = np.flatnonzero(lengths < 3)
    if few.size:
        refuse(f"faces[{int(few[0])}] has {int(lengths[few[0]])} vertices", "a face has at least 3", "remove it")
    return corners, np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)


def _row(face: Any) -> Any:
    if np.ndim(face) != 1:
        refuse(f"the face {face!r} is no row of vertices", "a face is a row of vertex indices",
               "give one row for each face")
    return face


def _padded_faces(row: Ints) -> tuple[Ints, Ints]:
    """Faces as PyVista and VTK keep them: the number of corners, the corners, the next number, ..."""
    corners: list[int] = []
    starts, at = [0], 0
    values: Any = row.tolist()
    while at < len(values):
        count = values[at]
        if count < 3 or at + count >= len(values):
            refuse(f"faces[{at}] is {count}, as the number of vertices of face {len(starts) - 1}",
                   "an array of one axis is [n, n vertices, n, ...]", "give an array (m, 3), or a list of rows")
        corners += values[at + 1 : at + 1 + count]
        starts.append(len(corners))
        at += count + 1
    return np.array(corners, np.int64), np.array(starts, np.int64)


def _patches(patch: Any, names: Any, faces: int) -> tuple[Ints, list[str]]:
    """The patch of each face, and the names of the patches."""
    if isinstance(names, str):
        names = [names]
    if patch is None:
        if names is not None and len(names) != 1:
            refuse(f"there are {len(names)} names and no patch of each face", "faces belong to patches",
                   "give patch=, an integer for each face")
        return np.zeros(faces, np.int64), list(names or ["default"])
    column = np.asarray(patch)
    if column.dtype.kind == "U":
        words: Any = column.tolist()
        listed: list[str] = list(dict.fromkeys(words))
        index = {name: i for i, name in enumerate(listed)}
        result = np.array([index[name] for name in words], np.int64)
    else:
        result, listed = _numbered(whole_numbers(patch, "patch"), names)
    if result.shape != (faces,):
        refuse(f"patch has the shape {result.shape}, and there are {faces} faces", "it gives the patch of each face",
               "give one integer, or name, for each face")
    return result, listed


def _numbered(column: Ints, names: Any) -> tuple[Ints, list[str]]:
    numbers_used, result = np.unique(column, return_inverse=True)
    if names is None:
        return result.reshape(column.shape).astype(np.int64), [f"patch_{n}" for n in numbers_used]
    table: Mapping[int, str] = names if isinstance(names, Mapping) else dict(enumerate(names))
    missing = [int(n) for n in numbers_used if int(n) not in table]
    if missing:
        refuse(f"patch {missing[0]} has no name", "names gives a name for each number in patch",
               f"give {missing[0] + 1} names, or a dict" if missing[0] >= 0 else "number patches from 0")
    listed = [table[int(n)] for n in numbers_used]
    return result.reshape(column.shape).astype(np.int64), listed


def _materials(materials: Optional[Mapping[str, MaterialLike]],
               patches: Sequence[str]) -> list[tuple[str, list[float], list[float]]]:
    """A material for each patch."""
    given = dict(materials or {})
    for name in given:
        if name not in patches:
            refuse(f"materials: there is no patch {name!r}", "a material belongs to a patch",
                   f"choose from {list(patches)}")
    return [_material(name, given.get(name, Material())) for name in patches]


def _material(patch: str, given: MaterialLike) -> tuple[str, list[float], list[float]]:
    if isinstance(given, Mapping):
        unknown = set(given) - {"reflectance", "radiosity", "name"}
        if unknown:
            refuse(f"materials[{patch!r}] has {sorted(unknown)}", "a material has reflectance, radiosity and name",
                   "remove the others")
        given = Material(**given)
    return (given.name or patch, _colour(given.reflectance, f"reflectance of {patch!r}", 1.0),
            _colour(given.radiosity, f"radiosity of {patch!r}", np.inf))


def _colour(value: Any, name: str, most: float) -> list[float]:
    array: Floats = numbers(value, name)
    if array.shape not in ((), (1,), (3,)):
        refuse(f"{name} has the shape {array.shape}", "it is one number, or three for red, green and blue",
               "give one or three")
    if (array < 0.0).any() or (array > most).any():
        refuse(f"{name} is {value!r}", f"it is {'from 0 to 1' if most == 1.0 else 'at least 0'}", "correct it")
    return [float(c) for c in np.broadcast_to(array, (3,))]
