"""Numbers of scenes in frames of their own, from what `drumlin measure` left in RUN/measured: a silo over its height and width, a drum over r.
Used by scene_numbers.py."""

import json
import math

import numpy
from result_files import read_table
from scene_events import recycled


def frame(run, name):
    _, header, columns = read_table(run["folder"] / f"measured/{name}.csv", "drumlin-frame-1")
    return header, columns


def measured_by(run):
    content = json.loads((run["folder"] / "measured/measured.json").read_text(encoding="utf-8"))
    return {"measured_revision": content["provenance"]["measurement"]["revision"]}


def silo_frames(run):
    """What leaves the silo goes through its slot and crosses its width: area of discs per time by nu v_z, against the outlet's own count.
    --height: over the slot; --width: a band in the bed. The half widths are those of all layers at once, an upper bound."""
    above, height = frame(run, "height")
    across, width = frame(run, "width")
    slot = float(above["x_to"]) - float(above["x_from"])
    falling = (height["z"] > -5) & (height["z"] < 0)

    def flow(columns, chosen, extent):
        share = extent * columns["nu"][chosen]
        return {"value": float(-numpy.nansum(columns["v_z"][chosen] * share)), "ci99": float(numpy.nansum(columns["v_z_ci99"][chosen] * share))}

    everywhere = numpy.isfinite(width["v_z"])
    speed, x = -width["v_z"][everywhere], width["x"][everywhere]
    fast = x[speed > 0.5 * speed.max()]
    bed = height["z"] > 0
    sides = (x < x[0] + 5) | (x > x[-1] - 5)
    stress, middle = width["sigma_zz"][everywhere], numpy.abs(x - 0.5 * (x[0] + x[-1])) < 5
    return recycled(run) | {
        "through_slot": flow(height, falling, slot / falling.sum()), "across": flow(width, everywhere, float(across["layer_thickness"])),
        "band": [float(across["z_from"]), float(across["z_to"])], "speed_in_slot": float(-height["v_z"][bed][0]), "nu_in_slot": float(height["nu"][bed][0]),
        "speed_across": float(speed.max()), "half_speed_width": float(fast[-1] - fast[0] + 1), "nu_across": float(numpy.mean(width["nu"][everywhere])),
        "sigma_zz_middle": float(stress[middle].mean()), "sigma_zz_sides": float(stress[sides].mean()),
        "sigma_zz_axis_most": float(numpy.nanmax(height["sigma_zz"][bed]))} | measured_by(run)


def weight_within(snapshot, radius):
    """Torque of the weight within a circle about the origin, clockwise; a disc that the circle cuts counts by its area within."""
    depth = numpy.clip((radius - numpy.hypot(snapshot["x"], snapshot["z"])) / snapshot["radius"], -1, 1)
    share = 0.5 + (depth * numpy.sqrt(1 - depth ** 2) + numpy.arcsin(depth)) / math.pi
    g = snapshot["gravity"]
    return float((share * snapshot["mass"] * (snapshot["z"] * g[0] - snapshot["x"] * g[1])).sum())


def drum_rings(run):
    """The torque of the stresses on a circle, 2 pi r^2 sigma_rt, carries the weight within it; rings from half the radius outwards."""
    radius = run["scene"]["walls"][0]["radius_mm"] / run["d_mm"]
    _, rings = frame(run, "radial")
    chosen = (rings["r"] > 0.5 * radius) & (rings["r"] < radius - 1)
    carried = 2 * math.pi * rings["r"] ** 2 * rings["sigma_rt"]
    weight = numpy.array([numpy.mean([weight_within(snapshot, r) for snapshot in run["snapshots"]]) for r in rings["r"]])
    spin = run["scene"]["stages"][-1]["motions"][0]["speed_rpm"] * 2 * math.pi / 60 * run["second"]
    ratio = -carried[chosen] / weight[chosen]
    return {"radius": radius, "r": rings["r"][chosen].tolist(), "torque_over_weight": {"value": float(ratio.mean()), "least": float(ratio.min()), "most": float(ratio.max())},
            "torque_ci99_share": float(numpy.mean(rings["sigma_rt_ci99"][chosen] / numpy.abs(rings["sigma_rt"][chosen]))),
            "mu": float(numpy.mean(rings["mu"][chosen])), "k": float(numpy.mean(rings["k"][chosen])), "still_at": float(numpy.interp(0, rings["v_t"][rings["r"] > 2], rings["r"][rings["r"] > 2])),
            "turning_at_wall_over_drum": float(rings["v_t"][chosen][-1] / rings["r"][chosen][-1] / spin)} | measured_by(run)


KINDS = {"silo-frames": silo_frames, "drum-rings": drum_rings}
