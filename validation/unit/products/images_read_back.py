#!/usr/bin/env python3
"""Reads the images of exactff render with OpenImageIO: names, types, orientation and numbers, compared with the NumPy
files and with exactff truth for the same pixels.

Usage: images_read_back.py PROGRAM SCENES-FOLDER
"""

import csv
import pathlib
import subprocess
import sys
import tempfile

import numpy
import OpenImageIO as oiio

CAMERA = "--eye 278 273 -800 --look 278 273 0 --fov 39.3 --size 24x24".split()


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


def main():
    program, scene = sys.argv[1], pathlib.Path(sys.argv[2]) / "cornell_box.obj"
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        render = [program, "render", scene, *CAMERA]
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
    print("names, types, orientation and numbers are right")


if __name__ == "__main__":
    main()
