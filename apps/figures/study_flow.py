"""The paper's Figs. 1 to 7: packing, velocities, spin."""

import math

import matplotlib.pyplot as plt

import style
from drum_maps import read_grains
from style import FIT
from study_panels import (depth_panel, draw, draw_logarithmic, limits_of, lowest_shown, none_if_nan, over_flow_rate, speed_legend, speed_marks)
from study_runs import WALL_MARGIN, color_of, label_of, marker_of, shown

PAPER = {"color": style.PAPER, "marker": "x", "markersize": 7, "markeredgewidth": 1.6, "linestyle": "none"}


def snapshot(study):
    run = study.main_run()
    files = sorted((run.folder / "snapshots").glob("*.h5"))
    if not files or float(run.header["drum_radius"]) == 0:
        return None
    R = float(run.header["drum_radius"])
    grains = read_grains(files[-1], float(run.header["theta_deg"]), float(run.header["axis_depth"]))
    figure, (axes,) = style.panels(1, height=4.2)
    discs = style.discs(axes, *(grains[name] for name in ("x", "z", "radius", "speed")), cmap="viridis", linewidths=0)
    center = float(run.header["axis_depth"])
    axes.add_patch(plt.Circle((0, center), R, fill=False, color="0.2", linewidth=1.5))
    half = float(run.header["slice_width"]) / 2
    bottom = center - math.sqrt(R * R - half * half)
    axes.add_patch(plt.Rectangle((-half, bottom), 2 * half, 2 - bottom, fill=False, color=style.CONTINUUM, linewidth=1.5))
    axes.set_aspect("equal")
    axes.set_xlim(-1.03 * R, 1.03 * R)
    axes.set_ylim(center - 1.03 * R, 0.25 * R)
    axes.grid(False)
    axes.set_xlabel(r"$x$  [$d$]")
    axes.set_ylabel(style.axis_label("z"))
    figure.colorbar(discs, ax=axes, label=r"speed in the frame of the drum  [$\sqrt{gd}$]", shrink=0.75)
    return (figure, f"Fig. 1: a snapshot, {label_of(run)}",
            "typical snapshot of the steady surface flow; the slice in its middle is what is averaged over.",
            f"last snapshot of {run.name}, turned so that the mean surface lies level; the slice is framed.")


def volume_fraction(study):
    run = study.main_run()
    figure, (axes,) = style.panels(1, height=4.6)
    depth_panel(axes, run, style.axis_label("nu"))
    draw(axes, run, "nu")
    axes.axhline(0.7, color="0.6", linestyle="--", linewidth=1)
    axes.set_ylim(0, 0.95)
    inset = axes.inset_axes([0.2, 0.13, 0.56, 0.5])
    depth_panel(inset, run, "", run.wall + WALL_MARGIN)
    draw(inset, run, "nu")
    bulk = study.at_main_speed("nu_bulk")
    if math.isfinite(bulk["value"]):
        inset.axhline(bulk["value"], color=FIT, linewidth=1)
        inset.set_ylim(bulk["value"] - 0.05, bulk["value"] + 0.03)
    inset.set_xlim(run.wall + WALL_MARGIN, 0.5)
    inset.set_xlabel("")
    return (figure, f"Fig. 2: volume fraction, {label_of(run)}",
            "0.82 in the bulk, a slight decrease in the flowing layer; drops to zero over 3 to 4 d at the surface, over 2 to "
            "3 d at the drum.",
            f"{shown(bulk)} in the bulk; lower in the flowing layer than below it by "
            f"{shown(study.at_main_speed('nu_flowing_drop'))}; widths {shown(study.at_main_speed('nu_surface_width'))} d at the "
            f"surface, {shown(study.at_main_speed('nu_wall_width'))} d at the drum.")


def velocity(study):
    run = study.main_run()
    figure, (left, right) = style.panels(2, height=4.4)
    H, rate, decay = (run.scalar(name) for name in ("H", "shear_rate", "lambda"))
    depth_panel(left, run, style.axis_label("v_x"), lowest_shown([run], -45))
    draw(left, run, "v_x")
    depth_panel(right, run, style.axis_label("shear_rate"), lowest_shown([run], -45))
    draw(right, run, "shear_rate")
    if math.isfinite(H):
        left.plot([-H, 0], [0, rate * H], color=FIT, zorder=5, label=rf"$\dot\gamma$ = {rate:.3f},  $H$ = {H:.1f} $d$")
        right.plot([-H, 0], [rate, rate], color=FIT, zorder=5, label=rf"$\dot\gamma$ = {rate:.3f}")
    if study.is_papers:
        paper_H = [row["H"] for row in study.table if abs(row["rotation_rpm"] - run.rpm) < 0.05]
        paper_rate = study.paper_value("shear_rate", round(run.rpm))
        if paper_H and math.isfinite(paper_rate):
            left.plot([-paper_H[0], 0], [0, paper_rate * paper_H[0]], color=style.PAPER, linestyle="--", linewidth=1.2,
                      label=rf"paper: {paper_rate:g},  {paper_H[0]:g} $d$")
            right.axhline(paper_rate, color=style.PAPER, linestyle="--", linewidth=1.2, label=f"paper: {paper_rate:g}")
    right.set_ylim(-0.02, limits_of(run, "shear_rate", run.z < 0)[1] * 1.25)
    left.legend(loc="upper left", bbox_to_anchor=(0.04, 0.36))
    right.legend(loc="upper left", bbox_to_anchor=(0.04, 0.36))
    for axes, name in ((left, "v_x"), (right, "shear_rate")):
        inset = axes.inset_axes([0.1, 0.46, 0.42, 0.5])
        draw_logarithmic(inset, run, name, size=2)
        if math.isfinite(decay):
            window = run.content["settings"]["decay_window_below_H"]
            z = [-H - window[1], -H - window[0]]
            amplitude = math.exp(run.content["fits"]["decay_log_rate"])
            factor = 1 if name == "shear_rate" else decay
            inset.plot(z, [factor * amplitude * math.exp(at / decay) for at in z], color=FIT, linewidth=2.5, zorder=5)
            inset.text(0.05, 0.86, rf"$\lambda$ = {decay:.2f} $d$", transform=inset.transAxes, color=FIT)
        inset.set_xlim(run.wall, 4)
    return (figure, f"Fig. 3: velocity and shear rate, {label_of(run)}",
            "a linear flowing layer with a shear rate of about 0.15 and H = 14.6, an exponential tail with lambda = 3.4.",
            f"shear rate {shown(study.at_main_speed('shear_rate'))}, H {shown(study.at_main_speed('H'))}, lambda "
            f"{shown(study.at_main_speed('lambda'))}; the line misses v_x by {shown(study.at_main_speed('line_misfit'), 2)} of "
            f"the surface's speed (rms), yet the shear rate changes by {shown(study.at_main_speed('shear_rate_change'), 2)} of "
            "itself from the lower half of the line to the upper.")


def velocity_along_x(study):
    run = study.main_run()
    if len(run.slices) < 2:
        return None
    figure, (left, right) = style.panels(2, height=4.4)
    colors = plt.get_cmap("coolwarm")
    entries = {entry["position"]: entry for entry in run.content.get("slices", [])}
    for n, (columns, place) in enumerate(zip(run.slices.values(), style.place_labels(list(run.slices)))):
        color = colors(n / (len(run.slices) - 1)) if n != (len(run.slices) - 1) / 2 else "0.2"
        label = f"$x$ = {place} $d$"
        style.band(left, columns["z"], columns["v_x"], columns["v_x_ci99"], color, label, marker="o")
        right.plot(columns["z"], style.positive(columns["v_x"]), "o-", color=color, label=label)
    for axes in (left, right):
        axes.axvline(0, linestyle="-.", color="0.4", linewidth=1)
        axes.set_xlabel(r"$z$ from the surface at $x$  [$d$]")
        axes.set_ylabel(style.axis_label("v_x"))
    deepest = min((z for columns in run.slices.values() for z in columns["z"]), default=-50)
    left.set_xlim(max(-40, deepest - 1), 4)
    right.set_xlim(max(-50, deepest - 1), 4)
    right.set_yscale("log")
    left.legend(loc="upper left")
    rates = [entry["shear_rate"] for entry in entries.values() if entry.get("shear_rate")]
    decays = [entry["lambda"] for entry in entries.values() if entry.get("lambda")]
    found = "not measured" if not rates or not decays else (
        f"shear rate {min(rates):.3f} to {max(rates):.3f}, lambda {min(decays):.2f} to {max(decays):.2f} in slices 2 d wide.")
    return (figure, f"Fig. 4: velocity {style.at_places(len(run.slices))}, {label_of(run)}",
            "the shape stays the same; shear rate and lambda depend weakly on the place.", found)


def velocity_over_speed(study):
    figure, (left, middle, right) = style.panels(3, height=4)
    for run in study.first_runs():
        draw(left, run, "v_x", color_of(study, run.rpm), label_of(run), marker=marker_of(run.rpm))
    style.depth_axes(left, math.nan, style.axis_label("v_x"), "-.")
    left.set_xlim(lowest_shown(study.first_runs(), -45), 4)
    left.legend(loc="upper left")

    over_flow_rate(middle, study, "lambda", r"$\lambda$  [$d$]", scale=True)
    middle.set_ylim(0, None)
    over_flow_rate(right, study, "shear_rate", r"$\dot\gamma$  [$\sqrt{g/d}$]", scale=True)
    rates = [rate for rate in study.speed_values("shear_rate")[0] if math.isfinite(rate)]
    right.set_ylim(0, 1.35 * max(rates, default=1))
    if study.is_papers:
        paper = next(e for e in study.observables if e["name"] == "lambda" and "half_width" in e)
        middle.axhspan(paper["value"] - paper["half_width"], paper["value"] + paper["half_width"], color="0.5", alpha=0.25,
                       linewidth=0, label=f"paper: {paper['value']:g} ± {paper['half_width']:g}")
        middle.legend(loc="lower right")
        right.plot(study.paper_column("Q"), [paper_shear_rate(study, row["theta_deg"]) for row in study.table], color="k",
                   linestyle="--", linewidth=1.2, label="paper's law at its own slopes")
        right.legend(loc="upper left")
    inset = right.inset_axes([0.56, 0.26, 0.42, 0.28])
    scaling_inset(inset, study)
    c = study.law("shear_rate_com", "c")
    return (figure, "Fig. 5: velocity profiles of all speeds, decay length and shear rate over Q",
            "lambda = 3 ± 0.3 independent of Q; shear rate from 0.1 to 0.25, as "
            "0.75 sqrt(sin theta - sin Phi)/sqrt(cos Phi) with Phi = 17.4 deg.",
            f"lambda {shown(study.mean('lambda'))}, changing by {shown(study.trend('lambda'), 2)} of itself over Q; the scaling "
            f"gives c = {shown(c)} and Phi = {shown(study.law('shear_rate_com', 'Phi_deg'))} deg with the slope of the centre "
            f"of mass, c = {shown(study.law('shear_rate', 'c'))} and Phi = {shown(study.law('shear_rate', 'Phi_deg'))} deg with "
            "that of the surface. Inset: the former; solid through the origin, dashed with a free offset.")


def paper_shear_rate(study, theta_deg):
    Phi = math.radians(study.paper_law("shear_rate", "Phi_deg"))
    pull = (math.sin(math.radians(theta_deg)) - math.sin(Phi)) / math.cos(Phi)
    return study.paper_law("shear_rate", "c") * math.sqrt(pull) if pull > 0 else math.nan


def scaling_inset(axes, study):
    """Shear rate against Rajchenbach's scaling, slope of the centre of mass."""
    Phi = math.radians(study.law("shear_rate_com", "Phi_deg")["value"])
    rates, halves = study.speed_values("shear_rate")
    slopes, _ = study.speed_values("theta_com_deg")
    largest = 0
    for speed, slope, rate, half in zip(study.speeds, slopes, rates, halves):
        pull = (math.sin(math.radians(slope)) - math.sin(Phi)) / math.cos(Phi)
        if not pull > 0:
            continue
        largest = max(largest, math.sqrt(pull))
        rpm = speed["rotation_rpm"]
        axes.errorbar(math.sqrt(pull), rate, none_if_nan(half), fmt=marker_of(rpm), color=color_of(study, rpm), markersize=5, elinewidth=1)
    x = [0, 1.1 * largest]
    c = study.law("shear_rate_com", "c")["value"]
    offset, slope = (study.law("shear_rate_with_offset_com", name)["value"] for name in ("g0", "c"))
    axes.plot(x, [c * at for at in x], color=FIT, linewidth=1.4)
    axes.plot(x, [offset + slope * at for at in x], color=FIT, linewidth=1, linestyle="--")
    axes.set_xlabel(r"$\sqrt{(\sin\theta-\sin\Phi)/\cos\Phi}$")
    axes.set_ylabel(r"$\dot\gamma$")
    axes.set_xlim(0, None)
    axes.set_ylim(0, None)


def depth_and_friction(study):
    figure, (left, right) = style.panels(2, height=4.4)
    over_flow_rate(left, study, "H", r"$H$  [$d$]", scale=True)
    Q, _ = study.speed_values("Q")
    Q = [0 if math.isnan(q) or q < 0 else q for q in Q]
    grid = [max(max(Q), 1) * 1.1 * i / 100 for i in range(1, 101)]
    c, power = study.law("flowing_layer_depth", "c"), study.law("flowing_layer_depth_power", "p")
    scale = study.law("flowing_layer_depth_power", "c")
    left.plot(grid, [c["value"] * math.sqrt(q) for q in grid], color=FIT, label=rf"${c['value']:.2f}\,\sqrt{{Q}}$")
    if math.isfinite(scale["value"]):
        left.plot(grid, [scale["value"] * q ** power["value"] for q in grid], color=FIT, linestyle="--",
                  label=rf"${scale['value']:.2f}\,Q^{{{power['value']:.2f}}}$")
    if study.is_papers:
        left.plot(study.paper_column("Q"), study.paper_column("H"), label="paper", **PAPER)
    left.set_ylim(0, None)
    left.legend(loc="upper left")
    inset = left.inset_axes([0.62, 0.21, 0.36, 0.28])
    H, half = study.speed_values("H")
    for speed, q, h, dh in zip(study.speeds, Q, H, half):
        rpm = speed["rotation_rpm"]
        inset.errorbar(math.sqrt(q), h, none_if_nan(dh), fmt=marker_of(rpm), color=color_of(study, rpm), markersize=5, elinewidth=1)
    inset.plot([0, math.sqrt(grid[-1])], [0, c["value"] * math.sqrt(grid[-1])], color=FIT, linewidth=1.4)
    if study.is_papers:
        inset.plot([math.sqrt(q) for q in study.paper_column("Q")], study.paper_column("H"), **(PAPER | {"markersize": 5}))
    inset.set_xlabel(r"$\sqrt{Q}$")
    inset.set_ylabel(r"$H$")

    over_flow_rate(right, study, "mu_eff", r"$\mu_{\mathrm{eff}} = \tan\theta$", scale=True)
    c0, c1 = study.law("effective_friction", "c0"), study.law("effective_friction", "c1")
    if math.isfinite(c0["value"]):
        right.plot([0, grid[-1]], [c0["value"], c0["value"] + c1["value"] * grid[-1]], color=FIT,
                   label=rf"surface: ${c0['value']:.3f} + {1e3 * c1['value']:.2f}\cdot10^{{-3}}\,Q$")
    com, com_half = study.speed_values("mu_eff_com")
    right.errorbar(Q, com, [0 if math.isnan(half) else half for half in com_half], fmt="o", color=style.OTHERS[1], fillstyle="none", markersize=6, elinewidth=1, zorder=4)
    m0, m1 = study.law("effective_friction_com", "c0"), study.law("effective_friction_com", "c1")
    if math.isfinite(m0["value"]):
        right.plot([0, grid[-1]], [m0["value"], m0["value"] + m1["value"] * grid[-1]], color=style.OTHERS[1],
                   label=rf"centre of mass (open): ${m0['value']:.3f} + {1e3 * m1['value']:.2f}\cdot10^{{-3}}\,Q$")
    if study.is_papers:
        right.plot(study.paper_column("Q"), [math.tan(math.radians(t)) for t in study.paper_column("theta_deg")],
                   label="paper", **PAPER)
    right.add_artist(right.legend(loc="upper left"))
    right.legend(handles=speed_marks(right, study), loc="lower right", ncol=2)
    return (figure, "Fig. 6: depth of the flowing layer and effective friction over Q",
            "H = 3 sqrt(Q); mu_eff = 0.31 + 1.9e-3 Q.",
            f"H = c sqrt(Q) with c = {shown(c)}, with a free power Q^p p = {shown(power)}; mu_eff = {shown(c0)} + ({shown(c1)}) Q "
            f"by the slope of the surface, {shown(m0)} + ({shown(m1)}) Q by that of the centre of mass. Grey: each run.")


def spin(study):
    run = study.main_run()
    if not run.has("omega"):
        return None
    figure, (axes, over_vorticity) = style.panels(2, height=3.8)
    depth_panel(axes, run, style.axis_label("omega"), lowest_shown([run], -50))
    draw(axes, run, "omega", label="mean spin")
    axes.plot(run.z, run.columns["shear_rate"] / 2, color=FIT, label=r"$\frac{1}{2}\,dv_x/dz$")
    axes.set_ylim(-0.01, 1.35 * limits_of(run, "omega", run.z < 0)[1])
    axes.legend(loc="upper left")
    for one in study.first_runs():
        rows = one.off_ends(1)
        over_vorticity.plot(one.columns["shear_rate"][rows], one.columns["omega"][rows], marker_of(one.rpm), color=color_of(study, one.rpm), markersize=3)
    largest = over_vorticity.get_xlim()[1]
    over_vorticity.plot([0, largest], [0, largest / 2], color="k", linewidth=1)
    over_vorticity.set_xlabel(r"$dv_x/dz$  [$\sqrt{g/d}$]")
    over_vorticity.set_ylabel(style.axis_label("omega"))
    speed_legend(over_vorticity, study, loc="upper left")
    return (figure, f"Fig. 7: mean spin, {label_of(run)}; below: over the vorticity, all speeds",
            "omega = 1/2 dv_x/dz in the whole packing, at every Q.",
            f"omega over half of dv_x/dz is {shown(study.mean('spin_over_half_vorticity'))} in the flowing layer over all speeds "
            f"(it changes by {shown(study.trend('spin_over_half_vorticity'), 2)} over Q) and "
            f"{shown(study.mean('spin_over_half_vorticity_static'))} below it.")
