"""Figures of `drumlin measure`: the profiles at the centre with 99 % bands, and what was fitted to them."""

import functools
import math

import matplotlib.pyplot as plt
import numpy as np

import quantity_table
import result_files
import script
import style
from style import FIT, positive

WIDEST_SHARE = 0.6  # of a value, up to which the figure of the sensitivities reaches


class Measured:
    """Scalars and profiles of one run; what was not measured is NaN."""

    def __init__(self, folder, content):
        self.folder = folder
        self.header, self.columns = style.shown_layers(style.read_profiles(folder / "profiles.csv"))
        self.content, self.reduced = content, content["reduced"]
        self.z = self.columns["z"]

    def scalar(self, name):
        return style.value_of(self.content.get(name))

    def fit(self, name):
        return style.value_of(self.content["fits"][name])

    def half_width(self, name):
        return self.columns.get(name + "_ci99")

    def in_drum(self):
        return float(self.header.get("drum_radius", 0)) > 0

    def along(self):
        """What its profiles of v_x are called."""
        return "Velocity along the surface" if self.in_drum() else "Velocity along $x$"

    def range(self):
        """Range of z that is shown."""
        return (self.z.min() - 1, self.z.max() + 1) if self.z.size else (-1, 1)


def depth_panel(axes, run, name):
    """Axes over depth with the marks of the paper: dashed at the surface, dotted at the interface."""
    style.depth_axes(axes, run.scalar("H"), style.axis_label(name), "--")
    axes.set_xlim(*run.range())


def draw(axes, run, name, color=style.PARTICLES, label=None):
    if name in run.columns:
        style.band(axes, run.z, run.columns[name], run.half_width(name), color, label)


def draw_logarithmic(axes, run, name):
    if name in run.columns:
        style.band(axes, run.z, run.columns[name], run.half_width(name), style.PARTICLES, foot=1e-2)
        style.log_scale(axes, "y")


def line_of(run, value):
    """Points of a straight line value(z) from the interface to the surface."""
    z = [-run.scalar("H"), 0]
    return z, [value(at) for at in z]


def velocity(run):
    figure, (left, right) = style.panels(2)
    depth_panel(left, run, "v_x")
    draw(left, run, "v_x", label="measured, 99 %")
    H, rate, decay = run.scalar("H"), run.scalar("shear_rate"), run.scalar("lambda")
    if math.isfinite(H):
        left.plot(*line_of(run, lambda z: rate * (z + H)), color=FIT, zorder=5,
                  label=rf"$\dot\gamma$ = {rate:.3f},  $H$ = {H:.1f} $d$")
    left.set_title(run.along() + (", frame of the drum" if run.in_drum() else ""))
    left.legend(loc="upper left")

    depth_panel(right, run, "shear_rate")
    draw_logarithmic(right, run, "shear_rate")
    if math.isfinite(decay):
        window = run.content["settings"]["decay_window_below_H"]
        z = [-H - window[1], -H - window[0]]
        right.plot(z, [math.exp(run.fit("decay_log_rate") + at / decay) for at in z], color=FIT, linewidth=3, zorder=5,
                   label=rf"$\lambda$ = {decay:.2f} $d$")
        right.legend(loc="upper left")
    right.set_title("Shear rate")
    return figure


def packing(run):
    figure, axes = plt.subplots()
    depth_panel(axes, run, "nu")
    draw(axes, run, "nu", label="measured, 99 %")
    bulk, margin = run.scalar("nu_bulk"), run.content["settings"]["bulk_margin"]
    if math.isfinite(bulk):
        axes.plot([float(run.header["wall_z"]) + margin, -margin], [bulk, bulk], color=FIT, zorder=5,
                  label=rf"bulk: {bulk:.3f}")
    axes.axhline(run.content["settings"]["surface_nu"], color="0.4", linestyle="--", linewidth=1)
    axes.set_ylim(0, 1)
    axes.set_title(style.title_of("Volume fraction", run.reduced))
    axes.legend(loc="lower left")
    return figure


def rotation(run):
    figure, axes = plt.subplots()
    depth_panel(axes, run, "omega")
    draw(axes, run, "omega", label=r"mean spin $\omega$, 99 %")
    axes.plot(run.z, run.columns["shear_rate"] / 2, color=FIT, label=r"$\frac{1}{2}\,dv_x/dz$")
    axes.plot(run.z, run.columns["half_vorticity"], color=style.OTHERS[0], linestyle="--", label=r"$\frac{1}{2}\,(dv_x/dz - dv_z/dx)$")
    axes.set_title(style.title_of("Spin and vorticity", run.reduced))
    axes.legend(loc="upper left")
    return figure


def stresses(run):
    figure, (axes,) = style.panels(1, height=4.6)
    depth_panel(axes, run, "sigma_zz")
    names = {"sigma_zz": style.PARTICLES, "sigma_xx": style.OTHERS[0], "sigma_xz": style.OTHERS[1]}
    for name, color in names.items():
        draw(axes, run, name, color, quantity_table.field(name).symbol())
    theta, nu = math.radians(float(run.header["theta_deg"])), run.scalar("nu_bulk")
    if math.isfinite(nu):
        z = np.array([min(run.z, default=0), 0])
        axes.plot(z, -z * nu * math.cos(theta), color="k", linestyle="--", linewidth=1, label=r"$-z\,\nu\,\cos\theta$")
        axes.plot(z, -z * nu * math.sin(theta), color="k", linestyle=":", linewidth=1.4, label=r"$-z\,\nu\,\sin\theta$")
    axes.set_ylabel(r"stress  [$\rho_0 g d$]")
    axes.set_title(style.title_of("Stresses, compression positive", run.reduced))
    axes.legend(loc="upper right")
    return figure


def over_inertia(axes, run, name):
    """One ratio over I: below the surface, those near the wall open."""
    settings = run.content["settings"]
    wall = float(run.header["wall_z"]) + settings["mu_fit_wall_margin"]
    inertial, values, half = run.columns["I"], run.columns[name], run.half_width(name)
    shown = (run.z <= 0) & (inertial > 0) & np.isfinite(values)
    fitted = (wall <= run.z) & (run.z <= -settings["mu_fit_surface_margin"])
    error = np.zeros(len(values)) if half is None else np.nan_to_num(half)
    inner, outer = shown & fitted, shown & ~fitted
    axes.errorbar(inertial[inner], values[inner], error[inner], fmt="o", color=style.PARTICLES, elinewidth=1, label="measured, 99 %")
    axes.plot(inertial[outer], values[outer], "o", color=style.PARTICLES, fillstyle="none", label="at surface or wall")
    style.log_scale(axes, "x")
    axes.set_xlabel(style.axis_label("I"))
    axes.set_ylabel(style.axis_label(name))


def rheology(run):
    figure, (left, middle, right, last) = style.panels(4, 2, 3.4)
    depth_panel(left, run, "I")
    draw_logarithmic(left, run, "I")
    left.set_title("Inertial number")
    over_inertia(middle, run, "mu")
    a, b = run.scalar("mu_a"), run.scalar("mu_b")
    curve = run.content.get("friction_curve")
    if curve:
        middle.plot(curve["I"], curve["mu"], color=FIT, zorder=5,
                    label=rf"{a:.3f} {b:+.4f} ln $I$")
    middle.set_title("Effective friction")
    style.room_above(middle, 0.7)
    middle.legend(loc="upper left")
    over_inertia(right, run, "k")
    right.set_title("Ratio of the normal stresses")
    over_inertia(last, run, "nu")
    last.set_title("Volume fraction")
    return figure


def fluctuations(run):
    figure, panels = style.panels(2)
    settings = run.content["settings"]
    for axes, name, plateau, label in ((panels[0], "dv", "dv_over_shear", r"$\delta v / \dot\gamma$  [$d$]"),
                                       (panels[1], "domega", "domega_over_shear", r"$\delta\omega / \dot\gamma$")):
        depth_panel(axes, run, label)
        if name not in run.columns:
            axes.set_title("no spin in this scene")
            continue
        axes.plot(run.z, run.columns[name] / positive(run.columns["shear_rate"]), "o-", color=style.PARTICLES)
        style.log_scale(axes, "y")
        value = run.scalar(plateau)
        if math.isfinite(value):
            axes.plot([run.fit("fit_bottom"), -settings["surface_speed_depth"]], [value, value], color=FIT, zorder=5,
                      linewidth=3, label=f"flowing layer: {value:.2f}")
            axes.legend(loc="upper right")
    panels[0].set_title("Fluctuation of the velocity")
    panels[1].set_title("Fluctuation of the spin")
    return figure


GRADIENTS = ["d_sigma_zz_dz", "d_sigma_zz_dx", "d_sigma_xx_dz", "d_sigma_xx_dx", "d_sigma_xz_dz", "d_sigma_xz_dx", "d_nu_dx", "d_v_x_dx", "d_k_dx"]


def expected_gradients(run):
    """What a flow that does not vary along x would show."""
    theta, nu = math.radians(float(run.header["theta_deg"])), run.scalar("nu_bulk")
    return {"d_sigma_zz_dz": -nu * math.cos(theta), "d_sigma_xz_dz": -nu * math.sin(theta), "d_sigma_zz_dx": 0,
            "d_sigma_xx_dx": 0, "d_sigma_xz_dx": 0, "d_nu_dx": 0, "d_v_x_dx": 0, "d_k_dx": 0}


def within_packing(run, name):
    """The packing itself decides the range of an axis, not the last grains in the air or the layers at the wall."""
    values = run.columns[name][(float(run.header["wall_z"]) + 3 < run.z) & (run.z < -1)]
    values = np.append(values, expected_gradients(run).get(name, math.nan))
    values = values[np.isfinite(values)]
    low, high = (values.min(), values.max()) if values.size else (0, 0)
    margin = 0.6 * (high - low) + 1e-9
    return low - margin, high + margin


def gradients(run):
    figure, panels = style.panels(len(GRADIENTS), 2, 2.5)
    for axes, name in zip(panels, GRADIENTS):
        depth_panel(axes, run, name)
        draw(axes, run, name, label="measured, 99 %")
        expected = expected_gradients(run).get(name)
        if expected is not None and math.isfinite(expected):
            axes.axhline(expected, color=FIT, label="if nothing varied along x")
        axes.set_ylim(*within_packing(run, name))
    panels[-1].legend(*panels[0].get_legend_handles_labels(), loc="center")
    return figure


def slices(run):
    """v_x and nu in the narrow slices, from upstream to downstream."""
    figure, (left, right) = style.panels(2)
    colors = plt.get_cmap("viridis")
    entries = run.content["slices"]
    for i, (entry, place) in enumerate(zip(entries, style.place_labels([entry["position"] for entry in entries]))):
        columns = style.shown_layers(style.read_profiles(run.folder / entry["file"]))[1]
        color = colors(i / max(1, len(entries) - 1) * 0.9)
        style.band(left, columns["z"], columns["v_x"], columns.get("v_x_ci99"), color, f"x = {place} d")
        right.plot(columns["z"], positive(columns["shear_rate"]), "o-", color=color)
    for axes, name in ((left, "v_x"), (right, "shear_rate")):
        axes.set_xlabel(style.axis_label("z") + ", each from its own surface")
        axes.set_ylabel(style.axis_label(name))
        axes.axvline(0, color="0.4", linestyle="--", linewidth=1)
    style.log_scale(right, "y")
    left.legend(loc="upper left")
    left.set_title(f"{run.along()} {style.at_places(len(entries))}")
    right.set_title("Shear rate")
    return figure


def steadiness(run):
    """Energy and slope over the turns that were measured."""
    _, _, columns = result_files.read_table(run.folder / "series.csv")
    has_slope = np.isfinite(columns["theta_com_deg"][:1]).any()
    rotates = len(set(columns["turns"])) > 1
    shown = [("kinetic_energy", "kinetic energy" + (" in\nthe drum's frame" if has_slope and run.in_drum() else "") + "\n[$\\rho_0 g d^3$]", style.PARTICLES)]
    if has_slope:
        shown.append(("theta_com_deg", "angle of the\ncentre of mass  [deg]", style.OTHERS[0]))
    for name, label in (("pressure", "pressure over\nthe discs  [$\\rho_0 g d$]"), ("shear_stress", "shear stress over\nthe discs  [$\\rho_0 g d$]"),
                        ("shear_rate", "mean shear rate\n[$\\sqrt{g/d}$]")):
        if np.isfinite(columns.get(name, np.nan)).any():
            shown.append((name, label, style.OTHERS[0]))
    figure, panels = style.panels(len(shown), height=2.6, sharex=True)
    for axes, (name, label, colour) in zip(panels, shown):
        axes.plot(columns["turns" if rotates else "time"], columns[name], ".-", linewidth=0.8, color=colour)
        axes.set_ylabel(label)
    panels[0].set_ylim(bottom=0)
    panels[-1].set_xlabel("turns of the drum" if rotates else r"time  [$\sqrt{d/g}$]")
    verdict = run.content["steadiness"]
    title = "steady" if verdict["steady"] else style.plain("not steady: " + "; ".join(verdict["reasons"]))
    panels[0].set_title(style.title_of(title, run.reduced), fontsize="medium" if "\n" in title else None)
    return figure


def sensitivity(run):
    """How far each scalar goes under other windows, beside its interval; both relative to its value."""
    rows = []
    for name, entry in run.content.items():
        if isinstance(entry, dict) and "sensitivity" in entry and entry["value"]:
            windows = entry["sensitivity"]
            scale = abs(entry["value"])
            rows.append((name, (windows["lowest"] - entry["value"]) / scale, (windows["highest"] - entry["value"]) / scale,
                         (entry["ci99"] or 0) / scale))
    figure, (axes,) = style.panels(1, height=0.32 * len(rows) + 1.6)
    for row, (name, low, high, half) in enumerate(rows):
        axes.barh(row, 2 * half, left=-half, height=0.75, color=style.PARTICLES, alpha=0.25, linewidth=0)
        axes.plot([low, high], [row, row], color=FIT, linewidth=3, solid_capstyle="butt")
        axes.plot([0], [row], "k|", markersize=9)
        if half > WIDEST_SHARE or max(abs(low), abs(high)) > WIDEST_SHARE:  # leaves the figure: its numbers stand beside it
            axes.annotate(f" ±{half:.2g}, {low:+.2g} … {high:+.2g}", (WIDEST_SHARE, row), va="center", annotation_clip=False)
    axes.margins(y=0.01)
    axes.set_yticks(range(len(rows)), [name for name, *_ in rows])
    axes.invert_yaxis()
    axes.set_xlim(-WIDEST_SHARE, WIDEST_SHARE)
    axes.set_xlabel("relative to the value\nband: 99 % over time, line: by other windows")
    axes.set_title(style.title_of("What each scalar owes to its definition", run.reduced))
    return figure


def figures_of(run):
    """The figures of what was measured."""
    chosen = [velocity, packing, stresses, rheology, fluctuations, steadiness]
    if "omega" in run.columns:
        chosen.append(rotation)
    if "d_k_dx" in run.columns:
        chosen.append(gradients)
    if run.content.get("slices"):
        chosen.append(slices)
    if any(isinstance(entry, dict) and "sensitivity" in entry for entry in run.content.values()):
        chosen.append(sensitivity)
    return chosen


def main():
    folder, content = script.measured_folder()
    run = Measured(folder, content)
    style.use_style()
    script.save_each({one.__name__: functools.partial(one, run) for one in figures_of(run)}, folder, run.reduced)


if __name__ == "__main__":
    main()
