"""Truth files: certified values with everything that their bytes depend on."""

from __future__ import annotations

import os
from typing import Literal, NamedTuple, Union

from . import _arrays, _exactff
from ._arrays import Names
from ._errors import refuse, warn
from ._files import require_free
from ._progress import Progress, shown
from ._receivers import Receivers
from ._scene import Scene


class TruthSummary(NamedTuple):
    """What :func:`truth` has written."""

    rows: int
    certified: int
    zero: int
    underflow: int
    not_certified: int
    resumed: int  #: rows that were already finished
    seconds: float  #: wall time of computing the other rows


def truth(scene: Scene, receivers: Receivers, path: Union[str, os.PathLike[str]], sources: Names = None, *,
          unoccluded: bool = False, fraction: bool = False, unit_normals: bool = False, uv: bool = False,
          gradient: bool = False,
          existing: Literal["refuse", "resume", "replace"] = "refuse", threads: int = 0,
          progress: Progress = None) -> TruthSummary:
    """Writes a truth file: the bytes that ``exactff truth`` writes for the same scene, receivers and sources.

    Parameters
    ----------
    sources : as in :meth:`Scene.form_factors`; the rows of "sky" are the last of each receiver
    receivers : from :meth:`Scene.receivers`, :meth:`Scene.read_receivers` or :meth:`Scene.receivers_at`
    unoccluded, fraction, unit_normals, uv, gradient : additional columns
    existing : what to do if there is a file or a journal of an interrupted run: "refuse", "resume" or "replace"

    After Ctrl-C or a crash, finished rows are kept in ``PATH.part``; ``existing="resume"`` continues.
    """
    if existing not in ("refuse", "resume", "replace"):
        refuse(f"existing is {existing!r}", "", "choose 'refuse', 'resume' or 'replace'")
    wanted = {"unoccluded": unoccluded, "visible_fraction": fraction, "unit_normals": unit_normals, "uv": uv,
              "gradient": gradient}
    count = _arrays.thread_count(threads)
    require_free(path, "replace", scene._read)
    with shown(progress, "row") as tell:
        rows, by_status, resumed, seconds = _exactff.write_truth(
            scene._scene, scene.name, receivers._list, receivers.name, scene._sources(sources, sky=True), os.fspath(path),
            existing, [column for column, is_wanted in wanted.items() if is_wanted], count, tell)
    certified, zero, underflow, not_certified = by_status
    if not_certified:
        warn(f"{not_certified} of {rows} rows are not certified")
    return TruthSummary(rows, certified, zero, underflow, not_certified, resumed, seconds)
