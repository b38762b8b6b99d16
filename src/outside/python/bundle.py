"""bundle.py WHEEL FOLDER: writes the same wheel into FOLDER with the shared libraries that its module is linked with, for
machines where they are not installed.

What every Linux has stays outside (PEP 600): the C and C++ libraries, with the versions that the new name of the wheel
states. Each other library goes into exactff/libs under a name with a hash of its content, so that it is never mixed up
with another version that the same process has loaded, and finds the others beside it. Needs patchelf, ldd, objdump, and
dpkg, which knows the copyright of each library."""

import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SYSTEM = re.compile(r"(linux-vdso|ld-linux.*|libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s)\.so\.\d+")
MODULES = "exactff/_exactff*.so"


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True).stdout


def libraries_of(module):
    """All that it is linked with, directly or not: {name: file}."""
    lines = (re.match(r"\s*(\S+) => (\S+)", line) for line in run("ldd", module).splitlines())
    found = {line[1]: pathlib.Path(line[2]) for line in lines if line and not SYSTEM.fullmatch(line[1])}
    missing = [name for name, file in found.items() if not file.is_file()]
    if missing:
        sys.exit(f"bundle.py: {', '.join(missing)} cannot be found, which {module.name} is linked with")
    return found


def needed_by(file):
    return re.findall(r"NEEDED\s+(\S+)", run("objdump", "-p", file))


def add_libraries(module, folder):
    found = libraries_of(module)
    names = {}
    for name, file in found.items():
        digest = hashlib.sha256(file.read_bytes()).hexdigest()[:8]
        names[name] = name.replace(".so", f"-{digest}.so", 1)
        shutil.copy(file, folder / names[name])

    for file in [module, *(folder / name for name in names.values())]:
        run("patchelf", "--set-rpath", f"$ORIGIN/{folder.name}" if file == module else "$ORIGIN", file)
        if file != module:  # each in a call of its own: patchelf mixes up the arguments of several
            run("patchelf", "--set-soname", file.name, file)
        replaced = [word for name in needed_by(file) if name in names
                    for word in ("--replace-needed", name, names[name])]
        if replaced:
            run("patchelf", *replaced, file)
    return found.values()


def add_copyrights(files, folder):
    """Of the packages that hold the files; a library that was built here has none."""
    places = (f"*/{'/'.join(file.resolve().parts[-2:])}" for file in files)
    owners = subprocess.run(["dpkg-query", "--search", *places], capture_output=True, text=True).stdout
    for package in {line.split(":")[0] for line in owners.splitlines()}:
        shutil.copy(f"/usr/share/doc/{package}/copyright", folder / f"copyright-{package}")


def set_platform(tree):
    """Names the oldest C library with all functions that the files call."""
    symbols = "".join(run("objdump", "-T", file) for file in tree.rglob("*.so*"))
    newest = max(tuple(map(int, version.split("."))) for version in re.findall(r"GLIBC_(\d+\.\d+)", symbols))
    about = next(tree.glob("*.dist-info/WHEEL"))
    about.write_text(re.sub(r"-linux_", "-manylinux_{}_{}_".format(*newest), about.read_text()))


def main(wheel, to):
    to.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        run(sys.executable, "-m", "wheel", "unpack", "--dest", work, wheel)
        tree = next(pathlib.Path(work).iterdir())
        module = next(tree.glob(MODULES))
        libs = module.parent / "libs"
        libs.mkdir()
        run("strip", "--strip-unneeded", module)
        add_copyrights(add_libraries(module, libs), libs)
        outside = [file for file in libraries_of(module).values() if file.parent != libs]
        if outside:
            sys.exit(f"bundle.py: the module still uses {outside}")
        set_platform(tree)
        run(sys.executable, "-m", "wheel", "pack", "--dest-dir", to, tree)


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:]))
