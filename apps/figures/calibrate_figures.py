"""Figure of `drumlin calibrate`: the layers of all runs over I, the fitted law and its 99 % band."""

import argparse
import math

import matplotlib.pyplot as plt

import style

QUANTILE_99 = 2.576


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("profiles", nargs="+", help="profiles.csv of each run")
    parser.add_argument("--output", required=True, help="the figure")
    for name in ("a", "b", "var-a", "cov-ab", "var-b", "I-min", "I-max", "rms", "surface-margin", "wall-margin"):
        parser.add_argument("--" + name, type=float, required=True)
    parser.add_argument("--reduced", action="store_true")
    return parser.parse_args()


def layers_of(path, options):
    """Layers with a positive I and a known mu: those of the fit, and all others."""
    header, columns = style.read_profiles(path)
    wall = float(header.get("wall_z", columns["z"][0]))
    fitted, others = [], []
    for i, z in enumerate(columns["z"]):
        inertial, friction = columns["I"][i], columns["mu"][i]
        if not (inertial > 0 and math.isfinite(friction)):
            continue
        inside = wall + options.wall_margin <= z <= -options.surface_margin
        in_range = options.I_min * (1 - 1e-9) <= inertial <= options.I_max * (1 + 1e-9)
        error = columns["mu_ci99"][i] if "mu_ci99" in columns else math.nan
        (fitted if inside and in_range else others).append((inertial, friction, 0 if math.isnan(error) else error))
    return header, fitted, others


def draw_law(axes, options):
    """The law over its range, with the band of its covariance."""
    steps = 100
    log_range = math.log(options.I_max / options.I_min)
    inertial = [options.I_min * math.exp(log_range * i / steps) for i in range(steps + 1)]
    law = [options.a + options.b * math.log(x) for x in inertial]
    half = [QUANTILE_99 * math.sqrt(max(0, options.var_a + 2 * math.log(x) * options.cov_ab
                                        + math.log(x) ** 2 * options.var_b)) for x in inertial]
    axes.plot(inertial, law, color=style.PAPER,
              label=rf"$\mu = {options.a:.3f} {options.b:+.4f}\,\ln I$,  rms {options.rms:.3f}")
    axes.fill_between(inertial, [y - h for y, h in zip(law, half)], [y + h for y, h in zip(law, half)],
                      color="0.5", alpha=0.4, linewidth=0, label="99 % of the fit")


def main():
    options = arguments()
    style.use_style()
    figure, axes = plt.subplots()
    colors = [style.PARTICLES, style.CONTINUUM] + style.OTHERS
    for i, path in enumerate(options.profiles):
        header, fitted, others = layers_of(path, options)
        color = colors[i % len(colors)]
        label = rf"run {i + 1}, $\theta$ = {float(header['theta_deg']):.1f}°"
        if fitted:
            axes.errorbar(*zip(*fitted), fmt="o", color=color, elinewidth=1, label=label)
        if others:
            axes.plot([p[0] for p in others], [p[1] for p in others], "o", color=color, fillstyle="none", alpha=0.6)
    draw_law(axes, options)
    axes.set_xscale("log")
    axes.set_xlim(left=options.I_min / 30)
    axes.set_xlabel(style.LABELS["I"])
    axes.set_ylabel(style.LABELS["mu"])
    axes.set_title(style.title_of("Friction law; open: layers left out", options.reduced))
    axes.legend(loc="upper left")
    style.save(figure, options.output, options.reduced)


if __name__ == "__main__":
    main()
