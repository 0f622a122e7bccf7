"""Makes the Debian package, unpacks it into a scratch root, and runs the commands from there, with their figures, where no path of the tree helps.

usage: debian_package.py CPACK BUILD_FOLDER SOURCES
"""

import pathlib
import subprocess
import sys
import tempfile

from installed import TINY, require, require_commands, require_no_path, run


def main():
    cpack, build, sources = sys.argv[1], *(pathlib.Path(word).resolve() for word in sys.argv[2:4])
    with tempfile.TemporaryDirectory(prefix="drumlin-deb-") as name:
        folder = pathlib.Path(name).resolve()
        run(cpack, "-G", "DEB", "-B", folder / "packages", "--config", build / "CPackConfig.cmake")
        packages = list((folder / "packages").glob("*.deb"))
        require(len(packages) == 1, f"{len(packages)} packages")
        depends = run("dpkg-deb", "-f", packages[0], "Depends")
        for needed in ("libhdf5", "libdeal.ii", "python3-matplotlib", "python3-h5py", "python3-numpy"):
            require(needed in depends, f"the package does not depend on {needed}: {depends}")
        root = folder / "root"
        subprocess.run(["dpkg", "-x", packages[0], root], check=True)
        for name in ("man/man1/drumlin.1", "bash-completion/completions/drumlin", "zsh/vendor-completions/_drumlin", "fish/vendor_completions.d/drumlin.fish"):
            require((root / "usr/share" / name).exists(), f"{name} is not in the package")
        require_no_path(root, [build, sources])
        require_commands(root / "usr", folder, sources)
        run(root / "usr/bin/drumlin", "flow", root / "usr/share/drumlin/scenes/incline-flow.toml", "--rheology",
                   root / "usr/share/drumlin/rheology/paper.toml", "-o", folder / "FLOW", "--set", "mesh.levels=1", cwd=folder)
        require((folder / "FLOW" / "flow.json").exists(), "the continuum did not finish")
        size = packages[0].stat().st_size / 2 ** 20
        print(f"{packages[0].name}: {size:.1f} MiB, runs from a scratch root ({' '.join(TINY[:2])} ...)")


if __name__ == "__main__":
    main()
