"""Pages of docs, command by command as they stand there: each ends with 0. Of docs/tutorial.md, which is followed where no other page is
given: every file that it names is there, and each line that it shows of what a command prints is printed.

usage: tutorial.py DRUMLIN SOURCE_DIR [--short | PAGE...]
  PAGE     below docs, such as cookbook/flows.md
  --short  docs/tutorial.md with runs of a fifth of a turn and flows on a coarser mesh: all its commands and files, and what the commands print
           that compute nothing
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from command import read_json, require

SHORTER = {"run": ["stages.1.turns=0.2", "stages.2.turns=0.2", "stages.2.snapshots=20"], "flow": ["mesh.surface_cell=2", "solver.sensitivity=false"]}
SHORT = "--short" in sys.argv[3:]
BUILD, SOURCE = pathlib.Path(sys.argv[1]).parent, pathlib.Path(sys.argv[2])
PAGE = (SOURCE / "docs" / "tutorial.md").read_text(encoding="utf-8")
BESIDE = {"PATH": f"{BUILD.resolve()}{os.pathsep}{os.environ['PATH']}"}


def commands(text):
    """The lines of the blocks of commands, each with what the page says that it prints: a comment below it, or in a block of a console all up to the
    next "$ "; without those of the build, those with a placeholder, and those that are more than one command."""
    found = []
    for kind, block in re.findall(r"^```(sh|console)\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            if kind == "console" and not line.startswith("$ "):
                found[-1][1].append(line)
            elif line.startswith("# ") and found:
                found[-1][1].append(line[2:])
            elif line.strip() and not line.startswith(("#", "cmake ", "cd ")) and (kind == "console" or not re.search(r"\b[A-Z]{3,}\b|[|>]", line)):
                found.append([line.removeprefix("$ "), []])
    return found


def require_printed(line, shown, printed):
    """Every line that the page shows, in that order; "..." stands for any."""
    lines = iter(" ".join(one.split()) for one in printed.splitlines())
    for wanted in (" ".join(one.split()) for one in shown):
        require(wanted in ("", "...") or any(one == wanted for one in lines), f"{line}\ndoes not print, or not in that order:\n{wanted}\nbut\n{printed}")


def follow(text, folder):
    """What the commands print, one after the other, called where `build` and `data` are those of the source. One that fails is one of which
    the page says so, with its message."""
    (folder / "build").symlink_to(BUILD)
    (folder / "data").symlink_to(SOURCE / "data")
    (folder / "docs").symlink_to(SOURCE / "docs")
    printed = {}
    for line, said in commands(text):
        words = shlex.split(line, comments=True)
        computes = words[1] not in ("scene", "new")
        if SHORT:
            words += [word for change in SHORTER.get(words[1], []) for word in ("--set", change)]
            words += ["--accept-unsteady"] if words[1] in ("calibrate", "compare") else []
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=3000, check=False, env=os.environ | BESIDE)
        everything = done.stdout + done.stderr
        require(done.returncode == 0 or (said and said[0] in everything), f"{line}\nexit code {done.returncode}\n{everything}")
        if words[0] == "drumlin" and not (SHORT and computes):
            require_printed(line, said, everything)
        printed[line] = done.stdout
        print(line, flush=True)
    return printed


def check_files(folder):
    flow = read_json(folder / "FLOW12/flow.json")
    require(flow["start"] == "neighbour", f"from its neighbour: {flow['start']}")
    for name in re.findall(r"`([A-Z][A-Z0-9-]*/[\w./-]+)`", PAGE):
        require((folder / name).exists(), f"{name}: the tutorial names it, and it is not there")


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    if pages := [word for word in sys.argv[3:] if word != "--short"]:
        for page in pages:
            (place / pathlib.Path(page).stem).mkdir()
            follow((SOURCE / "docs" / page).read_text(encoding="utf-8"), place / pathlib.Path(page).stem)
    else:
        output = follow(PAGE, place)
        require(len(output) > 10, f"{len(output)} commands found")
        check_files(place)
