"""Headers compile; includes and folders are those that docs/architecture.md states; sentences for users hold no name of the code.

All headers are compiled in one unit, and in another in the opposite order. With --each they are compiled one by one as well, each in a unit of its own: minutes of processor time.

The page is the rule: its table "Modules" has a row for each folder with code, and names the folders that its files may
include. This test fails on a folder without a row, a row without a folder, an include that the row does not allow,
and a circle of folders.

usage: headers.py SOURCE_ROOT COMPILER [--each] [INCLUDE_FOLDER...]
"""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys

TOPS = ("particles", "continuum", "coupling", "apps")
# Third-party headers that a public header may show to those who include it.
PUBLIC_LIBRARIES = {"particles": ["Eigen/"], "apps": ["nlohmann/"], "coupling/core/documents": ["nlohmann/"]}
# Headers that only these folders may include, in any file.
PRIVATE_LIBRARIES = {
    "deal.II/": ["continuum/fem", "particles/distributed"],
    "petsc": ["continuum/fem"],
    "hdf5": ["coupling/core/hdf5"],
    "toml++/": ["coupling/core/documents/document.cpp"],
    "CLI/": ["apps/command_line"],
    "boost/": ["coupling/core/statistics"],
    "openssl/": ["coupling/core/files/checksum.cpp"],
}
# Private to the finite elements: included by continuum/fem alone, full of deal.II, no part of the interface.
PRIVATE_FOLDERS = ["continuum/fem/detail"]
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
LITERAL = re.compile(r'//[^\n]*|"((?:\\.|[^"\\\n])*)"')
CODE_NAME = re.compile(r"\b[A-Z]?[a-z]+[A-Z][a-z]+\w*|\w+::\w+")
PROPER_NAMES = ("ParaView", "CellId")
ROW = re.compile(r"^\| `([\w/]+)` \|.*\| ([^|]*) \|$", re.MULTILINE)


def below(name, folders):
    return any(name == folder or name.startswith(folder + "/") for folder in folders)


def folder_of(name):
    """The room of a file. A folder `detail` holds the private headers of the room that it lies in."""
    return str(pathlib.PurePosixPath(name).parent).removesuffix("/detail")


def rooms_of(page):
    """What the table "Modules" says: folder -> folders that it may include. A word of its last column is a folder, or
    the name of a group, which a line `group`: `folder`, ... of the page explains; "all" allows everything."""
    text = page.read_text(encoding="utf-8")
    groups = {name: re.findall(r"`([\w/]+)`", rest) for name, rest in re.findall(r"^- \*\*(\w+)\*\*: (.*)$", text, re.MULTILINE)}
    rooms = {}
    for folder, allowed in ROW.findall(text):
        words = [word.strip(" `") for word in allowed.split(",") if word.strip(" `-")]
        rooms[folder] = [room for word in words for room in groups.get(word, [word])]
    return rooms


def wrong_folders(rooms, folders):
    for folder in sorted(folders - set(rooms)):
        yield f"docs/architecture.md has no row for {folder}"
    for folder in sorted(set(rooms) - folders):
        yield f"docs/architecture.md has a row for {folder}, which holds no code"


def wrong_includes(root, name, rooms):
    """What this file includes and should not, as messages."""
    folder, is_header = folder_of(name), name.endswith(".hpp")
    allowed = rooms.get(folder, [])
    for quote, included in INCLUDE.findall((root / name).read_text(encoding="utf-8")):
        if quote == '"' and (root / included).exists():
            if folder_of(included) != folder and "all" not in allowed and folder_of(included) not in allowed:
                yield f"{name}: {folder} must not include {included}"
            if below(included, PRIVATE_FOLDERS) and not below(name, ["continuum/fem"]):
                yield f"{name}: {included} is private to continuum/fem"
        elif quote == '"':
            yield f"{name}: {included} is not a path from the root of the project"
        elif "/" in included or included.endswith((".h", ".hpp")):
            owners = [places for start, places in PRIVATE_LIBRARIES.items() if included.startswith(start)]
            if owners and not below(name, owners[0]):
                yield f"{name}: {included} belongs to {', '.join(owners[0])} alone"
            public = [start for key, starts in PUBLIC_LIBRARIES.items() if below(name, [key]) for start in starts]
            if is_header and not below(name, PRIVATE_FOLDERS) and not included.startswith(tuple(public)):
                yield f"{name}: a public header must not show {included} to others"


def wrong_words(root, name):
    """Names of the code in sentences for users, which a renaming leaves there."""
    for literal in LITERAL.findall((root / name).read_text(encoding="utf-8")):
        for word in CODE_NAME.findall(literal.replace("\\n", " ")) if " " in literal and "<" not in literal else ():
            if word not in PROPER_NAMES:
                yield f'{name}: "{literal}" names {word}, which users do not know'


def circle_of(root, files):
    """A circle of folders that include each other, as a list of folders; empty when there is none."""
    edges = {}
    for name in files:
        for _, included in INCLUDE.findall((root / name).read_text(encoding="utf-8")):
            if (root / included).exists() and folder_of(included) != folder_of(name):
                edges.setdefault(folder_of(name), set()).add(folder_of(included))
    done = set()

    def walk(folder, path):
        if folder in path:
            return path[path.index(folder):] + [folder]
        if folder in done:
            return []
        for other in sorted(edges.get(folder, ())):
            if circle := walk(other, path + [folder]):
                return circle
        done.add(folder)
        return []

    return next((circle for folder in sorted(edges) if (circle := walk(folder, []))), [])


def compiles(root, names, compiler, folders, what):
    command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I", str(root)]
    for folder in folders:
        command += ["-isystem", folder]
    # From standard input, for a header as main file would warn.
    text = "".join(f'#include "{name}"\n' for name in names)
    result = subprocess.run(command + ["-x", "c++", "-"], input=text, capture_output=True, text=True, check=False)
    return "" if result.returncode == 0 else f"{what}:\n{result.stderr}"


def main():
    each = "--each" in sys.argv
    root, compiler, *folders = [word for word in sys.argv[1:] if word not in ("", "--each")]
    root = pathlib.Path(root)
    files = sorted(str(path.relative_to(root)) for top in TOPS for path in (root / top).rglob("*.[ch]pp"))
    rooms = rooms_of(root / "docs" / "architecture.md")
    faults = list(wrong_folders(rooms, {folder_of(name) for name in files}))
    faults += [message for name in files for message in wrong_includes(root, name, rooms)]
    faults += [message for name in files for message in wrong_words(root, name)]
    if circle := circle_of(root, files):
        faults.append("folders include each other in a circle: " + " -> ".join(circle))
    headers = [name for name in files if name.endswith(".hpp") and not below(name, PRIVATE_FOLDERS)]
    units = [(headers, "all public headers do not compile together"), (headers[::-1], "all public headers do not compile in the opposite order")]
    if each:
        # Twice: a forgotten #pragma once shows as well.
        units += [([name, name], f"{name} does not compile alone") for name in headers]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults += [fault for fault in pool.map(lambda unit: compiles(root, unit[0], compiler, folders, unit[1]), units) if fault]
    print(f"{len(headers)} headers in {len(units)} units, {len(files)} files of {len(rooms)} rooms looked through")
    if faults:
        sys.exit("\n".join(faults))


if __name__ == "__main__":
    main()
