"""Which systems a wheel of Linux runs on: its platform tag, as PEP 600 defines it.

A wheel is portable if it loads nothing but the C and C++ libraries and zlib, and manylinux_2_N if no symbol is newer than what systems with glibc 2.N
have (the policies of auditwheel).

usage: portable.py WHEEL    prints the tag, the libraries and the newest symbols; exit code 1 if the wheel is not portable
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

EVERYWHERE = re.compile(r"(ld-linux-[\w-]+|lib(c|m|gcc_s|stdc\+\+|z))\.so\.\d+")
# The oldest glibc beside which the C++ library and the compiler's have these symbols.
BESIDE = {34: {"GLIBCXX": (3, 4, 29), "CXXABI": (1, 3, 13), "GCC": (7, 0, 0)}, 35: {"GLIBCXX": (3, 4, 30), "CXXABI": (1, 3, 13), "GCC": (12, 0, 0)},
          39: {"GLIBCXX": (3, 4, 33), "CXXABI": (1, 3, 15), "GCC": (14, 0, 0)}}


def needs(folder):
    """Libraries that the programs and modules of a folder load, and the newest symbol of each kind, as numbers."""
    libraries, newest = set(), {}
    for file in folder.rglob("*"):
        if file.is_file() and file.open("rb").read(4) == b"\x7fELF":
            text = subprocess.run(["readelf", "-dVW", file], capture_output=True, text=True, check=True).stdout
            libraries.update(re.findall(r"\(NEEDED\).*\[(.*)\]", text))
            for kind, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI|GCC)_([\d.]+)", text):
                newest[kind] = max(newest.get(kind, ()), tuple(map(int, version.split("."))))
    return libraries, newest


def platform_tag(folder, platform):
    """The tag of what lies in a folder: manylinux where it is portable, else the platform's own."""
    libraries, newest = needs(folder)
    if not platform.startswith("linux_") or not all(map(EVERYWHERE.fullmatch, libraries)):
        return platform
    fitting = [minor for minor, limits in BESIDE.items() if all(newest.get(kind, ()) <= limit for kind, limit in limits.items())]
    return f"manylinux_2_{max(newest['GLIBC'][1], fitting[0])}_{platform.removeprefix('linux_')}" if fitting else platform


def main():
    wheel = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        zipfile.ZipFile(wheel).extractall(name)
        libraries, newest = needs(pathlib.Path(name))
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB; loads {', '.join(sorted(libraries))}; newest symbols "
          + ", ".join(f"{kind} {'.'.join(map(str, version))}" for kind, version in sorted(newest.items())))
    if "-manylinux_" not in wheel.name:
        foreign = sorted(name for name in libraries if not EVERYWHERE.fullmatch(name))
        sys.exit(f"it is for this system alone: {', '.join(foreign) or 'its symbols are too new'}")


if __name__ == "__main__":
    main()
