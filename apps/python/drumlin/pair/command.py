"""`drumlin pair` once it has read the scene and the law: makes both sides and their report.

usage: command.py GIVEN
  GIVEN   JSON: the options of the command by their long names (apps/commands/pair.cpp), and
  scene   text of the particle scene with all defaults, of `file`
  nu      volume fraction of the law (OUTPUT/rheology.toml)
  limits  file of the limits
  sum     of what was requested
"""

import functools
import json
import math
import os
import pathlib
import subprocess
import sys
import tomllib

import h5py
import numpy as np

from drumlin.commands import command, program
from drumlin.figures import whole_file
from drumlin.pair import layers, scene as scenes
from drumlin.scenes import toml_of
from drumlin.study.runs import refused
from drumlin.sweeping.executors import run_all

UNLIKE = ("title", "seed", "reduced", "output", "solver")  # may differ between a scene and a run of it


class Work:
    """The folder of the results, and the commands that fill it."""

    def __init__(self, given):
        self.given, self.output = given, None

    def __call__(self, begin=False, words=()):
        """Claims the folder; does a command of drumlin, which says by itself what goes wrong."""
        given = self.given
        if begin:
            from drumlin import _drumlin  # pylint: disable=import-outside-toplevel  # tests need none
            folder = pathlib.Path(given["output"])
            self.output = _drumlin.GrowingOutput(given["output"], "pair", given["resume"], given["overwrite"],
                                                 [given["file"], given["law"]], ["scene.toml", "rheology.toml", "flow.toml"], given["sum"])
            self.output.forget("*")
            whole_file.write_text(folder / "scene.toml", given["scene"])
            whole_file.write_text(folder / "rheology.toml", pathlib.Path(given["law"]).read_text(encoding="utf-8"))
            for name in ("scene.toml", "rheology.toml"):
                self.output.list(name)
            self.output.save()
        if words:
            code = subprocess.run([program(), *words], stdin=subprocess.DEVNULL, check=False).returncode
            if code:
                print(f"drumlin {' '.join(words)}: ended with exit code {code}", file=sys.stderr)
                sys.exit(code if code > 0 else 128 - code)


tell = None  # a Work


def again(given):
    """What the commands of the steps are told about results that are there."""
    return "--overwrite" if given["overwrite"] else "--resume"


def toml_text(content):
    """A scene as people write it: a table for each group of keys, an array of tables for each list of them."""
    text = toml_of({key: value for key, value in content.items() if not isinstance(value, dict) and not _is_tables(value)})
    for name, value in content.items():
        for head, table in [(f"[{name}]", value)] if isinstance(value, dict) else [(f"[[{name}]]", each) for each in value] if _is_tables(value) else []:
            text += f"\n{head}\n{toml_of(table)}"
    return text


def _is_tables(value):
    return isinstance(value, list) and all(isinstance(each, dict) for each in value)


class Run:
    """A finished run of the scene: its grains from a time of the scene on, s."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        report = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
        self.scales = report["scales"]
        self.ends = [stage["time_s"] for stage in report.get("stages", [])] or None
        self.snapshots = []
        for file in sorted((self.folder / "snapshots").glob("*.h5")):
            with h5py.File(file) as snapshot:
                self.snapshots.append((float(snapshot["time"][()]) * self.scales["time_s"], file))

    def grains_mm(self, file):
        """(x, z, radius)"""
        with h5py.File(file) as snapshot:
            return [1e3 * self.scales["length_m"] * snapshot[f"grains/{name}"][:] for name in ("x", "z", "radius")]

    def grains_from(self, origin):
        """Grains when the flow begins, and what they reach from then on (all but the thousandth that flies farthest)."""
        later = [file for time, file in self.snapshots if time >= origin * (1 - 1e-9)] or [self.snapshots[-1][1]]
        x, z, radius = self.grains_mm(later[0])
        every = [self.grains_mm(file) for file in later[:: math.ceil(len(later) / 20)]]
        reach = tuple(tuple(np.quantile(np.concatenate([grains[axis] for grains in every]), (1e-3, 1 - 1e-3))) for axis in (0, 1))
        return scenes.Grains(float(np.pi * np.sum(radius**2)), (float(x.mean()), float(z.mean())), None, reach), (2 * radius.min(), 2 * radius.max())


def require_same_scene(given, folder):
    def told(text):
        return {key: value for key, value in tomllib.loads(text).items() if key not in UNLIKE}
    first, second = told(given["scene"]), told((pathlib.Path(folder) / "scene.toml").read_text(encoding="utf-8"))
    for key in sorted({*first, *second}):
        if first.get(key) != second.get(key) and not (key == "grains" and "listed" in second.get("grains", {})):
            raise refused([(f"{folder}/scene.toml", key, "is not that of the scene", f"a run of {given['file']}")])


def runs_of(given, output):
    """Folders of finished runs: those that are given, or one for each seed."""
    for folder in given["run"]:
        require_same_scene(given, folder)
    if given["run"]:
        return given["run"]
    first = tomllib.loads(given["scene"]).get("seed", 0)
    folders = {seed: str(output / f"run-{seed}") for seed in range(first, first + given["seeds"])}
    run = ["run", str(output / "scene.toml"), "--threads", str(given["threads"]), again(given)]
    if len(folders) == 1:  # shows its progress
        tell(words=[*run, "--set", f"seed={first}", "-o", folders[first]])
    else:
        jobs = [functools.partial(command, *run, "--set", f"seed={seed}", "-o", os.path.abspath(folder)) for seed, folder in folders.items()]
        failed = [outcome.error for outcome in run_all(jobs, output, given["executor"]) if outcome.error is not None]
        if failed:
            raise failed[0]
    return list(folders.values())


def times_of(given, scene, first, end):
    """Seconds since the flow begins, 0 among them: as asked, or at most 40 of the snapshots of its first stage, evenly."""
    if given["at"]:
        return sorted({0.0, *given["at"]})
    count = scene["stages"][first].get("snapshots", 0) or 20
    count = max(each for each in range(1, 41) if count % each == 0) if len(scene["stages"]) == first + 1 else 20
    return [end * k / count for k in range(count + 1)]


def require_snapshot(given, scene, first):
    if not scene["stages"][first - 1].get("snapshots"):
        raise refused([(given["file"], f"stages.{first - 1}.snapshots", "is 0: the material at rest is measured in the snapshot at its end", "1 or more")])


def surface_mm(frames, length_m):
    """(x, z) of the surface at time 0, the mean of the runs, where there is one."""
    with h5py.File(frames) as file:
        x, height = file["x"][:], file["height"][:, 0]
    there = np.isfinite(height).all(axis=0)
    return 1e3 * length_m * x[there], 1e3 * length_m * height[:, there].mean(axis=0)


def pair_of_region(given, scene, output):
    first = scenes.release(scenes.Reader(scene, given["file"]))

    def flow_scene(**of_run):
        return scenes.flow_scene(scene, given["nu"], given["file"], frames_s=of_run.pop("frames_s", ()), **of_run)

    if not given["run"]:
        flow, _ = flow_scene(frames_s=sorted({0.0, *given["at"]}) if given["at"] else ())  # refuses before anything is run
        if given["scene-only"]:
            return begin(flow, output)
    require_snapshot(given, scene, first)
    tell(begin=True)
    runs = [Run(folder) for folder in runs_of(given, output)]
    ends = runs[0].ends
    times = [0.0, *scenes.stage_ends(scene, ends)]
    grains, sizes = runs[0].grains_from(times[first])
    sizes = None if "generated" in scene["grains"] else sizes
    frames_s = times_of(given, scene, first, times[-1] - times[first])
    flow, origin = flow_scene(grains=grains, sizes=sizes, ends=ends, frames_s=frames_s)
    d_mm, grid = 1e3 * runs[0].scales["length_m"], flow["output"]
    tell(words=["measure", *(str(run.folder) for run in runs), "--at", ",".join(f"{time:.12g}" for time in frames_s), "--origin", f"{origin:.12g}",
                *(word for axis in "xz" for word in (f"--{axis}", ",".join(f"{end / d_mm:.12g}" for end in grid[f"{axis}_mm"]))),
                "-o", str(output / "particles"), again(given)])
    grains.surface = surface_mm(output / "particles" / "frames.h5", runs[0].scales["length_m"])
    flow, _ = flow_scene(grains=grains, sizes=sizes, ends=ends, frames_s=frames_s)
    write_flow(flow | {"output": grid}, output)
    if given["scene-only"]:
        return
    solve(given, output)
    compare(given, output, runs)


def pair_of_layers(given, scene, output):
    if not given["run"]:
        flow = layers.flow_scene(scene, given["nu"], given["file"])
        if given["scene-only"]:
            return begin(flow, output)
    tell(begin=True)
    runs = [Run(folder) for folder in runs_of(given, output)]
    grains, sizes = runs[0].grains_from(runs[0].snapshots[-1][0])
    write_flow(layers.flow_scene(scene, given["nu"], given["file"], grains, None if "generated" in scene["grains"] else sizes), output)
    if given["scene-only"]:
        return
    for run in runs[:2]:
        if not (run.folder / "measured").exists():
            tell(words=["measure", str(run.folder), "--parts", "none"])
    solve(given, output)
    tell(words=["compare", str(runs[0].folder), str(output / "flow"), "-o", str(output / "report"), again(given),
                *(["--floor", str(runs[1].folder)] if len(runs) > 1 else []), *(["--accept-unsteady"] if given["accept-unsteady"] else [])])


def begin(flow, output):
    tell(begin=True)
    write_flow(flow, output)


def write_flow(flow, output):
    whole_file.write_text(output / "flow.toml", toml_text(flow))


def solve(given, output):
    tell(words=["flow", str(output / "flow.toml"), "--rheology", str(output / "rheology.toml"), "-o", str(output / "flow"), again(given)])


def compare(given, output, runs):
    from drumlin.pair import comparison  # pylint: disable=import-outside-toplevel  # with its figures it takes a second

    made = json.loads((output / "flow" / "flow.json").read_text(encoding="utf-8"))
    comparison.compare(output / "particles" / "frames.h5", output / "flow" / "frames.h5", output / "report", given["case"], given["limits"],
                       output / "flow.toml", {"seconds": made.get("cpu_seconds", math.nan), "energy": made.get("checks", {}).get("energy", math.nan)},
                       [run.folder for run in runs])


def main(words):
    global tell  # pylint: disable=global-statement
    given = json.loads(words)
    scene, output = tomllib.loads(given["scene"]), pathlib.Path(given["output"])
    tell = Work(given)
    (pair_of_layers if "periodic_x" in scene else pair_of_region)(given, scene, output)
    tell.output.finish()
    if given["scene-only"]:
        print(f"{output}: flow.toml")
    elif "periodic_x" not in scene:
        print(f"report: {(output / 'report' / 'index.html').absolute()}")


if __name__ == "__main__":
    main(*sys.argv[1:])
