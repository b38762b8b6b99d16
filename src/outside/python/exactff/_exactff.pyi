"""The compiled part of the package, which states the types that users see. To type checkers, it may be anything."""

from typing import Any

def __getattr__(name: str) -> Any: ...
