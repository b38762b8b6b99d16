#!/usr/bin/env python3
"""Measures the errors and times of Cycles against the exact image of the Cornell box.

Usage: cycles.py PROGRAM FOLDER [--quick]

Every run of a setting has a seed of its own, and an exact run beside it, so that both times see the same machine. The
spread between seeds is the noise; what the mean of the seeds keeps beyond its own noise is bias. Finished rows of
FOLDER/cycles.csv are kept, so an interrupted run continues.
"""

import csv
import json
import os
import pathlib
import resource
import subprocess
import sys
import time

import numpy
import OpenImageIO as oiio

SCENE = "data/scenes/cornell_box.obj"
CAMERA = {"eye": [278, 273, -800], "look": [278, 273, 0], "up": [0, 1, 0], "fov": 39.30764811610662}
THREADS = len(os.sched_getaffinity(0))
FULL_COLOUR = 0.01  # of the brightest pixel: the error that gets the full colour of the maps
USER = 4096  # Blender's default; adaptive sampling stops earlier
COUNTS = [1, 4, 16, 64, 256, 1024, 4096]

# Name, what it is, sample counts, and the job of cycles_scene.py. Scaling by a power of two changes no ratio of
# coordinates, not even in the last bit.
SETTINGS = [
    ("area", "area lamp of Blender", COUNTS, {"lamp": "area"}),
    ("mesh", "emitting faces, one unit is a millimetre", COUNTS, {}),
    ("mesh/1024", "emitting faces, scene scaled by 1/1024", COUNTS, {"scale": 1 / 1024}),
    ("area-pmj", "area lamp, Blender's default sample pattern", [256],
     {"lamp": "area", "pattern": "PROGRESSIVE_MULTI_JITTER"}),
    ("mesh/64", "emitting faces, scene scaled by 1/64", [256], {"scale": 1 / 64}),
    ("mesh/256", "emitting faces, scene scaled by 1/256", [256], {"scale": 1 / 256}),
    ("mesh-chance", "emitting faces, reached by chance only", [256], {"sample_as_light": False}),
    ("user-area", "Blender's defaults, area lamp", [USER], {"lamp": "area", "user": True}),
    ("user-mesh", "Blender's defaults, emitting faces", [USER], {"user": True}),
]
COLUMNS = """setting about samples runs seconds cpu_seconds us_per_pixel exact_seconds exact_cpu_seconds
    exact_us_per_pixel pixels left_out mean_ratio whole_lamp_ratio black_share median_ratio rms rms_of_brightest
    noise_of_brightest bias_of_brightest relative_mse p99_of_brightest worst_of_brightest load image""".split()


def channels(path, names, kind="float"):
    image = oiio.ImageInput.open(str(path))
    if not image:
        sys.exit(oiio.geterror())
    at = [image.spec().channelnames.index(name) for name in names]
    picture = numpy.concatenate([image.read_image(one, one + 1, kind) for one in at], axis=2)
    image.close()
    return picture.astype(float)


def run(command, passing=(0,)):
    before, clock = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in passing:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.stdout, (time.perf_counter() - clock, used)


def render_exactly(program, size, output, *more):
    flags = [word for name, value in CAMERA.items() for word in (f"--{name}", *map(str, numpy.ravel(value)))]
    return run([program, "render", SCENE, *flags, "--size", f"{size}x{size}", "--threads", str(THREADS), *more,
                "--force", "-o", output])[1]


class Cycles:
    """One Blender for all jobs, so that its start is not measured."""

    def __init__(self, size):
        self.common = {"scene": SCENE, "size": [size, size], "threads": THREADS, **CAMERA}
        script = pathlib.Path(__file__).with_name("cycles_scene.py")
        self.blender = subprocess.Popen(
            ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", script], text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def render(self, output, job):
        self.blender.stdin.write(json.dumps({**self.common, "output": str(output.resolve()), **job}) + "\n")
        self.blender.stdin.flush()
        said = []
        for line in self.blender.stdout:
            if line.startswith("timing "):
                return channels(output, "RGB"), tuple(map(float, line.split()[1:]))
            said.append(line)
        sys.exit("".join(said))

    def close(self):
        self.blender.communicate()


class Truth:
    """The exact image, and the pixels to compare: those that see a face, not the lamp, as do all their neighbours."""

    def __init__(self, program, size, folder):
        path = folder / "exact.exr"
        render_exactly(program, size, path, "--layers")
        picture = channels(path, "RGB")
        face = channels(path, ["id.face"], "uint")[:, :, 0]
        around = numpy.pad(face, 1, mode="edge")
        same = [around[row:row + size, column:column + size] == face for row in range(3) for column in range(3)]
        self.patch = channels(path, ["id.patch"], "uint")[:, :, 0]
        self.compared = numpy.all(same, axis=0) & (face > 0) & (self.patch != 3)  # the lamp is the file's third patch
        # There is one colour of light, so the relative error of a pixel is the same in all channels. The brightest of
        # them stands for the pixel.
        self.channel = picture.argmax(axis=2)
        self.values = self.brightest_channel(picture)
        self.brightest = self.values[self.compared].max()
        self.whole_lamp = self.compared & (channels(path, ["visible.light"], "uint")[:, :, 0] == 2)

    def brightest_channel(self, picture):
        return numpy.take_along_axis(picture, self.channel[:, :, None], axis=2)[:, :, 0]


def root_mean_square(numbers):
    return float(numpy.sqrt(numpy.mean(numpy.square(numbers))))


# Errors of the first picture; noise, bias and what concerns the whole lamp from all of them. A pixel that sees the
# whole lamp is black only if all of its samples were lost; black_share is the share of light that such pixels lack.
def statistics(pictures, truth):
    pixels = truth.compared
    expected = truth.values[pixels]
    seeds = numpy.stack([picture[pixels] for picture in pictures])
    error, mean_error = seeds[0] - expected, seeds.mean(axis=0) - expected
    lit, top = expected > 0, truth.brightest
    row = {
        "pixels": int(pixels.sum()), "left_out": int((~pixels).sum()),
        "mean_ratio": seeds[0].sum() / expected.sum(), "median_ratio": numpy.median(seeds[0][lit] / expected[lit]),
        "rms": root_mean_square(error), "rms_of_brightest": root_mean_square(error) / top,
        "relative_mse": numpy.mean(error**2 / (expected**2 + 0.01)),
        "p99_of_brightest": numpy.percentile(abs(error), 99) / top, "worst_of_brightest": abs(error).max() / top,
    }
    whole = truth.values[truth.whole_lamp]
    seen = numpy.stack([picture[truth.whole_lamp] for picture in pictures])
    row["whole_lamp_ratio"] = seen.mean(axis=0).sum() / whole.sum()
    row["black_share"] = numpy.mean((seen == 0) * whole) / whole.mean()
    if len(seeds) > 1:
        variance = seeds.var(axis=0, ddof=1).mean()
        row["noise_of_brightest"] = numpy.sqrt(variance) / top
        row["bias_of_brightest"] = numpy.sqrt(max(0, numpy.mean(mean_error**2) - variance / len(seeds))) / top
    return row


# White is right, red too bright, blue too dark; grey is not compared. Each pixel is drawn three by three.
def write_map(path, picture, truth):
    error = numpy.clip((picture - truth.values) / truth.brightest / FULL_COLOUR, -1, 1)
    colours = numpy.stack([1 + numpy.minimum(error, 0), 1 - abs(error), 1 - numpy.maximum(error, 0)], axis=2)
    colours[~truth.compared] = 0.6
    large = numpy.ascontiguousarray((colours * 15).round().repeat(3, axis=0).repeat(3, axis=1) * 17).astype("uint8")
    output = oiio.ImageOutput.create(str(path))
    output.open(str(path), oiio.ImageSpec(large.shape[1], large.shape[0], 3, "uint8"))
    output.write_image(large)
    output.close()


def measure(program, folder, size, runs, truth, cycles, setting, samples):
    name, about, _, job = setting
    pictures, times = [], []
    for seed in range(1, runs + 1):
        exact = render_exactly(program, size, folder / "timed.exr")
        picture, taken = cycles.render(folder / "cycles.exr", {**job, "samples": samples, "seed": seed})
        pictures.append(truth.brightest_channel(picture))
        times.append((*taken, *exact))
    seconds, used, exact_seconds, exact_used = numpy.median(times, axis=0)
    image = f"cycles_{name.replace('/', '_')}_{samples}.png"
    write_map(folder / image, pictures[0], truth)
    return {"setting": name, "about": about, "samples": samples, "runs": runs, "seconds": seconds, "cpu_seconds": used,
            "us_per_pixel": 1e6 * seconds / size**2, "exact_seconds": exact_seconds, "exact_cpu_seconds": exact_used,
            "exact_us_per_pixel": 1e6 * exact_seconds / size**2, "load": os.getloadavg()[0], "image": image,
            **statistics(pictures, truth)}


def finished_rows(path):
    if not path.exists():
        return []
    with open(path, encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return [(row["setting"], int(row["samples"])) for row in rows]


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    size, runs, most = (64, 2, 1024) if "--quick" in sys.argv else (128, 3, 4096)
    truth = Truth(program, size, folder)
    path = folder / "cycles.csv"
    finished = finished_rows(path)
    cycles = Cycles(size)
    cycles.render(folder / "cycles.exr", {**SETTINGS[0][3], "samples": 1, "seed": 1})  # the first one takes longer
    with open(path, "a", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        if file.tell() == 0:
            version = run(["blender", "--version"])[0].splitlines()[0]
            colour = f"{100 * FULL_COLOUR:g} %"
            file.write("# title: Cycles, the path tracer of Blender, in the Cornell box\n")
            file.write(f"# command: {' '.join(['validation/field/cycles.py', *sys.argv[1:]])}\n")
            file.write(f"# maps: Full colour is {colour} of the brightest pixel. Grey is not compared.\n")
            file.write("# Cycles' time is the render alone; exact includes the start, the scene and the file.\n")
            file.write(f"# {SCENE}, {json.dumps(CAMERA)}, {size} x {size} pixels, {version}, {THREADS} threads\n")
            table.writeheader()
        jobs = sorted(((samples, setting) for setting in SETTINGS for samples in setting[2]), key=lambda job: job[0])
        for samples, setting in jobs:
            if (setting[0], samples) in finished or (samples > most and not setting[3].get("user")):
                continue
            row = measure(program, folder, size, runs, truth, cycles, setting, samples)
            table.writerow({name: f"{value:.7g}" if isinstance(value, float) else value for name, value in row.items()})
            file.flush()
            print(row, flush=True)
    cycles.close()


if __name__ == "__main__":
    main()
