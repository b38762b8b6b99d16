#!/usr/bin/env python3
"""Parses VTK's XML files with Python's own XML parser, and checks that they are consistent.

usage: parse_vtk.py FOLDER

Beside a file NAME.vtp or NAME.vtu may stand NAME.f8 with the expected doubles of the array "exact". Prints what is wrong
with a file, and ends with 1 if something is.
"""
import array
import base64
import math
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

CODES = {"Float64": "d", "Int64": "q", "UInt8": "B"}


class Wrong(Exception):
    pass


def require(holds, what):
    if not holds:
        raise Wrong(what)


def values_of(element):
    data = base64.b64decode("".join(element.text.split()), validate=True)
    length, data = int.from_bytes(data[:8], "little"), data[8:]
    name = element.get("Name")
    require(length == len(data), f"{name} has {len(data)} bytes, and says {length}")
    if element.get("type") == "String":
        texts = data.decode("utf-8").split("\0")
        require(texts.pop() == "", f"{name} does not end with a zero")
        values = texts
    else:
        values = array.array(CODES[element.get("type")])
        values.frombytes(data)
        if sys.byteorder == "big":
            values.byteswap()
    tuples = int(element.get("NumberOfTuples"))
    require(len(values) == tuples * int(element.get("NumberOfComponents", 1)), f"{name} has {len(values)} values")
    return values


def arrays_of(parent):
    arrays = {}
    for element in parent:
        require(element.get("Name") not in arrays, f"two arrays are called {element.get('Name')!r}")
        arrays[element.get("Name")] = values_of(element)
    return arrays


def check_cells(cells, points, used):
    """Returns the numbers of corners."""
    sizes, begin = [], 0
    for end in cells["offsets"]:
        sizes.append(end - begin)
        begin = end
    require(begin == len(cells["connectivity"]), "the last cell does not end with the list")
    require(all(0 <= corner < points for corner in cells["connectivity"]), "a corner is no point")
    used.update(cells["connectivity"])
    return sizes


def check(path):
    root = ElementTree.parse(path).getroot()
    require(root.attrib == {"type": "PolyData" if path.suffix == ".vtp" else "UnstructuredGrid", "version": "1.0",
                            "byte_order": "LittleEndian", "header_type": "UInt64"}, "another head")
    for field_data in root[0].findall("FieldData"):
        arrays_of(field_data)
    piece = root[0].find("Piece")
    count = {name: int(piece.get("NumberOf" + name, 0)) for name in ("Points", "Verts", "Polys", "Cells")}
    coordinates = arrays_of(piece.find("Points"))["Points"]
    require(len(coordinates) == 3 * count["Points"], "not all points are there")
    require(all(math.isfinite(c) for c in coordinates), "a point is not finite")
    used = set()
    if path.suffix == ".vtp":
        vertices = check_cells(arrays_of(piece.find("Verts")), count["Points"], used)
        polygons = check_cells(arrays_of(piece.find("Polys")), count["Points"], used)
        require([len(vertices), len(polygons)] == [count["Verts"], count["Polys"]], "another number of cells")
        sizes = vertices + polygons
        require(all(n == 1 for n in vertices), "a vertex has several corners")
    else:
        cells = arrays_of(piece.find("Cells"))
        sizes = check_cells(cells, count["Points"], used)
        require(list(cells["types"]) == [{1: 1, 3: 5, 4: 9}.get(n, 7) for n in sizes], "a type is wrong")
        require(len(sizes) == count["Cells"], "another number of cells")
    require(all(n == 1 or n >= 3 for n in sizes), "a polygon has two corners")
    require(len(used) == count["Points"], "a point belongs to no cell")
    data = piece.find("CellData")
    arrays = arrays_of(data)
    for element in data:
        require(int(element.get("NumberOfTuples")) == len(sizes), f"{element.get('Name')} is not one for each cell")
    require(data.get("Scalars") in arrays, "the array to show is not there")
    if "receiver" in arrays:
        require(sorted(arrays["receiver"]) == list(range(len(sizes))), "not every receiver has a cell")
    expected = path.with_suffix(".f8")
    if expected.exists():
        in_order = array.array("d", expected.read_bytes())
        found = array.array("d", (in_order[i] for i in arrays["receiver"]))
        require(found.tobytes() == arrays["exact"].tobytes(), "a value has other bits")


def main():
    paths = sorted(path for path in pathlib.Path(sys.argv[1]).iterdir() if path.suffix in (".vtp", ".vtu"))
    wrong = 0 if paths else 1
    for path in paths:
        try:
            check(path)
        except (Wrong, ValueError, KeyError, ElementTree.ParseError) as error:
            print(f"{path.name}: {error}")
            wrong = 1
    return wrong


if __name__ == "__main__":
    sys.exit(main())
