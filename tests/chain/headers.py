"""Every public header compiles alone, and no include points the wrong way (docs/architecture.md, "Direction").

usage: headers.py SOURCE_ROOT COMPILER [INCLUDE_FOLDER...]
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

# Which rooms a room may include from; tests may see everything.
ALLOWED_ROOMS = {
    "coupling/exchange": ["coupling/exchange"],
    "coupling/files": ["coupling/exchange", "coupling/files"],
    "coupling/accuracy": ["coupling/exchange", "coupling/accuracy"],
    "coupling/calibration": ["coupling/exchange", "coupling/calibration"],
    "coupling/comparison": ["coupling/exchange", "coupling/comparison"],
    "coupling/study": ["coupling/exchange", "coupling/calibration", "coupling/comparison", "coupling/study"],
    "particles/io": ["coupling/exchange", "coupling/files", "particles"],
    "particles": ["coupling/exchange", "particles"],
    "continuum": ["coupling/exchange", "continuum"],
    "apps": ["coupling", "particles", "continuum", "apps"],
}
# Third-party headers that a public header may show to those who include it.
PUBLIC_LIBRARIES = {"particles": ["Eigen/"], "apps": ["nlohmann/json_fwd.hpp"]}
# Headers that only these folders may include, in any file.
PRIVATE_LIBRARIES = {
    "deal.II/": ["continuum/fem"],
    "petsc": ["continuum/fem"],
    "hdf5": ["coupling/files"],
    "toml++/": ["coupling/exchange/document.cpp"],
    "CLI/": ["apps/support"],
}
# Private to the finite elements: included by continuum/fem alone, full of deal.II, no part of the interface.
PRIVATE_FOLDERS = ["continuum/fem/detail"]
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


def below(name, folders):
    return any(name == folder or name.startswith(folder + "/") for folder in folders)


def room_of(name):
    return next((room for room in ALLOWED_ROOMS if below(name, [room])), None)


def wrong_includes(root, name):
    """What this file includes and should not, as messages."""
    room, is_header = room_of(name), name.endswith(".hpp")
    for quote, included in INCLUDE.findall((root / name).read_text(encoding="utf-8")):
        if quote == '"' and (root / included).exists():
            if not below(included, ALLOWED_ROOMS[room]):
                yield f"{name}: {room} must not include {included}"
            if below(included, PRIVATE_FOLDERS) and not below(name, ["continuum/fem"]):
                yield f"{name}: {included} is private to continuum/fem"
        elif quote == '"':
            yield f"{name}: {included} is not a path from the root of the project"
        elif "/" in included or included.endswith((".h", ".hpp")):
            owners = [folders for start, folders in PRIVATE_LIBRARIES.items() if included.startswith(start)]
            if owners and not below(name, owners[0]):
                yield f"{name}: {included} belongs to {', '.join(owners[0])} alone"
            public = [start for key, starts in PUBLIC_LIBRARIES.items() if below(name, [key]) for start in starts]
            if is_header and not below(name, PRIVATE_FOLDERS) and not included.startswith(tuple(public)):
                yield f"{name}: a public header must not show {included} to others"


def compile_alone(root, name, compiler, folders):
    command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I", str(root)]
    for folder in folders:
        command += ["-isystem", folder]
    # Included twice: a forgotten #pragma once shows as well. From standard input, for a header as main file would warn.
    text = f'#include "{name}"\n#include "{name}"\n'
    result = subprocess.run(command + ["-x", "c++", "-"], input=text, capture_output=True, text=True, check=False)
    return "" if result.returncode == 0 else f"{name} does not compile alone:\n{result.stderr}"


def main():
    root, compiler, folders = pathlib.Path(sys.argv[1]), sys.argv[2], [f for f in sys.argv[3:] if f]
    files = sorted(str(path.relative_to(root)) for room in ("particles", "continuum", "coupling", "apps")
                   for path in (root / room).rglob("*.[ch]pp"))
    faults = [message for name in files for message in wrong_includes(root, name)]
    headers = [name for name in files if name.endswith(".hpp") and not below(name, PRIVATE_FOLDERS)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults += [fault for fault in pool.map(lambda name: compile_alone(root, name, compiler, folders), headers) if fault]
    print(f"{len(headers)} headers compiled alone, {len(files)} files looked through")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
