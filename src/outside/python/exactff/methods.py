"""Every method of computing form factors behind one interface: ``exact`` and the approximate ones that it judges."""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import _arguments, _exactff
from ._arguments import Floats, Names, Progress, shown
from ._scene import _arrays_names, On, Scene

__all__ = ["describe", "evaluate", "names"]


def names() -> list[str]:
    """The names of all methods: ``exact``, ``adaptive``, ``hemicube``, ..."""
    return _exactff.method_names()


def describe(name: str) -> str:
    """Name, summary, and every setting with its meaning, unit, default and range."""
    return _exactff.method_description(name)


def evaluate(method: str, scene: Scene, points: ArrayLike, normals: ArrayLike, sources: Names = None, on: On = None, *,
             threads: int = 0, transparent: Names = None, progress: Progress = None) -> Floats:
    """Form factors by any method, such as ``"hemicube:resolution=256"``, as an array (n, sources) of float64.

    The parameters are those of :meth:`Scene.form_factors`. Values are estimates, except for the method ``exact``; they
    do not depend on the number of threads. Raises InputError for an unknown method or setting, with what is allowed.
    """
    changed = scene if transparent is None else scene.with_transparent(*_arrays_names(transparent))
    shape, p, n = _arguments.receivers(points, normals)
    chosen = scene._sources(sources)
    count = _arguments.thread_count(threads)
    own = changed._own_faces(on, shape, p, n, count)
    with shown(progress, "receiver") as tell:
        values = _exactff.estimates(method, changed._scene, p, n, own, chosen, count, tell)
    return values.reshape(shape + (len(chosen),))
