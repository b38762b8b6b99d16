#!/usr/bin/env python3
"""check_includes.py TOP: a source that names a function, type or constant of a room, as in text::in_quotes, must include a
header that declares it, itself or through its headers. A quick build joins the sources of a room, and hides the lack.
"""
import collections, functools, pathlib, re, sys

top = pathlib.Path(sys.argv[1]).resolve()
folders = (top / "include", top / "validation", *(top / "src").iterdir())
headers = {str(file.relative_to(folder)): file for folder in folders for file in folder.rglob("*.h")}


@functools.cache
def reach(file):
    """The file, and all of ours that it includes."""
    found = re.findall(r'^#include ["<]([^">]+)', file.read_text(), re.M)
    return frozenset({file}.union(*(reach(headers[name]) for name in found if name in headers)))


declaring = collections.defaultdict(set)  # of a namespace and a name: the headers
declaration = re.compile(r"(?! |[#/}]|return|struct \w+;|class \w+;).*?\b(\w+)(?=\(| = | \{| : |\{)")
for file in headers.values():
    spaces = []
    for line in file.read_text().splitlines():
        if opened := re.match(r"namespace (?:\w+::)*(\w+) \{", line):
            spaces.append(opened[1])
        elif line.startswith("}  // namespace"):
            spaces.pop()
        elif spaces and (declared := declaration.match(line)):
            declaring[spaces[-1], declared[1]].add(file)
failures = 0
for file in sorted(file for folder in ("src", "validation") for file in (top / folder).rglob("*.cpp")):
    code = re.sub(r'//[^\n]*|R"\((?s:.*?)\)"|"(?:\\.|[^"\\\n])*"', '""', file.read_text())
    for space, name in sorted(set(re.findall(r"\b(\w+)::(\w+)\b", code))):
        if (wanted := declaring[space, name]) and not wanted & reach(file):
            failures += 1
            print(f"{file.relative_to(top)} uses {space}::{name} of " + " or ".join(sorted(str(header.relative_to(top)) for header in wanted)))
sys.exit(failures > 0)
