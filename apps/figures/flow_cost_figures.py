"""Work against precision of the continuum: errors over seconds, by mesh and by eps, the default marked.

usage: flow_cost_figures.py FLOW_COSTS_JSON PICTURE
"""

import sys

import matplotlib.pyplot as plt

import script
import style

CURVES = [("theta_deg", r"$\theta$"), ("H", "$H$"), ("lambda", r"$\lambda$"), ("v_x_5d", r"$v_x$ at 5 $d$"), ("v_x_10d", r"$v_x$ at 10 $d$"),
          ("v_x", r"$v_x(z)$, rms")]
COLORS = [style.PARTICLES, style.CONTINUUM] + style.OTHERS


def draw(axes, rows, along, label, reference):
    rows = [row for row in rows if row["error_percent"]]
    for (name, said), color in zip(CURVES, COLORS):
        places = [(along(row), row["error_percent"][name]) for row in rows if row["error_percent"].get(name)]
        axes.loglog([x for x, _ in places], [y for _, y in places], marker="o", color=color, label=said)
    for row in rows:
        if row["default"]:
            axes.axvline(along(row), color="grey", linewidth=0.8, linestyle="--")
            axes.annotate(" default", (along(row), 1), xycoords=("data", "axes fraction"), va="top", fontsize=11, color="grey")
    axes.set_xlabel(label)
    axes.set_title(reference, fontsize=12)


def main():
    report = script.content_of(sys.argv[1])
    style.use_style()
    meshes, eps = report["accuracy"]["meshes"], report["accuracy"]["eps"]
    figure, axes = plt.subplots(1, 3, figsize=(14.5, 5), sharey=True)
    finest = f"{meshes[-1]['unknowns']:,} unknowns"
    draw(axes[0], meshes, lambda row: row["cpu_seconds"], "processor seconds, cold, one rank", f"meshes, against {finest}")
    draw(axes[1], meshes, lambda row: row["unknowns"], "unknowns", f"meshes, against {finest}")
    draw(axes[2], eps, lambda row: float(row["setting"]), r"eps  [$\sqrt{g/d}$]", f"eps, against {eps[-1]['setting']}, default mesh")
    axes[0].set_ylabel("error [%]")
    axes[2].legend(loc="lower right")
    figure.suptitle(style.title_of("What accuracy costs in the continuum, 6 rpm", report["reduced"]))
    style.save(figure, sys.argv[2], report["reduced"])


if __name__ == "__main__":
    main()
