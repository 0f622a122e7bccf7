# Untested: names dependencies and options, for a repository of your own.
from spack.package import *


class Drumlin(CMakePackage):
    """Coupled particle-continuum framework for dense granular flow."""

    license("LGPL-2.1-or-later")
    version("main", branch="main")
    variant("continuum", default=True, description="Build the continuum, on deal.II")

    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("eigen")
    depends_on("fmt")
    depends_on("highway")
    depends_on("nlohmann-json")
    depends_on("tomlplusplus")
    depends_on("cli11")
    depends_on("boost")
    depends_on("openssl")
    depends_on("zlib-api")
    depends_on("hdf5+mpi", when="+continuum")
    depends_on("hdf5~mpi", when="~continuum")
    depends_on("dealii@9.4:+mpi+petsc", when="+continuum")
    depends_on("petsc+mumps", when="+continuum")
    depends_on("py-pybind11", type="build")
    depends_on("python@3.11:", type=("build", "run"))
    for name in ("numpy", "scipy", "h5py", "matplotlib", "jinja2"):
        depends_on(f"py-{name}", type="run")

    def cmake_args(self):
        return [self.define_from_variant("DRUMLIN_CONTINUUM", "continuum"), self.define("DRUMLIN_BUILD_TESTS", False),
                self.define("DRUMLIN_PYTHON", self.spec["python"].command.path)]
