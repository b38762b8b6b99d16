"""Progress bars of tqdm, if it is there."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import sys
import time
from typing import Any, Callable, Iterator, Optional, Union

from ._errors import refuse

Progress = Union[None, bool, Callable[[int, int], object]]
_Tell = Optional[Callable[[int, int], object]]

_PATIENCE = 1.0  # seconds before a bar appears


class _Bar:
    def __init__(self, unit: str, at_once: bool) -> None:
        self._unit = unit
        self._start = time.monotonic() - (_PATIENCE if at_once else 0.0)
        self._bar: Any = None

    def __call__(self, done: int, total: int) -> None:
        if self._bar is None:
            if time.monotonic() - self._start < _PATIENCE:
                return
            self._bar = importlib.import_module("tqdm.auto").tqdm(total=total, unit=self._unit)
        self._bar.update(done - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


def _has_tqdm() -> bool:
    return importlib.util.find_spec("tqdm") is not None


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextlib.contextmanager
def shown(progress: Progress, unit: str) -> Iterator[_Tell]:
    """What to call with (done, total): a function of the user's, a bar, or nothing."""
    if callable(progress):
        yield progress
        return
    if progress is False or (progress is None and not (_is_watched() and _has_tqdm())):
        yield None
        return
    if not _has_tqdm():
        refuse("progress=True needs tqdm, which is not installed", "it draws the bar",
               "install python3-tqdm, or give a function of (done, total)")
    bar = _Bar(unit, at_once=progress is True)
    try:
        yield bar
    finally:
        bar.close()
