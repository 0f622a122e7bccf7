"""Numbers of scenes in a cell without walls: stress, volume fraction and rates of the whole cell (scene_numbers.py calls them)."""

import numpy
from scene_runs import da_cruz, inertial_number, mean, strength, velocities


def cell_state(snapshot):
    """Of all grains: nu, shear rate of the cell, and stress of contacts and motion about the flow of the cell; compression positive."""
    cell, width = snapshot["cell"], snapshot["period"]
    area, mass, v = width * cell["height"], snapshot["mass"], velocities(snapshot)
    weights = mass[:, None] / mass.sum()
    place = numpy.array([snapshot["x"], snapshot["z"]]).T
    place = place - (weights * place).sum(axis=0)
    flow = numpy.array([cell["rate_x"] * place[:, 0] + cell["shear"] * place[:, 1], cell["rate_z"] * place[:, 1]]).T
    own = v - flow
    own = own - (weights * own).sum(axis=0)
    branch = (snapshot["radius"][snapshot["i"]] + snapshot["radius"][snapshot["j"]])[:, None] * snapshot["normal"]
    contact = numpy.einsum("ca,cb->ab", snapshot["force"], branch) / area
    motion = numpy.einsum("g,ga,gb->ab", mass, own, own) / area
    total = contact + motion
    slope = numpy.polyfit(place[:, 1], v[:, 0], 1)[0]
    return {"nu": mass.sum() / area, "shear_rate": cell["shear"], "slope": slope, "sigma_xx": total[0, 0], "sigma_zz": total[1, 1],
            "sigma_xz": -total[0, 1], "width": width, "height": cell["height"]}


def asked(run, axis):
    """Pressure of the last stage along an axis, in units of the run."""
    return run["scene"]["stages"][-1]["cell"][axis]["pressure_n_m2"] / (run["density"] * 9.81e-3 * run["d_mm"])


def cell_shear(run):
    """mu, nu and I of a sheared cell, and whether stress and slope of the velocity are those asked for."""
    rows = [cell_state(snapshot) for snapshot in run["snapshots"]]
    means = {name: mean([row[name] for row in rows]) for name in rows[0]}
    pressure = means["sigma_zz"]["value"]
    inertial = inertial_number(means["shear_rate"]["value"], pressure)
    return means | {
        "mu": {"value": means["sigma_xz"]["value"] / pressure, "ci99": mean([row["sigma_xz"] / pressure for row in rows])["ci99"]},
        "I": inertial, "pressure_asked": asked(run, "zz"), "slope_over_rate": means["slope"]["value"] / means["shear_rate"]["value"],
        "da_cruz": da_cruz(inertial)}


def cell_biaxial(run):
    """Strength in the last stage."""
    rate = run["snapshots"][-1]["cell"]["rate_z"]
    rows = [cell_state(snapshot) for snapshot in run["snapshots"] if snapshot["cell"]["rate_z"] == rate]
    before = [cell_state(snapshot) for snapshot in run["snapshots"] if snapshot["cell"]["rate_z"] != rate]
    xx, zz, height, nu = (numpy.array([row[name] for row in rows]) for name in ("sigma_xx", "sigma_zz", "height", "nu"))
    return strength(-numpy.log(height / before[-1]["height"]), (zz - xx) / (zz + xx), nu, before[-1]["nu"]) | {
        "sigma_xx": mean(xx), "pressure_asked": asked(run, "xx"), "compressed_xx": before[-1]["sigma_xx"], "compressed_zz": before[-1]["sigma_zz"]}


KINDS = {"cell-shear": cell_shear, "cell-biaxial": cell_biaxial}
