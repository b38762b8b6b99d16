"""Scenes from meshes: arrays of cells, and whatever meshio reads.

Surfaces stay as they are. Of volumes, the outer faces count: those that one cell alone has, by their corners. They look
away from the cell, by the sign of its volume, since programs order nodes in different ways."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
from typing import Any, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _geometry
from ._arguments import _array, Floats, Ints, numbers, refuse, warn, whole_numbers

#: Corners of each side, outward if the volume of the cell is positive in this order.
_SIDES = {
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
_CORNERS = {"triangle": 3, "quad": 4, "tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}

#: Integer cell data of meshio that tell what a cell belongs to.
_GROUPS = ["gmsh:physical", "netgen:index", "nastran:ref", "medit:ref", "ugrid:ref", "avsucd:material", "tetgen:ref",
           "CellEntityIds", "cell_tags"]

UNNAMED = "default"  # the patch of cells that belong to nothing


class _Block(NamedTuple):
    type: str  # "triangle", of "triangle6" too; "polygon"; a key of _SIDES; "" for what has no area
    corners: Ints  # (n, k); of polygons all in a row
    starts: Ints  # of each cell in the row of all corners, and the end
    first: int  # the number of the first cell, counted over all blocks

    def cells(self) -> Ints:
        return self.first + np.arange(len(self.starts) - 1)


class _Sides(NamedTuple):  # of volume cells; or surface cells that may be such sides
    rings: Ints  # (n, 4); the last is -1 for a triangle
    cells: Ints  # which cell, counted over all blocks


def points_and_faces(mesh: Any) -> tuple[Any, Any]:
    """Of an object of PyVista, trimesh, Open3D or alike."""
    for points, faces in (("points", "faces"), ("vertices", "faces"), ("vertices", "triangles")):
        if hasattr(mesh, points) and hasattr(mesh, faces):
            return getattr(mesh, points), getattr(mesh, faces)
    refuse(f"cells is missing, and a {type(mesh).__name__} has no faces", "a mesh has points or vertices, and faces",
           "give points and cells, or extract_surface() of a grid of PyVista")


def build(points: Any, cells: Any, patches: Any, names: Any, materials: Any, skip_bad_faces: bool) -> Any:
    """Checks the arrays and makes the scene of the compiled module."""
    blocks = _blocks(cells)
    if isinstance(patches, (list, tuple)) and patches and all(np.ndim(one) == 1 for one in patches):
        patches = np.concatenate(patches)  # of each block, as meshio's cell data are
    patch_of, listed = _geometry._patches(patches, names, sum(len(block.cells()) for block in blocks))
    return _built(points, blocks, patch_of, listed, materials, skip_bad_faces)


# --- cells ---


def _blocks(cells: Any) -> list[_Block]:
    if isinstance(cells, dict):
        cells = list(cells.items())
    if not isinstance(cells, np.ndarray):
        cells = list(cells)
        if cells and all(hasattr(one, "type") and hasattr(one, "data") for one in cells):
            cells = [(one.type, one.data) for one in cells]
        if cells and all(isinstance(one, (tuple, list)) and len(one) == 2 and isinstance(one[0], str) for one in cells):
            firsts = np.cumsum([0] + [len(data) for _, data in cells])
            return [_block(kind, data, f"cells[{k}] ({kind})", int(firsts[k])) for k, (kind, data) in enumerate(cells)]
    return [_Block("polygon", *_geometry._faces(cells), 0)]


def _block(kind: str, data: Any, where: str, first: int) -> _Block:
    """A block by the name that meshio has for its cells. Curved cells have their corners first."""
    if kind.startswith(("vertex", "line", "VTK_LAGRANGE_CURVE")):
        return _Block("", np.empty(0, np.int64), np.zeros(len(data) + 1, np.int64), first)
    base = next((name for name in ("polygon", *_CORNERS)
                 if kind.replace("VTK_LAGRANGE_", "").lower().startswith(name[:5])), None)
    if base is None:
        refuse(f"{where}: cells of this type are not taken", "known are " + ", ".join(_CORNERS) + " and polygon",
               "divide them in the program that made the mesh")
    table = whole_numbers(data, where)
    corners = _CORNERS.get(base, max(table.shape[-1], 3))
    table = table if table.size else table.reshape(0, corners)
    if table.ndim != 2 or table.shape[1] < corners or kind == base != "polygon" and table.shape[1] > corners:
        refuse(f"{where} has the shape {table.shape}", f"each row is a cell of {corners} corners", "check the array")
    if table.shape[1] > corners:
        warn(f"{where}: curved cells count as straight ones between their {corners} corners")
    return _Block(base, table[:, :corners], np.arange(len(table) + 1, dtype=np.int64) * corners, first)


def _built(points: Any, blocks: Sequence[_Block], patch_of: Ints, names: list[str], materials: Any,
           skip_bad_faces: bool) -> Any:
    table = _array(points, "points")
    if table.ndim != 2 or table.shape[1] not in (2, 3):
        refuse(f"points has the shape {table.shape}", "each row is x, y, z, or x, y", "give an array of shape (n, 3)")
    used = np.zeros(len(table), np.bool_)
    for block in blocks:
        corners = block.corners.ravel()
        bad = (corners < 0) | (corners >= len(table))
        if bad.any():
            cell = block.first + int(np.searchsorted(block.starts, np.argmax(bad), side="right")) - 1
            refuse(f"cell {cell} has the vertex {corners[np.argmax(bad)]}",
                   f"points are numbered from 0 to {len(table) - 1}", "correct the index")
        used[corners] = True
    table = table.copy()
    table[~used] = 0  # may be anything
    exact = numbers(table, "points")
    if exact.shape[1] == 2:
        exact = np.column_stack([exact, np.zeros(len(exact))])
    corners, starts, cells = _faces_of(exact, blocks, patch_of, names)
    if not len(cells):
        refuse("the mesh has no faces", "surface or volume cells are needed", "check what it contains")
    present: Any = list(dict.fromkeys(patch_of[cells].tolist()))
    rank = np.zeros(len(names), np.int64)
    rank[present] = np.arange(len(present))
    kept, number = np.unique(corners, return_inverse=True)
    return _geometry.make(exact[kept], number.ravel().astype(np.int64), starts, rank[patch_of[cells]],
                          [names[i] for i in present], materials, skip_bad_faces)


# --- outer faces ---


def _faces_of(points: Floats, blocks: Sequence[_Block], patch_of: Ints,
              names: Sequence[str]) -> tuple[Ints, Ints, Ints]:
    """All corners in a row, where each face begins in it, and the cell whose patch it has."""
    volumes = [block for block in blocks if block.type in _SIDES and block.corners.size]
    surfaces = [block for block in blocks if block.type and block.type not in _SIDES]
    none = np.empty(0, np.int64)
    flat: Ints = np.concatenate([none, *(block.corners.ravel() for block in surfaces)])
    lengths: Ints = np.concatenate([none, *(np.diff(block.starts) for block in surfaces)])
    cells: Ints = np.concatenate([none, *(block.cells() for block in surfaces)])
    if volumes:
        _refuse_twins(volumes)
        outer, covered = _outer(_joined_sides([_sides(points, block) for block in volumes]),
                                _joined_sides([_given(block) for block in surfaces if block.type in _CORNERS]),
                                patch_of, names)
        keep = ~np.isin(cells, covered)
        flat = np.concatenate([flat[np.repeat(keep, lengths)], outer.rings[outer.rings >= 0]])
        lengths = np.concatenate([lengths[keep], (outer.rings >= 0).sum(axis=1)])
        cells = np.concatenate([cells[keep], outer.cells])
    return flat, np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64), cells


def _joined_sides(sides: Sequence[_Sides]) -> _Sides:
    return _without_repeats(_Sides(np.concatenate([np.empty((0, 4), np.int64), *(one.rings for one in sides)]),
                                   np.concatenate([np.empty(0, np.int64), *(one.cells for one in sides)])))


def _refuse_twins(volumes: Sequence[_Block]) -> None:
    for block in volumes:
        keys = np.sort(block.corners, axis=1)
        order = np.lexsort(keys.T)
        same = (keys[order[1:]] == keys[order[:-1]]).all(axis=1)
        if same.any():
            one, other = sorted(block.first + int(cell) for cell in order[int(np.argmax(same)):][:2])
            refuse(f"the cells {one} and {other} have the same corners "
                   f"({int(same.sum())} cells are there twice)", "which faces are outer ones would be unclear",
                   "remove one of them; Gmsh writes a cell of two physical groups twice in version 2")


def _given(block: _Block) -> _Sides:
    """The surface cells that may be sides of volume cells."""
    return _Sides(np.pad(block.corners, ((0, 0), (0, 4 - block.corners.shape[1])), constant_values=-1), block.cells())


def _sides(points: Floats, block: _Block) -> _Sides:
    """All sides of all cells, outward."""
    table = np.array([(*side, -1)[:4] for side in _SIDES[block.type]])
    rings = np.where(table >= 0, block.corners[:, table], -1)
    turned = _are_turned(points, rings)
    rings[turned] = rings[turned][:, :, [2, 1, 0, 3]]  # the other way round, also of four corners
    return _Sides(rings.reshape(-1, 4), np.repeat(block.cells(), len(table)))


def _are_turned(points: Floats, rings: Ints) -> NDArray[np.bool_]:
    """Whether the volume of a cell is negative, by its sides cut into triangles. Where roundings leave the sign
    unclear, that of the sum over the block decides."""
    ends = np.where(rings[..., 3] >= 0, rings[..., 3], rings[..., 2])  # of a triangle, the last corner twice
    corners = points[np.concatenate([rings[..., :3], ends[..., np.newaxis]], axis=-1)] - points[rings[:, :1, :1]]
    a, b, c, d = np.moveaxis(corners, -2, 0)
    volume = ((np.cross(a, b) * c).sum(axis=-1) + (np.cross(a, c) * d).sum(axis=-1)).sum(axis=-1)
    unclear = np.abs(volume) <= 1e-13 * np.abs(corners).max(axis=(1, 2, 3)) ** 3
    if unclear.any():
        warn(f"{int(unclear.sum())} of {len(unclear)} volume cells have no volume, to within rounding; their faces "
             "look as those of the others do")
    return np.where(unclear, volume[~unclear].sum() < 0.0, volume < 0.0)


def _without_repeats(sides: _Sides) -> _Sides:
    """Sides of collapsed cells lose corners that are there twice, and vanish with less than three."""
    ordered = np.sort(sides.rings, axis=1)
    twice = ((ordered[:, 1:] == ordered[:, :-1]) & (ordered[:, 1:] >= 0)).any(axis=1)
    if not twice.any():
        return sides
    keep = np.ones(len(twice), np.bool_)
    for at in np.flatnonzero(twice):
        ring = [int(c) for c in sides.rings[at] if c >= 0]
        ring = [c for i, c in enumerate(ring) if c != ring[i - 1]]
        keep[at] = len(set(ring)) == len(ring) == 3
        sides.rings[at] = (ring + [-1] * 4)[:4]
    return _Sides(sides.rings[keep], sides.cells[keep])


def _outer(sides: _Sides, given: _Sides, patch_of: Ints, names: Sequence[str]) -> tuple[_Sides, Ints]:
    """The sides that one volume cell alone has, with the cells whose patches they have; the surface cells on them."""
    if not len(sides.cells):
        return sides, sides.cells
    keys = np.sort(np.concatenate([sides.rings, given.rings]), axis=1)
    cells = np.concatenate([sides.cells, given.cells])
    order = np.lexsort(keys.T)  # stable, so the sides of volumes come first in each group
    starts = np.flatnonzero(np.concatenate([[True], (keys[order[1:]] != keys[order[:-1]]).any(axis=1)]))
    is_side = order < len(sides.cells)
    count = np.add.reduceat(is_side.astype(np.int64), starts)
    size = np.diff(np.concatenate([starts, [len(order)]]))
    many = np.flatnonzero(count > 2)
    if many.size:
        three = sorted(int(cell) for cell in cells[order[starts[many[0]]:][:3]])
        refuse(f"the volume cells {three[0]}, {three[1]} and {three[2]} have a face in common ({many.size} such faces)",
               "a face has one cell on each side", "remove the cells that overlap others")
    inner = int(size[count == 2].sum() - 2 * (count == 2).sum())
    if inner:
        warn(f"surface cells inside the volume, between two of its cells: {inner}; they stay faces")
    alone = count == 1
    outer = np.sort(order[starts[alone]])
    owner = sides.cells.copy()
    named = alone & (size > 1)
    over = cells[order[starts[named] + 1]]
    is_named = np.array([name != UNNAMED for name in names])[patch_of[over]]
    owner[order[starts[named]][is_named]] = over[is_named]
    return _Sides(sides.rings[outer], owner[outer]), cells[order[np.repeat(alone, size) & ~is_side]]


# --- meshio ---


def read(path: Any) -> Any:
    """The mesh that meshio reads. Its notes become warnings, its errors InputErrors."""
    name, library, output = os.fspath(path), meshio(), io.StringIO()
    if not os.path.isfile(name):
        refuse(f"{name}: no such file", "", "check the path")
    mesh, failure = None, ""
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
        try:
            mesh = library.read(name)
        except ImportError as error:
            refuse(f"{name}: meshio lacks a package that this format needs", str(error),
                   "install it: Debian's python3-h5py for MED, XDMF and CGNS, python3-netcdf4 for Exodus")
        except (Exception, SystemExit) as error:  # of any kind, where a file is cut off
            failure = f"{type(error).__name__}: {error}"
    said = " ".join(output.getvalue().split())
    if mesh is None:
        refuse(f"{name}: meshio cannot read it", said or failure, "convert it by the program that wrote it")
    if said:
        warn(f"{name}: meshio says: {said}")
    return mesh


def meshio() -> Any:
    """The module."""
    try:
        return importlib.import_module("meshio")
    except ImportError as error:
        refuse("meshio cannot be imported", str(error), "install Debian's python3-meshio, or by pip install meshio")


def build_meshio(mesh: Any, patches: Optional[str], names: Any, materials: Any, skip_bad_faces: bool) -> Any:
    """Makes the scene of a meshio.Mesh."""
    if not hasattr(mesh, "cell_data"):
        refuse(f"a {type(mesh).__name__} is no mesh of meshio", "it has no cells with data",
               "give the path of a file or a meshio.Mesh; arrays go to from_mesh")
    blocks = _blocks(mesh.cells)
    dimensions = np.concatenate([np.full(len(block.cells()), 3 if block.type in _SIDES else 2) for block in blocks])
    key = _key(mesh, patches)
    if key == "sets":
        patch_of, listed = _by_sets(_sets(mesh), blocks)
    elif key:
        data = [whole_numbers(np.asarray(one).reshape(len(one)), f"cell data {key!r}") for one in mesh.cell_data[key]]
        patch_of, listed = _by_numbers(np.concatenate(data), dimensions, _tags(mesh, names), key)
    else:
        patch_of, listed = np.zeros(len(dimensions), np.int64), [UNNAMED]
    return _built(mesh.points, blocks, patch_of, listed, materials, skip_bad_faces)


def _key(mesh: Any, patches: Optional[str]) -> str:
    """What tells the patches: the name of cell data, "sets", or "" for nothing."""
    has_sets = any(_sets(mesh).values())
    if patches is not None:
        if patches != "sets" and patches not in mesh.cell_data or patches == "sets" and not has_sets:
            refuse(f"the mesh has no {patches!r}", "patches names cell data, or is 'sets'",
                   f"choose from {sorted(mesh.cell_data) + ['sets'] * has_sets}")
        return patches
    whole = [str(key) for key, data in mesh.cell_data.items()
             if all(np.asarray(one).dtype.kind in "iu" for one in data)]
    known = [key for key in _GROUPS if key in whole]
    if has_sets and known[:1] != _GROUPS[:1]:
        return "sets"
    # Numbers of cells, which differ from cell to cell, are no groups.
    others = [key for key in whole if _repeats(mesh.cell_data[key])]
    if others and not known:
        warn(f"patches are the cells of equal {others[0]!r}, as the mesh has no sets; patches= names other cell data")
    return (known + others + [""])[0]


def _repeats(blocks: Any) -> bool:
    values = np.concatenate([np.ravel(one) for one in blocks])
    return 2 * len(np.unique(values)) <= len(values)


def _tags(mesh: Any, names: Any) -> dict[tuple[int, int], str]:
    """Names by number and dimension, as Gmsh, Netgen and XDMF have them; those of the caller for both dimensions."""
    if names is not None:
        table = names if isinstance(names, dict) else dict(enumerate(names))
        return {(int(tag), dimension): str(name) for tag, name in table.items() for dimension in (2, 3)}
    pairs = {str(name): np.asarray(value).ravel() for name, value in (mesh.field_data or {}).items()}
    return {(int(pair[0]), int(pair[1])): name for name, pair in pairs.items()
            if len(pair) == 2 and pair.dtype.kind in "iuf"}


def _by_numbers(tags: Ints, dimensions: Ints, named: dict[tuple[int, int], str], key: str) -> tuple[Ints, list[str]]:
    table, patch_of = np.unique(np.column_stack([tags, dimensions]), axis=0, return_inverse=True)
    pairs: Any = table.tolist()
    of_surfaces = {tag for tag, dimension in pairs if dimension == 2}
    names = []
    for tag, dimension in pairs:
        more = " (volume)" if dimension == 3 and tag in of_surfaces else ""  # Gmsh numbers dimensions apart
        plain = UNNAMED if tag == 0 and key in _GROUPS else f"{key.rsplit(':', 1)[-1]}_{tag}{more}"
        names.append(named.get((tag, dimension), plain))
    index = {name: k for k, name in enumerate(dict.fromkeys(names))}
    return np.array([index[name] for name in names], np.int64)[patch_of.ravel()], list(index)


def _sets(mesh: Any) -> dict[str, list[Any]]:
    """Members of each set, block by block. Families of MED have a number and several names."""
    sets = {str(name): list(members) for name, members in mesh.cell_sets.items() if not str(name).startswith("gmsh:")}
    tags = getattr(mesh, "cell_tags", None) or {}
    if "cell_tags" in mesh.cell_data:
        for name in dict.fromkeys(name for family in tags.values() for name in family):
            of_name = [tag for tag, family in tags.items() if name in family]
            sets[str(name)] = [np.flatnonzero(np.isin(data, of_name)) for data in mesh.cell_data["cell_tags"]]
    return {name: members for name, members in sets.items() if any(_members(one).size for one in members)}


def _members(one: Any) -> Ints:
    """Of one block. A set of sets has their members in lists."""
    if isinstance(one, list) and any(np.ndim(part) for part in one):
        return np.concatenate([_members(part) for part in one])
    return np.asarray([] if one is None else one, np.int64).ravel()


def _by_sets(sets: dict[str, list[Any]], blocks: Sequence[_Block]) -> tuple[Ints, list[str]]:
    """The smallest set that holds a cell is its patch, so that 'all' does not hide 'fin'."""
    whole: dict[str, Ints] = {}
    for name, members in sets.items():
        parts = [_members(one) for one in members]
        for k, part in enumerate(parts):
            if part.size and (k >= len(blocks) or part.min() < 0 or part.max() >= len(blocks[k].cells())):
                refuse(f"the set {name!r} has cells that the mesh does not have", f"in block {k}",
                       "name the set once, after all its cells; or give patches= to Scene.from_mesh")
        whole[name] = np.unique(np.concatenate([block.first + part for block, part in zip(blocks, parts)]))
    names = [UNNAMED, *sorted(whole, key=lambda name: -len(whole[name]))]
    patch_of, times = np.zeros((2, sum(len(block.cells()) for block in blocks)), np.int64)
    for k, name in enumerate(names[1:], 1):
        patch_of[whole[name]] = k
        times[whole[name]] += 1
    if (times > 1).any():
        warn(f"cells in several sets: {int((times > 1).sum())}; the smallest set of each is its patch")
    return patch_of, names
