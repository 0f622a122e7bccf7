"""docs/tutorial.md, command by command as it stands there, from step 1 on: each ends with 0, every file that it names is there, and what it
says of numbers holds.

usage: tutorial.py DRUMLIN SOURCE_DIR
"""

import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

from command import read_json, require

BUILD, SOURCE = pathlib.Path(sys.argv[1]).parent, pathlib.Path(sys.argv[2])
PAGE = (SOURCE / "docs" / "tutorial.md").read_text(encoding="utf-8")


def commands():
    """The lines of the blocks of shell commands, without those of the build."""
    blocks = re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    lines = [line for block in blocks for line in block.splitlines() if line.strip()]
    return [line for line in lines if not line.startswith("cmake ")]


def follow(folder):
    """What the commands print, one after the other, called where `build` and `data` are those of the source."""
    (folder / "build").symlink_to(BUILD)
    (folder / "data").symlink_to(SOURCE / "data")
    printed = {}
    for line in commands():
        done = subprocess.run(shlex.split(line), cwd=folder, capture_output=True, text=True, timeout=3000, check=False)
        require(done.returncode == 0, f"{line}\nexit code {done.returncode}\n{done.stdout}{done.stderr}")
        printed[line] = done.stdout
        print(line, flush=True)
    return printed


def check_numbers(folder, printed):
    first = next(iter(printed.values()))
    grains, steps = re.search(r"says what it amounts to: (\d+) grains, .* (\d+) time steps", PAGE).groups()
    require(grains in first and steps in first, f"scene check: not {grains} grains and {steps} steps\n{first}")
    run = read_json(folder / "tut/run/run.json")
    residual = re.search(r"mean residual ([\d.]+)", PAGE)[1]
    require(f"{run['accuracy']['residual_mean']:.{len(residual) - 2}f}" == residual, f"mean residual {run['accuracy']['residual_mean']}, not {residual}")
    said = {"three": 3, "four": 4, "five": 5, "six": 6}[re.search(r"Started from its neighbour the flow takes (\w+) iterations", PAGE)[1]]
    flow = read_json(folder / "tut/flow-12rpm/flow.json")
    require(flow["start"] == "neighbour" and flow["iterations"] == said, f"from its neighbour: {flow['start']}, {flow['iterations']} iterations, not {said}")


def check_files(folder):
    for name in re.findall(r"`(tut/[\w./-]+)`", PAGE):
        require((folder / name).exists(), f"{name}: the tutorial names it, and it is not there")


with tempfile.TemporaryDirectory() as name:
    place = pathlib.Path(name)
    output = follow(place)
    require(len(output) >= 13, f"{len(output)} commands found")
    check_numbers(place, output)
    check_files(place)
