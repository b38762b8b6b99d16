"""Files that the package writes."""

from __future__ import annotations

import os
from typing import Iterator, Sequence, Union

from ._errors import refuse

Path = Union[str, "os.PathLike[str]"]


def check_existing(existing: str) -> None:
    """Refuses other words than "refuse" and "replace"."""
    if existing not in ("refuse", "replace"):
        refuse(f"existing is {existing!r}", "", "choose 'refuse' or 'replace'")


def require_free(path: Path, existing: str, read: Sequence[Path] = ()) -> None:
    """Refuses a file that exists, unless it may be replaced; and always one that was read."""
    name = os.fspath(path)
    if not os.path.isfile(name):
        return
    if any(os.path.samefile(name, file) for one in read for file in _read_with(os.fspath(one))):
        refuse(f"{name}: is read and would be replaced", "its contents would be lost", "name another file")
    if existing != "replace":
        refuse(f"{name}: already exists", "it may hold something else",
               "name another file, or replace it with existing='replace'")


def _read_with(path: str) -> Iterator[str]:
    """The file and, of an OBJ file, its MTL files, as far as they still exist."""
    if not os.path.isfile(path):
        return
    yield path
    if not path.lower().endswith(".obj"):
        return
    with open(path, encoding="utf-8", errors="surrogateescape") as lines:
        for line in lines:
            if line.lstrip().startswith("mtllib"):
                names = line.strip()[len("mtllib"):].strip()
                for name in {names, *names.split()}:
                    library = os.path.join(os.path.dirname(path), name)
                    if os.path.isfile(library):
                        yield library
