"""Scenes, and the form factors in them."""

from __future__ import annotations

import operator
import os
from typing import Any, Literal, Mapping, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _arguments, _exactff, _geometry, _meshes
from ._arguments import check_existing, Floats, Ints, Measure, Names, Progress, refuse, require_free, shown, warn
from ._geometry import Contact, Finding, Gap, Lightmap, Material, Patch, Receivers, Report, Welding
from ._pair import _Again, FormFactor, FormFactors, Status

#: Own faces: None, "auto", "auto:DISTANCE", a name ("floor", "floor:2", "floor:1+2"), indices of faces, or a list of
#: these for each receiver.
On = Union[None, str, int, ArrayLike, Sequence[Any]]

_MOST_LOOKED_AT = 10_000  # receivers, for near misses
_MOST_BITS = 1 << 24


class Scene:
    """Named patches of planar polygonal faces with materials. Immutable; threads may share it.

    Coordinates are float64, in any unit of length, and each means exactly the value of its double. The front of a face
    is the side from which its vertices run counter-clockwise. A source emits from its front; an occluder blocks light
    from both sides.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) or (m, 4) integers, rows of different lengths, or PyVista's padded array ``mesh.faces``
    patch : an integer, or a name, for each face; without it, all faces are one patch
    names : names of the patches, as a list or a dict by the integers in `patch`; default ``patch_N``
    materials : a dict by patch name of :class:`Material`, or of dicts with ``reflectance`` (Kd, default 1) and
        ``radiosity`` (Ke, default 0); one number each, or three for red, green and blue
    skip_bad_faces : leave out unusable faces (self-crossing, say) with a warning instead of raising

    Raises InputError with all problems.
    """

    _scene: _exactff.Scene
    #: How far corners of cells lie from where they belong, at most, in a scene made by `divided`.
    largest_deviation: float = 0.0
    _read: tuple[str, ...] = ()  # files that the scene was read from

    def __init__(self, vertices: ArrayLike, faces: Any, patch: Any = None, names: Any = None,
                 materials: Optional[Mapping[str, Union[Material, Mapping[str, Any]]]] = None, *,
                 skip_bad_faces: bool = False) -> None:
        self._take(_geometry.build(vertices, faces, patch, names, materials, skip_bad_faces), "arrays")

    def _take(self, scene: _exactff.Scene, name: str) -> None:
        self._scene = scene
        self.name = name
        for warning in scene.warnings():
            warn(warning)

    @classmethod
    def _made(cls, scene: _exactff.Scene, name: str) -> Scene:
        made = cls.__new__(cls)
        made._take(scene, name)
        return made

    @classmethod
    def read(cls, path: Union[str, os.PathLike[str]], *, patches: str = "groups",
             skip_bad_faces: bool = False, unit: str = "") -> Scene:
        """Reads an OBJ, glTF, PLY, STL, OFF or View3D file, or several of them as ``"a.stl+b.glb"``. `patches` says
        what a patch is: see `with_patches`. `unit` ("mm", "cm", "m", "in", "ft") is that of files that state none.

        Raises InputError with every problem and its line. Warnings of the file are ModellingWarning."""
        file = os.path.abspath(os.fspath(path))
        scene = cls._made(_exactff.Scene.read(os.fspath(path), patches, skip_bad_faces, unit), os.path.basename(file))
        scene._read = tuple(os.path.abspath(name) for name in scene._scene.files())
        return scene

    @classmethod
    def from_model(cls, text: str, *, patches: str = "groups") -> Scene:
        """A generated scene, such as ``"teapot:segments=8"``; ``exactff info @`` lists the models. The same text gives
        the same bits on every machine."""
        return cls._made(_exactff.Scene.from_model(text, patches), "@" + text)

    @classmethod
    def from_mesh(cls, points: Any, cells: Any = None, patches: Any = None, names: Any = None,
                  materials: Optional[Mapping[str, Union[Material, Mapping[str, Any]]]] = None, *,
                  skip_bad_faces: bool = False) -> Scene:
        """A scene from a mesh: surface cells as they are, of volume cells the outer faces, with their fronts outward.

        Parameters
        ----------
        points : (n, 3), or (n, 2) with z = 0, in any unit of length. Or, without `cells`, an object with ``points`` or
            ``vertices`` and ``faces``, as of PyVista and trimesh; or a meshio.Mesh. Points of no face are left out
        cells : faces as in :class:`Scene`; or blocks ``[(type, (m, k) integers), ...]`` by meshio's names of types:
            triangle, quad, polygon, tetra, pyramid, wedge, hexahedron, and curved ones (triangle6, tetra10, ...), of
            which the corners count, with a warning. Lines and vertices are left out
        patches : an integer, or a name, for each cell, or such an array for each block; default: one patch
        names, materials, skip_bad_faces : as in :class:`Scene`

        An outer face is one that a single volume cell has, by the indices of its corners. Its patch is that of the surface
        cell with the same corners, which it replaces, or else of its volume cell. Surface cells between two volume cells
        stay, with a warning. No bit of a coordinate changes.

        Raises InputError for wrong indices, points that are not finite, unknown types, a volume cell that is there twice,
        and a face of three volume cells."""
        if cells is None:
            if hasattr(points, "cell_sets"):
                return cls.from_meshio(points, patches, names, materials, skip_bad_faces=skip_bad_faces)
            points, cells = _meshes.points_and_faces(points)
        return cls._made(_meshes.build(points, cells, patches, names, materials, skip_bad_faces), "mesh")

    @classmethod
    def from_meshio(cls, mesh: Any, patches: Optional[str] = None, names: Any = None,
                    materials: Optional[Mapping[str, Union[Material, Mapping[str, Any]]]] = None, *,
                    skip_bad_faces: bool = False) -> Scene:
        """A scene from a meshio.Mesh, or from a file that meshio reads (package python3-meshio): Gmsh, Abaqus, CalculiX,
        Nastran, VTK, MED, Exodus and others. Faces are those of `from_mesh`.

        Parameters
        ----------
        patches : the name of integer cell data, or "sets" for cell sets and element sets. Default: physical groups of
            Gmsh, else sets, else numbers that formats have for groups (Nastran's properties), else the first integers
            that repeat, with a warning; else one patch
        names : names of the integers, as a list or a dict. Default: those of physical groups, else for example ``ref_7``

        A cell of several sets belongs to the smallest, with a warning; cells of none are the patch ``default``. What meshio
        does not read (side sets of Exodus, ``*SURFACE`` of Abaqus) is lost. Raises InputError."""
        is_file = isinstance(mesh, (str, os.PathLike))
        file = os.path.abspath(os.fspath(mesh)) if is_file else ""
        made = _meshes.build_meshio(_meshes.read(mesh) if is_file else mesh, patches, names, materials, skip_bad_faces)
        scene = cls._made(made, os.path.basename(file) if is_file else "mesh")
        scene._read = (file,) if is_file else ()
        return scene

    # --- what it contains ---

    @property
    def vertices(self) -> Floats:
        """(n, 3): all vertices. A copy."""
        return self._scene.vertices()

    @property
    def patches(self) -> tuple[Patch, ...]:
        """The patches: name, faces, area, front, materials."""
        return tuple(_patch(row) for row in self._scene.patches())

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the patches."""
        return tuple(row[0] for row in self._scene.patches())

    @property
    def emitters(self) -> tuple[str, ...]:
        """The names of the patches that emit: the sources, if none are named."""
        return tuple(self._scene.emitters())

    @property
    def areas(self) -> Floats:
        """(m,): areas of the faces, in the square of the unit of length. Estimates."""
        return self._scene.areas()

    @property
    def fronts(self) -> Floats:
        """(m, 3): unit normals of the faces. Estimates; 0 for a face without area."""
        return self._scene.fronts()

    @property
    def patch_of_face(self) -> Ints:
        """(m,): index into `patches`."""
        return self._scene.patch_of_face()

    def rings(self, face: int) -> list[list[int]]:
        """The vertices of a face: the outer ring, then its holes."""
        return self._scene.rings(face)

    def texture(self, face: int, uv: int = 0) -> Floats:
        """Texture coordinates of a face, (n, 2): one row for each corner, through all rings; none if it has none."""
        return self._scene.texture(face, _set(uv))

    def face_name(self, face: int) -> str:
        """``NAME:k``, or ``NAME`` for a patch of one face."""
        return self._scene.face_name(face)

    def faces_of(self, name: str) -> list[int]:
        """Indices of the faces of ``NAME``, ``NAME:k`` or a pattern, without ignored ones."""
        return self._scene.faces_of(name)

    @property
    def unit(self) -> str:
        """The unit of length: "mm", "cm", "m", "in", "ft", or "" if none is known."""
        return self._scene.unit()

    @property
    def hash(self) -> str:
        """16 hexadecimal digits: a hash of everything that affects values."""
        return self._scene.hash()

    def report(self) -> Report:
        """What ``exactff info`` says: the patches, and likely slips of modelling. No value depends on it."""
        scene = self._scene
        return Report(patches=self.patches, emitters=self.emitters, face_count=scene.face_count(),
                      vertex_count=len(self.vertices), not_planar=tuple(scene.faces_of_shape(1)),
                      ignored=tuple(scene.faces_of_shape(2)), left_out=tuple(scene.faces_of_shape(3)),
                      open_edges=scene.open_edges(),
                      findings=tuple(Finding(kind, message, tuple(objects), flag)
                                     for kind, message, objects, flag in scene.findings()),
                      warnings=tuple(scene.warnings()),
                      contacts=tuple(Contact(*one) for one in scene.contacts()), gap=self.gap())

    def write(self, path: Union[str, os.PathLike[str]], *, encoding: Literal["default", "text", "binary"] = "default",
              existing: Literal["refuse", "replace"] = "refuse") -> None:
        """Writes the scene as ``exactff convert`` does; the extension is .obj (with .mtl), .ply, .stl, .off or .vs3.

        Doubles are kept, except in binary STL. `encoding` is for PLY (default: binary) and STL (default: text). What the
        format cannot hold, such as materials, is a ModellingWarning. A file appears complete or not at all. Raises
        InputError for another extension, for a file that exists unless ``existing="replace"``, and always for a file that
        this scene was read from."""
        check_existing(existing)
        if encoding not in ("default", "text", "binary"):
            refuse(f"encoding is {encoding!r}", "", "choose 'default', 'text' or 'binary'")
        for loss in self._scene.write(os.fspath(path), encoding, lambda file: require_free(file, existing, self._read)):
            warn(loss)

    # --- other scenes ---

    def with_unit(self, unit: str) -> Scene:
        """The same scene with its unit of length stated: "mm", "cm", "m", "in" or "ft". No coordinate changes;
        temperatures and conductors for ESATAN depend on it."""
        return self._changed(lambda _: self._scene.with_unit(unit), [unit])

    def with_flipped(self, *names: Union[str, Sequence[str]]) -> Scene:
        """The same scene with these patches or faces turned round: their fronts become their backs. Give names, patterns
        or lists of them; "all" is every patch."""
        return self._changed(self._scene.with_flipped, names)

    def with_transparent(self, *names: Union[str, Sequence[str]]) -> Scene:
        """The same scene with these patches or faces transparent: they hide nothing. They may still be sources, and
        have receivers on them. Names as in `with_flipped`."""
        return self._changed(self._scene.with_transparent, names)

    def with_two_sided(self, *names: Union[str, Sequence[str]]) -> Scene:
        """The same scene with the backs of these patches or faces as further patches, ``NAME (back)``: every face gets a
        twin that is turned round. Factors between other patches stay the same numbers, perhaps in other intervals; what
        met the backs meets the twins. Names as in `with_flipped`."""
        return self._changed(lambda listed: _exactff.with_two_sided(self._scene, listed), names)

    def with_patches(self, patches: str) -> Scene:
        """The same scene with other patches: "groups" (as they are), "faces" (``NAME:k``), or patches ``NAME/1``,
        ``NAME/2``, ... of each patch by falling area: "planes" (connected faces in exactly one plane), "smooth" or
        "smooth:DEGREES" (connected faces whose fronts differ by less; default 30), "parts" (connected faces). Names do
        not depend on the order of faces. Raises InputError."""
        return self._changed(lambda _: self._scene.with_patches(patches), ("all",))

    def with_names(self, names: Mapping[str, str]) -> Scene:
        """The same scene in which the faces that a selector finds are a patch of that name: ``{"left fin":
        "box:0,0,0,1,20,30"}``. Selectors: ``box:X0,Y0,Z0,X1,Y1,Z1``, ``normal:X,Y,Z[:DEGREES]``,
        ``plane:A,B,C,D[:DISTANCE]``, ``PATCH:1-20,25``, ``PATCH``, or several with " & " between. They are about this
        scene; of two that find a face, the later one counts. Warns where a patch has this name and keeps faces. Raises
        InputError if one finds nothing."""
        made = self._changed(lambda _: self._scene.with_names(list(names.items())), ("all",))
        for warning in made._scene.warnings()[len(self._scene.warnings()):]:
            warn(warning)
        return made

    def gap(self) -> Optional[Gap]:
        """How far apart corners are that should be one, so that `welded` with this length closes most; None if no length
        closes anything."""
        found = self._scene.gap()
        return None if found is None else Gap(*found)

    def welded(self, length: float) -> Welding:
        """The scene in which corners that are linked by distances of at most `length` are one, edges almost along an axis
        are parallel to it, and open edges have the corners of others that they pass; with what moved and vanished.
        Welding again changes nothing. Faces never merge. Raises InputError for a length that would move a corner by more
        than eight times of it."""
        made, before, corners, move, junctions, vanished, sheets = self._scene.welded(float(length))
        scene = self._changed(lambda _: made, ("all",))
        return Welding(scene, before, corners, move, junctions, tuple(vanished), tuple(sheets))

    def triangulated(self) -> Scene:
        """The same scene with every face cut into triangles at its own vertices; a face that is not planar becomes the
        triangles that it stands for. No form factor changes. Faces are numbered anew."""
        return self._changed(lambda _: self._scene.triangulated(), ("all",))

    def divided(self, length: float) -> Scene:
        """The same scene with every face cut into cells, no side of which is longer than `length` (but for one part in
        10^9). Cells of ``NAME`` are patches ``NAME:1``, ``NAME:2``, ...: see `cells_of`. All faces along an edge share
        its points, so closed surfaces stay closed. Corners are rounded to doubles; cells that are not exactly planar
        then are triangles."""
        changed = Scene.__new__(Scene)
        changed._scene, changed.largest_deviation = self._scene.divided(float(length))
        changed.name, changed._read = self.name, self._read
        return changed

    def cells_of(self, name: str) -> tuple[str, ...]:
        """The names of the cells of a divided patch, or the name itself if it is a patch or ``NAME:k``."""
        return tuple(self._scene.cells_of(name))

    def _changed(self, change: Any, names: Sequence[Union[str, Sequence[str]]]) -> Scene:
        listed = [name for one in names for name in _arrays_names(one)]
        if not listed:
            return self
        changed = Scene.__new__(Scene)
        changed._scene, changed.name, changed._read = change(listed), self.name, self._read
        return changed

    @property
    def flipped(self) -> tuple[str, ...]:
        """What `with_flipped` has turned."""
        return tuple(self._scene.flipped())

    @property
    def transparent(self) -> tuple[str, ...]:
        """What `with_transparent` has made transparent."""
        return tuple(self._scene.transparent())

    # --- receivers ---

    def receivers(self, on: Union[str, Sequence[str]], *, grid: Union[None, int, tuple[int, int]] = None,
                  vertices: bool = False, centres: bool = False, samples: int = 0, seed: int = 1,
                  per_face: bool = False) -> Receivers:
        """Receivers on patches or faces, as the program's ``--on`` makes them.

        Parameters
        ----------
        on : names ``NAME`` or ``NAME:k``, or patterns; "all" for every patch
        grid : (columns, rows), at the centres of the cells of each region (neighbouring faces in one plane)
        vertices : at every corner of every face
        centres : one in the middle of each region
        samples : so many at random, uniformly by area, by `seed`
        per_face : take each face by itself, with `grid` or `centres`

        Give one of grid, vertices, centres and samples. The receivers remember their own faces
        (:attr:`Receivers.on`), and have names (:attr:`Receivers.ids`). Raises InputError."""
        names = [on] if isinstance(on, str) else list(on)
        if not names:
            refuse("on names no patch", "receivers lie on patches", "name one")
        if (grid is not None) + bool(vertices) + bool(centres) + (samples > 0) != 1:
            refuse("give one of grid, vertices, centres and samples", "each places the receivers in a different way",
                   "for example grid=(32, 32)")
        return Receivers(*_exactff.ReceiverList.on_faces(self._scene, _arrays_names(names), _grid(grid), bool(vertices),
                                                         bool(centres), samples, seed, bool(per_face)))

    def lightmap(self, width: int, height: int, on: Names = None, *, uv: int = 0) -> Lightmap:
        """Receivers at the points of faces that the centres of texels stand for, by texture coordinates, exactly; as
        ``exactff render --lightmap``. `on`: names of patches or faces; None for all. Raises InputError."""
        names = _arrays_names(on)
        if on is not None and not names:
            refuse("on names no patch", "a lightmap shows faces", "name one, or leave it out for all")
        made, texels, *counts = _exactff.ReceiverList.of_lightmap(self._scene, operator.index(width),
                                                                  operator.index(height), _set(uv), names, on is None)
        return Lightmap(Receivers(made, f"{width}x{height} texels"), texels[:, 0], texels[:, 1], *counts)

    def read_receivers(self, path: Union[str, os.PathLike[str]]) -> Receivers:
        """Reads a CSV file with the columns id,x,y,z,nx,ny,nz,on, or a truth file."""
        made = _exactff.ReceiverList.read(self._scene, os.fspath(path))
        return Receivers(made, os.path.basename(os.fspath(path)))

    def receivers_at(self, points: ArrayLike, normals: ArrayLike, on: On = None, ids: Sequence[str] = ()) -> Receivers:
        """Receivers from arrays, for :func:`exactff.truth`."""
        shape, p, n = _arguments.receivers(points, normals)
        if ids and len(ids) != len(p):
            refuse(f"there are {len(ids)} ids and {len(p)} receivers", "each receiver has one", "give as many, or none")
        made = _exactff.ReceiverList.from_arrays(p, n, self._own_faces(on, shape, p, n, 0), list(ids))
        return Receivers(made, "arrays")

    def faces_at(self, points: ArrayLike, normals: ArrayLike, tolerance: Optional[float] = None, *,
                 threads: int = 0) -> Ints:
        """The faces that receivers were probably meant to lie on, as (n, k) indices filled up with -1: those within
        `tolerance` whose normals agree within a degree. An estimate. Default: about 1e-6 of the scene's size."""
        shape, p, n = _arguments.receivers(points, normals)
        found = _exactff.find_faces(self._scene, p, n, tolerance, _arguments.thread_count(threads))
        return found.reshape(shape + found.shape[1:])

    # --- form factors ---

    @overload
    def form_factors(self, points: ArrayLike, normals: Optional[ArrayLike], sources: Names = None, on: On = None, *,
                     threads: int = 0, transparent: Names = None, fraction: Literal[False] = False,
                     gradient: Literal[False] = False, full: Literal[False] = False, progress: Progress = None, precision_cap: int = 65536,
                     measure: Measure = "form-factor", up: ArrayLike = (0.0, 0.0, 1.0)) -> Floats: ...

    @overload
    def form_factors(self, points: ArrayLike, normals: Optional[ArrayLike], sources: Names = None, on: On = None, *,
                     threads: int = 0, transparent: Names = None, fraction: bool = False, gradient: bool = False,
                     full: bool = False, progress: Progress = None, precision_cap: int = 65536,
                     measure: Measure = "form-factor",
                     up: ArrayLike = (0.0, 0.0, 1.0)) -> Union[Floats, FormFactors]: ...

    def form_factors(self, points: ArrayLike, normals: Optional[ArrayLike], sources: Names = None, on: On = None, *,
                     threads: int = 0, transparent: Names = None, fraction: bool = False, gradient: bool = False,
                     full: bool = False, progress: Progress = None, precision_cap: int = 65536,
                     measure: Measure = "form-factor",
                     up: ArrayLike = (0.0, 0.0, 1.0)) -> Union[Floats, FormFactors]:
        """Exact form factors from receivers to sources.

        F is the share of the diffuse light leaving a point that reaches the source directly: the integral over the
        visible part of the source of max(0, cos th_r) max(0, cos th_s) / (pi r^2), a pure number in [0, 1].

        Parameters
        ----------
        points : (n, 3), in the scene's unit of length; any leading shape and any strides
        normals : (n, 3) of any length but 0, or (3,) for all; broadcast against `points`. None: each receiver is a small
            sphere, which sees all directions; its form factor is the solid angle over 4 pi
        sources : names ``NAME`` or ``NAME:k``, or patterns such as ``"lamp_*"`` for all that match; "all" for every patch;
            "sky" for what is open, all directions that meet nothing (unless a patch has this name), without `fraction` and
            `gradient`; default: every patch that emits
        on : own faces, whose planes hold nothing that hides or lights the receiver: None, a name such as "floor" or "floor:1+2" for
            all; "auto" (or "auto:DISTANCE") to find them; an integer array of the receivers' shape, or with one more
            axis for several faces each, where -1 stands for none; or a list with a name, indices or None for each
        threads : 0 for as many as this process may use; no value depends on it
        transparent : patches or faces that hide nothing, here only
        fraction : also compute the visible fractions; implies `full`
        gradient : also compute the derivatives by the receiver's point, per unit of length; implies `full`. Where they
            do not exist (kinks), they are NaN and their status says so
        full : return :class:`FormFactors` with bounds, status and precision
        progress : None for a bar of tqdm on a terminal; True, False, or a function of (done, total)
        precision_cap : the largest precision, in bits
        measure : instead of F, "solid-angle": of what is visible above the horizon, in sr; or "overcast": what the
            receiver gets of the CIE overcast sky behind the visible part, over what open ground gets of all of it (the
            sky component of a daylight factor), in [0, 1]. Not with `gradient`
        up : where the zenith of the overcast sky is; below its horizon there is no sky

        Returns
        -------
        (n, sources) float64. Exact: each is the true F, rounded to the nearest double. Values that could not be
        certified raise a ModellingWarning; ``full=True`` tells which they are.

        Raises InputError for arrays that are not finite or would have to be rounded, and for unknown names.
        KeyboardInterrupt comes within half a second. The GIL is released.

        Source: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III (1992), Eq. (4).
        """
        scene = self if transparent is None else self.with_transparent(*_arrays_names(transparent))
        shape, p, n = _arguments.receivers(points, normals)
        names = self._sources(sources, sky=True)
        count = _arguments.thread_count(threads)
        own = scene._own_faces(on, shape, p, n, count)
        scene._warn_of_misses(p, n, own)
        with shown(progress, "receiver") as tell:
            value, status, lower, upper, bits, share, slope, slope_status = _exactff.form_factors(
                scene._scene, p, n, own, names, full or fraction or gradient, fraction, gradient, _bits(precision_cap),
                count, tell, _arguments.measure_tuple(measure, up, normals is None))
        missing = int(np.count_nonzero(status == Status.NOT_CERTIFIED))
        if missing:
            warn(f"{missing} of {status.size} values are not certified (the precision cap was reached); "
                 "full=True tells which, with valid bounds")
        size = shape + (len(names),)
        if lower is None or upper is None or bits is None:
            return value.reshape(size)
        return FormFactors(value.reshape(size), lower.reshape(size), upper.reshape(size), status.reshape(size),
                           bits.reshape(size), None if share is None else share.reshape(size), tuple(names),
                           None if slope is None else slope.reshape(size + (3,)),
                           None if slope_status is None else slope_status.reshape(size + (3,)))

    def form_factor(self, point: ArrayLike, normal: Optional[ArrayLike], source: Optional[str] = None, on: On = None, *,
                    transparent: Names = None, fraction: bool = False, digits: int = 0,
                    precision_cap: int = 65536, gradient: bool = False, vertices: bool = False,
                    measure: Measure = "form-factor", up: ArrayLike = (0.0, 0.0, 1.0)) -> FormFactor:
        """The exact form factor of one pair, with its proof, an explanation and a drawing.

        Parameters are those of :meth:`form_factors`. `source` may be left out if one patch emits. `digits` raises the
        precision until so many significant digits are proved: ``f.enclosure.decimals(digits)``. ``gradient=True`` sets
        :attr:`FormFactor.gradient`, ``vertices=True`` also its derivatives by the vertices of the scene.
        """
        scene = self if transparent is None else self.with_transparent(*_arrays_names(transparent))
        ask = _Again(scene._scene, *scene._one_receiver(point, normal, on, "form_factor is for one", "use form_factors"),
                     self._source(source), _arguments.measure_tuple(measure, up, normal is None))
        return FormFactor._made(ask(fraction=fraction, digits=digits, precision_cap=_bits(precision_cap),
                                    gradient=gradient, vertices=vertices), ask)

    # --- names and own faces ---

    def _named(self, names: list[str], sky: bool = False) -> list[str]:
        """The names, with all that they match in place of patterns and "all"; and "sky", if it is allowed."""
        if sky and "sky" in names and "sky" not in self.names:
            at = names.index("sky")
            return self._named(names[:at]) + ["sky"] + self._named(names[at + 1:])
        return self._scene.names_like(names)

    def _source(self, name: Optional[str]) -> str:
        if name is None:
            emitters = self.emitters
            if len(emitters) != 1:
                refuse(f"{len(emitters)} patches emit", "without a name, the only patch that emits is the source",
                       "name the source")
            return emitters[0]
        if not isinstance(name, str):
            refuse(f"source is {name!r}", "it is the name of a patch or face", "for example 'light'")
        return name

    def _sources(self, sources: Names, sky: bool = False) -> list[str]:
        if sources is None:
            names = list(self.emitters)
            if not names:
                refuse("no patch of the scene emits", "without sources, every emitting patch is one",
                       "name them: sources=['window']")
            return names
        names = self._named(_arrays_names(sources), sky)
        if not names:
            refuse("sources is empty", "there would be no values", "name a patch, or leave it out")
        twice = [name for i, name in enumerate(names) if name in names[:i]]
        if twice:
            refuse(f"the source {twice[0]!r} is named twice", "its light would count twice", "give it once")
        return names

    def _one_receiver(self, point: ArrayLike, normal: Optional[ArrayLike], on: On, why: str,
                      advice: str) -> tuple[tuple[float, ...], tuple[float, ...], list[int]]:
        shape, p, n = _arguments.receivers(point, normal)
        if shape != ():
            refuse(f"there are receivers of shape {shape}", why, advice)
        own = self._own_faces(on, shape, p, n, 1)
        self._warn_of_misses(p, n, own)
        return tuple(p[0].tolist()), tuple(n[0].tolist()), [int(f) for f in own[0] if f >= 0]

    def _own_faces(self, on: On, shape: tuple[int, ...], p: Floats, n: Floats, threads: int) -> Ints:
        """(receivers, k) indices, -1 for none."""
        if on is None:
            return np.empty((len(p), 0), np.int64)
        if isinstance(on, str):
            tolerance = self._automatic(on)
            if tolerance is not False:
                if len(n) and not n.any():
                    refuse(f"on is {on!r} without normals", "it finds a face whose normal is the receiver's",
                           "name the face")
                return self._found(tolerance, p, n, threads)
            faces = np.array(self._scene.own_faces(on), np.int64)
            return np.broadcast_to(faces, (len(p), len(faces)))
        if isinstance(on, (list, tuple)) and any(not isinstance(one, (int, np.integer)) for one in on):
            return self._listed(on, shape)
        return _arguments.face_rows(_arguments.whole_numbers(on, "on"), shape, self._scene.face_count())

    def _automatic(self, on: str) -> Union[None, float, Literal[False]]:
        """The tolerance of "auto" or "auto:DISTANCE" (None: the default); False for a name."""
        if not (on == "auto" or on.startswith("auto:")) or "auto" in self.names:
            return False
        if on == "auto":
            return None
        try:
            tolerance = float(on[5:])
        except ValueError:
            tolerance = -1.0
        if not 0.0 <= tolerance < float("inf"):
            refuse(f"on is {on!r}", "auto:DISTANCE has a distance of at least 0", "write, for example, auto:0.001")
        return tolerance

    def _found(self, tolerance: Optional[float], p: Floats, n: Floats, threads: int) -> Ints:
        found = _exactff.find_faces(self._scene, p, n, tolerance, threads)
        without = int(np.count_nonzero((found < 0).all(axis=1)))
        if without:
            warn(f"on='auto' found no face for {without} of {len(p)} receivers, which now lie on none; "
                 "'auto:DISTANCE' looks further away")
        return found

    def _listed(self, on: Sequence[Any], shape: tuple[int, ...]) -> Ints:
        """One entry for each receiver: None, a name, an index, or indices."""
        if shape != (len(on),):
            refuse(f"on has {len(on)} entries, and there are receivers of shape {shape}",
                   "a list gives the own faces of each receiver", "give as many entries as receivers")
        by_name: dict[str, list[int]] = {}
        rows: list[list[int]] = []
        for i, one in enumerate(on):
            if one is None or one == "":
                rows.append([])
            elif isinstance(one, str):
                if one not in by_name:
                    by_name[one] = self._scene.own_faces(one)
                rows.append(by_name[one])
            else:
                row: Any = np.atleast_1d(_arguments.whole_numbers(one, f"on[{i}]")).tolist()
                rows.append(row)
        width = max(map(len, rows), default=0)
        table = np.array([row + [-1] * (width - len(row)) for row in rows], np.int64).reshape(len(rows), width)
        return _arguments.face_rows(table, shape, self._scene.face_count())

    def _warn_of_misses(self, p: Floats, n: Floats, own: Ints) -> None:
        """Warns of points slightly behind or in front of a face: these are probably slips. Not of spheres."""
        if not n.any():
            return
        step = -(-len(p) // _MOST_LOOKED_AT) if len(p) else 1
        for sentence in _exactff.near_misses(self._scene, p[::step], n[::step], own[::step]):
            warn(sentence)

    def __repr__(self) -> str:
        return (f"<exactff.Scene {self.name!r}: {len(self.names)} patches, {self._scene.face_count()} faces, "
                f"{len(self.emitters)} of them emit>")


def _patch(row: Any) -> Patch:
    name, faces, area, front, materials, emits, centre, low, high = row
    return Patch(name, tuple(faces), area, front, tuple(Material(kd, ke, m) for m, kd, ke in materials), emits, centre,
                 low, high)


def _arrays_names(names: Names) -> list[str]:
    listed = [names] if isinstance(names, str) else list(names or [])
    for name in listed:
        if not isinstance(name, str):
            refuse(f"{name!r} is no name", "patches and faces have names: NAME or NAME:k", "give strings")
    return listed


def _grid(cells: Union[None, int, tuple[int, int]]) -> str:
    """As the program writes it: "32x24"; empty for no grid."""
    if cells is None:
        return ""
    columns_and_rows = np.array((cells, cells) if np.ndim(cells) == 0 else cells)
    if columns_and_rows.shape != (2,) or columns_and_rows.dtype.kind not in "iu":
        refuse(f"grid is {cells!r}", "a grid has so many columns and rows", "for example grid=(32, 24), or grid=32")
    return "x".join(map(str, columns_and_rows.tolist()))


def _set(uv: int) -> int:
    if uv not in (0, 1):
        refuse(f"there is no set {uv} of texture coordinates", "a face has at most two", "give 0 or 1")
    return uv


def _bits(precision_cap: int) -> int:
    if not 32 <= precision_cap <= _MOST_BITS:
        refuse(f"precision_cap is {precision_cap}", f"it is from 32 to {_MOST_BITS} bits", "leave it out")
    return int(precision_cap)
