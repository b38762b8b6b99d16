"""Types, by mypy."""

import os
import pathlib
import sys

import pytest

import exactff
from support import run

PACKAGE = pathlib.Path(exactff.__file__).parent


def test_the_package_is_typed(tmp_path):
    pytest.importorskip("mypy")
    user = tmp_path / "user.py"
    user.write_text("import exactff\nimport numpy as np\n"
                    "scene = exactff.Scene.read('room.obj')\n"
                    "values: 'np.ndarray' = scene.form_factors([[0, 0, 0]], [0, 0, 1], ['light'], on='auto')\n"
                    "turned: exactff.Scene = scene.with_flipped('wall_*', ['floor', 'lamp']).triangulated()\n"
                    "turned.write('new.ply', encoding='text', existing='replace')\n"
                    "exactff.view_factor_matrix(turned, 'all', ['wall_*', 'sky']).save('m.npz')\n"
                    "unit: 'np.ndarray' = scene.receivers('floor', grid=3).unit_normals\n"
                    "word: str = scene.form_factor([0, 0, 0], [0, 0, 1]).enclosure.midpoint\n")
    mypy = (sys.executable, "-m", "mypy", "--cache-dir", tmp_path / "cache")
    run(*mypy, "--strict", "--no-warn-return-any", "-p", "exactff", cwd=PACKAGE.parent)  # the compiled part is Any
    environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent)}
    run(*mypy, user, env=environment)
    assert (PACKAGE / "py.typed").exists()
