"""Figures of a continuum flow: maps.png (speed, I, pressure, mu over drum or annulus), profiles.png (at the centre of a drum,
else across the gap, with the closed form), and what speaks for it: well_posedness.png, newton.png, sensitivity.png.

usage: flow_figures.py FLOWRUN FLOW_JSON   (the name of flow.json in the folder, or of what will become it)
"""

import math
import pathlib
import sys

import matplotlib.colors
import numpy as np
import quantity_table
import result_files
import script
import style
from drum_maps import read_maps
from flow_trust import newton, sensitivity, well_posedness


def outline(header, surface):
    """Lines around the domain of maps.h5, none around a strip; `surface` is that of flow.json, null where it has not moved."""
    if "drum_radius" in header:
        radius, axis_depth = float(header["drum_radius"]), float(header["axis_depth"])
        if surface:
            x, z = np.array(surface["x"]), np.array(surface["z"]) - surface["z_middle"]
            angle = np.linspace(*(math.atan2(x[i], axis_depth - z[i]) for i in (0, -1)), 200)
            return [(radius * np.sin(angle), axis_depth - radius * np.cos(angle)), (x, z)]
        half = math.acos(axis_depth / radius)
        angle = np.linspace(-half, half, 200)
        return [(radius * np.sin(angle), axis_depth - radius * np.cos(angle)),
                ([-radius * math.sin(half), radius * math.sin(half)], [0, 0])]
    if "inner_radius" not in header:
        return []
    angle = np.linspace(0, 2 * math.pi, 400)
    return [(float(header[name]) * np.cos(angle), float(header[name]) * np.sin(angle))
            for name in ("inner_radius", "outer_radius")]


def draw_map(axes, grids, values, label, norm, cmap, header, surface):
    axes.grid(False)
    image = axes.pcolormesh(grids["x"], grids["z"], values, norm=norm, cmap=cmap, shading="nearest", rasterized=True)
    for x, z in outline(header, surface):
        axes.plot(x, z, color="black", linewidth=1)
    axes.set_aspect("equal")
    axes.set_title(label)
    axes.set_xlabel(r"$x$  [$d$]" + (", downslope" if "drum_radius" in header else ""))
    axes.set_ylabel(style.axis_label("z"))
    axes.figure.colorbar(image, ax=axes, shrink=0.8, extend="both")


def title(flow):
    slope = f", slope {flow['theta_deg']:.2f} deg" if flow.get("theta_deg") is not None else ""
    return f"Continuum flow, {flow['geometry'].replace('_', ' ')}{slope}"


def maps(flow, header, grids):
    radius = float(header.get("drum_radius", header.get("outer_radius")))
    frame = "in the frame of the drum" if "drum_radius" in header else "in the laboratory frame"
    speed = np.ma.hypot(grids["v_x"], grids["v_z"])
    figure, axes = style.maps(4, 2, np.ptp(grids["x"]), np.ptp(grids["z"]))
    log = matplotlib.colors.LogNorm
    under_tension = " (white: $p < 0$)" if (grids["p"] <= 0).any() else ""
    top = float(speed.max())
    panels = [(speed, r"speed  [$\sqrt{gd}$]", log(top * 1e-4, top), "viridis"),
            (grids["I"], "$I$" + under_tension, log(1e-5, 1), "viridis"),
            (grids["p"], style.axis_label("p"),
             matplotlib.colors.Normalize(0, float(grids["p"].max())), "viridis"),
            (grids["mu"], r"$\mu = |\tau|/p$" + under_tension, matplotlib.colors.Normalize(0, 0.4), "viridis")]
    for place, (values, label, norm, cmap) in zip(axes, panels):
        draw_map(place, grids, values, label, norm, cmap, header, flow.get("surface"))
    # A few arrows on the map of the speed; the directions alone, for the speeds span decades.
    step = max(1, int(radius / 12 / (grids["x"][1] - grids["x"][0])))
    cut = (slice(None, None, step), slice(None, None, step))
    x, z = np.meshgrid(grids["x"], grids["z"])
    axes[0].quiver(x[cut], z[cut], (grids["v_x"] / speed)[cut], (grids["v_z"] / speed)[cut], color="white", alpha=0.7,
                      scale=32, width=0.0025)
    ill_posed = grids["well_posedness_margin"] < 0
    if ill_posed.any():
        axes[1].contourf(grids["x"], grids["z"], ill_posed.astype(float), levels=[0.5, 1.5], colors="none",
                            hatches=["////"])
        axes[1].set_title("$I$ (hatched: ill-posed)")
    figure.suptitle(style.title_of(f"{title(flow)};\nspeed {frame}", flow["reduced"]))
    return figure


def profiles(folder, flow):
    _, columns = style.read_profiles(folder / "profiles.csv")
    z, H = columns["z"], flow.get("H")
    figure, axes = style.panels(4, 2, 3.8, sharey=True)

    axes[0].plot(columns["v_x"], z, color=style.CONTINUUM, label="layer means" if flow["closed_form"] else None)
    for key, label in (("without_k", "without $k$"), ("without_nonlocal", "local")):
        if flow.get(key):
            plain = flow[key]["profile"]
            axes[0].plot(plain["v_x"], plain["z"], color=style.PAPER, linewidth=1, linestyle=":", label=label)
            axes[0].legend(loc="best")
    if flow["closed_form"]:
        exact = flow["closed_form"]["profile"]
        axes[0].plot(exact["v_x_closed_form"], exact["z"], color=style.PAPER, linewidth=1, linestyle="--", label="closed form")
        axes[0].legend(loc="best")
    if H is not None and flow.get("shear_rate") is not None:
        axes[0].plot([0, flow["shear_rate"] * H], [-H, 0], color=style.PAPER, linewidth=1, linestyle="--",
                     label=rf"line to $H$ = {H:.1f}")
        axes[0].legend(loc="lower right")
    axes[0].set_xlabel(style.axis_label("v_x"))
    for place in axes[::2]:
        place.set_ylabel(style.axis_label("z"))

    rate = style.positive(columns["shear_rate"])
    axes[1].semilogx(rate, z, color=style.CONTINUUM)
    known = [value for value in rate if math.isfinite(value)]
    if known and max(known) < 10 * min(known):  # a uniform shear is no occasion to magnify its rounding
        middle = math.sqrt(max(known) * min(known))
        axes[1].set_xlim(middle / 10, middle * 10)
    axes[1].set_xlabel(style.axis_label("shear_rate"))

    for name, color in zip(("sigma_xx", "sigma_zz", "sigma_xz"), style.OTHERS):
        axes[2].plot(columns[name], z, color=color, label=quantity_table.field(name).symbol())
    axes[2].legend()
    axes[2].set_xlabel(r"stress  [$\rho_0 g d$]")

    for name, color in zip(("mu", "k"), style.OTHERS):
        axes[3].plot(columns[name], z, color=color, label=quantity_table.field(name).symbol())
    axes[3].set_xlim(0, 1.5)
    axes[3].set_xticks([0, 0.5, 1, 1.5])
    axes[3].legend()
    axes[3].set_xlabel("ratio of stresses")

    if H is not None:
        for place in axes:
            place.axhline(-H, color="grey", linewidth=0.8, linestyle=":")
    where = ":\nat the centre of the drum, in its frame" if flow["geometry"] == "drum" else ": across the gap"
    figure.suptitle(style.title_of(title(flow) + where, flow["reduced"]))
    return figure


def series(folder, flow):
    """What a march in time leaves beside its last state."""
    _, _, columns = result_files.read_table(folder / "series.csv")
    shown = [("rotation_rpm", "speed [rpm]"), ("theta_deg", r"slope $\theta$ [deg]"), ("H", "$H$  [$d$]"),
             ("shear_rate", style.axis_label("shear_rate"))]
    figure, axes = style.panels(len(shown), height=2.2, sharex=True)
    for place, (name, label) in zip(axes, shown):
        place.plot(columns["time_s"], columns[name], color=style.CONTINUUM)
        place.set_ylabel(label)
    figure.align_ylabels(axes)
    axes[-1].set_xlabel("time [s]")
    figure.suptitle(style.title_of(f"March in time, {len(columns['time_s'])} steps", flow["reduced"]))
    return figure


def main():
    folder = pathlib.Path(sys.argv[1])
    flow = script.content_of(folder / sys.argv[2])
    style.use_style()
    header, grids = read_maps(folder / "maps.h5")
    drawings = {"profiles": lambda: profiles(folder, flow), "well_posedness": lambda: well_posedness(flow, header, grids, draw_map),
                "newton": lambda: newton(folder, flow), "sensitivity": lambda: sensitivity(flow)}
    if flow["geometry"] in ("drum", "annulus"):  # a strip is the same all along: its profiles say it all
        drawings["maps"] = lambda: maps(flow, header, grids)
    if "time" in flow:
        drawings["series"] = lambda: series(folder, flow)
    script.save_each(drawings, folder, flow["reduced"])


if __name__ == "__main__":
    main()
