"""The wheel."""

import os
import pathlib
import re
import shutil
import sys

import pytest

import exactff
from support import CORNELL, SOURCE, run

PACKAGE = pathlib.Path(exactff.__file__).parent


def test_a_wheel_is_installed_and_works(tmp_path):
    """From the module of this build; validation/wheel.sh compiles it. With the libraries inside, it needs none of the
    system but those of C and C++."""
    tree = tmp_path / "tree" / "src" / "outside" / "python"
    pytest.importorskip("wheel")
    if not shutil.which("patchelf"):
        pytest.skip("patchelf is not installed")
    made = shutil.ignore_patterns("_skbuild", "build", "*.egg-info")
    shutil.copytree(SOURCE / "src" / "outside" / "python", tree, ignore=made)
    shutil.copy(SOURCE / "CMakeLists.txt", tmp_path / "tree")
    run(sys.executable, "-m", "venv", "--system-site-packages", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    environment = {**os.environ, "EXACTFF_BUILT": str(PACKAGE.parents[1]), "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    environment.pop("PYTHONPATH")
    run(python, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "-w", tmp_path, tree, env=environment)
    linked = next(tmp_path.glob("*.whl"))
    run(sys.executable, tree / "bundle.py", linked, tmp_path / "bundled")
    wheel = next((tmp_path / "bundled").iterdir())
    assert re.fullmatch(rf"exactff-{exactff.__version__}-cp\d+-cp\d+-manylinux_2_\d+_x86_64.whl", wheel.name)
    run(python, "-m", "pip", "install", "--no-deps", "--no-index", wheel, env=environment)
    printed = run(python, SOURCE / "validation" / "python" / "try_wheel.py", CORNELL, cwd="/", env=environment)
    assert str(tmp_path / "venv") in printed
    installed = pathlib.Path(printed.split()[0])
    needed = {name for file in installed.rglob("*.so*")
              for name in re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", file))}
    outside = needed - {file.name for file in installed.rglob("*.so*")}
    assert outside <= {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "libstdc++.so.6", "libgcc_s.so.1",
                       "ld-linux-x86-64.so.2"}, outside
    assert any(file.name.startswith("copyright-libflint") for file in (installed / "libs").iterdir())
    assert {file.name for file in installed.glob("*.py*")} == {file.name for file in PACKAGE.glob("*.py*")}
