"""Materials, patches and receivers of scenes, and the findings of `Scene.report`."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _exactff
from ._arguments import Floats, Ints, numbers, refuse, vectors, whole_numbers


class Material(NamedTuple):
    """Reflectance (Kd, a pure number) and radiosity (Ke, not a radiance: no factor pi), per colour channel."""

    reflectance: tuple[float, float, float] = (1.0, 1.0, 1.0)
    radiosity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    name: str = ""


class Patch(NamedTuple):
    """A named set of faces."""

    name: str
    faces: tuple[int, ...]  #: indices of its faces, ignored ones included
    area: float  #: in the square of the scene's unit of length; an estimate
    front: Optional[tuple[float, float, float]]  #: mean unit normal; None if the faces have different directions
    materials: tuple[Material, ...]
    emits: bool
    centre: tuple[float, float, float]  #: of its area; an estimate
    low: tuple[float, float, float]  #: the lowest coordinates of its faces with area
    high: tuple[float, float, float]  #: the highest


class Gap(NamedTuple):
    """How far apart corners are that should be one."""

    length: float  #: the smallest one with which `Scene.welded` leaves the fewest open edges, to about two digits
    open_edges_before: int
    open_edges: int


class Welding(NamedTuple):
    """What :meth:`Scene.welded` did."""

    scene: Any  #: the new :class:`Scene`
    corners_before: int  #: positions of corners
    corners: int
    largest_move: float
    junctions: int  #: corners added to edges of faces
    vanished: tuple[str, ...]  #: faces that have no area any more
    sheets: tuple[tuple[str, str, float], ...]  #: faces that lie closer than the length, face to face, and how far apart


class Finding(NamedTuple):
    """A likely slip of modelling, and what mends it."""

    kind: str  #: such as ``unseen-front``
    message: str
    objects: tuple[str, ...]  #: names of patches or faces
    #: for the program, such as ``--flip lamp``: in Python, ``scene.with_flipped("lamp")``; empty if none helps
    flag: str


class Contact(NamedTuple):
    """A part of a patch that a closed solid lies on: it neither sends nor receives light."""

    patch: str
    under: str  #: the patch of the solid's faces
    area: float  #: in the square of the scene's unit of length; an estimate
    share: float  #: of the patch's area


class Report(NamedTuple):
    """What ``exactff info`` says of a scene. ``print(report)`` shows a table."""

    patches: tuple[Patch, ...]
    emitters: tuple[str, ...]
    face_count: int
    vertex_count: int
    not_planar: tuple[str, ...]  #: faces that are not exactly planar, and were cut into triangles
    ignored: tuple[str, ...]  #: faces without area
    left_out: tuple[str, ...]  #: unusable faces (``skip_bad_faces=True``)
    open_edges: int  #: edges that an odd number of faces use; a closed solid has none
    findings: tuple[Finding, ...]
    warnings: tuple[str, ...]
    contacts: tuple[Contact, ...] = ()  #: the largest first
    gap: Optional[Gap] = None  #: None if no length closes anything

    def __str__(self) -> str:
        lines = _table([("patch", "faces", "area", "front", "emits"), *map(_patch_row, self.patches)])
        lines += ["", f"{len(self.patches)} patches, {self.face_count} faces, {self.vertex_count} vertices",
                  _listed("emitters", self.emitters),
                  _listed("not exactly planar, cut into triangles", self.not_planar),
                  _listed("zero area, ignored", self.ignored), _listed("unusable, left out", self.left_out),
                  f"open edges: {self.open_edges}"]
        if self.gap:
            lines.append(f"gap: corners that should be one are up to {self.gap.length:.6g} apart; scene.welded("
                         f"{self.gap.length!r}) leaves {self.gap.open_edges} of {self.gap.open_edges_before} open edges")
        lines += [f"contact: {one.share:.3g} of {one.patch} is buried under {one.under}" for one in self.contacts]
        about_contacts = {"on-open-floor", "no-bottom", "near-contact", "overlapping-solids"}
        lines += [f"{'note' if finding.kind in about_contacts else 'check'}: {finding.message}" for finding in self.findings]
        lines += [f"warning: {warning}" for warning in self.warnings]
        return "\n".join(lines)


def _patch_row(patch: Patch) -> tuple[str, ...]:
    front = "mixed" if patch.front is None else "({:.4g}, {:.4g}, {:.4g})".format(*(c + 0.0 for c in patch.front))
    return patch.name, str(len(patch.faces)), f"{patch.area:.6g}", front, "yes" if patch.emits else "no"


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]


def _listed(title: str, items: Sequence[str], most: int = 12) -> str:
    rest = f" and {len(items) - most} more" if len(items) > most else ""
    return f"{title}: {', '.join(items[:most]) or 'none'}{rest}"


class Receivers:
    """Points with normals, and the faces they lie on. Made by :meth:`Scene.receivers`, :meth:`Scene.read_receivers`
    and :meth:`Scene.receivers_at`; ``scene.form_factors(r.points, r.normals, on=r.on)`` computes their values."""

    def __init__(self, made: _exactff.ReceiverList, name: str) -> None:
        self._list = made
        self.name = name  # in the header of truth files

    def __len__(self) -> int:
        return len(self._list)

    @property
    def points(self) -> Floats:
        """(n, 3), in the scene's unit of length."""
        return self._list.points()

    @property
    def normals(self) -> Floats:
        """(n, 3), exact and of any length: those of receivers on a face are as long as its area. See `unit_normals`."""
        return self._list.normals()

    @property
    def unit_normals(self) -> Floats:
        """(n, 3): the normals scaled to length 1, each component correctly rounded. For other programs; exact form factors
        belong to `normals`."""
        return self._list.unit_normals()

    @property
    def on(self) -> Ints:
        """(n, k): indices of the faces that each receiver lies on, filled up with -1."""
        return self._list.on()

    @property
    def ids(self) -> Sequence[str]:
        """A name for each, such as ``r7c12``: row 7, column 12 of a grid. May be empty."""
        return self._list.ids()

    def __repr__(self) -> str:
        return f"<exactff.Receivers: {len(self)}, {self.name}>"


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
    return make(points, corners, starts, patch_of_face, patch_names, materials, skip_bad_faces)


def make(points: Floats, corners: Ints, starts: Ints, patch_of_face: Ints, patch_names: list[str],
         materials: Optional[Mapping[str, MaterialLike]], skip_bad_faces: bool) -> _exactff.Scene:
    """The scene of arrays that are checked; each patch has a material."""
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
    if isinstance(patch, str):
        refuse(f"the patch of each face is {patch!r}", "its letters would be the names of the faces",
               f"give one integer, or name, for each face; for a single patch, names={patch!r} alone")
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


class Lightmap(NamedTuple):
    """The texels that show faces. ``image[m.rows, m.columns] = values`` draws values at its receivers; row 0 is at v = 1."""

    receivers: Receivers  #: at the points that the texels' centres stand for, with ids such as ``x4y2``
    rows: Ints
    columns: Ints
    faces: int  #: with texture coordinates
    without: int  #: faces without; they are left out
    flat: int  #: faces without area in the texture
    outside: int  #: faces with a corner outside of 0 to 1
    missed: int  #: other faces that no texel shows
    overlapping: int  #: texels strictly inside several triangles; they show the lowest face
