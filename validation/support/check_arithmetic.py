#!/usr/bin/env python3
"""Checks where src/ guards against the floating-point settings of the calling thread (kernel/float_environment.h).

The guard, a kernel::StandardArithmetic, stands at the public boundary: in functions that a header of include/exactff
declares, and in overrides of virtual functions declared there. Functions of inner rooms have none: their callers, or
the threads that started theirs, have one. Each public function that is defined in src/ has a guard, except
  - one-line functions, which hand over a member or call a function that has a guard,
  - constructors that only store, operators, names of enumerators,
  - functions that call an overload of their own name,
  - those listed below.

Usage: check_arithmetic.py TOP-FOLDER
"""
import pathlib
import re
import sys

GUARD = "const kernel::StandardArithmetic arithmetic;"

# Without a guard: they compute with no double, but copy, count, name, look up, or write texts and files.
WITHOUT = """
  Problem::message SceneBuilder::add_face SceneBuilder::add_material SceneBuilder::mark_as_twin SceneBuilder::patch
  SceneBuilder::state_normal SceneBuilder::state_texture Scene::faces_of Scene::hash Scene::name_of
  Scene::receiver_reflectance Scene::select Scene::select_all Scene::texture Scene::with_unit face_name name_of
  read_names number_setting seed_setting whole_setting word_setting as_form_factor behind_every_face decided_outcome
  stages unit_of check::program_names exr::ExrFile::find exr::ExrFile::layers exr::is_exr exr::name_of_pixel
  exr::warnings_of jobs::journal_of jobs::journal_of_folder jobs::merge jobs::require_free matrix::matrix_of
  matrix::options_of matrix::reasons_against_one matrix::with_values methods::Counters::add
  methods::Method::normalised methods::description models::all_models radiosity::matrix_options radiosity::patches_of
  radiosity::square_of render::image_kind render::png_of render::strip table::Head::find table::Head::number
  table::Head::set table::Table::append table::Table::at table::Table::column table::kind_of
"""
# Without a guard: they only call public functions that have one.
CALLERS = """
  batch::exact_form_factors batch::find_faces batch::form_factors batch::receivers_in place_on_faces
  radiosity::solve render::write_image to_scene
"""
# With a guard, although no header declares them: Method::prepare of the library's methods, and two functions of the
# package for Python that call inner rooms.
ALSO = "methods::prepare_as python::(anonymous)::result_of python::(anonymous)::scoreboard"


def without_comments(text):
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    return re.sub(r'"(\\.|[^"\\])*"', '""', text)


def without_templates(text):
    while (shorter := re.sub(r"<[^<>()]*>", "", text)) != text:
        text = shorter
    return text


NAME = r"(~?(?:\w+::)*~?(?:operator\s*[^\s\w(]+|\w+))\s*\("


def declared(text):
    """The functions that a public header declares, with namespaces and classes: exactff::Scene::hash. Second, those of
    them that are virtual."""
    scopes, statement, depth = [], "", 0
    names, virtuals = set(), set()
    for c in without_comments(text):
        inside_body = any(scope[0] == "body" for scope in scopes)
        depth += {"(": 1, ")": -1}.get(c, 0)
        if c == "{" and depth == 0:
            scope = re.search(r"\b(namespace|class|struct|enum)\s+(?:class\s+)?([\w:]*)[^;()=]*$", statement)
            scopes.append((scope[1], scope[2]) if scope and not inside_body else ("body", ""))
            if scopes[-1][0] != "body":
                statement = ""
        elif c == "}" and depth == 0:
            kind = scopes.pop()[0]
            if kind != "body" or re.search(r"\)[^;=]*$", statement):
                statement = ""
        elif c == ":" and re.search(r"\b(private|protected|public)\s*$", statement):
            scopes[-1] = scopes[-1][:2] + (not statement.rstrip().endswith("public"),)
            statement = ""
        elif c == ";" and depth == 0 and not inside_body and scopes and scopes[-1][2:] == (True,):
            statement = ""
        elif c == ";" and depth == 0 and not inside_body:
            found = re.search(NAME, without_templates(statement))
            if found and "= default" not in statement and "= delete" not in statement and "=" not in statement[: found.start()]:
                name = "::".join([scope[1] for scope in scopes if scope[1]] + [found[1]])
                names.add(name)
                if "virtual" in statement:
                    virtuals.add(found[1])
            statement = ""
        elif not inside_body:
            statement += c
    return names, virtuals


def definitions(text):
    """The functions that a source file defines: line, name with namespaces, body. Inner classes count as lines of their
    class."""
    lines = text.split("\n")
    spaces = []
    i = 0
    while i < len(lines):
        line = lines[i]
        if opened := re.match(r"namespace\s*([\w:]*)\s*\{", line):
            spaces.append(opened[1] or "(anonymous)")
        elif line.startswith("}  // namespace") and spaces:
            spaces.pop()
        elif line and line[0] not in " }/#" and not re.match(r"(using|enum|extern|static_assert)\b", line):
            j = i
            while j + 1 < len(lines) and not re.search(r"[;{}]\s*(//.*)?$", lines[j]):
                j += 1
            end = j
            if lines[j].split("//")[0].rstrip().endswith("{"):
                while not lines[end].startswith("}"):
                    end += 1
            signature = without_templates(" ".join(lines[i : j + 1]))
            found = re.search(NAME, signature)
            if found and "{" in signature:
                yield i + 1, "::".join(spaces + [found[1]]), lines[j:end]
            elif re.match(r"(class|struct|template)", line):
                yield i + 1, "::".join(spaces + ["(class)"]), lines[j:end]
            i = end
        i += 1


def check(top):
    """The complaints, and the number of guards."""
    public, virtuals = set(), set()
    for header in (top / "include/exactff").glob("*.h"):
        functions, overridden = declared(header.read_text())
        public |= functions
        virtuals |= overridden
    without, also = set((WITHOUT + CALLERS).split()), set(ALSO.split())
    complaints, seen, guards = [], set(), 0
    for file in sorted([*(top / "src").rglob("*.h"), *(top / "src").rglob("*.cpp")]):
        if file.name == "float_environment.h":
            continue
        text = file.read_text()
        found = 0
        for line, name, body in definitions(text):
            own, short = name.rsplit("::", 1)[-1], name.removeprefix("exactff::")
            seen.add(short)
            has_guard = GUARD in "".join(body)
            found += sum(GUARD in part for part in body)
            needs_none = (
                len(body) <= 2
                or name.endswith(f"{own}::{own}")
                or own.startswith("operator")
                or own == "to_string"
                or own.endswith("_named")
                or short in without
                or re.search(rf"\b{re.escape(own)}\(", "\n".join(body[1:]))
            )
            place = f"{file.relative_to(top)}:{line}: {short}"
            if name in public and not has_guard and not needs_none:
                complaints.append(f"{place} is public and computes, but has no guard")
            if has_guard and name not in public | {"exactff::" + one for one in also}:
                overrides = [part for part in body if re.search(r"\boverride\b", part)]
                if own not in virtuals and not (own == "(class)" and overrides):
                    complaints.append(f"{place} has a guard, but is not public")
        guards += found
        if found != text.count("StandardArithmetic arithmetic;"):
            complaints.append(f"{file.relative_to(top)} has a guard outside of functions")
    complaints += [f"{name} is listed, but is no function of src/" for name in sorted((without | also) - seen)]
    return complaints, guards


def main(top):
    complaints, guards = check(top)
    print(*complaints, f"{guards} guards", sep="\n")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
