#!/usr/bin/env python3
"""Judges what a run of the program has left behind, by parsers that share nothing with it: Python's standard library.

Reads requests from standard input, one a line, and answers each with one line: what is wrong, or nothing. A request is
FOLDER, FORM and EXIT CODE with tabs between: FOLDER holds stdout, stderr and the folder out; FORM says what standard
output is: json, plain, text, or cut where it may end anywhere. Every file below out is judged by its first bytes where
these tell what it is, else by its extension.
"""

import base64
import csv
import html.parser
import io
import json
import pathlib
import re
import sys
import xml.parsers.expat
import zipfile
import zlib
from decimal import Decimal, InvalidOperation

csv.field_size_limit(1 << 30)

CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f]")
# inf or nan, as printf, iostreams and JavaScript write it; not inside a word.
NO_NUMBER = re.compile(r"(?<![\w.])[-+]?(nan|inf|infinity)(?![\w.])", re.IGNORECASE)
# Places where a table may have no number: the value and error of a method in a stress table (some formulas give none);
# times that were not measured, for example of partly hidden receivers if there are none; fractions in large scenes
# (exactff/study.h).
MAY_BE_NO_NUMBER = re.compile(r"_(value|error)$|^seconds|^visible_fraction$")
# Sums over sources, for a formula whose result is not a pure number.
MAY_OVERFLOW = re.compile(r"^(approximate|error)$|^nettle:.*variant=literal")
LEFTOVER = re.compile(r"^\..*\.(partial|old)-\d|\.whole$|^\.lock$")
GEOMETRY = {"x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry", "width", "height", "d", "points", "viewBox",
            "transform", "stroke-width", "font-size"}
VOID = {"area", "base", "br", "col", "embed", "hr", "img", "input", "link", "meta", "source", "track", "wbr"}
RAW_TEXT = {"script", "style"}


class Wrong(Exception):
    pass


def text_of(data):
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise Wrong(f"not UTF-8 ({error.reason})") from None
    found = CONTROL.search(text)
    if found:
        raise Wrong(f"control character {ord(found.group()):#04x}")
    return text


def refuse_constant(name):
    raise Wrong(f"{name} is not JSON")


def refuse_twice(pairs):
    if len({key for key, _ in pairs}) < len(pairs):
        raise Wrong("a key twice")
    return dict(pairs)


# Places where JSON may have no number: patches without a common front, and errors that JSON cannot represent (README,
# check).
MAY_BE_NULL = {"front", "relative", "max", "max-rel", "measured", "median", "p90", "p99", "p999", "rms", "value", "limit",
               "found", "error", "now", "recorded", "bias",
               "eps-b",  # in a baseline: an error above the largest double
               "radiosity"}  # above the largest double if Ke is near it


def refuse_nulls(item, key, may_be_null):
    if item is None and key not in may_be_null:
        raise Wrong(f"no number: '{key}' is null")
    for name, part in item.items() if isinstance(item, dict) else ():
        refuse_nulls(part, name, may_be_null)
    for part in item if isinstance(item, list) else ():
        refuse_nulls(part, key, may_be_null)


def judge_json(data, may_be_null=MAY_BE_NULL):
    try:
        item = json.loads(text_of(data), parse_constant=refuse_constant, object_pairs_hook=refuse_twice)
    except json.JSONDecodeError as error:
        raise Wrong(f"not JSON: {error.msg}") from None
    refuse_nulls(item, "", may_be_null)


def judge_geometry(name, attributes):
    for key, value in attributes:
        if key in GEOMETRY and value is not None and NO_NUMBER.search(value):
            raise Wrong(f"<{name}> with {key} that is no number")


def judge_xml(data):
    text_of(data)
    parser = xml.parsers.expat.ParserCreate()
    parser.StartElementHandler = lambda name, attributes: judge_geometry(name, attributes.items())
    try:
        parser.Parse(data, True)
    except xml.parsers.expat.ExpatError as error:
        raise Wrong(f"not XML: {xml.parsers.expat.ErrorString(error.code)}") from None


class Page(html.parser.HTMLParser):
    """A page whose every element is closed where it has to be, without what HTML lets one leave out."""

    def __init__(self):
        super().__init__(convert_charrefs=False)
        self.open = []

    def handle_starttag(self, tag, attributes):
        judge_geometry(tag, attributes)
        if len({key for key, _ in attributes}) < len(attributes):
            raise Wrong(f"<{tag}> with an attribute twice")
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        judge_geometry(tag, attributes)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise Wrong(f"</{tag}> closes nothing")

    def handle_data(self, data):
        if self.open and self.open[-1] not in RAW_TEXT and "<" in data:
            raise Wrong("a bare < in text")


def judge_html(data):
    page = Page()
    page.feed(text_of(data))
    page.close()
    if page.open:
        raise Wrong(f"<{page.open[-1]}> is not closed")


def judge_csv(data):
    try:
        lines = data.decode("utf-8").split("\n")
    except UnicodeDecodeError as error:
        raise Wrong(f"not UTF-8 ({error.reason})") from None
    if lines.pop() != "":
        raise Wrong("the last line has no end")
    rows = csv.reader(io.StringIO("\n".join(line for line in lines if not line.startswith("#"))), strict=True)
    try:
        names = next(rows)
        for row in rows:
            if len(row) != len(names):
                raise Wrong(f"a row of {len(row)} fields under {len(names)} names")
            for name, field in zip(names, row):
                overflows = "inf" in field.lower() and MAY_OVERFLOW.search(name)
                if NO_NUMBER.fullmatch(field) and not overflows and not MAY_BE_NO_NUMBER.search(name):
                    raise Wrong(f"column {name} has {field}")
    except csv.Error as error:
        raise Wrong(f"not CSV: {error}") from None
    except StopIteration:
        raise Wrong("no names of columns") from None


def judge_plain(data):
    word = data.decode("ascii", "replace").removesuffix("\n")
    try:
        value = Decimal(word)
    except InvalidOperation:
        raise Wrong("--plain prints no number") from None
    if not (value.is_finite() and 0 <= value <= 1):
        raise Wrong("--plain prints a number outside [0, 1]")


# Names reach a terminal in UTF-8, whatever the files hold; they must not control it.
def judge_words(data):
    text_of(data)


def judge_binary_ply(data):
    header, _, rest = data.partition(b"end_header\n")
    vertices, faces = (int(re.search(rb"element %s (\d+)" % name, header).group(1)) for name in (b"vertex", b"face"))
    if b"property list uchar" not in header:
        return  # lists of more than 255 corners
    at = 24 * vertices
    for _ in range(faces):
        at += 1 + 4 * rest[at] + (4 if b"property uint patch" in header else 0)
    if at != len(rest):
        raise Wrong(f"{len(rest)} bytes of data instead of {at}")


# Names in them are the bytes from the scene file, but numbers stand where they are expected.
def judge_scene(data):
    if data.startswith(b"ply\nformat binary"):
        return judge_binary_ply(data)
    if data[:7] == b"written":
        if len(data) != 84 + 50 * int.from_bytes(data[80:84], "little"):
            raise Wrong("binary STL of a wrong length")
        return
    if data and not data.endswith(b"\n"):
        raise Wrong("the last line has no end")
    for line in data.splitlines():
        words = line.split()
        if words and words[0] in (b"v", b"V", b"vertex", b"Kd", b"Ke") and NO_NUMBER.search(line.decode("latin-1")):
            raise Wrong("a number that is none")


# Chunks with the right checksums, and as many bytes of pixels as the size says.
def judge_png(data):
    if not data.startswith(b"\x89PNG\r\n\x1a\n"):
        raise Wrong("not PNG")
    at, pixels, last, size = 8, b"", b"", b""
    while at < len(data):
        length, last = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body, checksum = data[at + 8:at + 8 + length], data[at + 8 + length:at + 12 + length]
        if zlib.crc32(last + body).to_bytes(4, "big") != checksum:
            raise Wrong(f"PNG chunk {last} is damaged")
        pixels += body if last == b"IDAT" else b""
        size = body if last == b"IHDR" else size
        at += 12 + length
    width, height = int.from_bytes(size[:4], "big"), int.from_bytes(size[4:8], "big")
    if last != b"IEND" or len(zlib.decompress(pixels)) != height * (1 + 3 * width):
        raise Wrong("PNG is cut off")


# The header, and that the table of offsets, which follows the header's last attribute, leads into the file.
def judge_exr(data):
    if not data.startswith(b"\x76\x2f\x31\x01\x02") or b"channels\0chlist\0" not in data:
        raise Wrong("not OpenEXR")
    last = b"screenWindowWidth\0float\0\x04\0\0\0"
    table = data.find(last) + len(last) + 4 + 1  # its value, then the zero that ends the header
    first = int.from_bytes(data[table:table + 8], "little")
    if not table < first < len(data):
        raise Wrong("OpenEXR without pixels")


def judge_vtk(data):
    judge_xml(data)
    for text in re.findall(rb'format="binary">\n(.*)\n</DataArray>', data):
        try:
            array = base64.b64decode(text, validate=True)
        except ValueError:
            raise Wrong("an array that is not base64") from None
        if len(array) < 8 or int.from_bytes(array[:8], "little") != len(array) - 8:
            raise Wrong("an array of a wrong length")


def judge_npy(data):
    header = data[10:10 + int.from_bytes(data[8:10], "little")]
    shape = re.search(rb"'shape': \(([0-9, ]*)\)", header)
    if data[:8] != b"\x93NUMPY\1\0" or not shape or b"'<f8'" not in header:
        raise Wrong("no NumPy array of doubles")
    count = 8
    for extent in shape.group(1).replace(b",", b" ").split():
        count *= int(extent)
    if len(data) != 10 + len(header) + count:
        raise Wrong("a NumPy array of another size")


# Whatever its arrays are, the archive is whole and each of them is a NumPy file.
def judge_npz(data):
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            damaged = archive.testzip()
            others = [name for name in archive.namelist() if not archive.read(name).startswith(b"\x93NUMPY\1\0")]
    except (zipfile.BadZipFile, zlib.error) as error:
        raise Wrong(f"no archive: {error}") from None
    if damaged or others:
        raise Wrong(f"an array that is damaged, or none: {damaged or others[0]}")


SCENES = {extension: judge_scene for extension in (".obj", ".mtl", ".ply", ".stl", ".off", ".vs3")}
JUDGES = {**SCENES, ".csv": judge_csv, ".json": judge_json, ".svg": judge_xml, ".xml": judge_xml, ".html": judge_html,
          ".png": judge_png, ".exr": judge_exr, ".npy": judge_npy, ".vtp": judge_vtk, ".vtu": judge_vtk,
          ".part": lambda data: None}
# These are written under any name that the user gives them.
SIGNATURES = {b"# exactff ": judge_csv, b"\x93NUMPY": judge_npy, b"\x76\x2f\x31\x01": judge_exr, b"\x89PNG": judge_png,
              b"PK\3\4": judge_npz}
FORMS = {"json": lambda data: judge_json(data, {"front"}), "plain": judge_plain, "text": judge_words}


def judge_file(path, code):
    if LEFTOVER.search(path.name):
        raise Wrong("half-written, left behind")
    if path.suffix == ".part" and code == 0:
        raise Wrong("a journal left behind by a finished run")
    if path.is_file():
        data = path.read_bytes()
        # A journal may end in the middle of a row.
        by_content = [judge for begin, judge in SIGNATURES.items() if data.startswith(begin) and path.suffix != ".part"]
        (by_content or [JUDGES.get(path.suffix, text_of)])[0](data)


def judge(folder, form, code):
    where = "stdout"
    try:
        if form in FORMS and code in (0, 1, 3) and (folder / "stdout").exists():
            FORMS[form]((folder / "stdout").read_bytes())
        where = "stderr"
        if not (folder / "stderr").exists():
            raise Wrong("the folder of the run is gone")
        judge_words((folder / "stderr").read_bytes())
        if code == 2 and not (folder / "stderr").read_bytes().strip():
            raise Wrong("bad input, and nothing is said")
        for path in sorted((folder / "out").rglob("*")):
            where = str(path.relative_to(folder))
            judge_file(path, code)
    except Wrong as wrong:
        return f"{where}: {wrong}"
    return ""


def main():
    for line in sys.stdin.buffer:
        folder, form, code = line.decode("utf-8").rstrip("\n").split("\t")
        answer = judge(pathlib.Path(folder), form, int(code))
        sys.stdout.write(answer.encode("ascii", "backslashreplace").decode("ascii").replace("\n", " ") + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
