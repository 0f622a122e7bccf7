"""The paper's Figs. 8, 9 and 12: stresses and their gradients."""

import math

import style
from study_panels import depth_panel, draw, limits_of
from style import FIT
from study_runs import label_of, shown


def weight_of(study, run):
    """nu cos(theta) and nu sin(theta) of this run."""
    theta = math.radians(float(run.header["theta_deg"]))
    nu = run.scalar("nu_bulk")
    return nu * math.cos(theta), nu * math.sin(theta)


def stresses(study):
    run = study.main_run()
    figure, panels = style.panels(3)
    cosine, sine = weight_of(study, run)
    for axes, name, slope, words in ((panels[0], "sigma_zz", cosine, r"$-z\,\nu\cos\theta$"), (panels[1], "sigma_xx", None, ""),
                                     (panels[2], "sigma_xz", sine, r"$-z\,\nu\sin\theta$")):
        depth_panel(axes, run, style.axis_label(name))
        draw(axes, run, name)
        if slope is not None:
            axes.plot([run.wall, 0], [-slope * run.wall, 0], color=FIT, label=words)
            axes.legend(loc="upper right")
        axes.set_ylim(0, None)
    return (figure, f"Fig. 8: stresses, {label_of(run)}",
            "sigma_zz = -z nu cos(theta); sigma_xz = -z nu sin(theta) in the flowing layer, less below.",
            f"sigma_zz over that weight: {shown(study.at_main_speed('sigma_zz_over_weight_flowing'))} in the flowing layer, "
            f"{shown(study.at_main_speed('sigma_zz_over_weight_static'))} below; sigma_xz over its own: "
            f"{shown(study.at_main_speed('sigma_xz_over_weight_flowing'))} in the flowing layer, "
            f"{shown(study.at_main_speed('sigma_xz_over_weight_static'))} below. The loose grains above z = 0 weigh, too.")


def gradient_panel(axes, run, name, expected=None, words=None):
    depth_panel(axes, run, style.axis_label(name))
    draw(axes, run, name, rows=run.z <= 1)
    if expected is not None:
        axes.axhline(expected, color=FIT, label=words)
        axes.legend(loc="upper right")
    axes.set_ylim(*limits_of(run, name, run.off_ends(), with_bands=True))
    if expected is not None:
        style.room_above(axes, 0.2)
    axes.set_xlim(run.wall, 2)


def stress_gradients(study):
    run = study.main_run()
    names = ("d_sigma_zz_dz", "d_sigma_zz_dx", "d_sigma_xx_dz", "d_sigma_xx_dx", "d_sigma_xz_dz", "d_sigma_xz_dx")
    if not run.has(*names):
        return None
    cosine, sine = weight_of(study, run)
    expected = {"d_sigma_zz_dz": (-cosine, r"$-\nu\cos\theta$"), "d_sigma_xz_dz": (-sine, r"$-\nu\sin\theta$"),
                "d_sigma_zz_dx": (0, "0"), "d_sigma_xz_dx": (0, "0")}
    figure, panels = style.panels(len(names), 2)
    for axes, name in zip(panels, names):
        gradient_panel(axes, run, name, *expected.get(name, (None, None)))
    panels[names.index("d_sigma_xx_dx")].axhline(0, color="0.6", linewidth=1)
    words = {name: shown(study.at_main_speed(name), 2) for name in
             (f"dsigma_{component}_dx_{zone}" for component in ("zz", "xx", "xz") for zone in ("flowing", "static"))}
    return (figure, f"Fig. 9: gradients of the stresses, {label_of(run)}",
            "d/dx of sigma_zz and of sigma_xz vanish, that of sigma_xx does not (x upslope there, downslope here).",
            "d/dx in the flowing layer and below it: sigma_zz {dsigma_zz_dx_flowing}, {dsigma_zz_dx_static}; sigma_xx "
            "{dsigma_xx_dx_flowing}, {dsigma_xx_dx_static}; sigma_xz {dsigma_xz_dx_flowing}, {dsigma_xz_dx_static}."
            .format(**words))


def k_gradient(study):
    run = study.main_run()
    if not run.has("d_k_dx"):
        return None
    figure, (axes,) = style.panels(1, height=4.6)
    gradient_panel(axes, run, "d_k_dx")
    axes.axhline(0, color="0.6", linewidth=1)
    mean = study.at_main_speed("dk_dx")
    axes.axhline(mean["value"], color=FIT, label=f"mean: {shown(mean, 2)}")
    axes.legend(loc="best")
    return (figure, f"Fig. 12: gradient of k along x, {label_of(run)}",
            "almost constant, -0.05 with x upslope (+0.05 here).",
            f"{shown(mean, 2)} per d in the mean over the packing; between the slices at +5 and -5 d, undivided, k changes by "
            f"{shown(study.at_main_speed('dk_dx_5'), 2)}.")
