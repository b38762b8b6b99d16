"""``python3 -m exactff convert IN OUT``: the program's ``convert``, for meshes that meshio reads as well.

Exit codes are those of the program: 0 done, 2 bad input, in one sentence."""

import argparse
import os
import sys
import warnings
from typing import Any

from . import _meshes
from ._arguments import InputError
from ._scene import Scene

_OWN = (".obj", ".ply", ".stl", ".off", ".vs3")


def _scene(path: str) -> Scene:
    extension = os.path.splitext(path)[1].lower()
    try:
        is_foreign = extension not in _OWN and extension in _meshes.meshio().extension_to_filetypes
    except InputError:  # without meshio, the reader tells what the file is
        is_foreign = False
    return Scene.from_meshio(path) if is_foreign else Scene.read(path)


def _main() -> int:
    parser = argparse.ArgumentParser(prog="python3 -m exactff")
    convert = parser.add_subparsers(required=True, metavar="convert").add_parser(
        "convert", help="write a mesh that exactff or meshio reads as a scene of exactff")
    convert.add_argument("IN", help="of volume cells, the outer faces count; groups and sets are patches")
    convert.add_argument("OUT", help=", ".join(_OWN) + "; never the file that is read")
    convert.add_argument("--force", action="store_true", help="replace an existing file")
    given = parser.parse_args()
    warnings.simplefilter("always")
    warnings.showwarning = lambda message, *_, **__: print(f"warning: {message}", file=sys.stderr)
    existing: Any = "replace" if given.force else "refuse"
    try:
        _scene(given.IN).write(given.OUT, existing=existing)
    except InputError as error:
        print(f"error: {error}".replace("existing='replace'", "--force"), file=sys.stderr)
        return 2
    print(f"wrote {given.OUT}")
    return 0


if __name__ == "__main__":
    sys.exit(_main())
