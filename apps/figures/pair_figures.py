"""Figures of a pair, particles and continuum over time, and what moves on its page.

usage: pair_figures.py PAIR_JSON PARTICLES CONTINUUM FOLDER

PARTICLES and CONTINUUM are files of frames; FOLDER takes heights.png, maps.png, differences.png, series.png and motion.json (docs/formats/pair.md).
"""

import base64
import json
import pathlib
import sys
import zlib

import matplotlib.pyplot as plt
import numpy as np

import script
import style
import whole_file
from drumlin.pair import frames, measures

COLOURS = 64
NONE = 255  # no material there
MOST_BYTES = 1_000_000  # of one side and field in what moves, before compression
MOVING = {"speed": ("viridis", "√(gd)"), "p": ("magma", "ρ₀gd")}


def speed(side):
    return np.hypot(side.fields["v_x"], side.fields["v_z"])


def shown_times(side, count):
    """Evenly spread from the origin until the material stops."""
    times = side.frames.times
    last = np.flatnonzero(~(times > measures.stopped(times, side.scalars["kinetic_energy"])))[-1]
    return np.unique(np.linspace(0, last, count).round().astype(int))


def extent(sides):
    """Part of the plane that ever holds material of either, with 2 d around: x and z from, to."""
    there = np.any([np.isfinite(side.fields["v_x"]).any(axis=0) for side in sides], axis=0)
    columns, rows = np.flatnonzero(there.any(axis=0)), np.flatnonzero(there.any(axis=1))
    x, z = sides[0].frames.x, sides[0].frames.z
    return x[columns[0]] - 2, x[columns[-1]] + 2, z[rows[0]] - 2, z[rows[-1]] + 2


def panels(sides, rows, columns):
    """Axes to scale, one place of the plane in all of them."""
    x0, x1, z0, z1 = extent(sides)
    figure, axes = style.maps(rows * columns, columns, x1 - x0, z1 - z0, sharex=True, sharey=True)
    axes = np.array(axes).reshape(rows, columns)
    for each in axes.flat:
        each.set(xlim=(x0, x1), ylim=(z0, z1), aspect="equal")
        each.grid(False)
    for each in axes[-1]:
        each.set_xlabel("$x$  [$d$]")
    for each in axes[:, 0]:
        each.set_ylabel("$z$  [$d$]")
    return figure, axes


def heights(sides):
    """Surfaces at six times: the ensemble's mean with the 99 % interval of its mean, and the continuum."""
    particles, continuum = sides
    x, each = particles.frames.x, np.nan_to_num(particles.frames.height - particles.floor).clip(0)
    half = measures.interval(each)[1]
    chosen = shown_times(particles, 6)
    figure, axes = style.panels(len(chosen), height=1.7, sharex=True, sharey=True)
    for row, t in zip(axes, chosen):
        for side, colour, label, band in ((particles, style.PARTICLES, "particles", half[t]), (continuum, style.CONTINUUM, "continuum", None)):
            style.band(row, x, np.where(side.h[t] > 0, side.h[t], np.nan), band, colour, label, marker="")
        row.set_title(rf"$t$ = {particles.frames.times[t]:.3g} $\sqrt{{d/g}}$", loc="right")
        row.set_ylabel("$h$  [$d$]")
    axes[0].legend(loc="upper right")
    axes[-1].set_xlabel("$x$  [$d$]")
    axes[-1].set_xlim(extent(sides)[:2])
    return figure


def maps(sides):
    """Speeds side by side at four times, on one scale a row."""
    chosen = shown_times(sides[0], 5)[1:]
    figure, axes = panels(sides, len(chosen), 2)
    for row, t in zip(axes, chosen):
        values = [speed(side)[t] for side in sides]
        top = max(np.nanmax(values[0], initial=0, where=np.isfinite(values[0])), 1e-9)
        for cell, side, value, name in zip(row, sides, values, ("particles", "continuum")):
            image = cell.pcolormesh(side.frames.x, side.frames.z, value, shading="nearest", cmap="viridis", vmin=0, vmax=top, rasterized=True)
            cell.plot(side.frames.x, np.where(side.h[t] > 0, side.h[t] + side.floor, np.nan), color="0.3", linewidth=0.8)
            cell.set_title(f"{name}, $t$ = {side.frames.times[t]:.3g}")
        figure.colorbar(image, ax=row, label=r"speed  [$\sqrt{gd}$]")
    return figure


def differences(sides):
    """Continuum less particles at four times: velocity along x and pressure; grey where one side alone has material."""
    chosen = shown_times(sides[0], 5)[1:]
    figure, axes = panels(sides, len(chosen), 2)
    for column, (name, label) in enumerate((("v_x", r"$\Delta v_x$  [$\sqrt{gd}$]"), ("p", r"$\Delta p$  [$\rho_0gd$]"))):
        for cell, t in zip(axes[:, column], chosen):
            a, b = (side.fields[name][t] for side in sides)
            largest = max(np.nanquantile(np.abs(b - a), 0.99) if np.isfinite(b - a).any() else 0, 1e-9)
            one = np.isfinite(a) != np.isfinite(b)
            grid = sides[0].frames
            cell.pcolormesh(grid.x, grid.z, np.where(one, 0.7, np.nan), shading="nearest", cmap="gray", vmin=0, vmax=1, rasterized=True)
            image = cell.pcolormesh(grid.x, grid.z, b - a, shading="nearest", cmap="RdBu_r", vmin=-largest, vmax=largest, rasterized=True)
            cell.set_title(f"$t$ = {grid.times[t]:.3g}")
            figure.colorbar(image, ax=cell, label=label)
    return figure


def series(content):
    """Over time: run-outs, centre of mass, loads, what was discharged, kinetic energy, errors beside their noise floors."""
    times, drawn = np.array(content["times"]), []

    def numbers(values):
        return np.array([np.nan if value is None else value for value in np.atleast_1d(np.array(values, object))], float)

    def entry(values):
        return numbers(values["particles"]), numbers(values["ci99"]), numbers(values["continuum"])

    for least, values in content["run_out"].items():
        drawn.append((f"run-out at $h$ > {least} $d$", entry(values)))
    for name, label in (("centre_x", "centre of mass, $x$  [$d$]"), ("centre_z", "centre of mass, $z$  [$d$]"), ("discharged", "discharged  [$d^2$]"),
                        ("discharge_rate", r"rate  [$d\sqrt{gd}$]"), ("kinetic_energy", r"kinetic energy  [$\rho_0gd^3$]")):
        if name in content["scalars"] and np.nanmax(np.abs(numbers(content["scalars"][name]["particles"])), initial=0) > 0:
            drawn.append((label, entry(content["scalars"][name])))
    for name, load in content["loads"].items():
        component = "xz".index(load["component"])
        across = {side: [at[component] for at in load[side]] for side in ("particles", "ci99", "continuum")}
        drawn.append((f"load on {style.plain(name)}  [$\\rho_0gd^2$]", entry(across)))
    figure, axes = style.panels(len(drawn) + 1, 2, 3)
    for cell, (label, (mean, half, other)) in zip(axes, drawn):
        style.band(cell, times, mean, np.nan_to_num(half), style.PARTICLES, "particles", marker="")
        cell.plot(times, other, color=style.CONTINUUM, label="continuum")
        cell.set(xlabel=r"$t$  [$\sqrt{d/g}$]", ylabel=label)
    last = axes[len(drawn)]
    for error, label, colour in ((content["heights"]["rms"], "$h$, rms over $H_0$", style.OTHERS[0]),
                                 (content["errors"]["v"]["flowing"], "$v$, where it flows", style.OTHERS[1])):
        last.plot(times, numbers(error["value"]), color=colour, label=label)
        if np.size(error["floor"]) > 1:
            last.plot(times, numbers(error["floor"]), color=colour, linestyle=":")
    last.set(xlabel=r"$t$  [$\sqrt{d/g}$]", ylabel="error (dotted: noise floor)")
    style.log_scale(last, "y")
    last.legend()
    axes[0].legend()
    return figure


def levels(values, top):
    """Bytes, a zlib stream in base64: 0 to COLOURS - 1 up to `top`, NONE where there is nothing."""
    scaled = np.clip(np.nan_to_num(values) / top * COLOURS, 0, COLOURS - 1)
    stream = zlib.compress(np.where(np.isfinite(values), scaled, NONE).astype(np.uint8).tobytes(), 9)
    return base64.b64encode(stream).decode("ascii")


def motion(sides):
    """Both sides frame by frame: every second (third, ...) frame and node where all would be more than a page can carry."""
    times, (x0, x1, z0, z1) = sides[0].frames.times, extent(sides)
    x, z = sides[0].frames.x, sides[0].frames.z
    columns, rows = np.flatnonzero((x >= x0) & (x <= x1)), np.flatnonzero((z >= z0) & (z <= z1))
    coarser = max(1, int(np.ceil(np.sqrt(len(columns) * len(rows) * min(len(times), 120) / MOST_BYTES))))
    columns, rows, kept = columns[::coarser], rows[::coarser], np.arange(len(times))[::-(-len(times) // 120)]
    content = {"times": times[kept].tolist(), "x": x[columns][[0, -1]].tolist() + [len(columns)], "z": z[rows][[0, -1]].tolist() + [len(rows)],
               "places": x[columns].round(3).tolist(), "fields": []}
    for name, (palette, unit) in MOVING.items():
        if name != "speed" and name not in sides[0].fields:
            continue
        values = [(speed(side) if name == "speed" else side.fields[name])[np.ix_(kept, rows, columns)] for side in sides]
        top = max(float(np.nanquantile(values[0], 0.995)) if np.isfinite(values[0]).any() else 0, 1e-9)
        colours = [plt.matplotlib.colors.to_hex(colour) for colour in plt.get_cmap(palette)(np.linspace(0, 1, COLOURS))]
        content["fields"].append({"name": name, "unit": unit, "top": top, "colours": colours, "sides": [levels(value, top) for value in values]})

    def outline(h, floor):
        return [[None if not up > 0 else round(float(up + low), 2) for up, low in zip(one, floor)] for one in h]
    content["surfaces"] = [outline(side.h[np.ix_(kept, columns)], side.floor[columns]) for side in sides]
    return content


def main():
    content, folder = script.content_of(sys.argv[1]), pathlib.Path(sys.argv[4])
    read = [frames.read_frames(file) for file in sys.argv[2:4]]
    floor = measures.floor_height(*read)
    sides = [measures.Mean(one, floor) for one in read]
    style.use_style()
    script.save_each({"heights": lambda: heights(sides), "maps": lambda: maps(sides), "differences": lambda: differences(sides),
                      "series": lambda: series(content)}, folder, content["reduced"])
    whole_file.write_text(folder / "motion.json", json.dumps(motion(sides)))


if __name__ == "__main__":
    main()
