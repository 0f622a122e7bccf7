"""Figures of `drumlin measure --radial, --height, --width`: the profiles in a frame of one's own, with 99 % bands."""

import functools

import numpy as np

import quantity_table
import result_files
import script
import style

LEAST_SHARE = 0.2  # of the densest layer's volume fraction: looser layers are not drawn
ROOM = 0.25  # beside the values, as a share of their range and zero: bands that reach further are cut
AXES = {"radial": r"distance from the {center}, $r$  [$d$]", "height": r"height $z$  [$d$]", "width": r"$x$  [$d$]"}
VELOCITY, STRESS, RATE = r"velocity  [$\sqrt{gd}$]", r"stress  [$\rho_0 g d$]", r"rate  [$\sqrt{g/d}$]"

SHARES = (r"$\nu$, $\rho/\rho_0$", False, ["nu", "density"])
STRESSES = (STRESS, False, ["sigma_zz", "sigma_xx", "sigma_xz", "sigma_yy"])
RATIOS = ("ratio of stresses", False, ["mu", "k"])

# By frame: panels of (label of the values, logarithmic, columns); a column that a scene does not have is left out, and a panel without any.
PANELS = {
    "radial": [(VELOCITY, False, ["v_t", "v_r"]), (r"$r\,|d(v_t/r)/dr|$  [$\sqrt{g/d}$]", True, ["shear_rate"]), (RATE, False, ["omega", "half_vorticity"]), SHARES,
               (STRESS, False, ["sigma_rr", "sigma_tt", "sigma_rt", "sigma_yy"]), RATIOS],
    "height": [(VELOCITY, False, ["v_z", "v_x"]), SHARES, STRESSES, RATIOS],
    "width": [(VELOCITY, False, ["v_z", "v_x"]), (RATE, False, ["d_v_z_dx", "omega"]), SHARES, STRESSES],
}


class Frame:
    """One table; layers that are too loose to be drawn are NaN, so that curves break there."""

    def __init__(self, file):
        _, self.header, columns = result_files.read_table(file, "drumlin-frame-1")
        self.name = self.header["frame"]
        self.coordinate, self.columns = next(iter(columns)), columns
        dense = columns["nu"] > LEAST_SHARE * max(columns["nu"], default=0)
        if dense.sum() > 1:  # a dense layer far from all others would stretch the axis
            dense &= np.convolve(dense, [1, 0, 1], "same") > 0
        shown = np.flatnonzero(dense)
        kept = slice(shown[0], shown[-1] + 1) if shown.size else slice(0)
        self.at = columns[self.coordinate][kept]
        self.values = {name: np.where(dense, column, np.nan)[kept] for name, column in columns.items()}

    def place(self):
        """What the frame is, as a title."""
        if self.name == "radial":
            return f"About x = {float(self.header['center_x']):g} d, z = {float(self.header['center_z']):g} d"
        across, what = ("x", "Over the height") if self.name == "height" else ("z", "Over the width")
        return f"{what}, {across} from {float(self.header[across + '_from']):g} to {float(self.header[across + '_to']):g} d"

    def label(self):
        return AXES[self.name].format(center=self.header.get("center", ""))


def curve(axes, frame, name, color, logarithmic):
    """A column with its band; over the height values run to the right and the coordinate upwards, as a silo stands."""
    upright, values, half = frame.name == "height", frame.values[name], frame.values.get(name + "_ci99")
    if logarithmic:  # either sense of turning
        values = style.positive(np.abs(values))
    axes.plot(*((values, frame.at) if upright else (frame.at, values)), "o-", color=color, label=quantity_table.field(name).symbol())
    if half is not None:
        low = values - half
        if logarithmic:  # a band that reaches zero ends at the foot of the axis
            low = np.maximum(low, 1e-2 * values)
        (axes.fill_betweenx if upright else axes.fill_between)(frame.at, low, values + half, color=color, alpha=0.25, linewidth=0)
    return values[np.isfinite(values)].tolist()


def panel(axes, frame, label, logarithmic, columns):
    upright = frame.name == "height"
    which, other = ("x", "y") if upright else ("y", "x")
    values = [value for color, name in zip(style.COLORS, columns) for value in curve(axes, frame, name, color, logarithmic)]
    if logarithmic:
        style.log_scale(axes, which)
        if values:
            getattr(axes, f"set_{which}lim")(min(values) / 3, max(values) * 3)
    elif values:
        low, high = min(*values, 0), max(*values, 0)
        room = ROOM * (high - low) + 1e-9
        getattr(axes, f"set_{which}lim")(low - room if low < 0 else -0.1 * room, high + room if high > 0 else 0.1 * room)
        (axes.axvline if upright else axes.axhline)(0, color="0.4", linewidth=1)
    if frame.at.size:
        getattr(axes, f"set_{other}lim")(frame.at[0] - 1, frame.at[-1] + 1)
    getattr(axes, f"set_{which}label")(label)
    if not upright or axes.get_subplotspec().is_first_col():
        getattr(axes, f"set_{other}label")(frame.label())
    axes.legend()


def figure_of(file):
    frame = Frame(file)
    known = [(label, logarithmic, [name for name in columns if name in frame.columns])
             for label, logarithmic, columns in PANELS[frame.name]]
    known = [entry for entry in known if entry[2]]
    figure, panels = style.panels(len(known), 2, 3.4)
    for axes, entry in zip(panels, known):
        panel(axes, frame, *entry)
    figure.suptitle(style.title_of(f"{frame.place()}; bands: 99 %", frame.header.get("reduced") == "true"))
    return figure


def main():
    folder, content = script.measured_folder()
    style.use_style()

    script.save_each({entry["frame"]: functools.partial(figure_of, folder / entry["file"]) for entry in content.get("frames", [])}, folder, content["reduced"])


if __name__ == "__main__":
    main()
