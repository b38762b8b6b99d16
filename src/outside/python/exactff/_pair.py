"""Results: one form factor with its proof, and arrays of them."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _exactff
from ._arguments import Floats
from ._exactff import Enclosure

_MOST_SHARES = 20


class Status(enum.IntEnum):
    """How far a value is proved."""

    CERTIFIED = 0  #: the true form factor, rounded to the nearest double
    ZERO = 1  #: the form factor is proved to be exactly 0
    UNDERFLOW = 2  #: it is positive and rounds to 0
    NOT_CERTIFIED = 3  #: the precision cap was reached; the enclosure is valid all the same

    def __str__(self) -> str:
        return _exactff.status_name(int(self))


class DerivativeStatus(enum.IntEnum):
    """How far a derivative is proved."""

    CERTIFIED = 0  #: the true derivative, rounded to the nearest double; not 0
    ZERO = 1  #: the derivative is proved to be exactly 0
    UNDERFLOW = 2  #: it is not 0 and rounds to 0
    ENCLOSED = 3  #: its ball does not determine the double; 0 if the ball still contains 0 at 256 bits
    KINK = 4  #: the derivative does not exist; its value is NaN


class Drawing:
    """A picture in SVG. A notebook shows it; ``save`` writes it."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str) -> None:
        """Writes the SVG document to a file."""
        with open(path, "w", encoding="utf-8") as out:
            out.write(self.svg)

    def __repr__(self) -> str:
        return f"<exactff.Drawing: {len(self.svg)} characters of SVG>"


@dataclass(frozen=True)
class VertexGradient:
    """The derivatives of one form factor by the vertices that move the visible boundary, per unit of length.

    Vertices at equal coordinates move together; the receiver does not move. A vertex by which there is no derivative has
    NaN and the status of a kink."""

    vertex: NDArray[np.int64]  #: (m,) indices into the scene's vertices, the lowest at each place
    place: Floats  #: (m, 3) coordinates
    derivative: Floats  #: exact: (m, 3), correctly rounded where certified
    status: NDArray[np.int8]  #: (m, 3), see :class:`DerivativeStatus`
    enclosures: tuple[tuple[Enclosure, ...], ...]  #: encloses: a ball for each; without meaning at kinks
    frames: NDArray[np.int64]  #: (faces, 3) the vertices that the plane of each face of the source follows


@dataclass(frozen=True)
class Gradient:
    """The derivatives of one form factor F by the receiver's point, per unit of length, and V with F = n . V / abs(n).

    At a kink dF/dx does not exist: `position` is NaN, and `kink` says why. V, dF/dn at a unit normal, always exists."""

    position: Floats  #: exact: (3,) dF/dx, dF/dy, dF/dz, correctly rounded where certified
    position_status: tuple[DerivativeStatus, ...]  #: of each
    position_enclosures: tuple[Enclosure, ...]  #: encloses: a ball for each; without meaning at a kink
    normal: Floats  #: exact: (3,) V, correctly rounded where certified
    normal_status: tuple[DerivativeStatus, ...]  #: of each
    normal_enclosures: tuple[Enclosure, ...]  #: encloses: a ball for each
    kink: Optional[str]  #: why dF/dx does not exist; None if it does
    kink_faces: tuple[str, ...]  #: names of the faces that meet there
    vertices: Optional[VertexGradient] = None  #: None unless ``vertices=True``, and at a kink


@dataclass(frozen=True, repr=False, eq=False)
class FormFactor:
    """The exact form factor from one receiver to one source. ``float(f)`` is its value.

    Made by :meth:`Scene.form_factor`. If ``status`` is certified, ``value`` is the true form factor, rounded to the
    nearest double (ties to even), and ``lower`` and ``upper`` are its neighbours. ``enclosure`` always contains the
    true form factor.
    """

    value: float  #: exact: correctly rounded; a pure number in [0, 1]
    lower: float  #: encloses: a double that is not above the form factor
    upper: float  #: encloses: a double that is not below it
    status: Status  #: how far the value is proved
    enclosure: Enclosure  #: encloses: a ball that contains the form factor
    source: str  #: its name
    precision_bits: int  #: of the last evaluation of the contour integral; 0 if none was needed
    visible_fraction: Optional[float]  #: exact: visible over whole area of the source; None unless ``fraction=True``
    visible_part: Optional[str]  #: "none", "some" or "all", decided exactly; None unless ``fraction=True``
    gradient: Optional[Gradient]  #: the derivatives by the receiver's point and normal; None unless ``gradient=True``
    _pair: _exactff.Pair
    _ask: _Again

    @classmethod
    def _made(cls, pair: _exactff.Pair, ask: _Again) -> FormFactor:
        value, lower, upper, status, ball, source, bits, fraction, part = pair.facts()
        return cls(value, lower, upper, Status(status), ball, source, bits, fraction, part, _gradient(pair.gradient()),
                   pair, ask)

    def explain(self) -> str:
        """What was computed and why, in words: the stages for each plane of the source, and the occluders that hide a
        part of it, with the share of the unoccluded form factor that each hides alone (estimates)."""
        return _explanation(self, self._ask(list_cutters=True), self._ask)

    def draw(self) -> Drawing:
        """The source as the receiver sees it: shadows of the occluders, and the exact visible region. Coordinates in
        the picture are rounded."""
        return Drawing(self._pair.svg())

    def __float__(self) -> float:
        return self.value

    def __repr__(self) -> str:
        return f"<exactff.FormFactor to {self.source!r}: {self.value!r} ({self.status})>"


def _gradient(found: Any) -> Optional[Gradient]:
    if found is None:
        return None
    kink, position, normal, vertices, frames = found
    return Gradient(*_derivatives(position), *_derivatives(normal), None if kink is None else kink[0],
                    () if kink is None else tuple(kink[1]), _vertices(vertices, frames) if frames else None)


def _derivatives(found: Any) -> tuple[Floats, tuple[DerivativeStatus, ...], tuple[Enclosure, ...]]:
    values, status, balls = zip(*found)
    return np.array(values), tuple(map(DerivativeStatus, status)), balls


def _vertices(found: Any, frames: list[list[int]]) -> VertexGradient:
    return VertexGradient(
        np.array([vertex for vertex, _, _ in found], dtype=np.int64),
        np.array([place for _, place, _ in found], dtype=np.float64).reshape(-1, 3),
        np.array([[value for value, _, _ in three] for _, _, three in found], dtype=np.float64).reshape(-1, 3),
        np.array([[status for _, status, _ in three] for _, _, three in found], dtype=np.int8).reshape(-1, 3),
        tuple(tuple(ball for _, _, ball in three) for _, _, three in found),
        np.array(frames, dtype=np.int64).reshape(-1, 3))


class _Again:
    """Computes the same pair with other options."""

    def __init__(self, scene: _exactff.Scene, point: tuple[float, ...], normal: tuple[float, ...], on: list[int],
                 source: str, measure: tuple[str, tuple[float, float, float], bool]) -> None:
        self.scene = scene
        self._fixed = (point, normal, on, source)
        self._measure = measure

    def __call__(self, fraction: bool = False, list_cutters: bool = False, digits: int = 0, precision_cap: int = 65536,
                 only_occluders: Optional[list[int]] = None, gradient: bool = False,
                 vertices: bool = False) -> _exactff.Pair:
        return _exactff.form_factor(self.scene, *self._fixed, fraction, list_cutters, gradient, vertices, digits,
                                    precision_cap, only_occluders, self._measure)


def _explanation(f: FormFactor, pair: _exactff.Pair, ask: _Again) -> str:
    lines = [f"source {f.source}", f"  form factor  {f.value!r}  ({f.status})",
             f"  enclosure    [{f.lower!r}, {f.upper!r}]"]
    for faces, outcome, notes, _ in pair.planes():
        more = f" and {len(faces) - 1} more faces" if len(faces) > 1 else ""
        lines += ["", f"  plane of {faces[0]}{more}: {outcome}"]
        lines += [f"    {stage:<24}{'ran' if ran else '-':<5}{note}".rstrip() for stage, ran, note in notes]
    cutters = pair.cutters()
    lines += ["", f"  occluders that hide a part of it: {len(cutters)}"]
    free = ask(only_occluders=[]).value
    if free > 0.0:
        shares = [(1.0 - ask(only_occluders=[face]).value / free, face) for face in cutters[:_MOST_SHARES]]
        for share, face in sorted(shares, key=lambda one: -one[0]):
            lines.append(f"    {ask.scene.face_name(face):<28}hides {100.0 * share:.3g} % alone")
        if len(cutters) > _MOST_SHARES:
            lines.append(f"    ... and {len(cutters) - _MOST_SHARES} more")
    lines.append(f"  unoccluded form factor: {free!r}")
    return "\n".join(lines)


@dataclass(frozen=True)
class FormFactors:
    """Exact form factors of many receivers, as arrays of shape (receivers, sources)."""

    value: Floats  #: exact: correctly rounded where certified
    lower: Floats  #: encloses: not above the true value
    upper: Floats  #: encloses: not below the true value
    status: NDArray[np.int8]  #: see :class:`Status`
    precision_bits: NDArray[np.int32]  #: of the last evaluation of the contour integral; 0 if none was needed
    visible_fraction: Optional[Floats]  #: exact: visible over whole area; None unless ``fraction=True``
    sources: tuple[str, ...]  #: names of the columns
    #: exact: dF/dx, dF/dy, dF/dz on a last axis of 3, NaN at kinks; None unless ``gradient=True``
    gradient: Optional[Floats] = None
    gradient_status: Optional[NDArray[np.int8]] = None  #: of each, see :class:`DerivativeStatus`
