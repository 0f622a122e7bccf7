"""How stress and fabric find their new axes after the direction of shear is turned back, over the shear strain since then.

usage: after_a_turn.py PICTURE --histories HISTORY... [--memory C M CHI_DEG] [--table TABLE.csv]
Each HISTORY is what `drumlin history RUN --box ...` left in a folder of a run of data/scenes/plane-shear-turned.toml (stages named
"turned-..."); means over their turns, bars: standard errors between turns. The law (docs/theory/rheology.md, with memory of the
axes) is integrated through the same turn. --table writes the means as numbers.
"""

import argparse
import cmath
import math
import pathlib
import tomllib

import numpy
import result_files
import style
import whole_file

plt = style.plt
EDGES = [0.0, 0.01, 0.02, 0.03, 0.04, 0.06, 0.08, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0]
FORGOTTEN = 0.2  # shear strain after which a turn no longer shows
COLUMNS = ("shear", "difference", "amount", "fabric_shear", "fabric_difference", "nu", "p")


def stages_of(run, time_unit):
    """(name, start, end, sense of the shear) of each stage, in dimensionless time."""
    with open(run / "scene.toml", "rb") as stream:
        stages = tomllib.load(stream)["stages"]
    start = 0
    for stage in stages:
        end = start + stage["duration_s"] / time_unit
        speeds = [motion.get("velocity_mm_s", [0, 0])[0] for motion in stage.get("motions", [])]
        yield stage["name"], start, end, math.copysign(1, speeds[0]) if speeds and speeds[0] else 0
        start = end


def values_of(row, sense):
    """Signs of a shear with dv_x/dz > 0: a shear the other way round is seen in a mirror."""
    p = 0.5 * (row["sigma_xx"] + row["sigma_zz"])
    shear = sense * 0.5 * (row["sigma_xz"] + row["sigma_zx"]) / p
    difference = 0.5 * (row["sigma_xx"] - row["sigma_zz"]) / p
    return {"shear": shear, "difference": difference, "amount": math.hypot(shear, difference), "nu": row["nu"], "p": p,
            "fabric_shear": -sense * row["fabric_xz"], "fabric_difference": 0.5 * (row["fabric_xx"] - row["fabric_zz"])}


def sheared(rows, times_before, sense):
    """Gives each row the shear strain since the turn, in the sense of the shear, so that noise adds nothing to it."""
    time, strain = times_before[-1] if times_before else rows[0]["time"], 0
    for row in rows:
        gradient = row["d_v_x_dz"] + row["d_v_z_dx"]
        if not math.isnan(gradient):
            strain += sense * gradient * (row["time"] - time)
        time = row["time"]
        row["sheared"] = strain


def turns_of(history):
    """One {bin: values} per turn, and the values of steady shear before."""
    rows = result_files.read_rows(history / "region.csv")
    unit = math.sqrt(float(head_of(history)["diameter_m"]) / 9.81)
    turns, steady = [], []
    for name, start, end, sense in stages_of(history.parent, unit):
        if not sense:
            continue
        inside = [row for row in rows if start < row["time"] - 1e-9 * end <= end]
        if not inside:
            continue
        sheared(inside, [row["time"] for row in rows if row["time"] <= start * (1 + 1e-9)], sense)
        if name.startswith("turned"):
            bins = {}
            for row in inside:
                strain = row["sheared"]
                place = next((b for b in range(len(EDGES) - 1) if EDGES[b] <= strain < EDGES[b + 1]), None)
                if place is not None:
                    bins.setdefault(place, []).append({"strain": strain, **values_of(row, sense)})
            turns.append({b: {key: sum(v[key] for v in found) / len(found) for key in found[0]} for b, found in bins.items()})
        late = [values_of(row, sense) for row in inside if row["sheared"] > max(inside[-1]["sheared"] - 0.4, FORGOTTEN)]
        if late:
            steady.append({key: sum(v[key] for v in late) / len(late) for key in COLUMNS})
    return turns, steady


def mean_and_error(numbers):
    n = len(numbers)
    mean = sum(numbers) / n
    return mean, math.sqrt(sum((v - mean) ** 2 for v in numbers) / (n - 1) / n) if n > 1 else math.nan


def pooled(histories):
    turns, steady = [], []
    for history in histories:
        some, rest = turns_of(history)
        turns += some
        steady += rest
    table = []
    for b in range(len(EDGES) - 1):
        found = [turn[b] for turn in turns if b in turn]
        if not found:
            continue
        line = {"strain": sum(v["strain"] for v in found) / len(found), "turns": len(found)}
        for key in COLUMNS:
            line[key], line[key + "_error"] = mean_and_error([v[key] for v in found])
        table.append(line)
    return table, {key: mean_and_error([v[key] for v in steady]) for key in COLUMNS}


def law_after_turn(c, m, chi, strains, keeps_amount=True, steps_per_unit=4000):
    """(shear, normal difference) over mu, by the law with rho = |n + m A| at once, or with rho held at its steady value; steady shear the
    other way round before."""
    def steady_axes(n, turn):
        return cmath.exp(1j * turn * (chi - math.atan(1 / c))) * math.cos(math.atan(1 / c)) * n

    # n = D_xx + i D_xz over |D|: i for dv_x/dz > 0, whose spin is +; seen in the mirror of the new direction
    A = steady_axes(-1j, -1)
    steady = abs(-1j + m * A)
    n, target, strain, found = 1j, cmath.exp(1j * chi) * 1j, 0.0, []
    step = 1 / steps_per_unit

    def rate(a):
        return -1j * a + c * (target - a)

    for wanted in strains:
        while strain < wanted - 1e-12:
            h = min(step, wanted - strain)
            k1 = rate(A)
            k2 = rate(A + 0.5 * h * k1)
            A += h * k2
            strain += h
        whole = n + m * A
        whole /= max(abs(whole), 1e-9) if keeps_amount else steady
        found.append((whole.imag, -whole.real))  # sigma_xx - sigma_zz = -2 s_xx
    return found


def head_of(history):
    return result_files.read_table(history / "region.csv")[1]


def write_table(path, table, steady, histories):
    names = ["strain", "turns"] + [name for key in COLUMNS for name in (key, key + "_error")]
    lines = [f"# {history.parent.name}: {head_of(history)['title']}, box {head_of(history)['box']}, revision {head_of(history)['revision']}"
             for history in histories]
    lines += [",".join(names)] + [",".join(f"{row[name]:.6g}" for name in names) for row in table]
    lines.append("# steady: " + ", ".join(f"{key} = {mean:.6g} +- {error:.2g}" for key, (mean, error) in steady.items()))
    whole_file.write_text(path, "\n".join(lines) + "\n")


def draw_fit(axes, table, steady_shear):
    """c and m by least squares over the bins up to a strain of 0.6, chi = atan(1/c): steady shear as mu(I) has it."""
    rows = [row for row in table if row["strain"] < 0.6]
    strains = [row["strain"] for row in rows]

    def misfit(logarithms):
        c, m = numpy.exp(logarithms)
        found = law_after_turn(c, m, math.atan(1 / c), strains, keeps_amount=False)
        return numpy.array([(steady_shear * shear - row["shear"]) / max(row["shear_error"], 0.005) for (shear, _), row in zip(found, rows)])

    at, small = numpy.log([10.0, 1.0]), 1e-3
    for _ in range(40):  # Gauss and Newton, steps halved where they do not help
        here = misfit(at)
        slopes = numpy.array([(misfit(at + small * unit) - here) / small for unit in numpy.eye(2)]).T
        step = -numpy.linalg.lstsq(slopes, here, rcond=None)[0]
        while (misfit(at + step) ** 2).sum() > (here ** 2).sum() and abs(step).max() > 1e-6:
            step = 0.5 * step
        at = at + step
        if abs(step).max() < 1e-5:
            break
    c, m = numpy.exp(at)
    errors = numpy.exp(at) * numpy.sqrt(numpy.diag(numpy.linalg.inv(slopes.T @ slopes)))
    print(f"rho held: c {c:.3g} +- {errors[0]:.2g}, m {m:.3g} +- {errors[1]:.2g} (standard errors), chi2 {(misfit(at) ** 2).sum():.3g} of {len(rows)} bins")
    strains = [0.002 * i for i in range(501)]
    found = law_after_turn(c, m, math.atan(1 / c), strains, keeps_amount=False)
    axes.plot(strains, [steady_shear * shear for shear, _ in found], "--", color=style.PARTICLES, label=f"linear law: c = {c:.3g}, m = {m:.3g}")
    axes.plot(strains, [steady_shear * difference for _, difference in found], "--", color=style.CONTINUUM)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture")
    parser.add_argument("--histories", nargs="+", type=pathlib.Path, required=True)
    parser.add_argument("--memory", nargs=3, type=float, metavar=("C", "M", "CHI_DEG"), help="draws the law that keeps the amount of stress")
    parser.add_argument("--fit", action="store_true", help="fits c and m of the law whose rho stays at its steady value to the shear stress, and draws it")
    parser.add_argument("--table", type=pathlib.Path)
    parser.add_argument("--title", default="")
    options = parser.parse_args()
    style.use_style()
    table, steady = pooled(options.histories)
    mu = steady["amount"][0]
    figure, (stress, fabric) = plt.subplots(1, 2, figsize=(12, 4.8))
    x = [row["strain"] for row in table]

    def dots(axes, key, color, label):
        axes.errorbar(x, [row[key] for row in table], yerr=[row[key + "_error"] for row in table], fmt="o", color=color, markersize=4, label=label)
        axes.axhline(steady[key][0], color=color, linewidth=0.8, linestyle=":")

    dots(stress, "shear", style.PARTICLES, r"$\sigma_{xz}/p$")
    dots(stress, "difference", style.CONTINUUM, r"$(\sigma_{xx} - \sigma_{zz})/2p$")
    dots(stress, "amount", "0.4", r"$|s|/p$")
    if options.memory:
        c, m, chi = options.memory[0], options.memory[1], math.radians(options.memory[2])
        strains = [0.002 * i for i in range(501)]
        found = law_after_turn(c, m, chi, strains)
        stress.plot(strains, [mu * shear for shear, _ in found], "-", color=style.PARTICLES, label=f"law: c = {c:g}, m = {m:g}, chi = {options.memory[2]:g} deg")
        stress.plot(strains, [mu * difference for _, difference in found], "-", color=style.CONTINUUM)
        stress.plot([0, 1], [mu, mu], "-", color="0.4", linewidth=0.8)
    if options.fit:
        draw_fit(stress, table, steady["shear"][0])
    dots(fabric, "fabric_shear", style.PARTICLES, "along the shear")
    dots(fabric, "fabric_difference", style.CONTINUUM, r"$(F_{xx} - F_{zz})/2$")
    for axes, title in ((stress, "stress over p"), (fabric, "fabric of the contacts")):
        axes.set_xlabel("shear strain since the turn")
        axes.set_title(f"{title}{', ' + options.title if options.title else ''}", fontsize=12)
        axes.legend(fontsize=10)
        axes.axhline(0, color="0.7", linewidth=0.8)
    style.save(figure, options.picture, False)
    for row in table:
        print("  ".join(f"{key} {row[key]:.4g}" for key in ("strain", "shear", "difference", "amount", "fabric_shear", "fabric_difference", "nu")))
    print("steady: " + ", ".join(f"{key} {mean:.4g} +- {error:.2g}" for key, (mean, error) in steady.items()))
    if options.table:
        write_table(options.table, table, steady, options.histories)


if __name__ == "__main__":
    main()
