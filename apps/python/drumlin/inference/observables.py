"""What a question may name as measured, read from the folder of a finished run: values with the standard error of that run."""

import json
import math
import pathlib
import tomllib

import numpy as np

from ..commands import command
from ..errors import DrumlinError, InputError
from ..figures import result_files
from ..pair import measures
from ..pair.frames import read_frames

NORMAL_99 = 2.5758293  # half width of a 99 % interval over the standard error
OF_FRAMES = ("repose_deg", "run_out")
RATE = "rate_grains_per_s"
SURFACE = (0.2, 0.8)  # of the heap's height: the part of its surface that a line is fitted to


def measure(folder, quantities):
    """Runs `drumlin measure` for what the folder does not hold yet."""
    folder, quantities = pathlib.Path(folder), set(quantities)
    if quantities - {RATE, *OF_FRAMES} and not (folder / "measured" / "measured.json").exists():
        command("measure", folder, "--parts", "none", "--no-figures", "--resume")
    if quantities & set(OF_FRAMES) and not (folder / "frames" / "frames.h5").exists():
        begin, end = _last_stage(folder)
        command("measure", folder, "--at", f"0,{end - begin:.12g}", "--origin", f"{begin:.12g}", "-o", folder / "frames", "--resume")


def _last_stage(folder):
    """Seconds of the scene at which the last stage begins and ends, by its snapshots."""
    scene, scales = tomllib.loads((folder / "scene.toml").read_text(encoding="utf-8")), _json(folder / "run.json")["scales"]
    times = [result_files.read_snapshot(file)["time"] * scales["time_s"] for file in sorted((folder / "snapshots").glob("*.h5"))]
    count = scene["stages"][-1].get("snapshots", 0)
    if not 0 < count < len(times):
        raise InputError(f"{folder}/scene.toml: stages: a snapshot at the end of the last stage and one at its start are needed")
    return float(times[-count - 1]), float(times[-1])


def _json(path):
    return json.loads(path.read_text(encoding="utf-8"))


def observed(folder, quantity, z=None):
    """(values, standard errors), arrays with one entry or one for each z; NaN where the run has none, a standard error of NaN where none is known."""
    folder = pathlib.Path(folder)
    if quantity == RATE:
        return _rate(folder)
    if quantity in OF_FRAMES:
        frames = read_frames(folder / "frames" / "frames.h5")
        return np.array([{"repose_deg": repose_angle, "run_out": run_out}[quantity](frames)]), np.array([math.nan])
    _, header, columns = result_files.read_table(folder / "measured" / "profiles.csv", "drumlin-profiles-1")
    factor = float(header.get("interval_factor", NORMAL_99))
    if z is not None:
        return _profile(columns, quantity, np.asarray(z, float), factor, folder)
    entry = _json(folder / "measured" / "measured.json").get(quantity, {})
    if not isinstance(entry, dict):
        raise InputError(f"{folder}: quantity: {quantity} is no measured number with an interval")
    value, half = (math.nan if entry.get(key) is None else entry[key] for key in ("value", "ci99"))
    return np.array([value]), np.array([half / factor])


def _profile(columns, quantity, z, factor, folder):
    """A column at heights between its layers, linearly; NaN outside."""
    if quantity not in columns:
        raise InputError(f"{folder}: quantity: {quantity} is no column of profiles.csv (allowed: {', '.join(columns)})")
    half = columns.get(quantity + "_ci99", np.full_like(columns["z"], math.nan))
    return tuple(np.interp(z, columns["z"], values, left=math.nan, right=math.nan) for values in (columns[quantity], half / factor))


def _rate(folder):
    rates = [region["rate"] for region in _json(folder / "run.json").get("regions", []) if "rate" in region]
    if not rates:
        return np.array([math.nan]), np.array([math.nan])
    return np.array([rates[0]["grains_per_s"]]), np.array([rates[0]["ci99"] / NORMAL_99])


def _heap(frames):
    return measures.Mean(frames, measures.floor_height(frames))


def repose_angle(frames):
    """Angle of the surface from its highest place down to the side that lies farther off, where its height is from 0.2 to 0.8 of the greatest, in the last
    frame, degrees."""
    side = _heap(frames)
    x, h = frames.x, side.h[-1]
    top, place = int(h.argmax()), np.arange(len(h))
    there = np.flatnonzero(h > 0)
    falls = place >= top if there[-1] - top >= top - there[0] else place <= top
    return abs(measures.slope_deg(x, h, falls & (h > SURFACE[0] * h[top]) & (h < SURFACE[1] * h[top])))


def run_out(frames):
    """How far the foot moved, over the width of the fill: of the surface 1 d above its floor."""
    return float(measures.run_out(_heap(frames), 1.0)[-1])


def read_all(folder, quantities):
    """{(quantity, z): (values, standard errors)} of a finished run; None where it could not be measured."""
    try:
        measure(folder, [name for name, _ in quantities])
        return {key: observed(folder, key[0], key[1]) for key in quantities}
    except InputError:
        raise
    except DrumlinError:
        return None
