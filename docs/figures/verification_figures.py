"""Figures of docs/verification.md from what benchmark_flow_verification measured.

usage: verification_figures.py RESULT.json OUTPUT_FOLDER
Writes verification-orders.png and verification-gaps.png, and prints the observed orders.
"""

import math
import pathlib
import sys

import script
import style

NAMES = {"velocity": (r"velocity, $L_2$", 3), "gradient": (r"velocity gradient, $L_2$", 2),
         "pressure": (r"pressure, $L_2$", 2)}

MANUFACTURED = {"manufactured_newtonian": "Newtonian fluid", "manufactured_friction": r"$\mu(I)$, pressure-coupled",
                "manufactured_given_turn": r"$k(I)$, turn given",
                "manufactured_found_turn": r"$k(I)$, turn found"}


def order(rows, name):
    """Of the last halving."""
    return math.log2(rows[-2][name] / rows[-1][name])


def triangle(axes, rows, name, slope):
    """Slope triangle below the last two points of a curve."""
    (coarse, top), (fine, low) = [(row["cell"], 0.45 * row[name]) for row in rows[-2:]]
    top = low * (coarse / fine) ** slope
    axes.plot([fine, coarse, coarse, fine], [low, low, top, low], color="grey", linewidth=1)
    axes.annotate(str(slope), (coarse, math.sqrt(low * top)), xytext=(4, 0), textcoords="offset points",
                  va="center", color="grey")


def mesh_axes(axes, title, label):
    axes.set_title(title)
    axes.set_xlabel(label)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.legend(loc="upper left")


def draw_orders(data, folder):
    figure, panels = style.panels(4, 2, 3.9, sharex=True, sharey=True)
    for axes, (key, title) in zip(panels, MANUFACTURED.items()):
        rows = data[key]
        for (name, (label, slope)), color in zip(NAMES.items(), [style.PARTICLES, style.CONTINUUM, style.OTHERS[0]]):
            axes.plot([row["cell"] for row in rows], [row[name] for row in rows], marker="o", color=color,
                      label=f"{label}: {order(rows, name):.2f}")
            if name != "pressure":  # its triangle would lie on the velocity
                triangle(axes, rows, name, slope)
        mesh_axes(axes, title, "cell / side of the box")
    for axes in (panels[0], panels[2]):
        axes.set_ylabel("error")
    panels[0].set_ylim(top=0.2)  # leaves room for the legends
    style.save(figure, folder / "verification-orders.png", False)


def draw_gaps(data, folder):
    figure, panels = style.panels(3, 2, 3.9, sharey=True)
    for axes, key, title in zip(panels, ("incline", "chute", "annulus"),
                                ("Incline (Bagnold)", "Upright chute", "Annular Couette flow")):
        rows = data[key]
        axes.plot([row["cell"] for row in rows], [row["velocity"] for row in rows], marker="o",
                  label=f"same regularised law: {order(rows, 'velocity'):.2f}")
        axes.plot([row["cell"] for row in rows], [row["closed_form"] for row in rows], marker="s", linestyle="--",
                  label="law without regularisation")
        triangle(axes, rows, "velocity", 3)
        axes.set_ylim(1e-7, 20)
        mesh_axes(axes, title, r"cell  [$d$]")
    for axes in (panels[0], panels[2]):
        axes.set_ylabel(r"relative error of $v_x$, $L_2$")
    style.save(figure, folder / "verification-gaps.png", False)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, folder = map(pathlib.Path, sys.argv[1:])
    data = script.content_of(source)
    if data.get("format") != "drumlin-flow-verification-1":
        sys.exit(f"{source}: is not a verification of this version")
    folder.mkdir(parents=True, exist_ok=True)
    style.use_style()
    draw_orders(data, folder)
    draw_gaps(data, folder)
    for key in MANUFACTURED:
        print(key, *(f"{name} {order(data[key], name):.2f}" for name in NAMES))
    for key in ("incline", "chute", "annulus"):
        print(key, f"velocity {order(data[key], 'velocity'):.2f}")


if __name__ == "__main__":
    main()
