"""The numbers of a shipped scene that the literature or a closed form gives too, as JSON (docs/scenes.md).

usage: scene_numbers.py KIND RUN... [-o FILE.json]
KIND: shear, chute, biaxial, janssen, vibrated, gas (here); cell-shear, cell-biaxial (scene_cells.py); collapse, silo, recycled, hourglass, intruder, segregation (scene_events.py); silo-frames, drum-rings (scene_frames.py). Values are
dimensionless (d, sqrt(d/g), rho0 g d) unless their name ends in a unit; ci99 is the half width of the 99 % interval over time.
"""

import argparse
import json
import math
import sys

import numpy
import scene_cells
import scene_events
import scene_frames
import whole_file
from scene_runs import da_cruz, inertial_number, layer_state, line, mean, read_run, strength, velocities, wall_forces


def wall_number(scene, name):
    names = list(dict.fromkeys(wall["name"] for wall in scene["walls"]))
    return names.index(name)


def plates(run, snapshot):
    """Heights of the centre planes of floor and lid."""
    at = {wall["name"]: wall["from_mm"][1] / run["d_mm"] for wall in run["scene"]["walls"]}
    return at["floor"], at["lid"] + snapshot["walls"][wall_number(run["scene"], "lid"), 1]


def shear(run):
    """The middle half of the gap by itself, and what the plates say: speed over distance, forces over length, grains over the gap."""
    motion = run["scene"]["stages"][-1]["motions"][0]
    speed = motion["velocity_mm_s"][0] / run["d_mm"] * run["second"]
    rows = []
    for snapshot in run["snapshots"]:
        floor, lid = plates(run, snapshot)
        gap, width = lid - floor, snapshot["period"]
        middle = layer_state(snapshot, floor + 0.25 * gap, lid - 0.25 * gap, width)
        forces = wall_forces(snapshot)
        rows.append({"gap": gap, "nu": middle["nu"], "shear_rate": middle["shear_rate"], "mu": middle["sigma_xz"] / middle["sigma_zz"],
                     "sigma_zz": middle["sigma_zz"], "sigma_xz": middle["sigma_xz"], "k": middle["sigma_xx"] / middle["sigma_zz"],
                     "nu_gap": snapshot["mass"].sum() / (width * gap), "nu_between": snapshot["mass"].sum() / (width * (gap - 1)),
                     "lid_force": forces["above"][1] / width, "lid_drag": -forces["above"][0] / width, "shear_rate_gap": speed / gap})
    means = {name: mean([row[name] for row in rows]) for name in rows[0]}
    pressure, drag = means["sigma_zz"]["value"], means["sigma_xz"]["value"]
    asked = motion["force_n_m"] / (1e-3 * snapshot["period"] * run["d_mm"]) / (run["density"] * 9.81e-3 * run["d_mm"])
    means["mu"] = {"value": drag / pressure, "ci99": mean([row["sigma_xz"] / pressure for row in rows])["ci99"]}
    inertial = inertial_number(means["shear_rate"]["value"], pressure)
    inertial_gap = inertial_number(means["shear_rate_gap"]["value"], asked)
    return means | {
        "I": inertial, "I_gap": inertial_gap, "pressure_asked": asked,
        "mu_gap": {"value": means["lid_drag"]["value"] / asked, "ci99": means["lid_drag"]["ci99"] / asked},
        "slip": 1 - means["shear_rate"]["value"] / means["shear_rate_gap"]["value"],
        "da_cruz": da_cruz(inertial) | da_cruz(inertial_gap, "_gap")}


def chute(run):
    """I and nu of the middle, Bagnold's exponent, and the base that carries the layer; mu = tan(slope) by balance of forces."""
    gravity, width = run["snapshots"][0]["gravity"], run["snapshots"][0]["period"]
    slope = math.atan2(gravity[0], -gravity[1])
    heights = numpy.arange(0.5, 60)
    shares, base, fast = [], [], []
    for snapshot in run["snapshots"]:
        v = velocities(snapshot)[:, 0]
        number = numpy.digitize(snapshot["z"], numpy.arange(0, 61)) - 1
        shares.append([(snapshot["mass"][number == k].sum() / width, v[number == k].mean() if (number == k).any() else math.nan) for k in range(60)])
        weight = snapshot["mass"].sum()
        forces = wall_forces(snapshot)["below"]
        base.append((-forces[1] / (weight * math.cos(slope)), forces[0] / (weight * math.sin(slope))))
        fast.append((snapshot["mass"] * v).sum() / weight)
    nu, v = numpy.ma.masked_invalid(numpy.array(shares)).mean(axis=0).filled(0).T
    height = 2 * float((nu * heights).sum() / nu.sum())
    inner = (heights > 0.25 * height) & (heights < 0.75 * height)
    above = numpy.cumsum(nu[::-1])[::-1] - 0.5 * nu
    shear_rate = numpy.gradient(v)
    numbers = [inertial_number(rate, weight * math.cos(slope)) for rate, weight in zip(shear_rate[inner], above[inner])]
    # v(z) = v_s - c depth^p: the free constant v_s is what a straight line through depth^p leaves over, p the best of a list.
    depth = numpy.maximum(height - heights, 0)
    chosen = (heights > 2) & (heights < height - 2)
    powers = numpy.arange(0.5, 3.01, 0.02)
    best = max(powers, key=lambda p: line(depth[chosen] ** p, v[chosen])[2])
    half = len(fast) // 2
    return {"slope_deg": math.degrees(slope), "mu": math.tan(slope), "height": height, "I": mean(numbers) | {"ci99": None},
            "I_spread": float(numpy.std(numbers)), "nu": float(nu[inner].mean()), "bagnold_exponent": float(best),
            "surface_speed": float(v[int(height) - 1]), "mean_speed": mean(fast), "speeding_up": float(numpy.mean(fast[half:]) / numpy.mean(fast[:half]) - 1),
            "base_normal_over_weight": mean([row[0] for row in base]), "base_shear_over_weight": mean([row[1] for row in base])}


def biaxial(run):
    """Strength of what lies between lid and sides."""
    d, scene = run["d_mm"], run["scene"]
    lid, right = (wall_number(scene, name) for name in ("lid", "right"))
    at = {wall["name"]: wall["from_mm"] for wall in scene["walls"]}
    rows = []
    for snapshot in run["snapshots"]:
        height = at["lid"][1] / d + snapshot["walls"][lid, 1]
        width = at["right"][0] / d + snapshot["walls"][right, 0]
        forces = wall_forces(snapshot)
        s_1 = 0.5 * (forces["above"][1] - forces["below"][1]) / width
        s_3 = 0.5 * (forces["right"][0] - forces["left"][0]) / height
        rows.append((height, (s_1 - s_3) / (s_1 + s_3), snapshot["mass"].sum() / (width * height)))
    height, sine, nu = numpy.array(rows).T
    return strength(1 - height / height[0], sine, nu, nu[0]) | {"nu_least": float(nu.min())}


def janssen(run):
    """Floor force against weight and against the closed form with K and the mobilised friction as measured."""
    width = run["scene"]["walls"][0]["to_mm"][0] / run["d_mm"]
    rows = []
    for snapshot in run["snapshots"]:
        forces, weight = wall_forces(snapshot), snapshot["mass"].sum()
        bottom = snapshot["z"].min() - 0.5
        height = 2 * ((snapshot["mass"] * snapshot["z"]).sum() / weight - bottom)
        inner = layer_state(snapshot, bottom, bottom + height, width)
        push, drag = forces["right"][0] - forces["left"][0], -(forces["right"][1] + forces["left"][1])
        side = (snapshot["j"] < 0) & (numpy.abs(snapshot["normal"][:, 0]) > 0.5)
        wall = snapshot["force_n"][side].sum() / (2 * height)
        rows.append((-forces["below"][1] / weight, drag / weight, -drag / push if push else math.nan, wall, inner["sigma_zz"], weight, height))
    floor, carried, friction, wall, stress, weight, height = numpy.array(rows).T
    mobilised, ratio = abs(float(friction.mean())), float(wall.mean() / stress.mean())
    decay = 2 * mobilised * ratio * height.mean() / width
    return {"floor_over_weight": mean(floor), "walls_over_weight": mean(carried), "sum_over_weight": mean(floor + carried), "mobilised_friction": mobilised, "K": ratio,
            "height_over_width": float(height.mean() / width), "janssen_floor_over_weight": (1 - math.exp(-decay)) / decay}


def flight(gamma):
    """Phases (rad) at which a body that does not bounce leaves a shaken plate and lands again."""
    leaves = math.asin(1 / gamma)
    def gap(s):
        return 1 / gamma + s * math.cos(leaves) - s * s / (2 * gamma) - math.sin(leaves + s)
    low = 0.1
    while gap(low + 0.01) > 0:
        low += 0.01
    high = low + 0.01
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if gap(middle) > 0 else (low, middle)
    return leaves, leaves + low


def vibrated(run):
    motion = run["scene"]["stages"][-1]["motions"][0]
    omega = 2 * math.pi * motion["frequency_hz"]
    gamma = 1e-3 * motion["amplitude_mm"][1] * omega ** 2 / 9.81
    start = sum(stage["duration_s"] for stage in run["scene"]["stages"][:-1])
    phases = numpy.array([((snapshot["time"] * run["second"] - start) * omega) % (2 * math.pi) for snapshot in run["snapshots"]])
    free = numpy.array([not (snapshot["j"] < 0).any() for snapshot in run["snapshots"]])
    leaves, lands = flight(gamma)
    inside = ((phases - leaves) % (2 * math.pi)) < lands - leaves
    return {"gamma": gamma, "free_share": mean(free), "closed_form_share": (lands - leaves) / (2 * math.pi), "leaves_deg": math.degrees(leaves),
            "lands_deg": math.degrees(lands), "agreeing_share": float((inside == free).mean())}


def gas(run):
    """Haff's law, and Enskog's rate of cooling with what the list says at the start."""
    first = run["snapshots"][0]
    radius = first["radius"].mean()
    height = abs(run["scene"]["walls"][1]["from_mm"][1] - run["scene"]["walls"][0]["from_mm"][1]) / run["d_mm"]
    nu = first["mass"].sum() / (first["period"] * height)
    time = numpy.array([snapshot["time"] for snapshot in run["snapshots"]])
    temperature = []
    for snapshot in run["snapshots"]:
        v = numpy.array([snapshot["v_x"], snapshot["v_z"]])
        temperature.append(0.5 * ((v - v.mean(axis=1, keepdims=True)) ** 2).mean(axis=1).sum())
    temperature = numpy.array(temperature)
    rate, constant, straight = line(time, temperature ** -0.5)
    loss = 1 - run["scene"]["effects"]["restitution"]["grain_grain"] ** 2
    chi = (1 - 7 * nu / 16) / (1 - nu) ** 2
    # d/dt T^(-1/2) = (1 - e^2) omega / (4 sqrt T), with omega / sqrt T = 8 nu chi / (sqrt(pi) d).
    enskog = loss / 4 * 8 * nu * chi / (math.sqrt(math.pi) * 2 * radius)
    tau = constant / rate
    exponent = line(numpy.log(1 + time / tau), numpy.log(temperature))[0]
    return {"nu": float(nu), "cooled_to": float(temperature[-1] * constant ** 2), "rate_over_enskog": rate / enskog, "straightness": straight,
            "exponent": exponent, "tau_s": tau * run["second"]}


KINDS = {"shear": shear, "chute": chute, "biaxial": biaxial, "janssen": janssen, "vibrated": vibrated, "gas": gas} | scene_cells.KINDS | scene_events.KINDS | scene_frames.KINDS


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("runs", nargs="+")
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    results = []
    for name in options.runs:
        run = read_run(name)
        report = run["report"]
        results.append({"title": report["title"], "seed": report["seed"], "grains": report["grains"], "revision": report["revision"],
                        "cpu_seconds": report["cpu_seconds"], "overlap_max": report["accuracy"]["overlap_max"]} | KINDS[options.kind](run))
    text = json.dumps({"format": "drumlin-scene-numbers-1", "kind": options.kind, "runs": results}, indent=1) + "\n"
    if options.output:
        whole_file.write_text(options.output, text)
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
