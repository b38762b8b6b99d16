"""An accuracy test of a program's form factors: python -m pytest test_accuracy.py"""

import pytest

import exactff

LIMITS = dict(max_abs=0.05, rms=5e-3)


def mine(scene, at):
    """Call your own code here. This stands for it: 256 shadow rays to each lamp."""
    return exactff.methods.evaluate("area-sampling:samples=256", scene, at.points, at.normals, on=at.on)


@pytest.fixture(scope="session", params=["room", "closed-room"])
def scene(request):
    return exactff.Scene.from_model(request.param)  # or exactff.Scene.read("room.obj")


@pytest.mark.parametrize("patch", ["floor", "table_top"])
def test_form_factors(scene, patch, tmp_path):
    at = scene.receivers(patch, grid=(16, 12))
    exact = scene.form_factors(at.points, at.normals, on=at.on, full=True)
    report = exactff.check(exact, mine(scene, at), receivers=at, junit=tmp_path / "accuracy.xml", **LIMITS)
    report.raise_if_failed()
