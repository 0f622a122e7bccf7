"""Figure of the part `forces` of `drumlin measure`: how contact forces are distributed and where they point."""

import math

import numpy as np

import result_files
import script
import style

ZONES = {"flowing": style.PARTICLES, "static": style.CONTINUUM, "wall": style.OTHERS[0]}
NAMES = {"flowing": "flowing layer", "static": "static phase", "bulk": "bulk", "wall": "at the drum"}
LEAST_COUNT = 10  # contacts in a bin that is drawn


class Forces:
    """Rows of force_distributions.csv by zone and quantity, scalars of "forces" in measured.json."""

    def __init__(self, folder, content):
        self.header, self.layers = style.read_profiles(folder / "forces.csv")
        self.zones = content["forces"]["zones"] or {}
        self.rows = {}
        for row in result_files.read_rows(folder / "force_distributions.csv"):
            self.rows.setdefault((row["zone"], row["quantity"]), []).append(row)

    def shown_zones(self):
        """Flowing and static where the run has them, else the bulk."""
        shown = [zone for zone in ZONES if zone in self.zones]
        return shown if any(zone != "wall" for zone in shown) else ["bulk"] * ("bulk" in self.zones) + shown

    def name(self, zone):
        return "at the wall" if zone == "wall" and not float(self.header.get("drum_radius", 0)) > 0 else NAMES[zone]

    def scalar(self, zone, name):
        return style.value_of(self.zones[zone].get(name))

    def curve(self, zone, quantity, least=LEAST_COUNT):
        """Middles of the bins with enough contacts, values, half widths."""
        rows = [row for row in self.rows.get((zone, quantity), []) if row["contacts"] >= least]
        return np.array([[(row["from"] + row["to"]) / 2, row["value"], row["ci99"]] for row in rows]).reshape(-1, 3).T


def densities(axes, forces, quantity, xlabel):
    for zone in forces.shown_zones():
        x, y, half = forces.curve(zone, quantity)
        color = ZONES.get(zone, style.PARTICLES)
        style.band(axes, x, y, half, color, forces.name(zone), foot=0.1, markersize=3)
    style.log_scale(axes, "y")
    axes.set_xlabel(xlabel)
    axes.set_ylabel("probability density")


def strong_forces(axes, forces):
    densities(axes, forces, "f_n", r"$f_n/\langle f_n\rangle$")
    for zone in forces.shown_zones():
        beta = forces.scalar(zone, "tail_exponent")
        x, y, _ = forces.curve(zone, "f_n")
        start = y[x > 1]
        if zone != "wall" and math.isfinite(beta) and start.size:
            axes.plot([1, 6], [start[0], start[0] * math.exp(-5 * beta)], "--", linewidth=1,
                      color=ZONES.get(zone, style.PARTICLES), label=rf"$e^{{-{beta:.2f} f}}$")
    axes.set_xlim(0, 8)
    axes.set_ylim(bottom=1e-4)
    axes.set_title("Normal forces")
    axes.legend(loc="upper right")


def weak_forces(axes, forces):
    densities(axes, forces, "f_n", r"$f_n/\langle f_n\rangle$")
    style.log_scale(axes, "x")
    axes.set_ylim(1e-3, 30)
    axes.set_title("The same, weak forces")


def friction(axes, forces):
    densities(axes, forces, "f_t_over_f_n", r"$|f_t|/f_n$")
    axes.set_title("Mobilised friction")


def polar(axes, forces, quantity, harmonics, title):
    """Measured by direction, and the second harmonic on it as a line."""
    line = np.radians(np.arange(361))
    for zone in forces.shown_zones():
        phi, value, _ = forces.curve(zone, quantity)
        if zone == "wall" or not phi.size:
            continue
        color = ZONES.get(zone, style.PARTICLES)
        closed = np.radians(np.concatenate([phi, phi + 180, phi[:1]]))
        axes.plot(closed, np.abs(np.concatenate([value, value, value[:1]])), "o:", markersize=3.5, linewidth=0.8, color=color)
        axes.plot(line, np.abs(harmonics(zone, line)), color=color, linewidth=1.2)
    axes.set_title(title)
    axes.set_yticklabels([])


def directions(forces, quantity):
    """The function of direction that a zone's second harmonic stands for; `quantity` is c (contacts), n (normal force) or t (tangential)."""
    def harmonic(zone, line):
        a, twice = forces.scalar(zone, "a_" + quantity), 2 * (line - math.radians(forces.scalar(zone, f"phi_{quantity}_deg")))
        mean = 1 / (2 * math.pi) if quantity == "c" else forces.curve(zone, "f_n_of_direction", 0)[1].mean()
        return mean * (a * np.sin(twice) if quantity == "t" else 1 + a * np.cos(twice))

    return harmonic


def over_depth(axes, forces):
    layers, z = forces.layers, forces.layers["z"]
    for name, color, label in (("a_c", style.PARTICLES, "$a_c$"), ("a_n", style.CONTINUUM, "$a_n$"),
                               ("a_t", style.OTHERS[0], "$a_t$"), ("a_c4", style.OTHERS[1], "$a_{c4}$")):
        style.band(axes, z, layers[name], layers.get(name + "_ci99"), color, label)
    axes.set_ylim(0, 1)
    axes.set_xlabel(style.axis_label("z"))
    axes.set_title("Anisotropies by layer")
    axes.legend(loc="upper left", ncols=2)


def stress_ratio(axes, forces):
    layers, z = forces.layers, forces.layers["z"]
    style.band(axes, z, layers["stress_ratio"], layers.get("stress_ratio_ci99"), style.PARTICLES, r"$|\tau|/p$")
    axes.plot(z, layers["stress_ratio_harmonics"], color=style.CONTINUUM, label="carried by the harmonics")
    axes.plot(z, layers["half_sum"], color="k", linestyle="--", linewidth=1, label=r"$(a_c + a_n + a_t)/2$")
    axes.set_ylim(0, 0.8)
    axes.set_xlabel(style.axis_label("z"))
    axes.set_title("Stress ratio")
    axes.legend(loc="upper left")


def main():
    folder, content = script.measured_folder()
    if content.get("forces") is None:
        return  # no contacts: nothing was measured
    forces = Forces(folder, content)
    style.use_style()
    figure, places = style.places([1, 2, 2, 2, 1], 3)
    for place, draw in zip(places, (strong_forces, weak_forces, friction)):
        draw(figure.add_subplot(place), forces)
    for place, quantity, name, title in ((places[3], "c", "contacts_of_direction", r"Contacts $E(\varphi)$"),
                                         (places[4], "n", "f_n_of_direction", r"Normal force $\langle f_n\rangle(\varphi)$"),
                                         (places[5], "t", "f_t_of_direction", r"Tangential force $|\langle f_t\rangle|(\varphi)$")):
        polar(figure.add_subplot(place, projection="polar"), forces, name, directions(forces, quantity), title)
    for place, draw in zip(places[6:], (over_depth, stress_ratio)):
        draw(figure.add_subplot(place), forces)
    style.save(figure, folder / "forces.png", content["reduced"])


if __name__ == "__main__":
    main()
