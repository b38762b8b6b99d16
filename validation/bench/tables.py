"""tables.py FILE...: prints the tables of validation/measurements.md in Markdown, from the JSON output of exactff_bench: medians.

Exits with 1 if a benchmark failed or the engines' values differ.
"""

import json
import math
import re
import sys

SCENES = "sparse blinds mesh dense deep tiles lattice near".split()
SIZES = [100, 1000, 10_000, 100_000, 1_000_000]
runs, sound = {}, True

for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            name = re.sub("/(iterations:[0-9]+|manual_time|real_time)", "", run["run_name"])  # how it ran
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


def total(a, b):
    return a + b if a is not None and b is not None else None


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


head("n = 1000. Engine: the visible edges, with Eq. (4) in double. Limit: Eq. (4) in double over the visible edges, one after "
     "another, every occluder read once. Rays: 10,000 in packets of 16 that end near one another, told to be coherent or "
     "not, whichever is faster. Scattered rays: the same in random order.",
     "scene", "engine ms", "Boolean ms", "Boolean / engine", "engine / limit", "engine / rays", "both with their builds",
     "engine / scattered rays", "certified ms", "certified / engine")
for scene in SCENES:
    engine, boolean, certified, limit, coherent, incoherent, scattered, tree, build = (
        ms(f"{subject}/{scene}/1000") for subject in
        "visible/edges visible/boolean certified/edges limit rays/coherent rays/incoherent rays/scattered tree rays/build".split())
    rays = min(coherent, incoherent) if coherent and incoherent else None
    row(scene, engine, boolean, ratio(boolean, engine), ratio(engine, limit), ratio(engine, rays),
        ratio(total(engine, tree), total(rays, build)), ratio(engine, scattered), certified, ratio(certified, engine))


def exponent(times):
    """The slope of log time over log n, by least squares, from 10^3 to 10^5."""
    points = [(math.log(n), math.log(time)) for n, time in times.items() if 1000 <= n <= 100_000]
    if len(points) < 2:
        return None
    x, y = (sum(part) / len(points) for part in zip(*points))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x)**2 for a, _ in points)


head("The certified value, ms. Exponents: per decade, and fitted over 10^3 to 10^5. Undecided: the share of pairs of an edge "
     "and an occluder that the filter left to exact predicates. That and the peak memory (of the whole process) at the "
     "largest n.",
     "scene", "10^2", "10^3", "10^4", "10^5", "10^6", "per decade", "fitted", "undecided", "peak MiB")
for engine in "edges", "boolean":
    for scene in SCENES:
        times = {n: ms(f"certified/{engine}/{scene}/{n}") for n in SIZES}
        known = {n: time for n, time in times.items() if time is not None}
        if len(known) < 2:
            continue
        largest = figure(f"certified/{engine}/{scene}/{max(known)}", "undecided_pairs")
        pairs = figure(f"certified/{engine}/{scene}/{max(known)}", "pairs")
        peaks = [figure(f"memory/{scene}/{n}", "peak_mib") for n in SIZES] if engine == "edges" else []
        decades = [text(math.log10(known[10 * n] / known[n])) for n in known if 10 * n in known]
        row(scene if engine == "edges" else scene + ", Boolean", *times.values(), ", ".join(decades) or "-", exponent(known),
            ratio(largest, pairs), next((peak for peak in reversed(peaks) if peak is not None), None))

head("Cornell box, light to a floor grid of 32 x 32: the certified value, median over receivers.", "receivers", "count",
     "edges, us", "Boolean, us")
for kind in "unoccluded", "partly", "every":
    row(kind, figure(f"cornell/{kind}/edges", "receivers"), figure(f"cornell/{kind}/edges", "real_time"),
        figure(f"cornell/{kind}/boolean", "real_time"))
one, two = ("cornell/throughput/threads:1", "cornell/throughput/threads:2")
print(f"\nTwo threads do {text(ratio(figure(two, 'items_per_second'), figure(one, 'items_per_second')))} times the work of one"
      f" (by their CPU time alone, {text(ratio(figure(one), ratio(figure(two), 2)))} times).")

head("All hidden by many together, ms: from scratch, and with what hid the source from a receiver nearby.", "scene",
     "candidates", "needed", "from scratch", "neighbour")
for scene in "deep/100 deep/1000 deep/10000 wall/100 wall/1000 wall/10000".split():
    row(scene, figure(f"covers/scratch/{scene}", "candidates"), figure(f"covers/scratch/{scene}", "cover"),
        ms(f"covers/scratch/{scene}"), ms(f"covers/neighbour/{scene}"))

head("All faces from one point, ms: one by one, in one sweep, and the contour of its arcs alone.", "scene", "faces seen",
     "arcs", "loop", "sweep", "loop / sweep", "contour")
for scene in "karkanis/500 karkanis/1000 karkanis/10000 karkanis/100000 covered/10000 room/400 room/1600".split():
    loop, sweep = ms(f"view/loop/{scene}"), ms(f"view/sweep/{scene}")
    row(scene, figure(f"view/sweep/{scene}", "seen"), figure(f"view/sweep/{scene}", "arcs"), loop, sweep,
        ratio(loop, sweep), ms(f"view/contour/{scene}"))

for scene in SCENES:
    for n in SIZES:
        edges, boolean = (figure(f"certified/{engine}/{scene}/{n}", "value") for engine in ("edges", "boolean"))
        if None not in (edges, boolean) and edges != boolean:
            print(f"{scene}, n = {n}: the engines give {edges!r} and {boolean!r}", file=sys.stderr)
            sound = False
sys.exit(0 if sound else 1)
