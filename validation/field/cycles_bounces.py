#!/usr/bin/env python3
"""Holds images of all light, gathered from ever smaller cells, and Cycles with many bounces against each other.

Usage: cycles_bounces.py PROGRAM FOLDER [--quick]

Cycles lets radiosity vary over a patch, but has noise; a gathered image has none, but one radiosity for each cell. So
what is left between them as cells shrink tells whether both are right. Pictures of Cycles and solutions that are
already in FOLDER are used again, so an interrupted run continues.
"""

import csv
import json
import pathlib
import sys

import numpy

from cycles import CAMERA, SCENE, Cycles, Truth, channels, render_exactly, root_mean_square, run

BOUNCES = 256
BOX = 556  # the longest side of the scene's box
PATCHES = ["floor", "ceiling", "light", "back", "right", "left", "short_block", "tall_block"]  # of the file
LAMPS = [("area", {"lamp": "area"})]  # which loses no samples (see cycles.py)
COLUMNS = """setting cells_per_side cells patch pixels ratio_red ratio_green ratio_blue ratio_noise rms_of_brightest
    noise_of_brightest left_of_brightest""".split()


class Seeds:
    """The pictures of one lamp, each by a seed of its own."""

    def __init__(self, folder, size, samples, count, cycles, name, job):
        self.pictures = []
        for seed in range(1, count + 1):
            kept = folder / f"bounces_{name.replace('/', '_')}_{size}_{samples}_{seed}.npy"
            if not kept.exists():
                job = {**job, "bounces": BOUNCES, "samples": samples, "seed": seed}
                picture, (seconds, _) = cycles.render(folder / "cycles.exr", job)
                print(f"Cycles, {name}, seed {seed}: {seconds:.1f} s", flush=True)
                numpy.save(kept, picture)
            self.pictures.append(numpy.load(kept))
        self.pictures = numpy.stack(self.pictures)
        self.mean = self.pictures.mean(axis=0)

    # The standard error of the mean of the seeds, RMS over pixels and channels.
    def noise(self, pixels):
        return float(numpy.sqrt(self.pictures[:, pixels].var(axis=0, ddof=1).mean() / len(self.pictures)))

    # The standard error of the largest of the ratios in red, green and blue.
    def ratio_noise(self, pixels, expected):
        ratios = self.pictures[:, pixels].mean(axis=1) / expected[pixels].mean(axis=0)
        return float(ratios.std(axis=0, ddof=1).max() / numpy.sqrt(len(ratios)))


class Gathered:
    """The image of all light from cells of 1 / parts of the box."""

    def __init__(self, program, folder, size, parts):
        solution, image = folder / f"cells_{parts}.csv", folder / f"cells_{parts}_{size}.exr"
        length = f"{BOX / parts:g}"
        if not solution.exists():
            run([program, "radiosity", SCENE, "--divide", length, "--accuracy", "1e-3", "--budget", "100", "-o",
                 solution], passing=(0, 3))  # 3: wider than asked
        if not image.exists():
            render_exactly(program, size, image, "--radiosity", solution)
        self.parts, self.values = parts, channels(image, "RGB")
        with open(solution, encoding="utf-8") as file:
            self.cells = sum("," in line and ",red," in line for line in file)


def rows_of(name, seeds, gathered, truth):
    top = gathered.values[truth.compared].max()
    for number, patch in enumerate(["all", *PATCHES]):
        chosen = truth.compared & (truth.patch == number) if number > 0 else truth.compared
        if not chosen.any():
            continue
        ratios = seeds.mean[chosen].mean(axis=0) / gathered.values[chosen].mean(axis=0)
        rms = root_mean_square(seeds.mean[chosen] - gathered.values[chosen])
        noise = seeds.noise(chosen)
        yield {"setting": name, "cells_per_side": gathered.parts, "cells": gathered.cells, "patch": patch,
               "pixels": int(chosen.sum()), "ratio_red": ratios[0], "ratio_green": ratios[1], "ratio_blue": ratios[2],
               "ratio_noise": seeds.ratio_noise(chosen, gathered.values), "rms_of_brightest": rms / top,
               "noise_of_brightest": noise / top,
               "left_of_brightest": numpy.sqrt(max(0.0, rms**2 - noise**2)) / top}


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    size, samples, count, levels = (64, 256, 3, [2, 4]) if "--quick" in sys.argv else (128, 1024, 4, [2, 4, 8])
    cycles = Cycles(size)
    lamps = [(name, Seeds(folder, size, samples, count, cycles, name, job)) for name, job in LAMPS]
    cycles.close()
    truth = Truth(program, size, folder)
    with open(folder / "cycles_bounces.csv", "w", encoding="utf-8", newline="") as file:
        version = run(["blender", "--version"])[0].splitlines()[0]
        file.write("# title: All light in the Cornell box: Cycles, and images gathered from cells of one radiosity\n")
        file.write(f"# command: {' '.join(['validation/field/measure.sh cycles_bounces', *sys.argv[3:]])}\n")
        file.write("# ratio: of the means of all pixels of a patch, Cycles over gathered; noise: of the mean of seeds\n")
        file.write(f"# {SCENE}, {json.dumps(CAMERA)}, {size} x {size} pixels, {version}, {BOUNCES} bounces at most, "
                   f"{count} seeds of {samples} samples\n")
        table = csv.DictWriter(file, COLUMNS)
        table.writeheader()
        for parts in levels:
            gathered = Gathered(program, folder, size, parts)
            for name, seeds in lamps:
                for row in rows_of(name, seeds, gathered, truth):
                    table.writerow({key: f"{one:.7g}" if isinstance(one, float) else one for key, one in row.items()})
                    print(row, flush=True)
                file.flush()


main()
