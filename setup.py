"""`pip install .`: the particles, the law and the figures as a wheel, which holds the command `drumlin`, its data and the Python package.

Builds them first, without deal.II and MPI, from the packages of the first part of .ci/packages. DRUMLIN_BUILD names a build tree that is packed in
place of a new one.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_py import build_py

SOURCES = pathlib.Path(__file__).resolve().parent
# What figures, files and pages need; Debian's python3-h5py is not known to pip by its name, so that --no-deps serves where Debian's packages are.
NEEDED = ["numpy", "scipy", "h5py", "matplotlib", "jinja2"]


def cmake(*words):
    subprocess.run(["cmake", *map(str, words)], check=True)


class Build(build_py):
    def run(self):
        build = pathlib.Path(os.environ.get("DRUMLIN_BUILD", SOURCES / "build-wheel" / "cmake"))
        if "DRUMLIN_BUILD" not in os.environ:
            cmake("-S", SOURCES, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DDRUMLIN_CONTINUUM=OFF",
                  f"-DDRUMLIN_PYTHON={sys.executable}")
            cmake("--build", build, "--target", "drumlin", "drumlin_python")
        installed = pathlib.Path(self.build_lib).resolve().parent / "installed"
        shutil.rmtree(installed, ignore_errors=True)
        cmake("--install", build, "--component", "commands", "--prefix", installed)
        package = next(installed.glob("lib/python3/dist-packages/drumlin"))
        shutil.copytree(package, pathlib.Path(self.build_lib) / "drumlin", dirs_exist_ok=True)
        files = [file.relative_to(installed) for part in ("bin", "share") for file in (installed / part).rglob("*") if file.is_file()]
        self.distribution.data_files = [(str(file.parent), [str(installed / file)]) for file in files]


class Built(setuptools.Distribution):
    def has_ext_modules(self):  # for this interpreter and machine alone
        return True


setuptools.setup(
    name="drumlin",
    version=re.search(r"project\(drumlin VERSION (\S+)", (SOURCES / "CMakeLists.txt").read_text(encoding="utf-8"))[1],
    description="Coupled particle-continuum framework for dense granular flow",
    license="LGPL-2.1-or-later",
    packages=["drumlin"],
    package_dir={"drumlin": "apps/python/drumlin"},
    data_files=[("share/doc/drumlin", ["README.md"])],
    install_requires=NEEDED,
    python_requires=">=3.11",
    options={"build": {"build_base": "build-wheel"}},
    cmdclass={"build_py": Build},
    distclass=Built,
)
