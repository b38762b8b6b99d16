#!/usr/bin/env python3
"""Holds other programs and our methods to our values.

Usage: field.py PROGRAM TASK    PROGRAM: build/exactff; results are written to build/field/TASK

  suite [NAME...]  asks our methods, or those named, the questions of data/suite: NAME.csv with the columns question and
                   value, and times.json
  board            grades the answers in data/field/suite: their table there, and the page

The answers of other programs were asked for by field.py of commit e320668f.
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import time

TOP = pathlib.Path(__file__).resolve().parents[2]
SUITE = TOP / "data" / "suite"


def run(command, passing=(0,)):
    """What a command says."""
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode not in passing:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}")
    return done.stdout


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


METHODS = {  # 1,024 rays or samples, or pixels in proportion
    "adaptive-literal": "adaptive:variant=literal,rays=256",
    "adaptive-mended": "adaptive:rays=256",
    "hemicube-256": "hemicube:resolution=256",
    "nettle-16x16": "nettle:splits=16",
    "wallace-32x32": "wallace:splits=32",
    "area-sampling-1024": "area-sampling:samples=1024,pattern=stratified",
}


def ask_method(method):
    """The form factors at points, of patches; each question on its own."""
    import exactff
    scenes = {}
    for q in rows_of(SUITE / "questions.csv"):
        if q["quantity"] != "form factor" or q["to"] == "sky":
            continue
        if q["scene"] not in scenes:
            scenes[q["scene"]] = exactff.Scene.read(str(SUITE / "scenes" / f"{q['scene']}.obj"))
        point, normal = ([[float(q[c]) for c in columns]] for columns in (("x", "y", "z"), ("nx", "ny", "nz")))
        try:
            value = exactff.methods.evaluate(method, scenes[q["scene"]], point, normal, q["to"], q["on"] or None)
        except exactff.InputError as error:  # a scene that single precision cannot hold
            print(f"{q['question']}: {str(error).splitlines()[0][:150]}")
            continue
        yield q["question"], float(value[0, 0])


def board(program, folder):
    """data/field/suite.csv, from the answers in data/field/suite and what programs.csv says of the programs."""
    field = SUITE.parent / "field"
    about = {row["program"]: row for row in rows_of(field / "suite" / "programs.csv")}
    times = [word for row in about.values() if row["cpu_seconds"]
             for word in ("--time", f"{row['program']}={row['cpu_seconds']}")]
    answers = [os.path.relpath(field / "suite" / f"{name}.csv") for name in about]
    print(run([program, "check", os.path.relpath(SUITE), *answers, "--max-abs", "1e-3", *times, "-o", folder],
              passing=(0, 1)))
    columns = "program level questions answered worst median digits_median digits_worst limits limits_kept".split()
    with open(field / "suite.csv", "w", encoding="utf-8") as file:
        file.write("# command: validation/field/field.py build/exactff board; limit: 1e-3\n")
        file.write(",".join(columns) + "\n")
        for one in json.loads((pathlib.Path(folder) / "scoreboard.json").read_text())["programs"]:
            for level in one["levels"]:
                errors, digits = level.get("errors", {}), level.get("digits", {})
                numbers = errors.get("max"), errors.get("median"), digits.get("median"), digits.get("worst")
                file.write(",".join([one["name"], level["level"], str(level["cases"]), str(level["answered"]),
                                     *("" if n is None else f"{n:.3g}" for n in numbers), str(level["limits"]),
                                     str(level["limits_kept"])]) + "\n")


def ask(program, folder, names):
    sys.path.insert(0, str(program.parent / "python"))
    times = folder / "times.json"
    seconds = json.loads(times.read_text()) if times.exists() else {}
    for name in names or METHODS:
        before = time.process_time()
        lines = [f"{question},{value!r}" for question, value in ask_method(METHODS[name])]
        (folder / f"{name}.csv").write_text("\n".join(["question,value", *lines]) + "\n")
        seconds[name] = time.process_time() - before
        times.write_text(json.dumps(seconds, indent=1))
        print(f"{name}: {len(lines)} answers, {seconds[name]:.1f} s of the processor", flush=True)


def main(program, task, *more):
    program = pathlib.Path(program).resolve()
    folder = TOP / "build" / "field" / task
    os.chdir(TOP)
    if task == "board":
        return board(program, folder)
    folder.mkdir(parents=True, exist_ok=True)
    return ask(program, folder, more)


if __name__ == "__main__":
    main(*sys.argv[1:])
