"""Receivers: points with normals."""

from __future__ import annotations

from typing import Sequence

from . import _exactff
from ._arrays import Floats, Ints


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
