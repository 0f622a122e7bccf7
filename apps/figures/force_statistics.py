"""Distribution and anisotropy of the contact forces of a slice, by layer and by zone, with 99 % intervals (docs/theory/measurement.md defines each number).

usage: force_statistics.py RESULTS REQUEST
  RESULTS  folder of the results of `drumlin measure`: profiles.csv is there; receives forces.json and, where a contact carries a force, forces.csv and
           force_distributions.csv
  REQUEST  what to read, as JSON: run, first (snapshot), batches, interval_factor, in_mirror, origin and x_axis (of the frame), x (ends of the slice, null
           for none), z_min, thickness, layers, closed (the cell is periodic in z), surface_z, wall_z, H, friction ([between grains, with walls]; null: not known)

Contacts are arrays by name, a set for each batch: z (of the contact point, in the frame), f_n, f_t (along the normal turned clockwise), phi (of the normal
from x towards z, in [0, pi)), branch (from centre to centre, or to the wall), wall (with one). Sums are arrays by name; those of leave_one_out() have the
whole run first and then the run without one batch each along their first axis. Lengths in d, forces in rho0 g d^2 per unit depth.
"""

import json
import math
import pathlib
import sys

import numpy as np

import result_files
import whole_file

DIRECTIONS = 18  # bins of the direction of the normal
FORCE_EDGES = np.concatenate([1e-4 * 10 ** (np.arange(24) / 8), 0.1 + 0.1 * np.arange(100)])  # of f/<f>: a power of weak, an exponential of strong forces
RATIO_EDGES = np.concatenate([[0], (np.arange(1, 102) - 0.5) * 0.01])  # of |f_t|/f_n
DIRECTION_EDGES = np.arange(DIRECTIONS + 1) * 180 / DIRECTIONS
LEAST_CONTACTS = 30  # fewer give no mean force
SLIDING = 0.999  # share of friction that is used up in a contact that slides
WEAK = (0.1, 0.5)  # window of weak forces; below it stand grains that carry nothing but their own weight
MARGINS = {"surface_margin": 1.0,  # above it contacts are collisions of a few grains
           "interface_gap": 2.0,  # between H and the static phase
           "wall_margin": 3.0}  # the wall orders the grains this far


def contacts_of(snapshot, place):
    """The contacts of a snapshot whose point lies in the slice. Single precision: a run keeps millions of them, and sums are double."""
    mirror = np.array([-1.0 if place["in_mirror"] else 1.0, 1.0])
    if "normal" not in snapshot:  # nobody said where contacts are
        snapshot = snapshot | {"normal": np.zeros((0, 2)), **dict.fromkeys(("i", "j"), np.zeros(0, int)), **dict.fromkeys(("force_n", "force_t"), np.zeros(0))}
    normal, radius, i, j = snapshot["normal"] * mirror, snapshot["radius"], snapshot["i"], snapshot["j"]
    centres = np.array([snapshot["x"], snapshot["z"]]).T * mirror
    axes = np.array([place["x_axis"], [-place["x_axis"][1], place["x_axis"][0]]]).T
    x, z = ((centres[i] - radius[i, None] * normal - place["origin"]) @ axes).T
    height = place["layers"] * place["thickness"]
    if place["closed"]:  # the same share of the height in every cell
        z = place["z_min"] + (z - snapshot["cell"]["z"]) / snapshot["cell"]["height"] % 1 * height
    west, east = place["x"]
    inside = (z >= place["z_min"]) & (z < place["z_min"] + height)
    inside &= (x >= (-math.inf if west is None else west)) & (x <= (math.inf if east is None else east))
    along, up = (normal @ axes).T
    found = {"z": z, "f_n": snapshot["force_n"], "f_t": snapshot["force_t"] * mirror[0], "phi": np.arctan2(up, along) % np.pi,
             "branch": radius[i] + np.where(j < 0, 0, radius[np.maximum(j, 0)]), "wall": j < 0}
    return {name: values[inside].astype(bool if name == "wall" else np.float32) for name, values in found.items()}


def picked(contacts, chosen):
    return {name: values[chosen] for name, values in contacts.items()}


def sums_of(group, groups, values):
    """Sum of values over each group; of complex ones too."""
    if np.iscomplexobj(values):
        return sums_of(group, groups, values.real) + 1j * sums_of(group, groups, values.imag)
    return np.bincount(group, np.broadcast_to(values, group.shape), groups)


def direction_sums(contacts, scale, group=0, groups=1):
    """Sums over the contacts of each group, whole and by direction of the normal; forces times `scale`. Without groups of all contacts."""
    f_n, f_t, phi, branch = ((contacts[name].astype(float) for name in ("f_n", "f_t", "phi", "branch")))
    f_n, f_t, twice, group = f_n * scale, f_t * scale, np.exp(2j * phi), np.broadcast_to(group, phi.shape)
    whole = {"contacts": 1.0, "normal_sum": f_n, "tangential_size": np.abs(f_t), "turned_2": twice, "turned_4": twice ** 2, "turned_6": twice ** 3,
             "pressure": f_n * branch / 2, "shear": (f_n - 1j * f_t) * twice * branch / 2}
    bins = group * DIRECTIONS + np.minimum(DIRECTIONS - 1, (phi / np.pi * DIRECTIONS).astype(int))
    by_direction = {"count": 1.0, "normal": f_n, "tangential": f_t}
    sums = {name: sums_of(group, groups, values) for name, values in whole.items()} | {
        name: sums_of(bins, groups * DIRECTIONS, values).reshape(groups, DIRECTIONS) for name, values in by_direction.items()}
    return sums if groups > 1 else {name: values[0] for name, values in sums.items()}


def second_harmonic(mean):
    """Of means over the contacts of each direction, as a complex number a exp(2 i phi_0) for a cos 2(phi - phi_0); a bin's width damps it."""
    width = np.pi / DIRECTIONS
    return (mean * np.exp(1j * (2 * np.arange(DIRECTIONS) + 1) * width)).sum(-1) * 2 * width / (DIRECTIONS * np.sin(width))


def direction_scalars(sums):
    """Fabric, anisotropies and directions (Rothenburg & Bathurst 1989). NaN where a direction holds no contact. The ratio of the stresses that the
    harmonics carry is the mean of E f over all directions; the source stops at (a_c + a_n + a_t)/2, but among discs of almost one size the fourth
    harmonic of E is as large as the second."""
    contacts, normal = sums["contacts"], sums["normal"] / sums["count"]
    mean = normal.mean(-1)
    fabric, fourth, sixth = (2 * sums[name] / contacts for name in ("turned_2", "turned_4", "turned_6"))
    along, across = second_harmonic(normal) / mean, -1j * second_harmonic(sums["tangential"] / sums["count"]) / mean
    stress = sums["shear"] / sums["pressure"]
    carried = fabric + along + across + fourth * np.conj(along - across) / 2
    return {"contacts": contacts, "f_n": sums["normal_sum"] / contacts, "f_t": sums["tangential_size"] / contacts, "fabric_xx": (1 + fabric.real / 2) / 2,
            "fabric_zz": (1 - fabric.real / 2) / 2, "fabric_xz": fabric.imag / 4, "a_c": abs(fabric), "a_n": abs(along), "a_t": abs(across),
            "a_c4": abs(fourth), "a_c6": abs(sixth)} | {
        f"phi_{name}_deg": np.degrees(np.angle(harmonic)) / 2 % 180
        for name, harmonic in (("c", fabric), ("n", along), ("t", across), ("stress", stress))} | {
        "stress_ratio": abs(stress), "half_sum": (abs(fabric) + abs(along) + abs(across)) / 2,
        "stress_ratio_harmonics": abs(carried) / (2 + (fabric * np.conj(along)).real)}


def histogram(values, edges):
    """Numbers of values between the edges, of which the last is left out."""
    place = np.searchsorted(edges, values, side="right") - 1
    return np.bincount(place[(place >= 0) & (place < len(edges) - 1)], minlength=len(edges) - 1).astype(float)


def distribution_sums(contacts, scale, friction):
    """Sums over contacts, whose forces are over their mean once they are multiplied by `scale`. Those held together by an attraction are left out: neither
    ratio nor tail means anything there."""
    pushed = contacts["f_n"] > 0
    f_n, f_t = ((np.abs(contacts[name].astype(float)) * scale)[pushed] for name in ("f_n", "f_t"))
    ratio, weak = f_t / f_n, f_n[(f_n > WEAK[0]) & (f_n < WEAK[1])]
    numbers = {"contacts": f_n.size, "ratio_sum": ratio.sum(), "sliding": (ratio >= SLIDING * (math.inf if friction is None else friction)).sum(),
               "above_1": (f_n > 1).sum(), "excess_1": np.maximum(0, f_n - 1).sum(), "above_2": (f_n > 2).sum(), "excess_2": np.maximum(0, f_n - 2).sum(),
               "weak": weak.size, "weak_logarithm": np.log(weak).sum()}
    return {name: np.float64(number) for name, number in numbers.items()} | {
        "normal": histogram(f_n, FORCE_EDGES), "tangential": histogram(f_t, FORCE_EDGES), "ratio": histogram(ratio, RATIO_EDGES)}


def power_of(mean_logarithm, low, high):
    """Exponent p of a density x^p between two ends, from the mean of ln x: maximum likelihood. With t = ln(x/low)/length the density is exp(k t), k =
    (p + 1) length, and the mean of t grows with k."""
    length = math.log(high / low)
    wanted = (np.asarray(mean_logarithm) - math.log(low)) / length
    below, above = np.full(wanted.shape, -700.0), np.full(wanted.shape, 700.0)
    for _ in range(60):
        k = (below + above) / 2
        mean = np.where(np.abs(k) < 1e-4, 0.5 + k / 12, 1 / -np.expm1(-k) - 1 / k)
        below, above = np.where(mean < wanted, k, below), np.where(mean < wanted, above, k)
    return np.where((wanted > 0) & (wanted < 1), (below + above) / 2 / length - 1, np.nan)


def distribution_scalars(sums, friction):
    """tail_exponent: beta of P ~ exp(-beta f/<f>) above the mean, by maximum likelihood; weak_exponent: P ~ f^p in the window of weak forces."""
    ratio = sums["ratio_sum"] / sums["contacts"]
    found = {"tail_exponent": sums["above_1"] / sums["excess_1"], "tail_exponent_above_2": sums["above_2"] / sums["excess_2"],
             "weak_exponent": power_of(sums["weak_logarithm"] / sums["weak"], *WEAK), "f_t_over_f_n": ratio}
    if friction is not None:
        found.update(mobilisation=ratio / friction, sliding_share=sums["sliding"] / sums["contacts"])
    return found


def leave_one_out(batches):
    """Of sums: those of all batches, and then those without one batch each; with one batch of the whole alone."""
    stacked = {name: np.array([one[name] for one in batches]) for name in batches[0]}
    return {name: np.concatenate([values.sum(0)[None], (values.sum(0) - values)[:len(values) if len(values) > 1 else 0]]) for name, values in stacked.items()}


def half_width(values, factor, period=None):
    """99 % half width from a value of the whole and those without one batch each (docs/theory/statistics.md); angles count from the nearest turn."""
    values, count = values if period is None else values - period * np.round((values - values[0]) / period), len(values) - 1
    if count < 2:
        return np.full(values.shape[1:], np.nan)
    apart = values[1:] - values[1:].mean(0)
    return factor * np.sqrt((count - 1) / count * ((apart ** 2).sum(0) + 2 * np.maximum(0, (apart[1:] * apart[:-1]).sum(0))))


def with_intervals(scalars, factor):
    """{name: (value, half width)}; counts have none."""
    return {name: (values[0], None if name == "contacts" else half_width(values, factor, 180 if name.endswith("_deg") else None))
            for name, values in scalars.items()}


class Zone:
    """Numbers and distributions of some contacts, one set per batch, over the mean normal force at their depth; over their own mean where none is given."""

    def __init__(self, batches, means, friction, factor):
        def over(function, *scales):
            return leave_one_out([function(one, *each) for one, *each in zip(batches, *scales)])

        self.scalars, self.rows, self.factor = {}, [], factor
        raw = over(lambda one: direction_sums(one, 1))
        common = raw["contacts"][0] / raw["normal_sum"][0]
        scales = [common if means is None else 1 / means[b] for b in range(len(batches))]
        local = over(lambda one, scale: distribution_sums(one, scale, friction), scales)
        self.add(dict(list(direction_scalars(raw).items())[:3]))
        for quantity, name, edges in (("f_n", "normal", FORCE_EDGES), ("f_t", "tangential", FORCE_EDGES), ("f_t_over_f_n", "ratio", RATIO_EDGES)):
            self.add_density(quantity, local, name, edges)
        if means is None:  # the directions of contacts with a wall are the wall's
            self.add(distribution_scalars(local, friction))
            return
        directions = over(direction_sums, scales)
        zone_wide = over(lambda one: distribution_sums(one, common, None))
        self.add(dict(list(direction_scalars(directions).items())[3:]) | distribution_scalars(local, friction))
        self.add({"tail_exponent_zone_mean": zone_wide["above_1"] / zone_wide["excess_1"]})
        self.add_density("f_n_zone_mean", zone_wide, "normal", FORCE_EDGES)
        # A contact shows in two opposite directions: the density per rad is counted over the full circle.
        self.add_rows("contacts_of_direction", DIRECTION_EDGES, directions["count"] / directions["contacts"][:, None] * DIRECTIONS / (2 * np.pi),
                      directions["count"])
        for name in ("normal", "tangential"):
            self.add_rows(f"f_{name[0]}_of_direction", DIRECTION_EDGES, directions[name] / directions["count"], directions["count"])

    def add(self, scalars):
        self.scalars.update(with_intervals(scalars, self.factor))

    def add_density(self, quantity, sums, name, edges):
        self.add_rows(quantity, edges, sums[name] / (sums["contacts"][:, None] * np.diff(edges)), sums[name])

    def add_rows(self, quantity, edges, values, counts):
        self.rows += zip([quantity] * len(edges), edges[:-1], edges[1:], values[0], half_width(values, self.factor), counts[0])


def statistics(batches, place):
    """(layers, zones): of the layers that hold contacts {z, name: (values, half widths)}, and the zones by name with their ends. In flowing, static and
    bulk a force is divided by the mean normal force at its depth: stress grows with depth, and one mean for a zone of 40 d would mix strong contacts
    with deep ones."""
    factor, count = math.nan if place["interval_factor"] is None else place["interval_factor"], place["layers"]
    grains = [picked(one, ~one["wall"]) for one in batches]
    layers_of = [np.minimum(count - 1, ((one["z"].astype(float) - place["z_min"]) / place["thickness"]).astype(int)) for one in grains]
    sums = leave_one_out([direction_sums(one, 1, layer, count) for one, layer in zip(grains, layers_of)])
    z, number = place["z_min"] + (np.arange(count) + 0.5) * place["thickness"], sums["contacts"][0]
    held, enough = np.flatnonzero(number), number >= LEAST_CONTACTS
    shown = slice(held[0], held[-1] + 1) if len(held) else slice(0)
    layers = {name: (np.where(enough | (name == "contacts"), value, np.nan)[shown], None if half is None else np.where(enough, half, np.nan)[shown])
              for name, (value, half) in with_intervals(direction_scalars(sums), factor).items()}
    zones = {}

    def add(name, ends, chosen, means, friction):
        if sum(one["z"].size for one in chosen) >= LEAST_CONTACTS:
            zones[name] = (ends, Zone(chosen, means, friction, factor))

    bottom, H = place["wall_z"] + MARGINS["wall_margin"], math.nan if place["H"] is None else place["H"]
    for name, low, high in (("flowing", -H, -MARGINS["surface_margin"]), ("static", bottom, -H - MARGINS["interface_gap"]),
                            ("bulk", bottom, -MARGINS["surface_margin"])):
        if enough.any() and low < high:
            chosen = [picked(one, (one["z"] >= low + place["surface_z"]) & (one["z"] < high + place["surface_z"])) for one in grains]
            means = [np.interp(one["z"], z[enough], sums["normal_sum"][0][enough] / number[enough]) for one in chosen]
            add(name, (low, high), chosen, means, place["friction"][0])
    add("wall", (place["wall_z"], place["wall_z"]), [picked(one, one["wall"]) for one in batches], None, place["friction"][1])
    return {"z": (z[shown] - place["surface_z"], None)} | layers, zones


def text_of(value, digits=None):
    """At most so many digits, or those that read back as the same number; empty where a number was not computed."""
    if not math.isfinite(value):
        return ""
    return repr(float(value)).removesuffix(".0") if digits is None else f"{value:.{digits}g}"


def layer_table(layers):
    """The lines of forces.csv below its head."""
    columns = [column for name, (value, half) in layers.items() for column in [(name, value)] + ([] if half is None else [(f"{name}_ci99", half)])]
    return [",".join(name for name, _ in columns)] + [",".join(text_of(values[l]) for _, values in columns) for l in range(len(columns[0][1]))]


def json_of(zone):
    ends, found = zone
    number = {name: float(value) if math.isfinite(value) else None for name, (value, _) in found.scalars.items()}
    return {"z": list(ends)} | {name: number[name] if half is None else {"value": number[name], "ci99": float(half) if math.isfinite(half) else None}
                                for name, (_, half) in found.scalars.items()}


def main():
    results, place = pathlib.Path(sys.argv[1]), json.loads(sys.argv[2])
    files = sorted((pathlib.Path(place["run"]) / "snapshots").glob("*.h5"))[place["first"]:]
    found = [[] for _ in range(place["batches"])]
    for index, file in enumerate(files):
        found[index * place["batches"] // len(files)].append(contacts_of(result_files.read_snapshot(file), place))
    batches = [{name: np.concatenate([one[name] for one in batch]) for name in batch[0]} for batch in found]
    content = None
    if not all(one["wall"].all() for one in batches):
        with np.errstate(all="ignore"):
            layers, zones = statistics(batches, place)
        head = [line for line in (results / "profiles.csv").read_text(encoding="utf-8").splitlines() if line.startswith("#") and not line.startswith("# column ")]
        whole_file.write_text(results / "forces.csv", "\n".join(head + layer_table(layers)) + "\n")
        rows = [",".join([name, row[0], *(text_of(value, 6) for value in row[1:5]), f"{row[5]:.0f}"]) for name, (_, zone) in zones.items() for row in zone.rows]
        whole_file.write_text(results / "force_distributions.csv",
                              "\n".join(["# drumlin-force-distributions-1", "zone,quantity,from,to,value,ci99,contacts", *rows]) + "\n")
        content = {"zones": {name: json_of(zone) for name, zone in zones.items()} or None,
                   "settings": {"normalised_by": "mean normal force at the depth of the contact, over the whole run", **MARGINS,
                                "friction_grain_grain": place["friction"][0], "friction_grain_wall": place["friction"][1]}}
    whole_file.write_text(results / "forces.json", json.dumps(content))


if __name__ == "__main__":
    main()
