#!/usr/bin/env python3
"""draw_house.py TOP > data/pictures/house.svg: draws src/ from its folders, its includes and the pages of its storeys.

A box is a room, with the words of its storey's page. Dots tell which of the three values a room includes, also through
other headers. A test compares the bytes.
"""
import functools, html, itertools, pathlib, re, sys, textwrap

top = pathlib.Path(sys.argv[1]).resolve()
storeys = re.search(r"storeys=\((.*?)\)", (top / "validation/support/check_modules.sh").read_text())[1].split()
pages = {storey: (top / "src" / storey / "README.md").read_text() for storey in storeys}
words = {storey: dict(re.findall(r"^\| `(\w+)` \| (.*?) \|", pages[storey], re.M)) for storey in storeys}
storey_of = {room: storey for storey in storeys for room in words[storey]}
values = (("scenes", "Scene", "scene.h", "exactff/scene.h", "#2e6db4"), ("solver", "VisibleRegion", "region.h",
          "visibility/visible_arcs.h", "#cc6a14"), ("products", "Table", "table.h", "exactff/table.h", "#338a48"))


@functools.cache
def reach(name):
    """The names of a file and of all that it includes."""
    room, _, header = name.partition("/")
    file = top / "include" / name if room == "exactff" else top / "src" / storey_of.get(room, "-") / room / header
    found = re.findall(r'^#include "(\w+/\w+\.h)"', file.read_text(), re.M) if file.is_file() else []
    return frozenset({name}.union(*map(reach, found)))


used = {room: set().union(*(reach(f"{room}/{file.name}") for file in (top / "src" / storey / room).glob("*.[hc]*")))
        for room, storey in storey_of.items()}
for before, room in itertools.combinations(storey_of, 2):
    if storey_of[before] == storey_of[room] and any(name.startswith(f"{room}/") for name in used[before]):
        sys.exit(f"{before} includes {room}: in src/{storey_of[room]}/README.md it must stand after it")
out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1160 768" font-family="Helvetica, Arial, sans-serif">']
text = lambda x, y, size, fill, words, more="": out.append(
    f'<text x="{x}" y="{y}" font-size="{size}" fill="{fill}" {more}>{html.escape(words)}</text>')
rect = lambda x, y, width, height, radius, fill, more="": out.append(
    f'<rect x="{x}" y="{y}" width="{width}" height="{height}" rx="{radius}" fill="{fill}" {more}/>')
rect(0, 0, 1160, 768, 0, "#fff")
tints = dict(zip(storeys, ("#eceef2", "#e4eef9", "#fcefdf", "#f7e9ea", "#e6f3e8", "#efecf6", "#f4f1ea")))
for storey, y in zip(storeys, range(638, 0, -105)):
    rect(8, y, 1144, 99, 9, tints[storey])
    text(22, y + 20, 15, "#222", storey, 'font-weight="bold"')
    text(122, y + 19, 12, "#555", pages[storey].splitlines()[2])
    for i, room in enumerate(words[storey], -((len(words[storey]) + 1) // 2)):  # around the middle
        x = 580 + 122 * i + (70 if i >= 0 else -65)
        rect(x, y + 30, 117, 62, 6, "#fff", 'stroke="#aaa"')
        text(x + 7, y + 46, 13, "#222", room, 'font-weight="bold"')
        for k, line in enumerate(textwrap.wrap(words[storey][room].replace("`", ""), 18)):
            text(x + 7, y + 60 + 13 * k, 11, "#333", line)
        for k, (*_, colour) in enumerate([value for value in values if value[3] in used[room]][::-1]):
            rect(x + 100 - 12 * k, y + 26, 9, 9, 4.5, colour)
out.append('<path d="M580 590 V16 m-7 13 l7 -13 l7 13" fill="none" stroke="#777" stroke-width="2.5"/>')
for k, (storey, name, header, _, colour) in enumerate(values):
    y = 638 - 105 * storeys.index(storey)
    rect(517, y + 37, 126, 48, 24, colour)
    text(580, y + 58, 14.5, "#fff", name, 'font-weight="bold" text-anchor="middle"')
    text(580, y + 74, 11, "#fff", header, 'text-anchor="middle"')
    rect(22 + 12 * k, 748, 9, 9, 4.5, colour)
text(62, 756, 12, "#555", "The room includes this value. Of its own storey, a room includes only rooms further left.")
print("\n".join(out), "</svg>", sep="\n")
