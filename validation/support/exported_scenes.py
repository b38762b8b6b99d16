#!/usr/bin/env python3
"""Writes five scenes as modelling programs export them, each with one slip, and one without.

usage: exported_scenes.py FOLDER

All show the same room: a floor of 4 x 3 m (patch `floor`), a lamp of 2 x 1 m that shines down from 2.5 m (`lamp`), and a
closed box on the floor (`table`). What the slip is stands at each function. The tests of these scenes are in
validation/unit/scenes/exported_scenes_test.cpp.
"""
import math
import os
import sys

FLOOR = [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0)]
LAMP = [(1, 1, 2.5), (1, 2, 2.5), (3, 2, 2.5), (3, 1, 2.5)]  # seen from below: counter-clockwise
BOX = [(2.5, 0.5, 0), (3.5, 0.5, 0), (3.5, 1, 0), (2.5, 1, 0),
       (2.5, 0.5, 0.75), (3.5, 0.5, 0.75), (3.5, 1, 0.75), (2.5, 1, 0.75)]
SIDES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]

MATERIALS = """newmtl paint
Kd 0.5 0.5 0.5
newmtl lamp
Kd 0 0 0
Ke 10 10 10
newmtl glass
Kd 0.1 0.1 0.1
d 0.1
illum 4
"""


def turned(face):
    return list(reversed(face))


class Obj:
    """Collects faces and writes them as OBJ, with `digits` decimals."""

    def __init__(self, digits=None):
        self.digits = digits
        self.text = "mtllib scene.mtl\n"
        self.vertices = 0

    def number(self, value):
        return repr(float(value)) if self.digits is None else "%.*f" % (self.digits, value)

    def add(self, patch, material, faces, normals=None):
        self.text += "g %s\nusemtl %s\n" % (patch, material)
        for k, face in enumerate(faces):
            for corner in face:
                self.text += "v %s\n" % " ".join(self.number(c) for c in corner)
            if normals:
                self.text += "vn %s\n" % " ".join(self.number(c) for c in normals[k])
            numbers = range(self.vertices + 1, self.vertices + len(face) + 1)
            self.text += "f %s\n" % " ".join("%d//-1" % n if normals else str(n) for n in numbers)
            self.vertices += len(face)

    def write(self, folder, name):
        with open(os.path.join(folder, name + ".obj"), "w", encoding="utf-8") as file:
            file.write(self.text)


def box():
    return [[BOX[i] for i in side] for side in SIDES]


def room(obj, at=lambda p: p, floor=None, lamp=None, table=None):
    def moved(faces):
        return [[at(p) for p in face] for face in faces]

    obj.add("floor", "paint", moved(floor or [FLOOR]))
    obj.add("lamp", "lamp", moved(lamp or [LAMP]))
    obj.add("table", "paint", moved(table or box()))
    return obj


def triangles(faces):
    return [[face[0], face[i], face[i + 1]] for face in faces for i in range(1, len(face) - 1)]


def rotated(p):
    c, s = math.cos(0.4), math.sin(0.4)
    x, y, z = p
    y, z = c * y - s * z, s * y + c * z
    return (c * x - s * y + 10, s * x + c * y, z)


def scenes():
    pane = [(0.5, 0.5, 2), (0.5, 2.5, 2), (3.5, 2.5, 2), (3.5, 0.5, 2)]
    room_of_normals = Obj()
    room_of_normals.add("floor", "paint", [FLOOR], [(0, 0, 1)])
    room_of_normals.add("lamp", "lamp", [turned(LAMP)], [(0, 0, -1)])
    room_of_normals.add("table", "paint", box())
    with_pane = room(Obj())
    with_pane.add("pane", "glass", [pane])
    return {
        "clean": room(Obj()),
        "rotated": room(Obj(6), at=rotated, floor=triangles([FLOOR]), table=triangles(box())),
        "flipped": room(Obj(), lamp=[turned(LAMP)]),
        "glass": with_pane,
        "inverted": room(Obj(), table=[turned(face) for face in box()]),
        "normals": room_of_normals,
    }


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "scene.mtl"), "w", encoding="utf-8") as file:
        file.write(MATERIALS)
    for name, obj in scenes().items():
        obj.write(folder, name)


if __name__ == "__main__":
    main()
