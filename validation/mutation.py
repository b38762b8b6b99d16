#!/usr/bin/env python3
"""The mutation check: plants known faults, one at a time, in a copy of the sources, and requires that the test named
beside each fault catches it. The faults are in validation/mutation, one file for each storey; its README has
the format.

  mutation.py [NAME...]  all faults, or those named
  mutation.py --check    only checks that each fault has its place in the sources and its test (a test of the suite)

Prints a line for each fault. Exits with 1 if one survives, has no place, does not compile, or is caught by another test
only. The copy and its build stay in build/mutation, so that a second run builds little.
"""
import argparse
import dataclasses
import filecmp
import pathlib
import re
import shutil
import subprocess
import sys
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
FOLDER = TOP / 'build/mutation'
SOURCE, BUILD, LOG = FOLDER / 'source', FOLDER / 'build', FOLDER / 'log'
COPIED = ('CMakeLists.txt', 'README.md', 'LICENSE', 'src', 'include', 'validation', 'data')
TEST_SECONDS, SUITE_SECONDS = 300, 900  # what takes longer hangs
FIELDS = ('breaks', 'seen as', 'caught by')


@dataclasses.dataclass
class Place:
    file: str
    scope: str  # the function, class or constant that holds the old text
    old: list = dataclasses.field(default_factory=list)
    new: list = dataclasses.field(default_factory=list)


@dataclasses.dataclass
class Fault:
    name: str
    where: str  # of its first line
    fields: dict = dataclasses.field(default_factory=dict)
    places: list = dataclasses.field(default_factory=list)

    @property
    def test(self):
        return self.fields['caught by']


class Refused(Exception):
    """A fault that cannot be read or planted; the text says why."""


def read_faults():
    faults = {}
    for file in sorted((TOP / 'validation/mutation').glob('*.faults')):
        fault = None
        for number, line in enumerate(file.read_text().splitlines(), 1):
            where = f'{file.relative_to(TOP)}:{number}'
            key, _, value = line.partition(': ')
            if not line or line.startswith('#'):
                continue
            if re.fullmatch(r'\[\w+\]', line) and line[1:-1] not in faults:
                fault = faults[line[1:-1]] = Fault(line[1:-1], where)
            elif fault and key in FIELDS and key not in fault.fields:
                fault.fields[key] = value
            elif fault and key == 'in' and ', ' in value:
                fault.places.append(Place(*value.split(', ', 1)))
            elif fault and fault.places and line[:2] in ('- ', '+ '):
                (fault.places[-1].old if line[0] == '-' else fault.places[-1].new).append(line[2:])
            else:
                raise Refused(f'{where}: this line is not understood, or repeats another one: {line}')
    for fault in faults.values():
        if set(fault.fields) != set(FIELDS) or not fault.places or not all(place.old for place in fault.places):
            wanted = ', '.join(FIELDS)
            raise Refused(f'{fault.where}: {fault.name} lacks one of the lines {wanted}, in, and - with the old text')
    return faults


def pattern(lines):
    """Matches these tokens, whatever white space is between them."""
    tokens = re.findall(r'\w+|\S', ' '.join(lines))
    text = ''
    for last, token in zip([''] + tokens, tokens):
        between = '' if not last else r'\s+' if re.match(r'\w', last) and re.match(r'\w', token) else r'\s*'
        text += between + re.escape(token)
    whole = [r'(?<!\w)' if re.match(r'\w', tokens[0]) else '', text, r'(?!\w)' if re.match(r'\w', tokens[-1]) else '']
    return re.compile(''.join(whole))


def without_texts(code):
    """The code with blanks for comments, strings and characters; every position keeps its meaning."""
    return re.sub(r'//[^\n]*|/\*.*?\*/|R"\((?s:.*?)\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'',
                  lambda found: re.sub(r'[^\n]', ' ', found[0]), code, flags=re.S)


def end_of_definition(code, at):
    """Where the definition of the name that ends here ends: at the brace of a body, or at the semicolon of a constant.
    None if the name is only used here."""
    depth, is_constant = 0, re.match(r'(\[\w*\])?\s*=[^=]', code[at:at + 40]) is not None
    for k in range(at, len(code)):
        depth += (code[k] in '([{') - (code[k] in ')]}')
        if depth < 0:
            return None
        if depth == 0 and code[k] == '}' and not is_constant and not re.match(r'\s*[,{]', code[k + 1:k + 200]):
            return k + 1  # after one in a list of initialisers, there is more
        if depth == 0 and code[k] == ';':
            return k + 1 if is_constant else None
        if depth == 0 and not is_constant and not re.match(r'[\w\s:<>,&*\-\])}]', code[k]):
            return None
    return None


def definitions(file, code, scope):
    """The parts of the code that define the name, as pairs of positions."""
    if file.endswith('.py'):
        return [found.span() for found in re.finditer(rf'(?m)^( *)(def|class) {scope}\b.*\n((\1 +.*)?\n)*', code)]
    plain = without_texts(code)
    ends = ((found.start(), end_of_definition(plain, found.end()))
            for found in re.finditer(rf'(?<![\w.>~]){re.escape(scope)}(?!\w)', plain))
    return [(begin, end) for begin, end in ends if end]


def position(place, folder):
    """Where the old text is; refuses unless it is once in its scope."""
    file, wanted = folder / place.file, pattern(place.old)
    code = file.read_text() if file.is_file() else ''
    found = {match.span() for begin, end in definitions(place.file, code, place.scope)
             for match in wanted.finditer(code, begin, end)}
    if len(found) == 1:
        return found.pop()
    hits = [f'{other.relative_to(folder)}:{text.count(chr(10), 0, match.start()) + 1}'
            for other in sorted((folder / 'src').rglob('*')) if other.suffix in ('.cpp', '.h', '.py')
            for text in [other.read_text()] for match in wanted.finditer(text)]
    raise Refused(f'"{place.old[0]}" is {len(found)} times in {place.scope} of {place.file}; '
                  + (f'now in {", ".join(hits[:5])}' if hits else 'it is nowhere in src'))


def planted(fault, folder):
    """The text of each file that the fault changes."""
    places = {}
    for place in fault.places:
        places.setdefault(place.file, []).append((*position(place, folder), '\n'.join(place.new)))
    files = {}
    for file, changes in places.items():
        files[file] = (folder / file).read_text()
        for begin, end, new in sorted(changes, reverse=True):
            files[file] = files[file][:begin] + new + files[file][end:]
    return files


def names_of_tests():
    names = {f'Python.{file.stem[len("test_"):]}' for file in (TOP / 'validation/python').glob('test_*.py')}
    for file in (TOP / 'validation').rglob('*.cpp'):
        found = re.findall(r'\bTEST(?:_[FP])?\(\s*(\w+)\s*,\s*(\w+)\s*\)', file.read_text())
        names.update(f'{suite}.{case}' for suite, case in found)
    return names


def check(faults):
    problems, tests = [], names_of_tests()
    for fault in faults:
        if fault.test.split('/')[-1] not in tests:  # without the name of an instance before the slash
            problems.append(f'{fault.where}: {fault.name}: there is no test {fault.test}')
        try:
            planted(fault, TOP)
        except Refused as refused:
            problems.append(f'{fault.where}: {fault.name}: {refused}')
    print('\n'.join(problems) or f'{len(faults)} faults have their place and their test')
    return not problems


def copy_sources():
    """Compares contents, so that a file gets a new time only if it differs from what the last build saw."""
    def files(*places):
        return (path for place in places for path in (place, *place.rglob('*')) if path.is_file())

    wanted = {path.relative_to(TOP) for path in files(*(TOP / name for name in COPIED))}
    for path in {path.relative_to(SOURCE) for path in files(SOURCE)} - wanted:
        (SOURCE / path).unlink()
    for path in wanted:
        if not (SOURCE / path).exists() or not filecmp.cmp(TOP / path, SOURCE / path, shallow=False):
            (SOURCE / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(TOP / path, SOURCE / path)


def run(log, *command):
    with open(LOG / log, 'w') as output:
        return subprocess.call([str(word) for word in command], stdout=output, stderr=subprocess.STDOUT)


def build(log):
    return run(log, 'cmake', '--build', BUILD, '--parallel', 2) == 0


def first_failure(log, *choice):
    """The first test that fails of those chosen; None if all pass. Never chosen are the layout of the sources and this
    check, since a fault must be caught by what it does."""
    shutil.rmtree(BUILD / 'Testing', ignore_errors=True)  # otherwise ctest starts with the tests that failed last
    status = run(log, 'timeout', SUITE_SECONDS, 'ctest', '--test-dir', BUILD, '--parallel', 2, '--stop-on-failure',
                 '--timeout', TEST_SECONDS, '--no-tests=error', '--exclude-regex', r'^(Mutation|Sources)\.', *choice)
    failed = re.search(r'(?m)^ *\d+/\d+ Test +#\d+: (\S+) .*\*\*\*', (LOG / log).read_text())
    return None if status == 0 else failed[1] if failed else f'ctest failed, see {LOG / log}'


def regex_of(tests):
    """Tests with these names, for any parameter."""
    return '^(' + '|'.join(test.replace('.', '[.]') for test in tests) + ')(/|$)'


def try_fault(fault):
    """What became of the planted fault, and whether its own test caught it."""
    if not build(f'{fault.name}.build'):
        return f'does not compile, see {LOG / fault.name}.build', False
    caught = first_failure(f'{fault.name}.test', '--tests-regex', regex_of([fault.test]))
    if caught:
        return caught, re.match(regex_of([fault.test]), caught) is not None
    caught = first_failure(f'{fault.name}.suite')
    return (f'not caught by {fault.test}, but by {caught}' if caught else 'SURVIVES'), False


def try_faults(faults):
    for folder in (SOURCE, LOG):
        folder.mkdir(parents=True, exist_ok=True)
    copy_sources()
    # With a shared library, a fault in it costs one link.
    options = ['-DEXACTFF_TESTS=ON', '-DEXACTFF_QUICK_BUILD=TESTS', '-DCMAKE_BUILD_TYPE=Release',
               '-DBUILD_SHARED_LIBS=ON', '-DCMAKE_LINK_DEPENDS_NO_SHARED=ON']
    if shutil.which('ccache'):
        options.append('-DCMAKE_CXX_COMPILER_LAUNCHER=ccache')
    if not (BUILD / 'CMakeCache.txt').exists():
        options.extend(['-G', 'Ninja'])
    if run('configure', 'cmake', '-S', SOURCE, '-B', BUILD, *options) != 0 or not build('sound.build'):
        sys.exit(f'the sound sources do not build, see {LOG}')
    if failed := first_failure('sound.test', '--tests-regex', regex_of(sorted({fault.test for fault in faults}))):
        sys.exit(f'before any fault is planted: {failed} fails, see {LOG}/sound.test')
    missed, start = [], time.monotonic()
    for fault in faults:
        began, sound = time.monotonic(), {}
        try:
            for file, text in planted(fault, SOURCE).items():
                sound[file] = (SOURCE / file).read_text()
                (SOURCE / file).write_text(text)
            result, is_caught = try_fault(fault)
        except Refused as refused:
            result, is_caught = str(refused), False
        finally:
            for file, text in sound.items():
                (SOURCE / file).write_text(text)
        if not is_caught:
            missed.append(fault.name)
        print(f'{fault.name:34} {time.monotonic() - began:4.0f} s  {result}', flush=True)
    seconds = time.monotonic() - start
    print(f'{len(faults)} faults, {len(faults) - len(missed)} caught by their tests, in {seconds:.0f} s')
    return not missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('names', nargs='*', metavar='NAME')
    parser.add_argument('--check', action='store_true')
    arguments = parser.parse_args()
    try:
        faults = read_faults()
        if unknown := [name for name in arguments.names if name not in faults]:
            raise Refused(f'there is no fault {unknown[0]}; the faults are: {" ".join(faults)}')
    except Refused as refused:
        parser.exit(2, f'{refused}\n')
    chosen = [faults[name] for name in arguments.names or faults]
    sys.exit(0 if (check if arguments.check else try_faults)(chosen) else 1)


if __name__ == '__main__':
    main()
