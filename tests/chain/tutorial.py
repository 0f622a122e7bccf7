"""Pages of docs, command by command as they stand there: each ends with 0. Of docs/tutorial.md, which is followed where no other page is
given: every file that it names is there, and what it says of numbers holds.

usage: tutorial.py DRUMLIN SOURCE_DIR [--short | PAGE...]
  PAGE     below docs, such as cookbook/flows.md
  --short  docs/tutorial.md with runs of a fifth of a turn and flows on a coarser mesh: all its commands and files, and of its numbers those
           that no run has to be whole for
"""

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


def commands(text):
    """The lines of the blocks of shell commands, each with what the comment below it says that it prints; without those of the build, those
    with a placeholder, and those that are more than one command."""
    found = []
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            if line.startswith("# ") and found:
                found[-1][1] = line[2:]
            elif line.strip() and not line.startswith(("#", "cmake ", "cd ")) and not re.search(r"\b[A-Z]{3,}\b|[|>]", line):
                found.append([line, None])
    return found


def follow(text, folder):
    """What the commands print, one after the other, called where `build` and `data` are those of the source. One that fails is one of which
    the page says so, with its message."""
    (folder / "build").symlink_to(BUILD)
    (folder / "data").symlink_to(SOURCE / "data")
    (folder / "docs").symlink_to(SOURCE / "docs")
    printed = {}
    for line, said in commands(text):
        words = shlex.split(line, comments=True)
        if SHORT:
            words += [word for change in SHORTER.get(words[1], []) for word in ("--set", change)]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=3000, check=False)
        everything = done.stdout + done.stderr
        require(done.returncode == 0 or (said and said in everything), f"{line}\nexit code {done.returncode}\n{everything}")
        printed[line] = done.stdout
        print(line, flush=True)
    return printed


def check_numbers(folder, printed):
    first = next(iter(printed.values()))
    grains, steps = re.search(r"says what it amounts to: (\d+) grains, .* (\d+) time steps", PAGE).groups()
    require(grains in first and steps in first, f"scene check: not {grains} grains and {steps} steps\n{first}")
    flow = read_json(folder / "tut/flow-12rpm/flow.json")
    require(flow["start"] == "neighbour", f"from its neighbour: {flow['start']}")
    if SHORT:
        return
    expected = float(re.search(r"^output +about ([\d.]+) MB", first, re.MULTILINE)[1])
    written = sum(path.stat().st_size for path in (folder / "tut/run").rglob("*") if path.suffix in (".h5", ".csv")) * 1e-6
    require(abs(written / expected - 1) < 0.2, f"the run wrote {written:.3g} MB, expected were {expected} MB")
    run = read_json(folder / "tut/run/run.json")
    residual = re.search(r"mean residual ([\d.]+)", PAGE)[1]
    require(f"{run['accuracy']['residual_mean']:.{len(residual) - 2}f}" == residual, f"mean residual {run['accuracy']['residual_mean']}, not {residual}")
    said = {"three": 3, "four": 4, "five": 5, "six": 6}[re.search(r"Started from its neighbour the flow takes (\w+) iterations", PAGE)[1]]
    require(flow["iterations"] == said, f"from its neighbour: {flow['iterations']} iterations, not {said}")


def check_files(folder):
    for name in re.findall(r"`(tut/[\w./-]+)`", PAGE):
        require((folder / name).exists(), f"{name}: the tutorial names it, and it is not there")


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    if pages := [word for word in sys.argv[3:] if word != "--short"]:
        for page in pages:
            (place / pathlib.Path(page).stem).mkdir()
            follow((SOURCE / "docs" / page).read_text(encoding="utf-8"), place / pathlib.Path(page).stem)
    else:
        output = follow(PAGE, place)
        require(len(output) == 13, f"{len(output)} commands found")
        check_numbers(place, output)
        check_files(place)
