"""What a scene contains, and likely slips of modelling."""

from __future__ import annotations

from typing import NamedTuple, Optional, Sequence


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

    def __str__(self) -> str:
        lines = _table([("patch", "faces", "area", "front", "emits"), *map(_row, self.patches)])
        lines += ["", f"{len(self.patches)} patches, {self.face_count} faces, {self.vertex_count} vertices",
                  _listed("emitters", self.emitters),
                  _listed("not exactly planar, cut into triangles", self.not_planar),
                  _listed("zero area, ignored", self.ignored), _listed("unusable, left out", self.left_out),
                  f"open edges: {self.open_edges}"]
        lines += [f"contact: {one.share:.3g} of {one.patch} is buried under {one.under}" for one in self.contacts]
        about_contacts = {"on-open-floor", "no-bottom", "near-contact", "overlapping-solids"}
        lines += [f"{'note' if finding.kind in about_contacts else 'check'}: {finding.message}" for finding in self.findings]
        lines += [f"warning: {warning}" for warning in self.warnings]
        return "\n".join(lines)


def _row(patch: Patch) -> tuple[str, ...]:
    front = "mixed" if patch.front is None else "({:.4g}, {:.4g}, {:.4g})".format(*(c + 0.0 for c in patch.front))
    return patch.name, str(len(patch.faces)), f"{patch.area:.6g}", front, "yes" if patch.emits else "no"


def _table(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]


def _listed(title: str, items: Sequence[str], most: int = 12) -> str:
    rest = f" and {len(items) - most} more" if len(items) > most else ""
    return f"{title}: {', '.join(items[:most]) or 'none'}{rest}"
