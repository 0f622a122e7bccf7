"""`pip install .`: the particles, the law and the figures as a wheel, which holds the command `drumlin`, its data and the Python package.

Builds them first, without deal.II and MPI, from the packages of the first part of .ci/packages. After packaging/wheels/libraries the wheel holds what
it needs of others and runs on other systems; its name says on which.
"""

import pathlib
import re
import shutil
import subprocess
import sys

import setuptools
from setuptools.command.build_py import build_py

try:
    from setuptools.command.bdist_wheel import bdist_wheel
except ImportError:  # before setuptools 70
    from wheel.bdist_wheel import bdist_wheel

SOURCES = pathlib.Path(__file__).resolve().parent
LIBRARIES = SOURCES / "build-wheel" / "libraries"
sys.path.insert(0, str(SOURCES / "packaging" / "wheels"))
import portable  # noqa: E402 pylint: disable=wrong-import-position
# What figures, files and pages need; Debian's python3-h5py is not known to pip by its name, so that --no-deps serves where Debian's packages are.
NEEDED = ["numpy", "scipy", "h5py", "matplotlib", "jinja2"]


def cmake(*words):
    subprocess.run(["cmake", *map(str, words)], check=True)


def library_options():
    """CMake's, for the libraries that packaging/wheels/libraries has built; none: the system's."""
    if not (LIBRARIES / "done").exists():
        return []
    return [f"-DCMAKE_PREFIX_PATH={LIBRARIES}", f"-DHDF5_ROOT={LIBRARIES}", "-DHDF5_USE_STATIC_LIBRARIES=ON", "-DOPENSSL_USE_STATIC_LIBS=ON",
            f"-DDRUMLIN_HDF5_LIBRARY={LIBRARIES}/lib/libhdf5.a", "-DDRUMLIN_OWN_HDF5_LIBRARY="]


class Build(build_py):
    def run(self):
        build = SOURCES / "build-wheel" / f"cmake-{sys.implementation.cache_tag}"
        cmake("-S", SOURCES, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DDRUMLIN_CONTINUUM=OFF",
              f"-DDRUMLIN_PYTHON={sys.executable}", *library_options())
        cmake("--build", build, "--target", "drumlin", "drumlin_python")
        installed = pathlib.Path(self.build_lib).resolve().parent / "installed"
        shutil.rmtree(installed, ignore_errors=True)
        cmake("--install", build, "--component", "commands", "--strip", "--prefix", installed)
        package = next(installed.glob("lib/python3/dist-packages/drumlin"))
        shutil.copytree(package, pathlib.Path(self.build_lib) / "drumlin", dirs_exist_ok=True)
        files = [file.relative_to(installed) for part in ("bin", "share") for file in (installed / part).rglob("*") if file.is_file()]
        self.distribution.data_files = [(str(file.parent), [str(installed / file)]) for file in files]


class Wheel(bdist_wheel):
    def get_tag(self):  # of what is packed
        python, abi, platform = super().get_tag()
        return python, abi, portable.platform_tag(pathlib.Path(self.bdist_dir), platform)


class Built(setuptools.Distribution):
    def has_ext_modules(self):  # for this interpreter and machine alone
        return True


setuptools.setup(
    name="drumlin",
    version=re.search(r"project\(drumlin VERSION (\S+)", (SOURCES / "CMakeLists.txt").read_text(encoding="utf-8"))[1],
    description="Coupled particle-continuum framework for dense granular flow",
    license="LGPL-2.1-or-later",
    license_files=["LICENSE", "build-wheel/libraries/licenses/*"],
    packages=["drumlin"],
    package_dir={"drumlin": "apps/python/drumlin"},
    data_files=[("share/doc/drumlin", ["README.md"])],
    install_requires=NEEDED,
    python_requires=">=3.11",
    options={"build": {"build_base": "build-wheel"}},
    cmdclass={"build_py": Build, "bdist_wheel": Wheel},
    distclass=Built,
)
