"""What the library of laws says, beside what others found: `law_figures.py -o FOLDER --record data/laws/findings.json`.

Draws laws-mu.png, laws-nu.png, laws-grains.png, laws-left-out.png, laws-exponents.png from data/laws/laws.csv, and writes the numbers of docs/results/laws.md.
"""
import argparse
import json
import math
import pathlib
import time

import numpy as np
import scipy.optimize
import scipy.stats

import script  # noqa: F401
import style
import whole_file
from drumlin.library.table import GRAINS, NORMAL_99, Library

plt = style.plt
BASE = {"friction": 0.4, "restitution": 0.1, "spread": 0.2, "rolling_resistance": 0.0}
WORDS = {"friction": "friction", "restitution": "e", "spread": "sizes +-", "rolling_resistance": "rolling resistance"}
FITTED_I = (10**-2.5, 0.1)  # of the exponents, I of mass


class Points:
    """Columns of the points of some grains, by I."""

    def __init__(self, columns, **grains):
        wanted = np.all([np.isclose(columns[name], value) for name, value in (BASE | grains).items()], axis=0)
        order = np.argsort(columns["I"][wanted])
        self.columns = {name: column[wanted][order] for name, column in columns.items()}

    def __getattr__(self, name):
        return self.columns[name]


def kinds(columns):
    """Every kind of grains, as a dict."""
    return [dict(zip(GRAINS, map(float, one))) for one in sorted({tuple(one) for one in zip(*(columns[name] for name in GRAINS))})]


def said(grains):
    parts = [f"{WORDS[name]} {value:g}" for name, value in grains.items() if name == "friction" or not math.isclose(value, BASE[name])]
    return ", ".join("sizes 1:2" if part.startswith("sizes") and grains["spread"] > 0.55 else part for part in parts)


def left_out(library):
    """Each kind of grains by the law of all others: points with prediction, its half width and that of the point itself added in quadrature."""
    found = []
    for grains in kinds(library.columns):
        others, points = Library(left_out=grains), Points(library.columns, **grains)
        mean, covariance = others.normal("mu", grains, points.I)
        law = np.exp(mean)
        half = np.hypot(NORMAL_99 * law * np.sqrt(np.diag(covariance)), points.mu_ci99)
        found += [{"grains": said(grains), "I": float(i), "mu": float(m), "mu_ci99": float(c), "law": float(p), "half": float(h), "inside": bool(abs(m - p) <= h)}
                  for i, m, c, p, h in zip(points.I, points.mu, points.mu_ci99, law, half)]
    return found


def power(x, y, y_ci99):
    """Exponent of y over x and the half width of its 99 % interval, from points with intervals."""
    weight = y / (y_ci99 / NORMAL_99)
    (slope, _), covariance = np.polyfit(np.log(x), np.log(y), 1, w=weight, cov="unscaled")
    misfit = np.sum((weight * (np.log(y) - np.polyval(np.polyfit(np.log(x), np.log(y), 1, w=weight), np.log(x)))) ** 2) / (len(x) - 2)
    return float(slope), float(scipy.stats.t.ppf(0.995, len(x) - 2) * math.sqrt(covariance[0, 0] * max(1.0, misfit)))


def friction_exponent(points):
    """(mu at I = 0, exponent of mu - mu(0)), each with its half width."""
    chosen = (points.I_of_mass < FITTED_I[1])
    x, y, error = points.I_of_mass[chosen], points.mu[chosen], points.mu_ci99[chosen] / NORMAL_99
    (zero, _, exponent), covariance = scipy.optimize.curve_fit(lambda i, m, a, e: m + a * i**e, x, y, p0=(y[0] * 0.95, 1, 0.6), sigma=error, absolute_sigma=True,
                                                               bounds=([0, 0, 0.05], [1, 20, 3]), maxfev=20000)
    t = scipy.stats.t.ppf(0.995, max(1, len(x) - 3))
    return [float(zero), float(t * math.sqrt(covariance[0, 0]))], [float(exponent), float(t * math.sqrt(covariance[2, 2]))]


def exponents(columns):
    """By friction: b of each of the three powers, and mu at I = 0."""
    found = []
    for grains in kinds(columns):
        if any(not math.isclose(grains[name], BASE[name]) for name in GRAINS[1:]):
            continue
        points = Points(columns, **grains)
        chosen = (points.I_of_mass > FITTED_I[0]) & (points.I_of_mass < FITTED_I[1])
        zero, of_mu = friction_exponent(points)
        x = points.I_of_mass[chosen]
        speed = power(x, points.dv_over_shear[chosen], points.dv_over_shear_ci99[chosen])
        row = {"friction": grains["friction"], "mu_0": zero, "b_of_mu": [(1 - of_mu[0]) / 2, of_mu[1] / 2], "b_of_dv": [-speed[0], speed[1]], "b_of_sliding": None}
        if grains["friction"] > 0:
            row["b_of_sliding"] = list(power(x, points.sliding_share[chosen], points.sliding_share_ci99[chosen]))
        found.append(row)
    return found


def pooled(rows, name):
    """Weighted mean over the frictions above 0 with Student's t of their spread."""
    value, half = np.array([row[name] for row in rows if row["friction"] > 0 and row[name]]).T
    weight = 1 / half**2
    middle = np.average(value, weights=weight)
    spread = math.sqrt(np.average((value - middle) ** 2, weights=weight) / (len(value) - 1))
    return [float(middle), float(scipy.stats.t.ppf(0.995, len(value) - 1) * max(spread, 1 / math.sqrt(weight.sum()) / NORMAL_99))]


def line(points, name, most=0.2):
    """Intercept and slope over I of mass up to `most`, with half widths."""
    chosen = points.I_of_mass <= most
    x, y, error = points.I_of_mass[chosen], getattr(points, name)[chosen], getattr(points, name + "_ci99")[chosen] / NORMAL_99
    (slope, middle), covariance = np.polyfit(x, y, 1, w=1 / error, cov="unscaled")
    return {"intercept": [float(middle), float(NORMAL_99 * math.sqrt(covariance[1, 1]))], "slope": [float(slope), float(NORMAL_99 * math.sqrt(covariance[0, 0]))]}


def at(points, name, inertial):
    place = int(np.argmin(abs(np.log(points.I_of_mass / inertial))))
    return [float(getattr(points, name)[place]), float(getattr(points, name + "_ci99")[place])]


def findings(library, out):
    columns = library.columns
    start = time.process_time()
    library.normal("mu", BASE, columns["I"][:1])
    narrow = columns["mu_ci99"] < 0.03 * columns["mu"]
    base = Points(columns)
    rows = exponents(columns)
    rolling = [Points(columns, rolling_resistance=r) for r in (0, 0.05, 0.1, 0.3)]
    return {
        "runs": int(library.header["runs"]), "points": len(narrow), "points_below_3_percent": float(narrow.mean()), "kinds": len(kinds(columns)),
        "median_interval": float(np.median(columns["mu_ci99"] / columns["mu"])), "steady_runs": int(columns["steady"].sum()), "runs_of_points": int(columns["seeds"].sum()),
        "left_out": {"coverage": float(np.mean([one["inside"] for one in out])), "points": len(out),
                     "median_half_width": float(np.median([one["half"] / one["law"] for one in out])), "missed": [one for one in out if not one["inside"]]},
        "da_cruz": {"mu": line(base, "mu"), "nu": line(base, "nu"),
                    "rms_of_their_mu": float(np.sqrt(np.mean((base.mu - 0.25 - 1.1 * base.I_of_mass) ** 2))),
                    "rms_of_their_nu": float(np.sqrt(np.mean((base.nu - 0.81 + 0.3 * base.I_of_mass) ** 2)))},
        "exponents": rows, "b": {name: pooled(rows, name) for name in ("b_of_mu", "b_of_dv", "b_of_sliding")},
        "over_friction": {f"I = {i:g}": [[grains["friction"], *at(Points(columns, friction=grains["friction"]), "mu", i)] for grains in
                                         kinds(columns) if all(math.isclose(grains[n], BASE[n]) for n in GRAINS[1:])] for i in (0.001, 0.01, 0.08, 0.3)},
        "over_rolling_resistance": [{"rolling_resistance": r, **{name: at(points, name, 0.001) for name in ("mu", "nu", "fabric")}}
                                    for r, points in zip((0, 0.05, 0.1, 0.3), rolling) if len(points.I)],
        "over_restitution": [{"restitution": e, "mu": [at(Points(columns, restitution=e), "mu", i) for i in (0.01, 0.08, 0.3)]}
                             for e in (0.1, 0.5, 0.9) if len(Points(columns, restitution=e).I)],
        "seconds": time.process_time() - start}


def lines_by_friction(library, name, label, reference, file):
    figure, (axes,) = style.panels(1, height=5)
    values = sorted({grains["friction"] for grains in kinds(library.columns)})
    for place, value in enumerate(values):
        points = Points(library.columns, friction=value)
        if not len(points.I):
            continue
        colour = plt.cm.viridis(place / len(values))
        axes.errorbar(points.I_of_mass, getattr(points, name), getattr(points, name + "_ci99"), fmt="o", ms=4, color=colour, capsize=2)
        x = np.geomspace(points.I.min(), points.I.max(), 60)
        mean, _ = library.normal(name, BASE | {"friction": value}, x)
        axes.plot(x * math.sqrt(math.pi) / 2, np.exp(mean) if name == "mu" else mean, color=colour, lw=1.2, label=f"{value:g}")
    x = np.geomspace(1e-3, 0.3, 60)
    axes.plot(x, reference(x), "k--", lw=1.2, label="da Cruz et al., 0.4")
    axes.set(xscale="log", xlabel=r"$I = \dot\gamma\sqrt{m/P}$", ylabel=label)
    axes.legend(title="friction of grains", ncols=2)
    style.save(figure, file, False)


def by_grains(library, file):
    figure, panels = style.panels(6, 2, sharex=True)
    for column, friction in enumerate((0.4, 0.2)):
        base = Points(library.columns, friction=friction)
        for axes, name in zip(panels[column::2], GRAINS[1:]):
            for place, value in enumerate(sorted({g[name] for g in kinds(library.columns) if math.isclose(g["friction"], friction)})):
                points = Points(library.columns, friction=friction, **{name: value})
                common = np.isin(points.I, base.I)
                if not common.any():
                    continue
                reference = base.mu[np.isin(base.I, points.I)]
                axes.errorbar(points.I_of_mass[common] * 1.04**place, points.mu[common] / reference, points.mu_ci99[common] / reference, fmt="o-", ms=3, lw=0.8, capsize=2,
                              label="1:2" if name == "spread" and value > 0.55 else f"{value:g}")
            axes.set(xscale="log", title=f"friction {friction:g}: {WORDS[name]}")
            style.room_above(axes, 0.45)
            axes.legend(loc="upper left", ncols=2)
    for axes in panels[::2]:
        axes.set_ylabel(r"$\mu$ over that of the axis")
    for axes in panels[-2:]:
        axes.set_xlabel(r"$I = \dot\gamma\sqrt{m/P}$")
    style.save(figure, file, False)


def of_left_out(out, file):
    figure, axes = plt.subplots(figsize=(6.4, 5.6))
    for inside, colour in ((True, style.PARTICLES), (False, style.CONTINUUM)):
        chosen = [one for one in out if one["inside"] == inside]
        axes.errorbar([one["mu"] for one in chosen], [one["law"] for one in chosen], [one["half"] for one in chosen], fmt="o", ms=3, lw=0.7, color=colour,
                      label=f"{len(chosen)} points {'inside' if inside else 'outside'} the 99 % interval")
    ends = [min(one["mu"] for one in out), max(one["mu"] for one in out)]
    axes.plot(ends, ends, "k-", lw=0.8)
    axes.set(xlabel=r"$\mu$ measured", ylabel=r"$\mu$ of the law without these grains")
    axes.legend()
    style.save(figure, file, False)


def of_exponents(library, rows, file):
    figure, (left, middle, right) = style.panels(3, height=3.6)
    for place, row in enumerate(rows):
        points, colour = Points(library.columns, friction=row["friction"]), plt.cm.viridis(place / len(rows))
        rise = points.mu - row["mu_0"][0]
        for axes, y, half in ((left, rise, points.mu_ci99), (middle, points.dv_over_shear, points.dv_over_shear_ci99),
                              (right, points.sliding_share, points.sliding_share_ci99)):
            shown = np.isfinite(y) & (y > 0)
            axes.errorbar(points.I_of_mass[shown], y[shown], half[shown], fmt="o-", ms=3, lw=0.7, color=colour, label=f"{row['friction']:g}")
    x = np.array(FITTED_I)
    for axes, exponent, start, label in ((left, 0.6, 0.02, r"$\mu-\mu(0)$"), (middle, -0.2, 6, r"$\delta v/(\dot\gamma d)$"), (right, 0.2, 0.15, "share of sliding contacts")):
        axes.plot(x, start * (x / x[0]) ** exponent, "k--", label="b = 0.2")
        axes.set(xscale="log", yscale="log", xlabel=r"$I = \dot\gamma\sqrt{m/P}$", ylabel=label)
    right.legend(title="friction", loc="center left", bbox_to_anchor=(1, 0.5))
    style.save(figure, file, False)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    parser.add_argument("--record", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    style.use_style()
    library = Library()
    out = left_out(library)
    found = findings(library, out)
    whole_file.write_text(arguments.record, json.dumps(found, indent=1) + "\n")
    lines_by_friction(library, "mu", r"$\mu$", lambda i: 0.25 + 1.1 * i, arguments.output / "laws-mu.png")
    lines_by_friction(library, "nu", r"$\nu$", lambda i: 0.81 - 0.3 * i, arguments.output / "laws-nu.png")
    by_grains(library, arguments.output / "laws-grains.png")
    of_left_out(out, arguments.output / "laws-left-out.png")
    of_exponents(library, found["exponents"], arguments.output / "laws-exponents.png")
    print(json.dumps(found["left_out"] | {"missed": len(found["left_out"]["missed"])}), found["b"], found["points_below_3_percent"])


if __name__ == "__main__":
    main()
