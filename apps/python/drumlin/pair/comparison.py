"""Both sides of a pair compared over time and judged by data/limits/pair.toml: pair.json, figures, a page that moves (docs/formats/pair.md)."""

import json
import pathlib
import sys

import numpy as np

from ..commands import draw
from ..errors import InputError
from ..figures import whole_file
from ..study.runs import refused
from ..study.tables import plain
from . import measures
from .frames import read_frames
from .geometry import Walls
from .judgement import Pair, judged, read_pair_limits
from .loads import mean_loads

STRESS = ("sigma_xx", "sigma_zz", "sigma_xz")
ERRORS = {"v": ("v_x", "v_z"), "stress": STRESS} | {name: (name,) for name in ("v_x", "v_z", *STRESS, "p", "mu")}


def require_one_grid(first, second):
    """InputError unless both sides have the same nodes and times."""
    problems = []
    for name in ("x", "z", "times"):
        a, b = getattr(first, name), getattr(second, name)
        if len(a) != len(b) or not np.allclose(a, b, rtol=1e-6, atol=1e-6):
            said = f"has {len(b)} from {b[0]:.6g} to {b[-1]:.6g}" if len(b) else "is empty"
            problems.append((str(second.path), name, said, f"those of {first.path}: {len(a)} from {a[0]:.6g} to {a[-1]:.6g}"))
    if problems:
        raise refused(problems)


def compared(pair):
    """The keys of pair.json that no limit is needed for."""
    particles, continuum, halves = pair.particles, pair.continuum, pair.halves

    def beside(measure):
        return {"value": measure(particles, continuum), "floor": measures.noise_floor(measure, halves)}

    def scalar(name):
        value, half = measures.interval(pair.sides[0].scalars[name])
        return {"particles": value, "ci99": half, "continuum": continuum.scalars[name]}

    heights = {"rms": beside(measures.height_error("h")), "mass_rms": beside(measures.height_error("mass_height"))}
    errors = {name: {zone: beside(measures.field_error(names, zone, False)) | {"pooled": beside(measures.field_error(names, zone, True))}
                     for zone in ("flowing", "all")} for name, names in ERRORS.items() if all(each in particles.fields for each in names)}
    loads = {name: {"component": "xz"[component], "particles": particles.loads[name], "ci99": measures.interval(pair.sides[0].loads[name])[1],
                    "continuum": continuum.loads[name], "error": beside(measures.load_error(name, component, pair.weight))}
             for name, component in pair.loads.items()}
    reach = {str(least): beside_runs(pair, lambda side, least=least: measures.run_out(side, least)) for least in measures.RUN_OUTS}
    stop = beside_runs(pair, lambda side: measures.stopped(side.frames.times, side.scalars["kinetic_energy"]))
    return {"times": particles.frames.times, "fill": {"height": measures.fill_height(particles), "area": particles.scalars["area"][0], "weight": pair.weight},
            "heights": heights, "errors": errors, "scalars": {name: scalar(name) for name in particles.scalars if name in continuum.scalars},
            "loads": loads, "run_out": reach, "time_of_stopping": stop, "rate": beside_runs(pair, measures.rate) | {"steady": steady(pair)},
            "slot_width": float(np.diff(pair.walls.slot()[0])[0]) if pair.walls.slot() else None}


def beside_runs(pair, take):
    """What `take` gives of each run, as mean and 99 % interval, and of the continuum."""
    value, half = measures.interval(np.array([take(each) for each in pair.each_run]))
    return {"particles": value, "ci99": half, "continuum": take(pair.continuum)}


def steady(pair):
    return {"particles": measures.steady_part(pair.particles), "continuum": measures.steady_part(pair.continuum)}


def compare(particles, continuum, output, case="any", limits=None, scene=None, record=None, runs=None, figures=True):
    """Compares two files of frames and writes pair.json, figures and index.html into the folder `output`; the content of pair.json.
    case: which limits of the file `limits` judge it, beside those of any pair; scene: the flow scene, whose walls and openings some limits ask for;
    record: of the continuum, {"energy", "seconds"}; runs: folders of the particles' runs, whose walls.csv, if all have it, gives loads as means over time.
    InputError where the sides do not fit one another."""
    sides = read_frames(particles), read_frames(continuum)
    require_one_grid(*sides)
    means = mean_loads(sides[0], runs or [], measures.fill_height(measures.Mean(sides[0], measures.floor_height(*sides))))
    sides[0].loads = means or sides[0].loads
    pair = Pair(*sides, Walls.of_scene(scene, sides[1].scales["length_m"]) if scene else Walls(), record or {})
    rows = judged(read_pair_limits(limits), case, pair) if limits else []
    content = {"format": "drumlin-pair-1", "case": case, "reduced": sides[0].header.get("reduced") == "true",
               "particles": described(sides[0]), "continuum": described(sides[1]), "mean_loads": bool(means)} | compared(pair) | {"rows": rows}
    content, output = plain(as_lists(content)), pathlib.Path(output)
    output.mkdir(parents=True, exist_ok=True)
    whole_file.write_text(output / "pair.json", json.dumps(content, indent=1) + "\n")
    if figures:
        draw("figures/pair_figures.py", output / "pair.json", particles, continuum, output)
        draw("pages/write_page.py", "pair.html", output / "pair.json", output)
    return content


def described(frames):
    return {"file": frames.path.name, "runs": frames.runs, "title": frames.header.get("title", "")}


def as_lists(value):
    """Arrays as lists, tuples of numbers too."""
    if isinstance(value, dict):
        return {key: as_lists(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [as_lists(one) for one in value]
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def main(words):
    """usage: python3 -m drumlin.pair.comparison PARTICLES CONTINUUM OUTPUT [CASE [LIMITS [SCENE]]]"""
    if not 3 <= len(words) <= 6:
        sys.exit(main.__doc__)
    try:
        for row in compare(*words)["rows"]:
            print(" ".join(f"{key} {row[key]}" for key in ("quantity", "where", "value", "limit", "must_outcome", "aim_outcome")))
    except InputError as error:
        print(error, file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main(sys.argv[1:])
