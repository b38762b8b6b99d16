#!/usr/bin/env python3
"""Recomputes data/suite: suite.py EXACTFF FOLDER writes the answers and the verdicts on published values to FOLDER.

    answers/SCENE.points.csv  exactff truth, both engines, for the questions about points
    answers/SCENE.pairs.csv   exactff matrix --certify, for those about pairs of patches
    published.csv             of each printed value its error and a verdict; what is printed, and where, is input

Where two patches are rectangles along the axes, opposed or perpendicular, the closed forms of the catalogues (C-11 to
C-15 of J. Howell) are evaluated with 40 digits: they must lie in the proved bounds, and decide about digits beyond.
"""
import csv
import fnmatch
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from mpmath import atan, log, mp, mpf, pi, sqrt

mp.dps = 40
SUITE = Path(__file__).resolve().parent.parent / "data" / "suite"
# The widest interval of a pair: 1e-11 on the plain level, else 1e-9, but for these, to save time.
WIDTH = {"shapiro": "1e-11", "pinhole": "1e-11", "cornell_box": "1e-6", "room_with_cube": "1e-8", "slats_8": "1e-6",
         "soup_5": "2e-5", "touching": "2e-5"}
COLUMNS = {"form factor": "exact", "sphere": "sphere", "solid angle": "solid_angle", "overcast sky": "overcast"}


def run(*command):
    ended = subprocess.run(command, capture_output=True, text=True)
    if ended.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\nended with code {ended.returncode}\n{ended.stderr}")


def questions():
    with open(SUITE / "questions.csv", newline="") as file:
        return list(csv.DictReader(file))


def unique(names):
    return ",".join(dict.fromkeys(names))


def ask_points(program, scene, asked, out):
    measures = unique(COLUMNS[q["quantity"]].replace("_", "-") for q in asked if q["quantity"] != "form factor")
    with tempfile.NamedTemporaryFile("w", suffix=".csv", prefix=scene, delete=False) as file:
        file.write("id,x,y,z,nx,ny,nz,on\n")
        for q in asked:
            file.write(",".join([q["question"]] + [q[c] for c in ("x", "y", "z", "nx", "ny", "nz", "on")]) + "\n")
    try:
        receivers = Path(file.name).rename(Path(file.name).with_name(scene + ".csv"))
        run(program, "truth", SUITE / "scenes" / f"{scene}.obj", "--receivers", receivers, "--source",
            unique(q["to"] for q in asked), *(["--measure", measures] if measures else []), "--engine", "both",
            "-o", out, "--force")
    finally:
        receivers.unlink()


def ask_pairs(program, scene, asked, out):
    run(program, "matrix", SUITE / "scenes" / f"{scene}.obj", "--from", unique(q["from"] for q in asked), "--to",
        unique(q["to"] for q in asked), "--certify", "--accuracy",
        WIDTH.get(scene, "1e-11" if all(q["level"] == "plain" for q in asked) else "1e-9"), "-o", out, "--force")


def table(file):
    with open(file, newline="") as lines:
        json.loads(lines.readline()[2:])
        return list(csv.DictReader(lines))


def bounds(q, tables):
    """The value and its bounds, as exactff wrote them."""
    kind = "pairs" if q["from"] else "points"
    keys = ("from", "to") if q["from"] else ("receiver", "source")
    wanted = (q["from"] or q["question"], q["to"])
    row = next(row for row in tables[f"{q['scene']}.{kind}"] if tuple(row[k] for k in keys) == wanted)
    column = "factor" if q["from"] else COLUMNS[q["quantity"]]
    if column in ("exact", "factor"):
        return mpf(row[column]), mpf(row["lower"]), mpf(row["upper"])
    value = float(row[column])  # correctly rounded
    return mpf(value), mpf(math.nextafter(value, 0)), mpf(math.nextafter(value, math.inf))


# --- Closed forms ---

def read_obj(file):
    vertices, patches, name = [], {}, ""
    for words in (line.split() for line in open(file)):
        if words[:1] == ["v"]:
            vertices.append([mpf(w) for w in words[1:]])
        elif words[:1] == ["g"]:
            name = words[1]
        elif words[:1] == ["f"]:
            patches.setdefault(name, []).append([vertices[int(w) - 1] for w in words[1:]])
    return patches


def rectangle(patch):
    """(axis, its coordinate, extent along each axis) of one rectangle along the axes, or None."""
    if len(patch) != 1 or len(patch[0]) != 4:
        return None
    extent = [(min(c), max(c)) for c in zip(*patch[0])]
    flat = [i for i in range(3) if extent[i][0] == extent[i][1]]
    whole = all(c in extent[i] for corner in patch[0] for i, c in enumerate(corner))
    return (flat[0], extent[flat[0]][0], extent) if len(flat) == 1 and whole else None


def signed_sum(term, *extents):
    """The sum of the term over all corners, where each lower end changes the sign."""
    if not extents:
        return term()
    low, high = extents[0]
    return (signed_sum(lambda *rest: term(high, *rest), *extents[1:])
            - signed_sum(lambda *rest: term(low, *rest), *extents[1:]))


def closed_form(a, b):
    """F from rectangle a to b, in parallel (C-13) or perpendicular planes (C-15); None for others."""
    a, b = rectangle(a), rectangle(b)
    if not a or not b:
        return None
    if a[0] == b[0]:
        gap = abs(a[1] - b[1])
        u, v = (i for i in range(3) if i != a[0])

        def term(x, xi, y, eta):
            s, t = x - xi, y - eta
            p, q = sqrt(s * s + gap * gap), sqrt(t * t + gap * gap)
            return (t * p * atan(t / p) + s * q * atan(s / q) - gap * gap / 2 * log(s * s + t * t + gap * gap)) / (2 * pi)
    else:  # distances from the line in which the planes meet
        u, v = next(i for i in range(3) if i not in (a[0], b[0])), None

        def term(y, eta, x, z):
            k, t = sqrt(x * x + z * z), y - eta
            rest = (k * k - t * t) / 4 * log(k * k + t * t) if k or t else mpf(0)
            return -((t * k * atan(t / k) if k else mpf(0)) - rest) / (2 * pi)
    area = mpf(1)
    for low, high in (a[2][i] for i in range(3) if i != a[0]):
        area *= high - low
    if v is not None:
        return signed_sum(term, a[2][u], b[2][u], a[2][v], b[2][v]) / area
    from_line = [tuple(sorted(abs(c - at) for c in extent)) for extent, at in ((a[2][b[0]], b[1]), (b[2][a[0]], a[1]))]
    return -signed_sum(term, a[2][u], b[2][u], *from_line) / area


# --- Published values ---

def verdict(printed, low, high):
    digits = len(printed.lower().split("e")[0].split(".")[1])
    exponent = int(printed.lower().split("e")[1]) if "e" in printed.lower() else 0
    unit = mpf(10) ** (exponent - digits)
    value = mpf(printed)
    least = max(low - value, value - high, mpf(0))
    most = max(abs(value - low), abs(value - high))
    short = lambda x: mp.nstr(x, 2)
    error = mp.nstr(value - (low + high) / 2, 2, min_fixed=0, max_fixed=0)
    if most <= unit / 2 * (1 + mpf(10) ** -9):
        return error, "right"
    if least > 100 * unit:
        return error, f"wrong by {short(least / ((low + high) / 2) * 100)} %"
    if least > unit:
        return error, f"wrong by {short(least / unit)} in its last digit"
    if least > unit / 2:
        return error, "rounded wrongly"
    return error, f"right within {short(most)} (as far as the bounds tell)"


def judge(asked, tables, closed, out):
    truth = {}
    for q in asked:
        value, low, high = bounds(q, tables)
        truth[q["question"]] = (closed[q["question"]],) * 3 if closed.get(q["question"]) else (value, low, high)
    with open(SUITE / "published.csv", newline="") as file, open(out, "w", newline="") as written:
        rows = csv.DictReader(file)
        writer = csv.DictWriter(written, rows.fieldnames, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            value, low, high = truth[row["question"]]
            row["digits"] = len(row["printed"].lower().split("e")[0].replace(".", "").lstrip("0"))
            row["truth"] = mp.nstr(value, 18, min_fixed=-4)
            row["error"], row["verdict"] = verdict(row["printed"], low, high)
            if row["alike"] and verdict(row["printed"], *truth[row["alike"]][1:])[1] != "right":
                sys.exit(f"{row['question']}: {row['printed']} is not the value of {row['alike']}")
            writer.writerow(row)


def main(program, folder):
    out = Path(folder)
    (out / "answers").mkdir(parents=True, exist_ok=True)
    asked, tables = questions(), {}
    for scene in dict.fromkeys(q["scene"] for q in asked):
        for kind, ask in (("points", ask_points), ("pairs", ask_pairs)):
            part = [q for q in asked if q["scene"] == scene and bool(q["from"]) == (kind == "pairs")]
            if part:
                file = out / "answers" / f"{scene}.{kind}.csv"
                ask(program, scene, part, file)
                tables[f"{scene}.{kind}"] = table(file)
    closed = {}
    for q in (q for q in asked if q["from"] and (q["level"] == "plain" or q["scene"] in ("gap", "close"))):
        patches = read_obj(SUITE / "scenes" / f"{q['scene']}.obj")
        value = closed_form(patches[q["from"]], patches[q["to"]])
        if value is None:
            continue
        _, low, high = bounds(q, tables)
        if not low <= value <= high:
            sys.exit(f"{q['question']}: the closed form {mp.nstr(value, 20)} is not in [{low}, {high}]")
        closed[q["question"]] = value
    judge(asked, tables, closed, out / "published.csv")
    verdicts = [row["verdict"] for row in csv.DictReader(open(out / "published.csv", newline=""))]
    right, rounded = (sum(v.startswith(word) for v in verdicts) for word in ("right", "rounded"))
    page = " ".join((SUITE / "README.md").read_text().split())
    for told in (f"{len(asked)} questions", f"{len(verdicts)} numbers", f"confirm {len(closed)} of them",
                 f"{len(set(q['scene'] for q in asked))} small scenes",
                 f"{right} are right to their digits, {rounded} are rounded wrongly, {len(verdicts) - right - rounded} "
                 "are wrong"):
        if told not in page:
            sys.exit(f"data/suite/README.md does not say: {told}")
    print(f"{len(asked)} answers; {len(closed)} agree with closed forms")


if __name__ == "__main__":
    main(*sys.argv[1:])
