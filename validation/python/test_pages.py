"""The pages (*.md): what they show runs, and their links lead somewhere. One test for each page.

Every fenced block has a language. All run in the order of the page, in one scratch folder that looks like the folder of
the sources after a build. Files that they write stay there.

console   Lines "$ COMMAND", continued by a backslash, run by bash; the lines between are what they print, on standard
          output and standard error. A line "..." stands for any lines, "..." in a line for any text. Where nothing is
          shown, anything may be printed. The exit code is 0: `check ... || echo "exit code $?"` shows another one.
python    All blocks of a page are one program. A block "text" right after one is what it prints.
cpp       All blocks of a page are compiled as one function, a block with "int main(" by itself. Nothing is run.
sh        What takes long, or needs what may not be there. The line above is <!-- run by FILE -->, with the script or
          test that runs these commands, or the same with other arguments. Their flags must be known to the program.
text, cmake   Nothing is run.

<!-- run by FILE --> above a block of another language leaves it to FILE as well. Flags in `code` must be known, too.
"""

import contextlib
import functools
import io
import os
import pathlib
import re
import subprocess
import sys

import pytest

from support import PROGRAM, run, SOURCE

BUILD = pathlib.Path(PROGRAM).resolve().parent
PAGES = sorted(page for folder in ("data", "include", "src", "validation") for page in (SOURCE / folder).rglob("*.md")
               if ".pytest_cache" not in page.parts)
PAGES.insert(0, SOURCE / "README.md")
LANGUAGES = {"console", "python", "cpp", "sh", "text", "cmake"}
LARGEST_PAGE, ALL_PAGES = 15_000, 120_000


class Block:
    def __init__(self, found):
        self.by, self.language, self.text = found["by"], found["language"], found["text"]
        self.end = found.end()


def blocks_of(text):
    return [Block(found) for found in re.finditer(
        r"(?:^<!-- run by (?P<by>\S+) -->\n\n?)?^```(?P<language>\w*)\n(?P<text>.*?)^```\n", text, re.M | re.S)]


def require_same(shown, printed, what):
    """`shown` may have "..." for any lines, or for any text within a line, with the blanks around it."""
    lines = [r"(?:.*\n)*?" if line.strip() == "..." else
             ".*?".join(map(re.escape, re.split(r" *\.\.\. *", line.rstrip()))) + "\n" for line in shown.splitlines()]
    printed = "".join(line.rstrip() + "\n" for line in printed.strip("\n").splitlines())
    if not re.fullmatch("".join(lines), printed):
        pytest.fail(f"{what}\nprints\n{printed}\nnot\n{shown}", pytrace=False)


# ------------------------------------------------------------------------------------------------------------- to run

@pytest.fixture
def scratch(tmp_path, monkeypatch):
    """The folder of the sources, after a build."""
    for name in ("data", "include", "src", "validation"):
        (tmp_path / name).symlink_to(SOURCE / name)
    (tmp_path / "build").mkdir()
    for made in BUILD.iterdir():
        if made.name == "python" or (made.is_file() and os.access(made, os.X_OK)):
            (tmp_path / "build" / made.name).symlink_to(made)
    programs = tmp_path / "build" / "programs"
    programs.mkdir()
    (programs / "python3").write_text(f'#!/bin/sh\nexec "{sys.executable}" -B "$@"\n')
    (programs / "python3").chmod(0o755)
    (programs / "exactff").symlink_to(PROGRAM)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_console(block):
    """Commands that hang would hang on a reader's terminal, too: standard input is empty."""
    assert block.text.startswith("$ "), block.text
    for part in re.split(r"^\$ ", block.text, flags=re.M)[1:]:
        command, shown = re.match(r"((?:[^\n]*\\\n)*[^\n]*\n)(.*)", part, re.S).groups()
        done = subprocess.run(["bash", "-o", "pipefail", "-c", command], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, f"{command}ends with {done.returncode}\n{done.stdout}"
        if shown.strip():
            require_same(shown, done.stdout, command)


def run_python(block, names, shown):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(block.text, "page", "exec"), names)
    if shown is not None:
        require_same(shown, out.getvalue(), block.text)


def compile_cpp(blocks):
    """Includes come first; the rest of all blocks is the body of one function."""
    compiler = os.environ.get("EXACTFF_COMPILER", "c++")
    whole = [block.text for block in blocks if "int main(" in block.text]
    lines = [line for block in blocks if "int main(" not in block.text for line in block.text.splitlines()]
    if lines:
        includes = [line for line in lines if line.startswith("#")]
        whole.append("\n".join([*includes, "void page() {", *(line for line in lines if line not in includes), "}\n"]))
    for code in whole:
        folders = (f"-I{SOURCE}/include", f"-I{BUILD}/include")
        done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", *folders, "-x", "c++", "-"], input=code,
                              capture_output=True, text=True)
        assert done.returncode == 0, f"{code}\n{done.stderr}"


# ------------------------------------------------------------------------------------------------------- not to be run

@functools.cache
def flags_of(command):
    return set(re.findall(r"--[a-z][a-z0-9-]*", run(PROGRAM, command, "--help")))


@functools.cache
def commands():
    return re.findall(r"^  (\w+) ", run(PROGRAM, "help").split("Subcommands:")[1], re.M)


def require_known_flags(text):
    for command, rest in re.findall(r"(?<!\.py build/)\bexactff ([a-z]+)\b([^\n|;&#)]*)", text.replace("\\\n", " ")):
        assert command in commands(), f"exactff {command}"
        unknown = set(re.findall(r"(?<=\s)--[a-z][a-z0-9-]*", rest)) - flags_of(command)
        assert not unknown, f"exactff {command} has no {unknown}"
        yield command


def require_a_runner(block):
    file = SOURCE / block.by
    assert file.is_file(), f"{block.by}, which is said to run\n{block.text}"
    text = file.read_text()
    for command in require_known_flags(block.text):
        assert re.search(rf"\b{command}\b", text), f"{block.by} does not run exactff {command}"


def require_known_flags_in_words(prose):
    known = {flag for command in commands() for flag in flags_of(command)}
    for flag in re.findall(r"`(--[a-z][a-z0-9-]*)[^`]*`", prose):
        assert flag in known, f"no command has {flag}"


def anchors_of(page):
    text = re.sub(r"^```.*?^```\n", "", page.read_text(), flags=re.M | re.S)
    made = []
    for title in re.findall(r"^#+ (.+)$", text, re.M):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        anchor = re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")
        made.append(anchor + (f"-{made.count(anchor)}" if anchor in made else ""))
    return {*made, *re.findall(r'<a id="([^"]+)">', text)}


def require_links(page, prose):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        assert file.exists(), f"a link to {target}"
        if anchor:
            assert anchor in anchors_of(file), f"a link to {target}"


# --------------------------------------------------------------------------------------------------------------- tests

@pytest.mark.parametrize("page", PAGES, ids=[str(page.relative_to(SOURCE)) for page in PAGES])
def test_a_page(page, scratch):
    text = page.read_text()
    assert len(text.encode()) <= LARGEST_PAGE
    blocks = blocks_of(text)
    prose = re.sub(r"^```.*?^```\n", "", text, flags=re.M | re.S)
    assert "```" not in prose and not re.search(r"^    (\$ |\S*exactff )", prose, re.M), "a command that is not run"
    require_links(page, prose)
    require_known_flags_in_words(prose)
    names = {"__name__": "page"}
    for block, after in zip(blocks, [*blocks[1:], None]):
        assert block.language in LANGUAGES, block.language
        if block.by or block.language == "sh":
            assert block.by, f"nothing is said to run\n{block.text}"
            require_a_runner(block)
        elif block.language == "console":
            run_console(block)
        elif block.language == "python":
            is_shown = after and after.language == "text" and not text[block.end:].split("```")[0].strip()
            run_python(block, names, after.text if is_shown else None)
    compile_cpp([block for block in blocks if block.language == "cpp" and not block.by])


def test_pages_are_short():
    """In all. So what a header or the help says is not said again."""
    size = sum(page.stat().st_size for page in PAGES)
    assert size <= ALL_PAGES, size
