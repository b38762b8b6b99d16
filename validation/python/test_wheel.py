"""The wheel."""

import os
import pathlib
import shutil
import sys

import pytest

import exactff
from support import SOURCE, run

PACKAGE = pathlib.Path(exactff.__file__).parent


def test_a_wheel_is_installed_and_works(tmp_path):
    """From the module of this build; validation/wheel.sh compiles it."""
    tree = tmp_path / "tree" / "src" / "outside" / "python"
    pytest.importorskip("wheel")
    made = shutil.ignore_patterns("_skbuild", "build", "*.egg-info")
    shutil.copytree(SOURCE / "src" / "outside" / "python", tree, ignore=made)
    shutil.copy(SOURCE / "CMakeLists.txt", tmp_path / "tree")
    run(sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    environment = {**os.environ, "EXACTFF_BUILT": str(PACKAGE.parents[1]), "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    environment.pop("PYTHONPATH")
    run(python, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index", tree, env=environment)
    show = "import exactff; print(exactff.__version__, exactff.__file__)"
    printed = run(python, "-c", show, cwd="/", env=environment)
    assert printed.startswith(exactff.__version__) and str(tmp_path / "venv") in printed
    installed = pathlib.Path(printed.split()[1]).parent
    assert {file.name for file in installed.glob("*.py*")} == {file.name for file in PACKAGE.glob("*.py*")}
