"""Numbers of scenes that happen once: collapse, discharge, impact, segregation. Used by scene_numbers.py."""

import math

import numpy
from scene_runs import line, mean


def surface(snapshot):
    """Height of a heap of constant width: twice that of its centre of mass."""
    return float(2 * (snapshot["mass"] * snapshot["z"]).sum() / snapshot["mass"].sum())


def connected(snapshot, reach=1.1):
    """Grains that hang together with the mass in the corner, over gaps up to a tenth of a diameter."""
    x, z, r = snapshot["x"], snapshot["z"], snapshot["radius"]
    found = numpy.zeros(len(x), bool)
    edge = list(numpy.nonzero(numpy.hypot(x, z) < 3)[0])
    found[edge] = True
    while edge:
        k = edge.pop()
        near = ~found & (numpy.hypot(x - x[k], z - z[k]) < reach * (r + r[k]))
        found[near] = True
        edge.extend(numpy.nonzero(near)[0])
    return found


def collapse(run):
    """Run-out of what hangs together, over the initial width; angle of the heap's face from foot to top."""
    gate = next(wall for wall in run["scene"]["walls"] if wall["name"] == "gate")
    width = gate["from_mm"][0] / run["d_mm"]
    before, after = run["snapshots"][0], run["snapshots"][-1]
    height = surface(before)
    heap = connected(after)
    foot = float((after["x"] + after["radius"])[heap].max())
    top = float((after["z"] + after["radius"])[heap].max())
    aspect = height / width
    energy = [float((s["mass"] * (s["v_x"] ** 2 + s["v_z"] ** 2)).sum() / (before["mass"] * before["z"]).sum()) for s in run["snapshots"]]
    return {"aspect": aspect, "run_out": foot / width - 1, "run_out_over_aspect": (foot / width - 1) / aspect, "top_over_width": top / width,
            "face_deg": math.degrees(math.atan2(top, foot)), "connected": int(heap.sum()), "kinetic_share_at_end": energy[-1],
            "staron_hinch": 2.5 * aspect if aspect < 2 else 3.25 * aspect ** 0.7, "lajeunesse": 1.2 * aspect if aspect < 2.3 else 1.9 * aspect ** (2 / 3)}


def discharge(run, level):
    """Area that has passed a level, over time; the rate of its middle part, by straight lines through its two halves."""
    time = numpy.array([snapshot["time"] for snapshot in run["snapshots"]])
    out = numpy.array([snapshot["mass"][snapshot["z"] < level].sum() for snapshot in run["snapshots"]])
    total = run["snapshots"][0]["mass"].sum()
    chosen = (out > 0.1 * total) & (out < min(0.6 * total, 0.95 * out[-1]))
    steps = numpy.diff(out[chosen]) / numpy.diff(time[chosen])
    half = len(steps) // 2
    first, second = mean(steps[:half]), mean(steps[half:])
    rate = line(time[chosen], out[chosen])
    return {"rate": {"value": rate[0], "ci99": mean(steps)["ci99"]}, "straightness": rate[2], "second_half_over_first": second["value"] / first["value"],
            "out_share": float(out[-1] / total)}


def silo(run):
    floors = [wall for wall in run["scene"]["walls"] if wall["name"] == "floor"]
    slot = (floors[1]["from_mm"][0] - floors[0]["to_mm"][0]) / run["d_mm"]
    result = {"slot": slot} | discharge(run, -0.5)
    return result | {"rate_over_slot_power": result["rate"]["value"] / (slot - 1) ** 1.5}


def recycled(run):
    """Rate through the slot of a silo whose grains come back, as the run itself tells it: area of discs per time."""
    floors = [wall for wall in run["scene"]["walls"] if wall["name"] == "floor"]
    outlet = run["report"]["regions"][0]
    area = outlet["out_kg_m"] / outlet["out"] / run["density"] / (1e-3 * run["d_mm"]) ** 2 * run["second"]
    return {"slot": (floors[1]["from_mm"][0] - floors[0]["to_mm"][0]) / run["d_mm"], "out": outlet["out"], "waiting": outlet["waiting"],
            "rate": {name: outlet["rate"][key] * area for name, key in (("value", "grains_per_s"), ("ci99", "ci99"))}}


def hourglass(run):
    result = discharge(run, 0)
    last = run["snapshots"][-1]
    glass = numpy.array([wall["from_mm"] for wall in run["scene"]["walls"] if wall["name"] == "glass"]) / run["d_mm"]
    inside = (numpy.abs(last["x"]) < glass[:, 0].max()) & (last["z"] > glass[:, 1].min()) & (last["z"] < glass[:, 1].max())
    return result | {"inside": int(inside.sum()), "grains": len(last["x"])}


def intruder(run):
    """Path of the largest disc: speed at impact, depth, time to stop."""
    big = int(numpy.argmax(run["snapshots"][0]["radius"]))
    time = numpy.array([s["time"] for s in run["snapshots"]])
    foot = numpy.array([s["z"][big] - s["radius"][big] for s in run["snapshots"]])
    speed = numpy.array([s["v_z"][big] for s in run["snapshots"]])
    def bed(snapshot):
        rest = numpy.arange(len(snapshot["z"])) != big
        return float(2 * (snapshot["mass"] * snapshot["z"])[rest].sum() / snapshot["mass"][rest].sum())
    hit = int(numpy.argmax((foot < bed(run["snapshots"][0])) & (speed < 0)))
    surface_then = bed(run["snapshots"][max(hit - 1, 0)])
    after = numpy.nonzero(speed[hit:] > 0.05 * speed[hit])[0]
    stop = hit + int(after[0]) if len(after) else len(time) - 1
    return {"diameter": 2 * float(run["snapshots"][0]["radius"][big]), "impact_speed": float(-speed[hit]), "bed": surface_then,
            "depth": float(surface_then - foot[stop]), "depth_at_end": float(surface_then - foot[-1]), "stopping_time": float(time[stop] - time[hit]),
            "speed_at_end": float(abs(speed[-1]))}


def segregation(run):
    """Mean distance of the small from the drum's axis over that of the large, at the start and over the last quarter of the run."""
    def ratio(snapshot):
        small = snapshot["radius"] < 0.5 * (snapshot["radius"].min() + snapshot["radius"].max())
        distance = numpy.hypot(snapshot["x"], snapshot["z"])
        return distance[small].mean() / distance[~small].mean()
    ratios = [ratio(snapshot) for snapshot in run["snapshots"]]
    first = run["snapshots"][0]["radius"]
    small = first < 0.5 * (first.min() + first.max())
    return {"small": int(small.sum()), "large": int((~small).sum()), "distance_ratio_start": float(ratios[0]),
            "distance_ratio_end": mean(ratios[-len(ratios) // 4:]), "ratios": [round(float(value), 4) for value in ratios[::max(1, len(ratios) // 16)]]}


KINDS = {"collapse": collapse, "silo": silo, "recycled": recycled, "hourglass": hourglass, "intruder": intruder, "segregation": segregation}
