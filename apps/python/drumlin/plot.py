"""Figures on axes of one's own, in the colours and words of the commands' figures: theirs are drawn by the same functions."""

import html
import importlib
import json
import pathlib
import sys
import tempfile

import numpy as np

from .commands import command
from .errors import InputError

_FIGURES = pathlib.Path(__file__).parent / "figures"


def figure_module(name):
    """A script of the commands' figures as a module: figure_module("style").use_style()."""
    sys.path.insert(0, str(_FIGURES))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(_FIGURES))


class Picture:
    """A picture or a page of a run, which a notebook shows; `content` holds its bytes, `kind` what they are: png, gif or html.

    >>> drumlin.show("RUN").save("grains.png")
    """

    def __init__(self, content: bytes, kind: str, words: str) -> None:
        self.content, self.kind, self.words = content, kind, words

    def save(self, path) -> None:
        """Writes it to a file."""
        pathlib.Path(path).write_bytes(self.content)

    def _repr_mimebundle_(self, **_):
        if self.kind != "html":
            return {f"image/{self.kind}": self.content}
        page = html.escape(self.content.decode("utf-8"), quote=True)
        return {"text/html": f'<iframe srcdoc="{page}" width="100%" height="720" style="border: 0"></iframe>'}

    def __repr__(self):
        return f"<{self.kind}, {len(self.content) / 1e6:.2g} MB: {self.words}>"


def show(run, color: str = "speed", snapshot="last", forces: bool = False, animation: bool = False, player: bool = False, every: int | None = None,
         window=()) -> Picture:
    """A run (its folder, or the path of it) as `drumlin plot` draws it, grains with their walls; a notebook shows what is returned.

    color: speed, spin, size, material, pressure, coordination or id; forces: the chains of the normal forces in place of it; animation: all snapshots, or
    each `every`-th, as a moving picture; player: as a page that plays them. snapshot: a number from 1 on, or last; window: x0, x1, z0, z1 in d.

    >>> drumlin.show("RUN", animation=True, every=4)
    """
    name, kind = ("player.html", "html") if player else ("animation.gif", "gif") if animation else ("forces.png" if forces else f"{color}.png", "png")
    with tempfile.TemporaryDirectory() as folder:
        drawn = pathlib.Path(folder) / "drawn"
        command("plot", getattr(run, "path", run), output=drawn, color=color, snapshot=snapshot, animation=animation, player=player, every=every, window=window)
        words = json.loads((drawn / "plots.json").read_text(encoding="utf-8"))["figures"].get(name, name)
        return Picture((drawn / name).read_bytes(), kind, words)


def grains(axes, snapshot, values=None, **keywords):
    """Draws discs and walls, as `drumlin plot` does, of a snapshot that was read, or a simulation at hand. values: a colour for each disc; returns the
    collection of the discs.

    >>> drumlin.plot.grains(axes, snapshot, snapshot.spin)
    """
    from . import _drumlin  # pylint: disable=import-outside-toplevel

    maps = figure_module("grain_maps")
    with tempfile.TemporaryDirectory() as folder:
        if is_read := hasattr(snapshot, "path"):
            file = snapshot.path
        else:
            snapshot.save_snapshot(file := pathlib.Path(folder) / "000001.h5")
        drawn = json.loads(_drumlin.drawn_of_snapshot(str(file)) if is_read else snapshot._scene.drawn())  # pylint: disable=protected-access
        here = maps.Grains({"file": str(file), "walls": drawn["walls"]}, drawn["period"])
    here.x, here.z, here.radius = (np.asarray(getattr(snapshot, name)) for name in ("x", "z", "radius"))  # as they are now
    view = maps.View([here])
    discs = view.add_grains(axes, here, **({"edgecolors": "0.3"} | keywords))
    if values is not None:
        discs.set_array(np.array(values, float))
    view.add_marks(axes, here)
    axes.set(xlim=(view.low[0], view.high[0]), ylim=(view.low[1], view.high[1]), aspect="equal", xlabel="x [d]", ylabel="z [d]")
    return discs


def profile(axes, table, name, color=None, label=None):
    """Draws a column of a profile over z with its 99 % interval as a band, where it has one.

    >>> drumlin.plot.profile(axes, profile, "v_x")
    """
    style = figure_module("style")
    half_width = table.get(name + "_ci99")
    style.band(axes, table["z"], table[name], half_width, color or style.PARTICLES, label)
    axes.set(xlabel=style.axis_label("z"), ylabel=style.axis_label(name))


def compared(axes, report, name, logarithmic=False):
    """Draws both sides of a comparison over z with their bands, interface and surface: report is the folder that `compare` left, name a field such as
    "sigma_xz".

    >>> drumlin.plot.compared(axes, drumlin.read("REPORT"), "sigma_xz")
    """
    figures, style = figure_module("compare_figures"), figure_module("style")
    comparison, overlay = report["comparison.json"], report["overlay.csv"]
    if name + "_particles" not in overlay:
        known = [key.removesuffix("_particles") for key in overlay if key.endswith("_particles")]
        raise InputError(f"{report.path}: compares no {name} (allowed: {', '.join(known)})")
    figures.draw(axes, overlay, name, figures.names_of(comparison), logarithmic)
    figures.mark_depths(axes, comparison["scalars"]["H"]["particles"]["value"], comparison["zones"])
    axes.set_title(style.title_of("", comparison["reduced"]).removeprefix(" - "))


def field(axes, maps, name, logarithmic=False, label=None, norm=None, cmap="viridis", surface=None):
    """Draws a field of maps.h5, of either side, with the outline of drum or annulus and a bar of its colours. surface: "surface" of flow.json, where the
    flow moved it.

    >>> drumlin.plot.field(axes, drumlin.read("FLOW/maps.h5"), "p")
    """
    import matplotlib.colors

    if name not in maps:
        raise InputError(f"{maps.path}: holds no field {name} (allowed: {', '.join(key for key in maps if np.ndim(maps[key]) == 2)})")
    values = np.ma.masked_invalid(maps[name])
    if logarithmic:
        values = np.ma.masked_less_equal(values, 0)
        norm = norm or matplotlib.colors.LogNorm(max(values.min(), 1e-6 * values.max()), values.max())
    style = figure_module("style")
    figure_module("flow_figures").draw_map(axes, maps, values, label or style.axis_label(name), norm, cmap, maps.header, surface)


def law(axes, record, rest=False):
    """Draws what `calibrate` found: points of all runs and the law with its band over I; with rest=True what the law leaves of them. record: the JSON
    file beside the law, which was read.

    >>> drumlin.plot.law(axes, drumlin.read("rheology.json"))
    """
    figures = figure_module("calibrate_figures")
    (figures.draw_rest if rest else figures.draw_law)(axes, record)


def newton(axes, flow, over_time=False):
    """Draws the residuals of a flow over its iterations or seconds, a colour for each phase: flow is the folder that `flow` left.

    >>> drumlin.plot.newton(axes, drumlin.read("FLOW"))
    """
    trust = figure_module("flow_trust")
    trust.draw_convergence(axes, figure_module("result_files").read_rows(flow.path / "iterations.csv"), flow["flow.json"]["settings"]["tolerance"], over_time)
    axes.set_ylabel("residual / norm of the loads")


def history(axes, table, *names, logarithmic=False):
    """Draws columns of a table over its time: log.csv or energy.csv of a run, series.csv of what was measured or of a march, what `history` wrote.

    >>> drumlin.plot.history(axes, drumlin.read("RUN/log.csv"), "kinetic_energy")
    """
    time = next((name for name in ("time_s", "time") if name in table), None)
    for name in names:
        if name not in table or time is None:
            raise InputError(f"{table.path}: holds no {name} over time (allowed: {', '.join(key for key in table if key != time)})")
        values = np.asarray(table[name], float)
        line, = axes.plot(table[time], np.where(values > 0, values, np.nan) if logarithmic else values, label=name.replace("_", " "))
        half_width = table.get(name + "_ci99")
        if half_width is not None and not logarithmic:
            axes.fill_between(table[time], values - half_width, values + half_width, color=line.get_color(), alpha=0.25, linewidth=0)
    if logarithmic:
        axes.set_yscale("log")
    axes.set(xlabel="time  [s]" if time == "time_s" else r"time  [$\sqrt{d/g}$]")
    axes.legend()
