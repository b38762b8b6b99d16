"""The package: docstrings, examples, the blocks in the documents."""

import inspect
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import exactff
from support import CORNELL, program, SCENES, SOURCE, run

PACKAGE = pathlib.Path(exactff.__file__).parent
EXAMPLES = SOURCE / "src" / "outside" / "python" / "examples"


def public_things():
    for name in exactff.__all__:
        thing = getattr(exactff, name)
        if name not in ("__version__", "methods"):
            yield name, thing
        if inspect.isclass(thing):
            own = {key: value for key, value in vars(thing).items() if not key.startswith("_")}
            yield from ((f"{name}.{key}", value) for key, value in own.items()
                        if inspect.isfunction(value) or isinstance(value, (property, classmethod)))
    yield from ((f"methods.{name}", getattr(exactff.methods, name)) for name in exactff.methods.__all__)


def test_everything_public_has_a_docstring():
    without = [name for name, thing in public_things() if not inspect.getdoc(thing)]
    assert not without and exactff.__version__ in (SOURCE / "CMakeLists.txt").read_text()


def test_the_map_of_the_cornell_box(tmp_path):
    pytest.importorskip("matplotlib")
    printed = run(sys.executable, EXAMPLES / "cornell_map.py", CORNELL, tmp_path / "map.png")
    assert printed.startswith("6400 cells, brightest 0.0")
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")


def test_the_mesh_for_paraview(tmp_path):
    meshio = pytest.importorskip("meshio")
    out = tmp_path / "blocks.vtu"
    run(sys.executable, EXAMPLES / "paraview_mesh.py", CORNELL, "tall_block", "light", out)
    mesh = meshio.read(out)
    scene = exactff.Scene.read(CORNELL)
    at = scene.receivers("tall_block", centres=True, per_face=True)
    exact = scene.form_factors(at.points, at.normals, "light", at.on)
    assert sum(len(block.data) for block in mesh.cells) == len(exact)
    assert sorted(v for block in mesh.cell_data["form_factor"] for v in block) == sorted(exact[:, 0])


def test_the_test_of_accuracy(tmp_path):
    """The example passes; where its limits are too strict, it says where."""
    pytest_of = (sys.executable, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider")
    example = (EXAMPLES / "test_accuracy.py").read_text()
    shutil.copy(EXAMPLES / "test_accuracy.py", tmp_path)
    assert "4 passed" in run(*pytest_of, "test_accuracy.py", cwd=tmp_path)
    (tmp_path / "test_strict.py").write_text(example.replace("max_abs=0.05", "max_abs=1e-9"))
    strict = subprocess.run([*pytest_of, "test_strict.py"], capture_output=True, text=True, cwd=tmp_path)
    assert strict.returncode == 1 and "AssertionError: max-abs: " in strict.stdout
    assert "worst at receiver 'r" in strict.stdout and "_check.py" not in strict.stdout


def test_without_numpy_it_says_what_to_install():
    """-S: without the folders in which NumPy is."""
    failed = subprocess.run([sys.executable, "-S", "-c", "import exactff"], capture_output=True, text=True)
    assert failed.returncode == 1 and "\nImportError: exactff needs NumPy" in failed.stderr
    assert "-m pip install numpy" in failed.stderr and "python3-numpy" in failed.stderr
    assert "ModuleNotFoundError" not in failed.stderr


def test_an_occluder_is_found_from_its_shadow():
    """The script asserts that it converges."""
    assert run(sys.executable, "-B", EXAMPLES / "find_occluder.py")


def test_the_doctest_of_the_package():
    code = "import doctest, exactff, sys; sys.exit(doctest.testmod(exactff).failed)"
    run(sys.executable, "-c", code, cwd=SOURCE)
    assert SCENES.is_dir()


def test_the_turned_panel_computes_only_what_it_may_change():
    """What is kept has the bits of a fresh computation."""
    example = (EXAMPLES / "turned_panel.py").read_text()
    assert len(example.splitlines()) < 40
    kept = run(sys.executable, "-B", EXAMPLES / "turned_panel.py").splitlines()
    assert len(kept) == 13 and kept[-1] == "220 of 352 factors were kept"
    anew = run(sys.executable, "-B", "-c", example.replace("keep = before is not None and", "keep = False and")).splitlines()
    assert anew[:-1] == kept[:-1] and anew[-1] == "0 of 352 factors were kept"


def test_the_thermal_network_has_the_temperatures_of_the_program(tmp_path):
    example = EXAMPLES / "thermal_network.py"
    assert len(example.read_text().splitlines()) < 40
    cavity = SOURCE / "data" / "scenes" / "triangular_cavity.obj"
    found = {line.split()[0]: float(line.split()[1]) for line in run(sys.executable, "-B", example, cavity).splitlines()[:-1]}
    (tmp_path / "known.csv").write_text("patch,T,Q\nbottom,400,\nside,280,\nslope,,0\nends,,0\n")
    rows = program("radiosity", cavity, "--temperatures", tmp_path / "known.csv", "--accuracy", "1e-3", "--csv").splitlines()
    for row in rows[-6:-2]:
        name, kelvin = row.split(",")[:2]
        assert found[name] == pytest.approx(float(kelvin), abs=0.01)


def test_mean_radiant_temperatures_lie_between_those_of_the_walls():
    example = EXAMPLES / "mean_radiant.py"
    assert len(example.read_text().splitlines()) < 40
    lines = run(sys.executable, "-B", example, CORNELL).splitlines()
    assert len(lines) == 10
    assert all(-5.0 < float(line.rsplit("degrees", 1)[0].split()[-1]) < 30.0 for line in lines[:-1])
