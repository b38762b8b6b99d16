#!/usr/bin/env python3
"""Asks programs the questions of data/suite.

Usage: suite.py PROGRAM FOLDER [NAME...]
       suite.py PROGRAM --board FOLDER    grades data/field/suite: its table, and FOLDER with the page

Writes FOLDER/NAME.csv with the columns question and value, for every program or for those named, and times.json. What a
program cannot be asked is left out: points are asked of methods for points and of POV-Ray, pairs of OpenFOAM and
CalculiX, the sky of none.
"""

import json
import os
import pathlib
import shutil
import sys
import time

import numpy

import calculix
import exactff
import factors
import openfoam

SUITE = pathlib.Path(__file__).resolve().parents[2] / "data" / "suite"
METHODS = {  # 1,024 rays or samples, or pixels in proportion
    "adaptive-literal": "adaptive:variant=literal,rays=256",
    "adaptive-mended": "adaptive:rays=256",
    "hemicube-256": "hemicube:resolution=256",
    "nettle-16x16": "nettle:splits=16",
    "wallace-32x32": "wallace:splits=32",
    "area-sampling-1024": "area-sampling:samples=1024,pattern=stratified",
}
ACROSS = {"openfoam": (33, {"block": 1}), "calculix": (17, {"sink": "300."})}  # cells along the longest edge
MOST_CELLS = 2500
POVRAY = """#version 3.7;
global_settings {{ assumed_gamma 1 radiosity {{ pretrace_start 1 pretrace_end 1 count 1600 nearest_count 1
  recursion_limit 1 error_bound 0.1 low_error_factor 1 minimum_reuse 1e-5 maximum_reuse 1e-3 }} }}
#default {{ finish {{ ambient 0 diffuse 0 }} pigment {{ rgb 0 }} }}
camera {{ orthographic location {camera} direction {down} right {right} up {up} }}
mesh {{ {receiver} pigment {{ rgb 1 }} finish {{ diffuse 1 }} }}
"""


def questions():
    return factors.rows_of(SUITE / "questions.csv")


def scene_file(question):
    return SUITE / "scenes" / f"{question['scene']}.obj"


def ask_method(method):
    """The form factors at points, of patches; each question on its own."""
    scenes = {}
    for q in questions():
        if q["quantity"] != "form factor" or q["to"] == "sky":
            continue
        if q["scene"] not in scenes:
            scenes[q["scene"]] = exactff.Scene.read(str(scene_file(q)))
        point, normal = ([[float(q[c]) for c in columns]] for columns in (("x", "y", "z"), ("nx", "ny", "nz")))
        try:
            value = exactff.methods.evaluate(method, scenes[q["scene"]], point, normal, q["to"], q["on"] or None)
        except exactff.InputError as error:  # a scene that single precision cannot hold
            print(f"{q['question']}: {str(error).splitlines()[0][:150]}")
            continue
        yield q["question"], float(value[0, 0])


def triangles(corners):
    return " ".join("triangle { " + ", ".join("<%r, %r, %r>" % tuple(map(float, c)) for c in (corners[0], a, b)) + " }"
                    for a, b in zip(corners[1:], corners[2:]))


def povray_scene(q):
    """A white square on the receiver, lit by the source, which emits from its front, by the rays of `radiosity`."""
    vertices, patches = factors.read_obj(scene_file(q))
    x, n = (numpy.array([float(q[c]) for c in columns]) for columns in (("x", "y", "z"), ("nx", "ny", "nz")))
    n /= numpy.linalg.norm(n)
    u = numpy.cross(n, [1, 0, 0] if abs(n[0]) < 0.6 else [0, 1, 0])
    u /= numpy.linalg.norm(u)
    w, size = numpy.cross(n, u), 1e-4 * numpy.ptp(vertices, axis=0).max()
    square = [x + size * (a * u + b * w) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    camera, down, right, up = ("<%r, %r, %r>" % tuple(map(float, vector))
                               for vector in (x + size * n, -size * n, size / 10 * u, size / 10 * w))
    text = POVRAY.format(camera=camera, down=down, right=right, up=up, receiver=triangles(square))
    for name, faces in patches.items():
        light = " interior_texture { pigment { rgb 1 } finish { emission 1 } }" if name == q["to"] else ""
        for k, face in enumerate(faces, 1):
            if q["on"] != f"{name}:{k}":
                text += f"mesh {{ {triangles(vertices[face])} no_image texture {{ pigment {{ rgb 0 }} }}{light} }}\n"
    return text


def ask_povray(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for q in questions():
        if q["quantity"] == "form factor" and q["to"] != "sky":
            (folder / "s.pov").write_text(povray_scene(q))
            factors.run(["povray", f"+I{folder}/s.pov", f"+O{folder}/s.ppm", "+W1", "+H1", "+FP16", "-D", "-A", "+WT1",
                         "File_Gamma=1"])
            yield q["question"], int.from_bytes((folder / "s.ppm").read_bytes()[-6:-4], "big") / 65535


def ask_program(program, exactff_program, folder):
    """The view factors of pairs of patches, from matrices of whole scenes. A scene without an answer is told."""
    solve, (across, needs) = {"openfoam": openfoam.solve, "calculix": calculix.solve}[program], ACROSS[program]
    pairs = [q for q in questions() if q["from"]]
    for name in dict.fromkeys(q["scene"] for q in pairs):
        place = folder / program / name
        place.mkdir(parents=True, exist_ok=True)
        source = SUITE / "scenes" / f"{name}.obj"
        scene = factors.Scene(exactff_program, source, place)
        used = next(a for a in range(across, 0, -1) if a == 1 or len(scene.cells(a).corners) <= MOST_CELLS)
        if program == "calculix":  # a face hides nothing from its back
            scene.sheets = [n for n in scene.names if n not in {q[end] for q in pairs if q["scene"] == name
                                                                for end in ("from", "to")}]
        try:
            _, matrix, *_ = solve(scene, used, **needs)
        except SystemExit as error:
            print(f"{name}: {str(error)[-150:]!r}")
            continue
        at = {patch: k for k, patch in enumerate(scene.names)}
        for q in pairs:
            if q["scene"] == name:
                yield q["question"], float(matrix[at[q["from"]], at[q["to"]]])


def board(program, folder):
    """data/field/suite.csv, from the answers in data/field/suite and what programs.csv says of the programs."""
    field = SUITE.parent / "field"
    about = {row["program"]: row for row in factors.rows_of(field / "suite" / "programs.csv")}
    times = [word for row in about.values() if row["cpu_seconds"]
             for word in ("--time", f"{row['program']}={row['cpu_seconds']}")]
    answers = [os.path.relpath(field / "suite" / f"{name}.csv") for name in about]
    said, *_ = factors.run([program, "check", os.path.relpath(SUITE), *answers, "--max-abs",
                            "1e-3", *times, "-o", folder], passing=(0, 1))
    print(said)
    columns = "program level questions answered worst median digits_median digits_worst limits limits_kept".split()
    with open(field / "suite.csv", "w", encoding="utf-8") as file:
        file.write("# command: validation/field/suite.py build/exactff --board build/field/board; limit: 1e-3\n")
        file.write(",".join(columns) + "\n")
        for one in json.loads((pathlib.Path(folder) / "scoreboard.json").read_text())["programs"]:
            for level in one["levels"]:
                errors, digits = level.get("errors", {}), level.get("digits", {})
                numbers = errors.get("max"), errors.get("median"), digits.get("median"), digits.get("worst")
                file.write(",".join([one["name"], level["level"], str(level["cases"]), str(level["answered"]),
                                     *("" if n is None else f"{n:.3g}" for n in numbers), str(level["limits"]),
                                     str(level["limits_kept"])]) + "\n")


def main(program, folder, *names):
    if folder == "--board":
        return board(program, *names)
    exactff_program, folder = pathlib.Path(program).resolve(), pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    times = folder / "times.json"
    seconds = json.loads(times.read_text()) if times.exists() else {}
    for name in [name for name in names if name != "--quick"] or (*METHODS, "povray", *ACROSS):
        before = time.process_time() + sum(os.times()[2:4])
        answers = (ask_method(METHODS[name]) if name in METHODS else ask_povray(folder / name) if name == "povray" else
                   ask_program(name, exactff_program, folder))
        lines = [f"{question},{value!r}" for question, value in answers]
        (folder / f"{name}.csv").write_text("\n".join(["question,value", *lines]) + "\n")
        seconds[name] = time.process_time() + sum(os.times()[2:4]) - before
        times.write_text(json.dumps(seconds, indent=1))
        print(f"{name}: {len(lines)} answers, {seconds[name]:.1f} s of the processor", flush=True)
        shutil.rmtree(folder / name, ignore_errors=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
