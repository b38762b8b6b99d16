"""The wheel: ``pip install --no-build-isolation ./src/outside/python`` in a virtual environment. Compiles the library, with two
jobs. With EXACTFF_BUILT=FOLDER in the environment, takes the module from that build folder instead."""

import os
import pathlib
import re

top = pathlib.Path(__file__).resolve().parents[3]
version = re.search(r"project\(exactff VERSION ([0-9.]+)", (top / "CMakeLists.txt").read_text()).group(1)
about = dict(
    name="exactff",
    version=version,
    description="Exact form factors (view factors), with proof",
    license="GPL-3.0-or-later",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["exactff"],
    package_data={"exactff": ["py.typed", "*.pyi", "*.so"]},
    zip_safe=False,
)

built = os.environ.get("EXACTFF_BUILT")
if built:
    from setuptools import Distribution, setup

    class WithModule(Distribution):
        def has_ext_modules(self):
            return True

    folder = os.path.relpath(os.path.join(built, "python", "exactff"), pathlib.Path(__file__).parent)
    setup(package_dir={"exactff": folder}, distclass=WithModule, **about)
else:
    from skbuild import setup

    os.environ.setdefault("CMAKE_BUILD_PARALLEL_LEVEL", "2")
    setup(
        cmake_source_dir="../../..",
        cmake_install_target="install-python",
        cmake_args=["-DEXACTFF_PYTHON=ON", "-DEXACTFF_PYTHON_DIR=.", "-DEXACTFF_PROGRAM=OFF", "-DEXACTFF_TESTS=OFF",
                    "-DEXACTFF_QUICK_BUILD=ON", "-DBUILD_SHARED_LIBS=OFF"],
        **about,
    )
