"""Errors and warnings."""

from __future__ import annotations

import sys
import warnings
from types import FrameType
from typing import NamedTuple, NoReturn, Optional

from . import _exactff


class Problem(NamedTuple):
    """One problem in the input: where it is, what is wrong, why it matters, and what to do. Parts may be empty."""

    file: str
    line: int
    what: str
    why: str
    suggestion: str
    message: str


class InputError(ValueError):
    """Bad input: a file, an array, a name or an option. ``str(error)`` has one line for each problem."""

    _problems: tuple[tuple[str, int, str, str, str, str], ...] = ()

    @property
    def problems(self) -> tuple[Problem, ...]:
        """All problems that were found, in the order of the input."""
        return tuple(Problem(*fields) for fields in self._problems)


class ModellingWarning(UserWarning):
    """The input is legal, but may not be what was meant: a point a hair behind its floor, say. Also: a value that is
    not certified."""


_exactff._set_input_error(InputError)


def refuse(what: str, why: str = "", suggestion: str = "") -> NoReturn:
    """Raises an InputError in the wording of the library."""
    message = what + (f" ({why})" if why else "") + (f"; {suggestion}" if suggestion else "")
    error = InputError(message)
    error._problems = (("", 0, what, why, suggestion, message),)
    raise error


def warn(message: str) -> None:
    """Warns at the line of the user's program that called into the package."""
    frame: Optional[FrameType] = sys._getframe(1)
    level = 2
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, ModellingWarning, stacklevel=level)
