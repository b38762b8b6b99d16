"""tables.py FILE...: prints the tables of validation/measurements.md in Markdown, from the JSON output of exactff_bench: medians.

Exits with 1 if a benchmark failed or the engines' values differ.
"""

import json
import math
import re
import sys

SCENES = "sparse blinds mesh dense deep tiles lattice near".split()
SIZES = [100, 1000, 10_000]
runs, sound = {}, True

for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            name = re.sub("/(iterations:[0-9]+|real_time)", "", run["run_name"])  # how it ran
            if run.get("error_occurred"):
                print(f"{name}: {run['error_message']}", file=sys.stderr)
                sound = False
            elif run.get("aggregate_name") == "median" or run["run_type"] == "iteration":
                assert run["time_unit"] == "us", name
                runs[name] = run


def figure(name, key="cpu_time"):
    """None if it was not measured. CPU time is the measure that a busy machine affects least."""
    return runs.get(name, {}).get(key)


def ratio(a, b):
    return a / b if a is not None and b else None


def text(value):
    """A whole number or three significant digits."""
    if value is None:
        return "-"
    digits = 0 if value == round(value) else max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{min(digits, 5)}f}"


def row(*cells):
    print("| " + " | ".join(cell if isinstance(cell, str) else text(cell) for cell in cells) + " |")


def head(title, *columns):
    print(f"\n{title}\n")
    row(*columns)
    print("|---" + "|--:" * (len(columns) - 1) + "|")


def ms(name):
    return ratio(figure(name), 1000)


head("n = 1000. Engine: the visible boundary. Rays: 10,000 in packets of 16 that end near one another, told to be coherent or not, "
     "whichever is faster. Certified values, ms, at n of 100, 1,000 and 10,000.",
     "scene", "engine ms", "Boolean ms", "Boolean / engine", "engine / rays", "100", "1,000", "10,000")
for scene in SCENES:
    engine, boolean, coherent, incoherent = (
        ms(f"{subject}/{scene}/1000") for subject in "visible/edges visible/boolean rays/coherent rays/incoherent".split())
    rays = min(coherent, incoherent) if coherent and incoherent else None
    row(scene, engine, boolean, ratio(boolean, engine), ratio(engine, rays),
        *(ms(f"certified/edges/{scene}/{n}") for n in (100, 1000, 10_000)))
if figure("memory/sparse/1000000"):
    print(f"\nA million random triangles: {text(ratio(ms('certified/edges/sparse/1000000'), 1000))} s and "
          f"{text(figure('memory/sparse/1000000', 'peak_mib'))} MiB, the scene included.")

head("All faces from one point, ms: one by one, and in one sweep.", "scene", "faces seen", "loop", "sweep", "loop / sweep")
for scene in "karkanis/500 karkanis/10000 covered/10000 room/1600".split():
    loop, sweep = ms(f"view/loop/{scene}"), ms(f"view/sweep/{scene}")
    row(scene, figure(f"view/sweep/{scene}", "seen"), loop, sweep, ratio(loop, sweep))

for scene in SCENES:
    for n in SIZES:
        edges, boolean = (figure(f"certified/{engine}/{scene}/{n}", "value") for engine in ("edges", "boolean"))
        if None not in (edges, boolean) and edges != boolean:
            print(f"{scene}, n = {n}: the engines give {edges!r} and {boolean!r}", file=sys.stderr)
            sound = False
sys.exit(0 if sound else 1)
