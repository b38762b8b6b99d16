"""What is seen: view factors from patch to patch, the whole view from one point, and radiosities after all bounces."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Iterator, Literal, Mapping, NamedTuple, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments, _exactff
from ._arguments import (check_existing, Floats, Measure, Names, Path, Progress, refuse, require_free, require_table,
                         shown, warn)
from ._pair import Status
from ._scene import On, Scene


_MOST_BITS = 1 << 24
# Name and extension.
_MATRIX_FILES = (("csv", ".csv"), ("npz", ".npz"), ("vtk", ".vtp"), ("vtk", ".vtu"),
                 *((name, extension) for name, extension, _ in _exactff.matrix_formats))


class ViewFactor(NamedTuple):
    """The view factor from one patch to another. ``lower`` and ``upper`` are as strong as ``claim`` says."""

    value: float  #: a pure number in [0, 1]
    lower: float
    upper: float
    claim: str  #: "zero", "certified" (both proved), or "estimated": the error is an estimate, with roundings in it
    way: str  #: how: "cells" or "points"
    accurate: bool  #: upper - lower is at most the accuracy, in both directions
    area_from: float  #: in the square of the scene's unit of length
    area_to: float
    cells: int
    event_cells: int  #: cells on which the order of three edges is undecided
    limit: str  #: why it is not accurate: "budget", "crowd" (too much between for the memory), "rounding"; else "none"

    def __float__(self) -> float:
        return self.value


class PairOfPatches(NamedTuple):
    """A_i F_ij and A_j F_ji, computed apart and divided by the larger area."""

    from_name: str
    to_name: str
    distance: float  #: of the two values
    radius: float  #: the sum of their radii; a distance above it breaks the bounds of one of them


@dataclass(frozen=True)
class Reciprocity:
    """How well the two directions of each pair agree: a test of their bounds."""

    pairs: int
    worst: Optional[PairOfPatches]  #: the largest distance / radius
    apart: tuple[PairOfPatches, ...]  #: pairs whose bounds contradict each other; empty if all is right


@dataclass(frozen=True)
class ViewFactorMatrix:
    """View factors between patches, as arrays. Made by :func:`view_factor_matrix`.

    ``lower`` and ``upper`` are as strong as ``claim`` says. ``row_sums`` (n, 2) are bounds of the sums of the rows, with
    ``back`` and ``open`` if they were computed, and ``buried``. Where ``reasons_against_one`` is empty, every row adds up to 1.
    """

    from_names: tuple[str, ...]
    to_names: tuple[str, ...]
    value: Floats  #: (n, m)
    lower: Floats  #: (n, m)
    upper: Floats  #: (n, m)
    claim: NDArray[np.str_]  #: (n, m)
    way: NDArray[np.str_]  #: (n, m)
    accurate: NDArray[np.bool_]  #: (n, m)
    limit: NDArray[np.str_]  #: (n, m); why an entry is not accurate
    areas_from: Floats  #: (n,)
    areas_to: Floats  #: (m,)
    back: Optional[tuple[ViewFactor, ...]]  #: for each row what meets backs of faces
    open: Optional[tuple[ViewFactor, ...]]  #: for each row what meets nothing
    buried: Optional[tuple[ViewFactor, ...]]  #: for each row the share of its area under a solid; None if nothing is
    row_sums: Floats
    reasons_against_one: tuple[str, ...]
    reciprocity: Optional[Reciprocity]  #: None unless both directions were computed apart
    sums: Mapping[str, tuple[ViewFactor, ...]]  #: for each name in `sums`, the sum of each row over its columns

    def __getitem__(self, names: tuple[str, str]) -> ViewFactor:
        """``matrix["floor", "light"]``."""
        for name, known in zip(names, (self.from_names, self.to_names)):
            if name not in known:
                raise KeyError(name)
        return self._entries[self.from_names.index(names[0])][self.to_names.index(names[1])]

    def save(self, path: Path, *, format: Optional[str] = None, existing: Literal["refuse", "replace"] = "refuse",
             zone: str = "Zone 1") -> None:
        """Writes the matrix to a file, as ``exactff matrix`` does. The extension says which, or `format`:

        - "csv": names, values, bounds, claims, areas; doubles read back to the same bits
        - "npz": a sparse matrix for ``scipy.sparse.load_npz``, with names, areas, radii, claims; if balanced, also with
          ``factor``, the values before that
        - "vtk" (``.vtp``, ``.vtu``): the one row as values on the scene, for ParaView
        - "energyplus" (``.idf``): ``ZoneProperty:UserViewFactors:bySurfaceName``, for `zone`
        - "view3d" (``.out``): its output, six decimals
        - "openfoam": F, with globalFaceFaces, finalAgglom and mapDist beside it; patches in the order of the mesh
        - "calculix" (``.vwf``), "moose", "nek" (Nek5000, NekRS): patches by number, in the order of the rows
        - "esatan" (``.gr``): conductors of :meth:`exchange`, with names in comments

        Files of other programs hold no bounds, and need the same patches as rows and columns. A file appears complete or not
        at all. Raises InputError for another extension or format, for a file that exists unless ``existing="replace"``,
        always for a file that the scene was read from, and for other programs if fronts of two patches overlap, since such
        rows exceed 1."""
        check_existing(existing)
        made = self._whole("save the first one")
        extension = os.path.splitext(os.fspath(path))[1].lower()
        names = [name for name, known in _MATRIX_FILES if (known and known == extension if format is None else name == format)]
        if format is None and not names:
            refuse(f"{os.fspath(path)}: no kind of matrix file has the extension {extension!r}",
                   "the extension says what is written", "name a file "
                   + ", ".join(known for _, known in _MATRIX_FILES if known) + ", or give a format")
        if not names:
            refuse(f"format is {format!r}", "it says what is written",
                   "give " + ", ".join(dict.fromkeys(name for name, _ in _MATRIX_FILES)))
        beside = _exactff.openfoam_files if names[0] == "openfoam" else ()
        for file in (path, *(os.path.join(os.path.dirname(os.fspath(path)), name) for name in beside)):
            require_free(file, existing, self._read)
        made.write(os.fspath(path), names[0], zone)

    def balanced(self) -> ViewFactorMatrix:
        """The nearest matrix in which every value, also of ``back``, ``open`` and ``buried``, lies in its interval, and

        - ``areas[i] * value[i, j] == areas[j] * value[j, i]`` in every bit,
        - the exact sum of a row, with ``back``, ``open`` and ``buried``, is 1 to within 2^-51, two ulps, and mostly
          within one; ``math.fsum`` nearly always gives 1.0.

        Values depend neither on threads nor on the order of the patches, but on their names. Needs the same patches as rows
        and columns, with `backs` and `sky`. Raises InputError where rows need not add up to 1, with
        ``reasons_against_one``; and where there is no such matrix, with the rows or pairs whose intervals prove it.
        ``save`` then writes these values, and ``.csv`` both."""
        whole = self._whole("balance the first one")
        if self.sums:
            refuse("the matrix has sums", "their balanced values are not computed", "leave out sums, and add values up")
        entries, back, free, below, _, made = whole.balanced()
        n = len(self.from_names)

        def with_values(row: Optional[tuple[ViewFactor, ...]], values: Floats) -> Optional[tuple[ViewFactor, ...]]:
            return None if row is None else tuple(f._replace(value=v) for f, v in zip(row, values.tolist()))

        value = entries.reshape(n, n)
        rows = tuple(tuple(f._replace(value=v) for f, v in zip(*row)) for row in zip(self._entries, value.tolist()))
        return replace(self, value=value, back=with_values(self.back, back), open=with_values(self.open, free),
                       buried=with_values(self.buried, below), _entries=rows, _made=made)

    def exchange(self, *, save: Optional[Path] = None, existing: Literal["refuse", "replace"] = "refuse",
                 threads: int = 0, progress: Progress = None) -> ExchangeFactors:
        """Gebhart's exchange factors over all bounces, and radiative conductors, with the emissivity 1 - Kd.

        Needs the factors between all patches. Bounds follow from those of the matrix; values are estimates by its values,
        so those of ``matrix.balanced().exchange()`` have rows that add up to 1, with ``back`` and ``open``, which are black.
        `save` names a CSV, .npz or .jsonl file that is written. Raises InputError for other patches and for a Kd above 1;
        a channel without a bound is a ModellingWarning."""
        made, file = self._whole("use the first one"), self._free_table(save, existing)
        with shown(progress, "exchange factor") as tell:
            channels, claim, areas = made.exchange(_arguments.thread_count(threads), file, tell)
        n = len(areas)

        def square(k: int) -> Floats:
            return np.array([np.reshape(np.asarray(c[k]), (n, n, 3)) for c in channels])

        def rest(k: int) -> Optional[Floats]:
            return np.array([c[k] for c in channels]) if len(channels[0][k]) else None

        for c in channels:
            if c[7]:
                warn(f"there is no bound for exchange factors ({c[7]})")
        factors, conductors = square(0), square(3)
        return ExchangeFactors(self.from_names, np.array(areas, np.float64), np.array([c[6] for c in channels]),
                               factors[..., 0], factors[..., 1], factors[..., 2], rest(1), rest(2), conductors[..., 0],
                               conductors[..., 1], conductors[..., 2], rest(4), rest(5), claim)

    def temperatures(self, known: Mapping[str, float], heats: Mapping[str, float] = {}, *, save: Optional[Path] = None,
                     existing: Literal["refuse", "replace"] = "refuse") -> Temperatures:
        """Temperatures of gray, diffuse surfaces of emissivity 1 - Kd that exchange sigma T^4, as ``exactff radiosity
        --temperatures`` solves for them, with bounds. Lengths are in the scene's unit, or in metres if it has none.

        Parameters
        ----------
        known : temperatures in K by names of patches; also of "(back)" and "(open)", which are black, else at 0 K
        heats : the heat in W that other patches give off, net; 0 for one that only reflects and emits again. What a
            pattern names shares it by areas
        save : a CSV, .npz or .jsonl file that is written

        Needs the factors between all patches, with `backs` and `sky`. Values are by the values of the matrix: no heat is made
        if it is balanced. Raises InputError for another matrix; for patches in neither or in both; for a Kd that differs
        between channels or is above 1; where more heat is taken away than arrives; and where there is no bound."""
        made, file = self._whole("use the first one"), self._free_table(save, existing)
        t, q, areas, emissivities, rest, claim = made.temperatures(dict(known), dict(heats), file)
        return Temperatures(self.from_names, areas, emissivities, t[:, 0], t[:, 1], t[:, 2], q[:, 0], q[:, 1], q[:, 2],
                            rest[0], rest[1], rest[2], claim)

    def _whole(self, advice: str) -> _exactff.MadeMatrix:
        if self._made is None:
            refuse("the matrix was copied or pickled", "a copy has the numbers alone", advice)
        return self._made

    def _free_table(self, save: Optional[Path], existing: str) -> str:
        check_existing(existing)
        if save is None:
            return ""
        require_table(save)
        require_free(save, existing, self._read)
        return os.fspath(save)

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": None}

    _entries: tuple[tuple[ViewFactor, ...], ...] = field(repr=False)
    _made: Optional[_exactff.MadeMatrix] = field(repr=False, compare=False)
    _read: tuple[str, ...] = field(repr=False, compare=False)  # files that the scene was read from


@dataclass(frozen=True)
class ExchangeFactors:
    """Exchange factors and conductors, with the first axis for channels: one if the three are alike, else red, green, blue.

    ``value[c, i, j]``: of what i emits, the share that j absorbs after all bounces. Made by :meth:`ViewFactorMatrix.exchange`.
    """

    names: tuple[str, ...]
    areas: Floats  #: (n,), in m^2, without buried parts
    emissivities: Floats  #: (c, n), 1 - Kd
    value: Floats  #: (c, n, n)
    lower: Floats  #: (c, n, n)
    upper: Floats  #: (c, n, n)
    back: Optional[Floats]  #: (c, n, 3): value, lower, upper of the share that meets backs; None if not in the matrix
    open: Optional[Floats]  #: (c, n, 3): of the share that leaves
    conductors: Floats  #: (c, n, n), eps_i A_i B_ij, an area; symmetric. Heat: sigma times it times (T_i^4 - T_j^4)
    conductors_lower: Floats  #: (c, n, n)
    conductors_upper: Floats  #: (c, n, n)
    conductors_to_back: Optional[Floats]  #: (c, n, 3)
    conductors_to_open: Optional[Floats]  #: (c, n, 3)
    claim: str  #: of the bounds: "zero", "certified" or "estimated"


@dataclass(frozen=True)
class Temperatures:
    """Temperatures and heats of patches, with bounds as strong as ``claim``. Made by :meth:`ViewFactorMatrix.temperatures`."""

    names: tuple[str, ...]
    areas: Floats  #: (n,), in m^2, without buried parts
    emissivities: Floats  #: (n,), 1 - Kd
    value: Floats  #: (n,), temperatures in K
    lower: Floats  #: (n,)
    upper: Floats  #: (n,)
    heat: Floats  #: (n,), in W, given off, net
    heat_lower: Floats  #: (n,)
    heat_upper: Floats  #: (n,)
    to_back: Floats  #: (3,): value, lower, upper of the heat that goes to backs of faces
    to_open: Floats  #: (3,): of that which leaves
    unbalanced: Floats  #: (3,): the sum of all heats less these two
    claim: str  #: "zero", "certified" or "estimated"


class Share(NamedTuple):
    """A share of the light leaving a point, as exact as a form factor: rounded once, with its neighbours as bounds."""

    value: float
    lower: float
    upper: float
    status: Status

    def __float__(self) -> float:
        return self.value


class SeenPatch(NamedTuple):
    """A patch in a view."""

    form_factor: Share  #: as :meth:`Scene.form_factor` gives it, in every bit
    share: Share  #: of the view; differs only where `stacked`
    stacked: bool  #: in one plane with a front of a lower index: the share may be less than the form factor


class View(Mapping[str, SeenPatch]):
    """All that a receiver sees: ``view["light"]``. Patches with a form factor of 0 are left out. Made by :func:`view`.

    The shares of all patches, ``back`` (backs of faces) and ``open`` (nothing) add up to 1. Of faces in one plane a front
    is seen before a back, and of several fronts the first in the file: the others are ``stacked``, and each keeps its
    full form factor.
    """

    def __init__(self, patches: dict[str, SeenPatch], back: Share, open: Share, buried_under: Optional[str] = None) -> None:
        self._patches = patches
        self.back = back
        self.open = open
        self.buried_under = buried_under  #: the face of a solid on the receiver's face, which then sees nothing

    def __getitem__(self, name: str) -> SeenPatch:
        return self._patches[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._patches)

    def __len__(self) -> int:
        return len(self._patches)

    def __repr__(self) -> str:
        return f"<exactff.View of {len(self)}, open {self.open.value:.3g}, back {self.back.value:.3g}>"


def _accuracy(accuracy: float) -> float:
    value = float(accuracy)
    if not 0.0 < value < float("inf"):
        refuse(f"accuracy is {accuracy!r}", "it bounds an error", "give a positive number; the default is 1e-6")
    return value


def _budget(budget: int) -> int:
    if isinstance(budget, bool) or not isinstance(budget, (int, np.integer)) or not 1 <= budget <= 2**32:
        refuse(f"budget is {budget!r}", "it is a number of cells and points", "give a whole number from 1 to 2^32")
    return int(budget)


def _warn_of_width(wide: int, accuracy: float, budget: int) -> None:
    if wide:
        warn(f"{wide} view factor{'s are' if wide > 1 else ' is'} wider than the accuracy {accuracy:g} (the limit of work "
             f"for an entry, {budget} cells and four points for each, or roundings; intervals are as strong as their claims)")


def view_factor(scene: Scene, a: str, b: str, accuracy: float = 1e-6, *, budget: int = 100_000,
                certify: bool = False) -> ViewFactor:
    """The view factor from patch `a` to patch `b`: the mean over `a` of the form factor from a point to `b`.

    Parameters
    ----------
    a, b : names of patches or faces, ``NAME`` or ``NAME:k``
    accuracy : the largest width ``upper - lower``, for the factor and for the one from `b` to `a`
    budget : the limit of work for an entry: the most cells, where one with many edges counts for several, and the most
        points; where it is reached, a ModellingWarning says so and the result keeps its width
    certify : prove the quadrature, too: the claim is "certified" or "zero"

    Raises InputError for unknown names and for patches without area. The GIL is released, and Ctrl-C answered.
    """
    for name in (a, b):
        if not isinstance(name, str):
            refuse(f"a patch is {name!r}", "it is the name of a patch or face", "for example 'light'")
    f = ViewFactor(*_exactff.view_factor(scene._scene, a, b, _accuracy(accuracy), _budget(budget),
                                           bool(certify)))
    _warn_of_width(int(not f.accurate), accuracy, budget)
    return f


def _patches(scene: Scene, names: Names, what: str, sky: bool = False) -> list[str]:
    listed = ["all"] if names is None else [names] if isinstance(names, str) else list(names)
    for name in listed:
        if not isinstance(name, str):
            refuse(f"{what} holds {name!r}", "it lists names of patches or faces", "for example ['floor', 'light']")
    return scene._named(listed, sky)


def view_factor_matrix(scene: Scene, from_patches: Names = None, to_patches: Names = None, *, accuracy: float = 1e-6,
                       budget: int = 100_000, certify: bool = False, backs: bool = False, sky: bool = False,
                       both_directions: bool = False, sums: Sequence[str] = (), threads: int = 0,
                       progress: Progress = None) -> ViewFactorMatrix:
    """All view factors between two lists of patches, the values of ``exactff matrix`` bit for bit.

    Parameters
    ----------
    from_patches, to_patches : names of the rows and columns, or patterns such as ``"wall_*"``; "all", the default: every
        patch with area. "sky" in `to_patches` is the same as ``sky=True``. With `backs` or `sky`, ``to_patches=[]``
        computes these alone.
    accuracy, budget, certify : of each entry, as in :func:`view_factor`
    backs, sky : also compute what meets the backs of faces, and what is open
    both_directions : compute F_ij and F_ji apart, so that ``reciprocity`` tests one against the other
    sums : names or patterns, each of which adds the sum of each row over all of its columns, such as the cells of a
        divided patch. Bounds are sums, rounded outward; the claim is the weakest one
    threads : 0 for as many as this process may use; no value depends on it
    progress : None for a bar of tqdm on a terminal; True, False, or a function of (done, total)

    Returns arrays of shape (rows, columns). Raises InputError; entries wider than the accuracy are a ModellingWarning.
    """
    rows, columns = _patches(scene, from_patches, "from_patches"), _patches(scene, to_patches, "to_patches", sky=True)
    if "sky" in columns and "sky" not in scene.names:
        columns.remove("sky")
        sky = True
    with shown(progress, "view factor") as tell:
        entries, back, free, below, row_sums, reasons, mutual, of_groups, made = _exactff.view_factor_matrix(
            scene._scene, rows, columns, _accuracy(accuracy), _budget(budget), bool(certify), bool(backs), bool(sky),
            bool(both_directions), list(sums), _arguments.thread_count(threads), tell)
    table = [ViewFactor(*entry) for entry in entries]
    shape = (len(rows), len(columns))

    def array(get: Callable[[ViewFactor], Any], kind: Any) -> Any:
        return np.array([get(f) for f in table], kind).reshape(shape)

    lists = [tuple(ViewFactor(*f) for f in one) if wanted else None
             for one, wanted in ((back, backs), (free, sky), (below, below))]
    wide = sum(not f.accurate for one in (table, *(one for one in lists if one)) for f in one)
    _warn_of_width(wide, accuracy, budget)
    by_rows = tuple(tuple(table[i * shape[1]:(i + 1) * shape[1]]) for i in range(shape[0]))
    reciprocity = _reciprocity(mutual, rows, columns) if both_directions else None
    return ViewFactorMatrix(
        tuple(rows), tuple(columns), array(lambda f: f.value, np.float64), array(lambda f: f.lower, np.float64),
        array(lambda f: f.upper, np.float64), array(lambda f: f.claim, np.str_),
        array(lambda f: f.way, np.str_), array(lambda f: f.accurate, np.bool_), array(lambda f: f.limit, np.str_),
        np.array([row[0].area_from for row in (by_rows if columns else zip(lists[0] or lists[1] or lists[2] or ()))]),
        np.array([f.area_to for f in by_rows[0]] if by_rows else []), lists[0], lists[1], lists[2],
        np.array(row_sums, np.float64).reshape(-1, 2), tuple(reasons), reciprocity,
        {name: tuple(ViewFactor(*f) for f in one) for name, one in zip(sums, of_groups)}, by_rows, made, scene._read)


def _reciprocity(found: Any, rows: list[str], columns: list[str]) -> Reciprocity:
    pairs, worst, apart = found

    def named(pair: Any) -> PairOfPatches:
        row, column, distance, radius = pair
        return PairOfPatches(rows[row], columns[column], distance, radius)

    return Reciprocity(pairs, None if worst is None else named(worst), tuple(named(pair) for pair in apart))


def view(scene: Scene, at: ArrayLike, normal: Optional[ArrayLike], on: On = None, *, patches: str = "groups",
         digits: int = 0, precision_cap: int = 65536, measure: Measure = "form-factor",
         up: ArrayLike = (0.0, 0.0, 1.0)) -> View:
    """All that a receiver sees, patch by patch, with the backs of faces and what is open.

    Parameters
    ----------
    at : (3,), a point in the scene's unit of length
    normal : (3,), of any length but 0; None: a small sphere, which sees all directions
    on : own faces, as in :meth:`Scene.form_factors`
    patches : "groups", or "faces" for a value for each face
    digits : raise the precision until so many significant digits are proved
    measure, up : as in :meth:`Scene.form_factors`; solid angles add up to 2 pi, or 4 pi around a sphere

    Every form factor is exact: the bits that :meth:`Scene.form_factor` gives. Raises InputError; the GIL is released.
    """
    if patches not in ("groups", "faces"):
        refuse(f"patches is {patches!r}", "", "choose 'groups' or 'faces'")
    receiver = scene._one_receiver(at, normal, on, "view is for one", "call it for each")
    if not 1 <= precision_cap <= _MOST_BITS:
        refuse(f"precision_cap is {precision_cap}", f"it is a number of bits from 1 to {_MOST_BITS}", "leave it out")
    rows, back, free, buried = _exactff.view(scene._scene, *receiver, patches == "faces", digits, precision_cap,
                                     _arguments.measure_tuple(measure, up, normal is None))

    def share(row: tuple[float, float, float, int]) -> Share:
        return Share(row[0], row[1], row[2], Status(row[3]))

    seen = {name: SeenPatch(share(f), share(s), stacked) for name, f, s, stacked in rows}
    return View(seen, share(back), share(free), buried)


@dataclass(frozen=True)
class Balance:
    """Where the light goes, in the unit of Ke times area: bounds of sums over all patches, one row for each channel.

    ``emitted`` is the sum of ``absorbed`` and ``lost``, unless ``Radiosity.reasons_against_balance`` says why it need not be. Then no
    part is above what is emitted, and none is ever below 0; but a Kd above 1 may make ``absorbed`` negative, and, in a
    channel without a bound, every upper bound infinite. ``back`` and ``open`` are known apart where one of them is
    proved to be zero, or with ``backs=True``. Bounds are as strong as ``Radiosity.claim_of_balance``.
    """

    emitted: Floats  #: (3, 2)
    absorbed: Floats  #: (3, 2)
    back: Floats  #: (3, 2), what meets the backs of faces
    open: Floats  #: (3, 2), what meets nothing
    lost: Floats  #: (3, 2), the last two together


@dataclass(frozen=True)
class Radiosity:
    """The solution of B = E + rho F B, an array entry for each patch and channel. Made by :func:`radiosity`.

    ``value`` is an estimate. The true B lies within ``lower`` and ``upper`` as surely as ``claim`` says, the weakest of
    all view factors. Where ``no_bound`` of a channel is not empty, it says why there is no upper bound: ``upper`` is
    then infinite, and ``value`` may be NaN.
    """

    names: tuple[str, ...]
    areas: Floats  #: (n,), in the square of the scene's unit of length
    value: Floats  #: (n, 3), in the unit of Ke
    lower: Floats  #: (n, 3)
    upper: Floats  #: (n, 3)
    irradiance: Floats  #: (n, 3), the sum of F_ij B_j
    irradiance_lower: Floats  #: (n, 3)
    irradiance_upper: Floats  #: (n, 3)
    claim: str  #: "zero", "certified" or "estimated"
    no_bound: tuple[str, str, str]  #: for red, green and blue; empty if there is a bound
    balance: Balance
    claim_of_balance: str
    reasons_against_balance: tuple[str, ...]
    widest: float  #: of all bounds, as a share of the brightest radiosity of the channel
    computed_again: int  #: view factors, for the width that was asked for


def _width(width: float) -> float:
    value = float(width)
    if not 0.0 < value < float("inf"):
        refuse(f"width is {width!r}", "it is a share of the brightest radiosity", "give a positive number, such as 1e-3")
    return value


def radiosity(scene: Scene, *, accuracy: Optional[float] = None, budget: int = 100_000, width: Optional[float] = None,
              backs: bool = False, threads: int = 0, progress: Progress = None) -> Radiosity:
    """The radiosity of every patch after all bounces, with bounds: the values of ``exactff radiosity`` bit for bit.

    E is Ke, rho is Kd; each patch has one radiosity, so divide patches where that is too coarse.

    Parameters
    ----------
    accuracy, budget : of each view factor, as in :func:`view_factor`; by default 1e-6, or four times ``width``
    width : the widest bounds that are wanted, as a share of the brightest radiosity of each channel. View factors that
        widen some bounds too much are computed again, more accurately
    backs : whether to compute what meets the backs of faces, for the balance
    threads : 0 for as many as this process may use; no value depends on it
    progress : None for a bar of tqdm on a terminal; True, False, or a function of (done, total)

    Raises InputError for a patch whose faces differ in Kd or Ke. A channel without a bound, as in a closed room of
    Kd 1, bounds wider than ``width``, or without it view factors wider than the accuracy, are a ModellingWarning.
    """
    with shown(progress, "view factor") as tell:
        names, areas, numbers, no_bound, claim, parts, claim_of_balance, reasons, wide, widest, again = (
            _exactff.radiosity(scene._scene, None if accuracy is None else _accuracy(accuracy), _budget(budget),
                               None if width is None else _width(width), bool(backs), _arguments.thread_count(threads),
                               tell))
    if width is None:
        _warn_of_width(wide, 1e-6 if accuracy is None else accuracy, budget)
    elif width < widest < np.inf:
        warn(f"the widest bounds are {widest:.2g} of the brightest radiosity wide, not {width:g} (the limit of work for "
             f"an entry, {budget} cells, or roundings)")
    for channel, reason in zip(("red", "green", "blue"), no_bound):
        if reason:
            warn(f"there is no bound for {channel} ({reason})")
    value, lower, upper, irradiance, irradiance_lower, irradiance_upper = (
        np.ascontiguousarray(numbers[:, :, k]) for k in range(6))
    balance = np.array(parts, np.float64)
    return Radiosity(tuple(names), np.array(areas, np.float64), value, lower, upper, irradiance, irradiance_lower,
                     irradiance_upper, claim, (no_bound[0], no_bound[1], no_bound[2]),
                     Balance(balance[:, 0], balance[:, 1], balance[:, 2], balance[:, 3], balance[:, 4]),
                     claim_of_balance, tuple(reasons), widest, again)
