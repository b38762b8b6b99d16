#!/usr/bin/env python3
"""Reads the images of exactff render with OpenImageIO: names, types, orientation and numbers, compared with the NumPy
files and with exactff truth for the same pixels.

Gives exactff truth the visible points of images, of its own render and of OpenImageIO (tiles, parts, windows), and
compares the images of exact values, read by OpenImageIO, with truth files for the same points on faces that are named.
Judges images by exactff check, and compares its figures with NumPy's.

Usage: images_read_back.py PROGRAM SCENES-FOLDER
"""

import csv
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

CAMERA = "--eye 278 273 -800 --look 278 273 0 --fov 39.3".split()
LAYERS = ["position.X", "position.Y", "position.Z", "normal.X", "normal.Y", "normal.Z"]
DYADIC = """mtllib dyadic.mtl
v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 3\nv 2 1 3\nv 2 2 3\nv 1 2 3\nv 1 2 1\nv 3 2 1\nv 3 3 1\nv 1 3 1
usemtl white\ng floor\nf 1 2 3 4\ng board\nf 9 10 11 12\nusemtl lamp\ng lamp\nf 8 7 6 5
"""
DYADIC_MATERIALS = "newmtl white\nKd .5 .25 .7\nnewmtl lamp\nKd .1 .1 .1\nKe 3 2 1\n"


def read(path):
    image = oiio.ImageInput.open(str(path))
    spec = image.spec()
    found = {}
    for at, (name, kind) in enumerate(zip(spec.channelnames, spec.channelformats or [spec.format] * spec.nchannels)):
        found[name] = numpy.asarray(image.read_image(at, at + 1, "uint" if str(kind) == "uint" else "float"))[:, :, 0]
        assert str(kind) == ("uint" if name.startswith(("id.", "visible.", "mark")) else "float"), (name, kind)
    return found, spec


def expect_equal(a, b, what):
    assert numpy.array_equal(a, b), f"{what} differ:\n{a}\n{b}"


# Red is the left wall, at large x, and the light is at the top.
def check_orientation(image):
    red, green = image["R"], image["G"]
    assert red[12, 1] > 4 * green[12, 1] > 0, "the left of the picture is not the red wall"
    assert green[12, -2] > 2 * red[12, -2] > 0, "the right of the picture is not the green wall"
    assert image["position.X"][12, 1] > 500 > 50 > image["position.X"][12, -2]
    brightest = numpy.unravel_index(numpy.argmax(red), red.shape)
    assert brightest[0] < 5, "the lamp is not at the top"
    floor = image["id.patch"] == 1
    assert floor.any() and not floor[:12].any(), "the floor is not at the bottom"


def receivers_of(image, path):
    rows, columns = numpy.nonzero((image["id.face"] > 0) & (image["id.patch"] == 1))
    with open(path, "w", encoding="ascii") as file:
        file.write("id,x,y,z,nx,ny,nz,on\n")
        for row, column in zip(rows, columns):
            x, y, z = (float(image["position." + axis][row, column]) for axis in "XYZ")
            file.write(f"{row} {column},{x!r},{y!r},{z!r},0,1,0,floor\n")
    return len(rows)


# The receivers of the truth file are rounded to 32 bits, so the values agree as far as the light varies in between.
def check_truth(program, scene, image, folder):
    count = receivers_of(image, folder / "receivers.csv")
    assert count > 30
    subprocess.run([program, "truth", scene, "--receivers", folder / "receivers.csv", "--fraction", "-o",
                    folder / "truth.csv"], check=True, stdout=subprocess.DEVNULL)
    with open(folder / "truth.csv", encoding="ascii") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    assert len(rows) == count
    for row in rows:
        at = tuple(int(word) for word in row["receiver"].split())
        for channel, column in (("R", "radiosity_r"), ("G", "radiosity_g"), ("B", "radiosity_b")):
            expected = float(row[column]) / numpy.pi
            assert abs(image[channel][at] - expected) <= 1e-4 * expected + 1e-9, (at, channel, expected)
        assert abs(image["F.light"][at] - float(row["exact"])) <= 1e-4 * float(row["exact"]) + 1e-9
        fraction = float(row["visible_fraction"])
        assert abs(image["fraction.light"][at] - fraction) <= 1e-3
        part = image["visible.light"][at]
        assert part == (0 if fraction == 0 else 2 if fraction == 1 else 1) or min(fraction, 1 - fraction) < 1e-3


def check_render(program, scene, folder):
    render = [program, "render", scene, *CAMERA, "--size", "24x24"]
    subprocess.run([*render, "--layers", "-o", folder / "a.exr", "--double", folder / "a.npy"], check=True,
                   stdout=subprocess.DEVNULL)
    image, spec = read(folder / "a.exr")
    attributes = {one.name: one.value for one in spec.extra_attribs}
    assert set(image) == {"R", "G", "B", "F.light", "visible.light", "fraction.light", "position.X", "position.Y",
                          "position.Z", "normal.X", "normal.Y", "normal.Z", "distance", "id.face", "id.patch"}
    assert attributes["exactff scene"] == "cornell_box.obj" and len(attributes["exactff scene hash"]) == 16
    assert attributes["exactff camera"].startswith("--eye 278 273 -800") and "exactff software" in attributes
    doubles = numpy.load(folder / "a.npy")
    assert doubles.shape == (24, 24, 3) and doubles.dtype == numpy.float64
    expect_equal(numpy.isnan(doubles[:, :, 0]), image["id.face"] == 0, "pixels that show nothing")
    for at, name in enumerate("RGB"):
        expect_equal(image[name], numpy.nan_to_num(doubles[:, :, at]).astype(numpy.float32), name)
    check_orientation(image)
    check_truth(program, scene, image, folder)
    subprocess.run([*render, "--exposure", "5", "-o", folder / "a.png"], check=True, stdout=subprocess.DEVNULL)
    png = numpy.asarray(oiio.ImageInput.open(str(folder / "a.png")).read_image("uint8"))
    linear = numpy.clip(5 * numpy.nan_to_num(doubles), 0, 1)
    srgb = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert numpy.abs(png - 255 * srgb).max() <= 0.5 + 1e-6, "sRGB"


def write(path, parts, tile=0, window=None):
    """Each part is a name and its channels."""
    specs, arrays = [], []
    for name, channels in parts:
        height, width = next(iter(channels.values())).shape
        spec = oiio.ImageSpec(width, height, len(channels), "float")
        spec.channelnames = tuple(channels)
        spec.tile_width = spec.tile_height = tile
        if name:
            spec.attribute("oiio:subimagename", name)
        if window:
            spec.x, spec.y, spec.full_x, spec.full_y, spec.full_width, spec.full_height = window
        specs.append(spec)
        arrays.append(numpy.ascontiguousarray(numpy.stack(list(channels.values()), axis=-1), numpy.float32))
    output = oiio.ImageOutput.create(str(path))
    assert output.open(str(path), specs[0] if len(specs) == 1 else tuple(specs)), output.geterror()
    for at, (spec, array) in enumerate(zip(specs, arrays)):
        if at > 0:
            assert output.open(str(path), spec, "AppendSubimage"), output.geterror()
        assert output.write_image(array), output.geterror()
    output.close()


class Cases:
    def __init__(self, program, scenes, folder):
        self.program, self.scenes, self.folder = program, scenes, folder

    def run(self, *words, code=0):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True)
        assert done.returncode == code, (words, done.returncode, done.stderr)
        return done.stderr

    def truth(self, scene, points, *more, code=0, name="values"):
        exr = self.folder / f"{name}.exr"
        error = self.run("truth", scene, "--receivers", points, "--on", "auto", "-o", self.folder / f"{name}.csv",
                         "--exr", exr, "--force", *more, code=code)
        return (error, None) if code else (error, read(exr))

    # The names of faces as the scene's file has them, by the numbers in an image.
    def names_of_faces(self, scene):
        names, patch, count = [None], "", {}
        for line in scene.read_text(encoding="ascii").splitlines():
            words = line.split()
            if words[:1] in (["g"], ["o"]):
                patch = words[1]
            elif words[:1] == ["f"]:
                count[patch] = count.get(patch, 0) + 1
                names.append(f"{patch}:{count[patch]}")
        return names

    # The same points as a table, with their faces: no face is looked for.
    def values_of_table(self, scene, image, faces, *more):
        names = self.names_of_faces(scene)
        table, truth = self.folder / "points.csv", self.folder / "table.csv"
        with open(table, "w", encoding="ascii") as file:
            file.write("id,x,y,z,nx,ny,nz,on\n")
            for row, column in zip(*numpy.nonzero(faces)):
                numbers = ",".join(repr(float(image[layer][row, column])) for layer in LAYERS)
                file.write(f"{row} {column},{numbers},{names[int(faces[row, column])]}\n")
        self.run("truth", scene, "--receivers", table, "--total", "radiance", "-o", truth, "--force", *more)
        values = numpy.full((3, *faces.shape), numpy.nan)
        with open(truth, encoding="ascii") as file:
            for row in csv.DictReader(line for line in file if not line.startswith("#")):
                at = tuple(int(word) for word in row["receiver"].split())
                values[(slice(None), *at)] = [float(row["total_" + c]) for c in "rgb"]
        return values

    def expect_values(self, image, values):
        for at, channel in enumerate("RGB"):
            expected = values[at].astype(numpy.float32)
            assert numpy.array_equal(image[channel], expected, equal_nan=True), (channel, image[channel], expected)

    # The points of our own images, rounded to 32 bits.
    def check_own_points(self):
        scene = self.scenes / "cornell_box.obj"
        points = self.folder / "points.exr"
        self.run("render", scene, *CAMERA, "--size", "20x16", "--layers", "-o", points)
        given, _ = read(points)
        _, (image, _) = self.truth(scene, points)
        assert numpy.array_equal(image["mark"], numpy.where(given["id.face"] > 0, 0, 2))
        self.expect_values(image, self.values_of_table(scene, given, given["id.face"]))
        assert numpy.isfinite(image["R"]).sum() > 200
        both = numpy.isfinite(image["R"])
        for channel in "RGB":  # near the pixel's own value, which belongs to the point rounded to 64 bits
            near = numpy.abs(image[channel][both] - given[channel][both]) <= 1e-4 * given[channel][both] + 1e-9
            assert near.all(), channel
        return points, given

    # Where 32 bits hold every point and normal, the image of truth has the bits of render.
    def check_exact_points(self):
        scene = self.folder / "dyadic.obj"
        scene.write_text(DYADIC, encoding="ascii")
        (self.folder / "dyadic.mtl").write_text(DYADIC_MATERIALS, encoding="ascii")
        points = self.folder / "dyadic.exr"
        self.run("render", scene, *"--eye 2 2 8 --look 2 2 0 --ortho 8 --size 32x32 --layers -o".split(), points)
        given, _ = read(points)
        _, (image, _) = self.truth(scene, points)
        hit = given["id.face"] > 0
        assert 200 < hit.sum() < hit.size and (given["R"] > 0).sum() > 150
        lit = hit & (given["id.patch"] != 3)  # the lamp is seen from behind, where render is black, as it is here
        for channel in "RGB":
            assert numpy.array_equal(image[channel][lit], given[channel][lit]), channel
            assert numpy.isnan(image[channel][~hit]).all()

    # Written by another library: tiles, parts, windows, pixels that hit nothing, normals that are off.
    def check_other_files(self, points, given):
        scene = self.scenes / "cornell_box.obj"
        _, (expected, _) = self.truth(scene, points)
        plain = {name: given[name].copy() for name in LAYERS}
        path = self.folder / "other.exr"
        forms = {
            "tiles": lambda: write(path, [("", plain)], tile=16),
            "window": lambda: write(path, [("", plain)], window=(-3, 7, 0, 0, 64, 48)),
            "parts": lambda: write(path, [("beauty", {"R": given["R"], "G": given["G"], "B": given["B"]}),
                                          ("position", {axis: plain["position." + axis] for axis in "XYZ"}),
                                          ("normal", {axis: plain["normal." + axis] for axis in "XYZ"})]),
        }
        for form, make in forms.items():
            make()
            _, (image, spec) = self.truth(scene, path, name="other_values")
            for channel in ("R", "G", "B", "mark"):
                assert numpy.array_equal(image[channel], expected[channel], equal_nan=True), (form, channel)
            if form == "window":
                assert (spec.x, spec.y, spec.full_width, spec.full_height) == (-3, 7, 64, 48)
        holes = {name: values.copy() for name, values in plain.items()}
        rows, columns = numpy.nonzero(given["id.face"] > 0)
        spots = list(zip(rows, columns))[10:15]
        holes["position.X"][spots[0]] = numpy.nan
        holes["normal.Y"][spots[1]] = numpy.inf
        for axis in "XYZ":
            holes["normal." + axis][spots[2]] = 0
        holes["position.Y"][spots[3]] -= 60
        holes["normal.X"][spots[4]] += 0.3
        write(path, [("", {"view.P." + name[-1] if name[0] == "p" else "view.N." + name[-1]: values
                           for name, values in holes.items()})])
        error, (image, _) = self.truth(scene, path)
        assert [int(image["mark"][spot]) for spot in spots] == [2, 2, 2, 3, 1], image["mark"]
        assert numpy.isnan([image["R"][spot] for spot in spots[:4]]).all() and numpy.isfinite(image["R"][spots[4]])
        assert "more than a degree off" in error and "lies on no face" in error, error

    # The figures of check are those of NumPy.
    def check_judgement(self):
        exact, _ = read(self.folder / "points.exr")
        truth = numpy.stack([exact[c] for c in "RGB"], axis=-1).astype(numpy.float64)
        noise = numpy.random.default_rng(1).normal(size=truth.shape)
        mine = (truth * (1 + 0.01 * noise)).astype(numpy.float32)
        mine_file, report = self.folder / "mine.exr", self.folder / "check.json"
        write(mine_file, [("", {"view.Combined." + c: mine[:, :, at] for at, c in enumerate("RGB")})])
        files = [self.folder / "points.exr", mine_file]
        self.run("check", *files, "--json", report, "--error-image", self.folder / "e.exr")
        error = mine.astype(numpy.float64) - truth
        overall = json.loads(report.read_text())["overall"]
        expected = {"rms": numpy.sqrt(numpy.mean(error ** 2)), "max": numpy.abs(error).max(),
                    "p99": numpy.sort(numpy.abs(error).ravel())[int(numpy.ceil(0.99 * error.size)) - 1]}
        for name, value in expected.items():
            assert abs(overall["absolute"][name] - value) <= 1e-9 * value, (name, value, overall)
        relative = numpy.mean(error ** 2 / (truth ** 2 + 0.01))
        assert abs(overall["relative_mse"] - relative) <= 1e-9 * relative
        assert abs(overall["bias"] - error.mean()) <= 1e-9 * abs(error.mean())
        picture, _ = read(self.folder / "e.exr")
        for at, channel in enumerate("RGB"):
            difference = mine[:, :, at] - truth[:, :, at].astype(numpy.float32)
            assert numpy.array_equal(picture[channel], difference), channel
        self.run("check", *files, "--rms", "1", "--relative-mse", "1", "--error-image", self.folder / "e.png",
                 "--junit", self.folder / "j.xml")
        assert oiio.ImageInput.open(str(self.folder / "e.png")).spec().width == 20
        self.run("check", *files, "--relative-mse", "1e-9", code=1)
        self.run("check", *files, "--rms", "1e-9", "--per-source", code=1)
        self.run("check", *files, "--value-column", "view.Combined.G", "--truth-column", "G", "--rms", "1")
        assert "its layers are" in self.run("check", *files, "--value-column", "nothing", code=2)
        assert "is no image" in self.run("check", files[0], self.folder / "values.csv", code=2)
        assert "cannot be opened" in self.run("check", files[0], self.folder / "missing.exr", code=2)


def main():
    program, scenes = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as place:
        check_render(program, scenes / "cornell_box.obj", pathlib.Path(place))
        cases = Cases(program, scenes, pathlib.Path(place))
        points, given = cases.check_own_points()
        cases.check_exact_points()
        cases.check_other_files(points, given)
        cases.check_judgement()
    print("images are read, points are taken, and values are written and judged, as another library sees them")


if __name__ == "__main__":
    main()
