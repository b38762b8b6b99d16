"""The light that leaves each patch after all its bounces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from . import _arrays, _exactff
from ._arrays import Floats
from ._errors import refuse, warn
from ._progress import Progress, shown
from ._scene import Scene
from ._views import _accuracy, _budget, _warn_of_width


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
                               None if width is None else _width(width), bool(backs), _arrays.thread_count(threads),
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
