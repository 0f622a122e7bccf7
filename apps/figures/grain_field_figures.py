"""Grains coloured by volume fraction and by pressure: grains.png in RUN/measured, of the last snapshot with fields."""

import math

import h5py
import matplotlib.colors
import matplotlib.patches
import matplotlib.pyplot as plt
import numpy as np

import script
import style
from result_files import number_of

HIGHEST = 6.0  # in, of one map
LEAST_SHARE = 1e-3  # pressures below this share of the largest are drawn as none
NO_CELL = "#E69F00"  # grains without a cell


class Fields:
    """One file of measured/grains."""

    def __init__(self, path):
        with h5py.File(path) as stored:
            self.of = {name: values[:] for name, values in stored["grains"].items()}
            self.radius = number_of(stored["container/radius"])
            self.axis_z = number_of(stored["container/z"])
            self.period = number_of(stored["period_x"])
            self.time_s = number_of(stored["time"]) * number_of(stored["scales/time_s"])
        self.x, self.z = self.of["x"], self.of["z"]
        if self.period > 0:
            self.x = np.mod(self.x, self.period)

    def limits(self):
        if self.radius > 0:
            low = np.array([-self.radius, self.axis_z - self.radius])
            high = np.array([self.radius, (self.z + self.of["radius"]).max()])
        else:
            low = np.array([(self.x - self.of["radius"]).min(), (self.z - self.of["radius"]).min()])
            high = np.array([(self.x + self.of["radius"]).max(), (self.z + self.of["radius"]).max()])
        margin = 0.01 * (high - low).max() + 0.2
        return low - margin, high + margin


def add_map(figure, axes, fields, values, inches, label, **colours):
    discs = style.discs(axes, fields.x, fields.z, fields.of["radius"], np.ma.masked_invalid(values), linewidths=min(0.05 * inches * 72, 0.8),
                        edgecolors="white", **colours)
    discs.get_cmap().set_bad(NO_CELL)
    if fields.radius > 0:
        axes.add_patch(matplotlib.patches.Circle((0, fields.axis_z), fields.radius, fill=False, edgecolor="0.15",
                                                 linewidth=1.6))
    axes.axhline(0, color="0.4", linewidth=0.8, linestyle="--")
    axes.set_ylabel(r"$z$  [$d$]")
    axes.set_title(label)
    figure.colorbar(discs, ax=axes, extend="both", shrink=0.9)


def add_pressure(figure, axes, fields, inches):
    pressure = (fields.of["sigma_xx_contact"] + fields.of["sigma_zz_contact"]) / 2
    largest = np.nanquantile(pressure, 0.99) if np.isfinite(pressure).any() else math.nan
    if not largest > 0:
        largest = 1.0
    add_map(figure, axes, fields, np.where(np.isnan(pressure), np.nan, np.maximum(pressure, LEAST_SHARE * largest)),
            inches, r"pressure of the contacts  [$\rho_0 g d$]", cmap=plt.get_cmap("magma").copy(),
            norm=matplotlib.colors.LogNorm(LEAST_SHARE * largest, largest))


def draw(fields, number, reduced):
    low, high = fields.limits()
    size = high - low
    beside = 2.2  # in, of labels and bar
    inches = min((style.WIDEST - beside) / size[0], HIGHEST / size[1])
    known = "sigma_zz_contact" in fields.of  # not in an imported snapshot that does not know its contacts
    count = 2 if known else 1
    figure, panels = plt.subplots(count, 1, figsize=(max(size[0] * inches, 2.6) + beside, count * (max(size[1] * inches, 1) + 0.6) + 0.8), sharex=True,
                                  squeeze=False)
    panels = panels[:, 0]
    for axes in panels:
        axes.set_aspect("equal")
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        axes.grid(False)
    add_map(figure, panels[0], fields, fields.of["nu"], inches, r"$\nu$ in the grain's cell",
            cmap=plt.get_cmap("viridis").copy(), norm=matplotlib.colors.Normalize(0.6, 0.9))
    if known:
        add_pressure(figure, panels[1], fields, inches)
    panels[-1].set_xlabel(r"$x$, downslope  [$d$]" if fields.radius > 0 else r"$x$  [$d$]")
    figure.suptitle(style.title_of(f"snapshot {number}, t = {fields.time_s:.2f} s", reduced))
    return figure


def main():
    folder, content = script.measured_folder()
    last = max((folder / "grains").glob("*.h5"))
    style.use_style()
    plt.rcParams["savefig.dpi"] = 130
    style.save(draw(Fields(last), int(last.stem), content["reduced"]), folder / "grains.png", content["reduced"])


if __name__ == "__main__":
    main()
