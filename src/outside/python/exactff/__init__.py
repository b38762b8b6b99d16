"""Exact form factors (view factors) from points to polygonal patches, with proof.

>>> import exactff
>>> room = exactff.Scene.read("data/scenes/cornell_box.obj")
>>> f = room.form_factor([200, 0, 400], [0, 1, 0], "light", on="floor")
>>> f.value, str(f.status)
(0.010822702782492406, 'certified')

Form factors are pure numbers; lengths are in the unit of the scene. Every coordinate means exactly the value of its
double. Errors in the input raise :class:`InputError`; likely slips of modelling warn as :class:`ModellingWarning`.
"""

import importlib.util
import sys

if importlib.util.find_spec("numpy") is None:
    raise ImportError(
        f"exactff needs NumPy, which {sys.executable} (Python {sys.version.split()[0]}) does not have. Install it: "
        f"`{sys.executable} -m pip install numpy` in a virtual environment, or Debian's package python3-numpy for its own "
        "Python"
    )

try:
    from . import _exactff
except ImportError as error:
    import pathlib

    found = ", ".join(file.name for file in pathlib.Path(__file__).parent.glob("_exactff*.so")) or "is missing"
    raise ImportError(
        f"the compiled part of exactff ({found}) cannot be loaded by {sys.executable}, Python {sys.version.split()[0]}: "
        f"{error}. Start the Python that CMake named ('Python: ON, for ...'), or build with -DPython_EXECUTABLE=PYTHON "
        "for another one that has NumPy"
    ) from error

from . import methods
from ._arguments import InputError, ModellingWarning, Problem
from ._check import (check, CheckReport, Distribution, Improvement, RowError, scoreboard, Scoreboard, truth,
                     TruthSummary, Verdict)
from ._geometry import Contact, Finding, Gap, Lightmap, Material, Patch, Receivers, Report, Welding
from ._exactff import Enclosure
from ._pair import DerivativeStatus, Drawing, FormFactor, FormFactors, Gradient, Status, VertexGradient
from ._scene import Scene
from ._views import (Balance, ExchangeFactors, PairOfPatches, radiosity, Radiosity, Reciprocity, SeenPatch, Share, Temperatures, View,
                     view, view_factor, view_factor_matrix, ViewFactor, ViewFactorMatrix)

__version__ = _exactff.version

__all__ = [
    "Balance", "CheckReport", "Contact", "DerivativeStatus", "Distribution", "Drawing", "Enclosure", "Finding", "FormFactor",
    "ExchangeFactors", "FormFactors", "Gap", "Gradient", "Improvement", "InputError", "Lightmap", "Material", "ModellingWarning", "PairOfPatches", "Patch", "Problem", "Radiosity", "Receivers",
    "Reciprocity", "Report", "RowError",
    "Scene", "Scoreboard", "SeenPatch", "Share", "Status", "Temperatures", "TruthSummary", "Verdict", "VertexGradient", "View", "ViewFactor", "ViewFactorMatrix", "Welding",
    "__version__", "check", "methods", "radiosity", "scoreboard", "truth", "view", "view_factor",
    "view_factor_matrix",
]
