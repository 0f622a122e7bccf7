"""What the colour of a grain may show: values, range, words and the scale beside the picture."""

import h5py
import matplotlib.cm
import matplotlib.colors
import numpy as np

STILL = 1e-6  # sqrt(g d), sqrt(g/d): what rests moves by rounding; no colours for that
DECADES = 1e-3  # three of them below nearly the fastest: the slow creep deep in a packing is seen beside the flow
FLAT = 20  # the middle nine tenths of speeds that differ by less are drawn from 0 on a linear scale
MOST_CONTACTS = 6  # of a grain among grains of its size
MATERIALS = ["#56B4E9", "#D55E00", "#009E73", "#CC79A7", "#F0E442", "#0072B2", "#E69F00", "#000000"]


class Colour:
    """One of the quantities for a set of snapshots: the same norm in all of them."""

    def __init__(self, name, snapshots, drawing):
        self.name, self.cmap, self.ticks, self.names = name, "viridis", None, None
        self.edges, self.extend = "white", "both"
        values = np.concatenate([self.of(grains) for grains in snapshots])
        values = values[np.isfinite(values)]
        if not len(values):  # no grain in any of them: any scale will do
            values = np.ones(1)
        getattr(self, "scale_" + name)(values, drawing)
        self.words = self.words_of(snapshots[0])

    def words_of(self, grains):
        words = {"speed": "speed in the frame of the drum" if grains.drum_spin != 0 else "speed",
                 "spin": "spin of the grains, positive clockwise", "size": "diameters", "material": "materials",
                 "pressure": "pressure of each grain's contacts over its disc", "coordination": "loaded contacts of each grain",
                 "id": "numbers of the grains"}
        return words[self.name]

    def of(self, grains):
        return getattr(self, "of_" + self.name)(grains)

    @staticmethod
    def of_speed(grains):
        return np.maximum(grains.speed, STILL * DECADES)

    @staticmethod
    def of_spin(grains):
        if grains.spin is None:
            raise SystemExit("--color spin: the grains of this scene have no spin")
        return grains.spin

    @staticmethod
    def of_size(grains):
        return 2 * grains.radius

    @staticmethod
    def of_pressure(grains):
        """Half the sum of F_a b_a, b from the contact to the centre: r f_n of each contact."""
        i, j = grains.contacts["i"], grains.contacts["j"]
        total = np.bincount(i, grains.radius[i] * grains.force, len(grains.radius))
        between = j >= 0
        total += np.bincount(j[between], grains.radius[j[between]] * grains.force[between], len(grains.radius))
        return total / (2 * np.pi * grains.radius ** 2)

    @staticmethod
    def of_coordination(grains):
        i, j = grains.contacts["i"], grains.contacts["j"]
        return (np.bincount(i, minlength=len(grains.radius)) + np.bincount(j[j >= 0], minlength=len(grains.radius))).astype(float)

    @staticmethod
    def of_material(grains):
        return grains.material.astype(float)

    @staticmethod
    def of_id(grains):
        return grains.id.astype(float)

    def scale_speed(self, values, _):
        fast, self.label = max(np.quantile(values, 0.998), STILL), r"speed  [$\sqrt{gd}$]"
        slow, high = np.quantile(values, [0.05, 0.95])
        if high < FLAT * slow:
            self.norm, self.extend = matplotlib.colors.Normalize(0, fast), "max"
        else:
            self.norm = matplotlib.colors.LogNorm(DECADES * fast, fast)

    def scale_spin(self, values, _):
        most = max(np.quantile(np.abs(values), 0.99), STILL)
        self.norm, self.cmap, self.edges = matplotlib.colors.Normalize(-most, most), "RdBu_r", "0.75"
        self.label = r"spin  [$\sqrt{g/d}$]"

    def scale_size(self, values, _):
        low, high = values.min(), values.max()
        sizes = np.unique(np.round(values, 6))
        self.label, self.extend = r"diameter  [$d$]", "neither"
        if len(sizes) <= len(MATERIALS):  # a colour for each
            edges = np.concatenate([[low - 0.1], (sizes[1:] + sizes[:-1]) / 2, [high + 0.1]])
            self.cmap, self.norm = matplotlib.colors.ListedColormap(MATERIALS[:len(sizes)]), matplotlib.colors.BoundaryNorm(edges, len(sizes))
            self.ticks, self.names = (edges[1:] + edges[:-1]) / 2, [f"{size:.3g}" for size in sizes]
            return
        self.norm = (matplotlib.colors.LogNorm if high > 4 * low else matplotlib.colors.Normalize)(low, max(high, 1.001 * low))

    def scale_pressure(self, values, _):
        most = max(np.quantile(values, 0.99), STILL)
        self.norm, self.cmap = matplotlib.colors.Normalize(0, most), "magma_r"
        self.edges, self.label, self.extend = "0.6", r"pressure  [$\rho_0 g d$]", "max"

    def scale_coordination(self, values, _):
        most = max(MOST_CONTACTS, int(values.max())) if values.max() < 12 else 12
        self.cmap = matplotlib.cm.get_cmap("viridis", most + 1)
        self.norm, self.ticks = matplotlib.colors.BoundaryNorm(np.arange(-0.5, most + 1), most + 1), range(most + 1)
        self.label, self.extend = "loaded contacts", "neither"

    def scale_material(self, _, drawing):
        self.names = drawing["materials"]
        count = len(self.names)
        self.cmap = matplotlib.colors.ListedColormap([MATERIALS[k % len(MATERIALS)] for k in range(count)])
        self.norm, self.ticks = matplotlib.colors.BoundaryNorm(np.arange(-0.5, count), count), range(count)
        self.label, self.extend, self.edges = "", "neither", "0.3"

    def scale_id(self, values, _):
        self.norm, self.cmap = matplotlib.colors.Normalize(values.min(), max(values.max(), values.min() + 1)), "turbo"
        self.label, self.extend = "number of the grain, from 0", "neither"

    def add_scale(self, figure, axes, discs):
        bar = figure.colorbar(discs, ax=axes, extend=self.extend, shrink=0.85, label=self.label)
        if self.ticks is not None:
            bar.set_ticks(list(self.ticks))
            bar.ax.minorticks_off()
        if self.names is not None:
            bar.set_ticklabels(self.names)
        return bar


def id_of(file, count):
    """Numbers that stay with their grains, where the snapshot has them; else the place in the list."""
    with h5py.File(file) as snapshot:
        return snapshot["grains/id"][:] if "grains/id" in snapshot else np.arange(count)
