#!/usr/bin/env python3
"""Has OpenFOAM or CalculiX read our files, and compares what it computes with `exactff radiosity --temperatures`.

Usage: read_back.py PROGRAM openfoam|calculix

A room of 4 x 3 x 2 m, emissivity 0.8. Ends with 77, which ctest counts as skipped, where the other program is missing.
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CORNERS = [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (0, 0, 2), (4, 0, 2), (4, 3, 2), (0, 3, 2)]
WALLS = {"floor": (0, 1, 2, 3), "ceiling": (4, 7, 6, 5), "west": (0, 3, 7, 4), "east": (1, 5, 6, 2),
         "south": (0, 4, 5, 1), "north": (3, 2, 6, 7)}  # counter-clockwise, seen from inside
ACCURACY = "1e-3"  # the values are the same here and there
KNOWN = {"floor": 350.0, "ceiling": 300.0, "west": 310.0, "east": 320.0, "south": 330.0, "north": 340.0}


def run(command, folder, **environment):
    done = subprocess.run(list(map(str, command)), cwd=folder, env={**os.environ, **environment}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-3000:]}")
    return done.stdout


def write_scene(folder, points, patches):
    """patches: for each name its faces, lists of numbers of points."""
    (folder / "grey.mtl").write_text("newmtl grey\nKd 0.2 0.2 0.2\n")
    (folder / "room.obj").write_text("mtllib grey.mtl\nusemtl grey\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join(
        f"g {name}\n" + "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces)
        for name, faces in patches.items()))


def temperatures(exactff, folder, conditions, *flags):
    """Patch, T, Q of each patch."""
    (folder / "conditions.csv").write_text("patch,T,Q\n" + "".join(f"{c}\n" for c in conditions))
    run([exactff, "radiosity", "room.obj", "--temperatures", "conditions.csv", "--accuracy", ACCURACY, "-o", "t.csv",
         "--force", *flags], folder)
    rows = [row.split(",") for row in (folder / "t.csv").read_text().splitlines() if not row.startswith("#")]
    named = [dict(zip(rows[0], row)) for row in rows[1:]]
    return [(row["patch"], float(row["temperature"]), float(row["heat"])) for row in named if row["area"]]


def worst(pairs):
    return max(abs(theirs / ours - 1.0) for theirs, ours in pairs)


# --- OpenFOAM: heats of walls of known temperatures, by its radiation model viewFactor ---

CASE = {
    "system/controlDict": "startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep;"
                          " writeInterval 1; writeFormat ascii; writePrecision 16;",
    "system/blockMeshDict": "scale 1; vertices (%s); blocks (hex (0 1 2 3 4 5 6 7) (4 3 2) simpleGrading (1 1 1)); edges ();"
                            " boundary (%s);" % (
                                " ".join("(%d %d %d)" % c for c in CORNERS),
                                " ".join("%s {type wall; inGroups (wall viewFactorWall); faces ((%s));}"
                                         % (name, " ".join(map(str, c[::-1]))) for name, c in WALLS.items())),
    "system/fvSchemes": "ddtSchemes {default steadyState;} gradSchemes {default Gauss linear;} divSchemes {default bounded"
                        " Gauss upwind; div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;} laplacianSchemes {default Gauss"
                        " linear corrected;} interpolationSchemes {default linear;} snGradSchemes {default corrected;}",
    "system/fvSolution": 'solvers { p_rgh {solver PCG; preconditioner DIC; tolerance 1e-8; relTol 0.1;} "(U|h)" {solver'
                         " PBiCGStab; preconditioner DILU; tolerance 1e-8; relTol 0.1;}} SIMPLE {momentumPredictor no;"
                         " nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0;} relaxationFactors {}",
    "constant/g": "dimensions [0 1 -2 0 0 0 0]; value (0 0 0);",
    "constant/turbulenceProperties": "simulationType laminar;",
    "constant/thermophysicalProperties": "thermoType {type heRhoThermo; mixture pureMixture; transport const; thermo hConst;"
                                         " equationOfState perfectGas; specie specie; energy sensibleEnthalpy;} mixture"
                                         " {specie {molWeight 28.9;} thermodynamics {Cp 1000; Hf 0;} transport {mu 1.8e-05;"
                                         " Pr 0.7;}}",
    "constant/radiationProperties": "radiation on; radiationModel viewFactor; viewFactorCoeffs {smoothing false;"
                                    " constantEmissivity true; nBands 1; useDirectSolver true;} solverFreq 1;"
                                    " absorptionEmissionModel none; scatterModel none; sootModel none; transmissivityModel"
                                    " none;",
    "constant/boundaryRadiationProperties": '".*" {type lookup; emissivity 0.8; absorptivity 0.8; transmissivity 0;}',
}
FIELDS = {
    "T": ("Scalar", "0 0 0 1 0 0 0", "320", " ".join(f"{name} {{type fixedValue; value uniform {t};}}"
                                                     for name, t in KNOWN.items())),
    "U": ("Vector", "0 1 -1 0 0 0 0", "(0 0 0)", '".*" {type noSlip;}'),
    "p": ("Scalar", "1 -1 -2 0 0 0 0", "1e5", '".*" {type calculated; value uniform 1e5;}'),
    "p_rgh": ("Scalar", "1 -1 -2 0 0 0 0", "1e5", '".*" {type fixedFluxPressure; value uniform 1e5;}'),
    "alphat": ("Scalar", "1 -1 -1 0 0 0 0", "0", '".*" {type calculated; value uniform 0;}'),
    "qr": ("Scalar", "1 0 -3 0 0 0 0", "0", '".*" {type greyDiffusiveRadiationViewFactor; qro uniform 0; emissivityMode'
                                            " lookup; value uniform 0;}"),
}
# By the constants in OpenFOAM's etc/controlDict, which differ from ours.
K, H, C = 1.38065e-23, 6.62607e-34, 2.99792e8
SIGMA_RATIO = 2 * math.pi**5 * K**4 / (15 * H**3 * C**2) / 5.670374419e-8


def write_dictionary(path, kind, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {path.name}; }}\n{text}\n")


def list_of(path):
    """The list in a file of a mesh, without its head and its brackets."""
    text = path.read_text().split("// * *")[1]
    return text[text.index("(") + 1:text.rindex(")")]


def scene_of_mesh(folder):
    """The boundary of a mesh, its faces turned to the inside, in its order."""
    mesh = folder / "constant/polyMesh"
    points = [tuple(p.split()) for p in re.findall(r"\(([^()]*)\)", list_of(mesh / "points"))]
    faces = [list(map(int, f.split()))[::-1] for f in re.findall(r"\(([^()]*)\)", list_of(mesh / "faces"))]
    patches = {}
    for name, entries in re.findall(r"(\w+)\s*\{([^}]*)\}", list_of(mesh / "boundary")):
        count, start = (int(re.search(rf"{word}\s+(\d+);", entries)[1]) for word in ("nFaces", "startFace"))
        patches[name] = faces[start:start + count]
    write_scene(folder, points, patches)
    return {name: len(faces) for name, faces in patches.items()}


def heat_fluxes(folder):
    """The mean over each patch of qr, whose faces have equal areas."""
    means = {}
    for name, entries in re.findall(r"(\w+)\s*\{([^}]*)\}", (folder / "1/qr").read_text().split("boundaryField")[1]):
        if (same := re.search(r"value\s+uniform (\S+);", entries)) is not None:
            means[name] = float(same[1])
        else:
            values = list(map(float, re.search(r"List<scalar>\s*\d+\s*\(([^()]*)\)", entries)[1].split()))
            means[name] = sum(values) / len(values)
    return means


def openfoam(exactff, folder):
    foam = {"WM_PROJECT_DIR": "/usr/share/openfoam"}
    for name, text in CASE.items():
        write_dictionary(folder / name, "uniformDimensionedVectorField" if name == "constant/g" else "dictionary", text)
    for name, (kind, dimensions, value, walls) in FIELDS.items():
        write_dictionary(folder / "0" / name, f"vol{kind}Field",
                         f"dimensions [{dimensions}]; internalField uniform {value}; boundaryField {{{walls}}}")
    run(["blockMesh"], folder, **foam)
    scene_of_mesh(folder)
    for flags, pattern in ([], ""), (["--patches", "faces"], ":*"):  # one coarse face a patch; each face alone
        run([exactff, "matrix", "room.obj", "--balance", "--accuracy", ACCURACY, "--openfoam", "constant/F", "--force", *flags],
            folder)
        shutil.rmtree(folder / "1", ignore_errors=True)
        run(["buoyantSimpleFoam"], folder, **foam)
        ours = dict.fromkeys(KNOWN, 0.0)
        for patch, _, heat in temperatures(exactff, folder, (f"{name}{pattern},{t}," for name, t in KNOWN.items()), *flags):
            ours[patch.split(":")[0]] += heat
        areas = {name: math.dist(*(CORNERS[k] for k in c[:2])) * math.dist(*(CORNERS[k] for k in c[1:3]))
                 for name, c in WALLS.items()}
        error = worst((-flux * areas[name], ours[name] * SIGMA_RATIO) for name, flux in heat_fluxes(folder).items())
        print(f"OpenFOAM {' '.join(flags) or 'with a coarse face for each patch'}: heats differ by {error:.1e}")
        if not error < 1e-6:
            sys.exit("OpenFOAM computes other heats")


# --- CalculiX: temperatures of two walls, one of which is heated ---

DECK = """*NODE, NSET=NODES
{nodes}
*ELEMENT, TYPE=C3D8, ELSET=BRICKS
{bricks}
*MATERIAL, NAME=SOLID
*CONDUCTIVITY
100.
*SOLID SECTION, MATERIAL=SOLID, ELSET=BRICKS
*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0, STEFAN BOLTZMANN=5.670374419E-8
*INITIAL CONDITIONS, TYPE=TEMPERATURE
NODES, 320.
{start}
*STEP, INC=1000
*HEAT TRANSFER, STEADY STATE
*CONTROLS, PARAMETERS=FIELD
1e-9, 1e-9
*BOUNDARY
{known}
*CFLUX
{heat}
*RADIATE
BRICKS, R1CR, 300., 0.8
*VIEWFACTOR, READ, INPUT=ours.vwf
*NODE PRINT, NSET=NODES
NT
*END STEP
"""
HEATED = {"south": 0.0, "north": 800.0}


def calculix(exactff, folder):
    write_scene(folder, CORNERS, {name: [c] for name, c in WALLS.items()})
    run([exactff, "matrix", "room.obj", "--balance", "--accuracy", ACCURACY, "--calculix", "ours.vwf"], folder)
    nodes, bricks, of = [], [], {}
    for name, wall in WALLS.items():  # face 1 of a brick runs clockwise, seen from its front
        front = [CORNERS[k] for k in wall[::-1]]
        centre = [sum(p[k] for p in CORNERS) / 8 for k in range(3)]
        across = next(k for k in range(3) if len({p[k] for p in front}) == 1)
        outward = math.copysign(0.01, front[0][across] - centre[across])
        of[name] = range(len(nodes) + 1, len(nodes) + 9)
        nodes += front + [tuple(x + (outward if k == across else 0) for k, x in enumerate(p)) for p in front]
        bricks.append(", ".join(map(str, [len(bricks) + 1, *of[name]])))
    fixed = {name: t for name, t in KNOWN.items() if name not in HEATED}
    (folder / "room.inp").write_text(DECK.format(
        nodes="\n".join("%d, %r, %r, %r" % (k, *map(float, p)) for k, p in enumerate(nodes, 1)),
        bricks="\n".join(bricks), start="\n".join(f"{k}, {t}" for name, t in fixed.items() for k in of[name]),
        known="\n".join(f"{k}, 11, 11, {t}" for name, t in fixed.items() for k in of[name]),
        heat="\n".join(f"{k}, 11, {q / 8}" for name, q in HEATED.items() for k in of[name])))
    run(["ccx", "room"], folder, OMP_NUM_THREADS="1")
    found = {int(k): float(t) for k, t in re.findall(r"^ +(\d+) +(\S+)$", (folder / "room.dat").read_text(), re.M)}
    theirs = {name: sum(found[k] for k in of[name][:4]) / 4 for name in WALLS}  # of the front
    conditions = [f"{name},{t}," for name, t in fixed.items()] + [f"{name},,{q}" for name, q in HEATED.items()]
    ours = {patch: t for patch, t, _ in temperatures(exactff, folder, conditions)}
    for name in HEATED:
        print(f"CalculiX, {name}: {theirs[name]:.4f} K, ours {ours[name]:.4f} K")
    if not worst((theirs[name], ours[name]) for name in WALLS) < 1e-6:
        sys.exit("CalculiX computes other temperatures")


if __name__ == "__main__":
    if shutil.which({"openfoam": "buoyantSimpleFoam", "calculix": "ccx"}[sys.argv[2]]) is None:
        print(f"{sys.argv[2]} is not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        {"openfoam": openfoam, "calculix": calculix}[sys.argv[2]](pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder))
