"""What the figures of all commands share: sizes, colours, the word "reduced", bands, profile files."""

import math
import os
import pathlib
import textwrap

import matplotlib
import matplotlib.collections
import matplotlib.pyplot as plt
import matplotlib.text
import matplotlib.ticker
import numpy as np

import result_files
import whole_file
from quantity_table import axis_label

# Okabe and Ito's colours: told apart with any kind of colour vision, and in grey.
PARTICLES = "#0072B2"
CONTINUUM = "#D55E00"
PAPER = "#000000"
OTHERS = ["#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442"]
COLORS = [PARTICLES, CONTINUUM] + OTHERS
FIT = CONTINUUM  # lines that are fitted or expected, not measured

WIDEST = 7.1  # in, of any figure...
LEAST_LABEL, SHOWN_WIDTH = 7.0, 400 / 96  # ... so that words of 12 points have so many where it is shown as wide as this, in: 400 pixels

LEAST_SHOWN_NU = 0.05  # volume fraction of the loosest layer that is drawn


def use_style():
    """Call once at the start of a script. A matplotlibrc of the current folder or of the user changes nothing."""
    matplotlib.rcdefaults()
    plt.rcParams.update({
        "figure.figsize": (6.4, 4.6),
        "figure.dpi": 110,
        "savefig.dpi": 110,
        "savefig.pad_inches": 0.04,  # as constrained layout leaves
        # Half of what a figure costs. Tests that look at numbers go without.
        "figure.constrained_layout.use": not os.environ.get("DRUMLIN_DRAFT_FIGURES"),
        "font.size": 12,
        "axes.titlesize": 13,
        "axes.labelsize": 13,
        "legend.fontsize": 12,
        "legend.handlelength": 1.6,
        "figure.titlesize": 13,
        "legend.frameon": False,
        "lines.linewidth": 1.8,
        "lines.markersize": 4,
        "axes.grid": True,
        "grid.alpha": 0.3,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.prop_cycle": plt.cycler(color=COLORS),
        # The same data give the same bytes on every machine.
        "svg.hashsalt": "drumlin",
    })


def panels(count, columns=1, height=3.2, **shared):
    """(figure, list of its axes) of so many panels in columns, as wide as a figure may be; a row has this height in inches. Places that are left over
    show nothing."""
    rows = math.ceil(count / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(WIDEST, height * rows), squeeze=False, **shared)
    for axes in grid.flat[count:]:
        axes.axis("off")
    return figure, list(grid.flat)


def places(rows, height=3.2):
    """(figure, places of its panels), as wide as a figure may be: rows of one panel or of two, as [1, 2, 2]."""
    figure = plt.figure(figsize=(WIDEST, height * len(rows)))
    grid = figure.add_gridspec(len(rows), 2)
    return figure, [grid[k, place] for k, count in enumerate(rows) for place in ([slice(None)] if count == 1 else [0, 1])]


def maps(count, columns, wide, high, **shared):
    """panels() for fields over a part of the plane that is so wide and high, drawn to scale beside their bars of colours."""
    return panels(count, columns, 1.1 + min(max((WIDEST / columns - 1.5) * high / wide, 0.8), WIDEST / columns), **shared)


def plain(text, width=64, lines=3):
    """A text of the user (a title, a name) as it stands, for a figure: no mathematics in it, what cannot be drawn replaced, wrapped,
    and cut after so many lines. Matplotlib takes what stands between two $ for mathematics, and \\$ for the sign."""
    seen = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in str(text))
    return textwrap.fill(seen, width, max_lines=lines, placeholder=" ...").replace("$", r"\$")


NUMBERS = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"]


def at_places(count):
    """"at five places": how many they are, in words where they are few."""
    return f"at {NUMBERS[count] if count < len(NUMBERS) else count} place{'s' * (count != 1)}"


def place_labels(places):
    """Places with a sign, with as many digits behind the point, none at least, as tell them apart."""
    for digits in range(7):
        labels = [f"{place:+.{digits}f}" for place in places]
        if len(set(labels)) == len(set(places)):
            break
    return labels


def title_of(text, reduced):
    """Title of a figure; a reduced run says so wherever it is shown."""
    return f"{text} - reduced" if reduced else text


def stamp(figure, reduced):
    """Writes "reduced" above a figure that stands for a reduced run; a title of its own says it already (title_of)."""
    if reduced and getattr(figure, "_suptitle", None) is None:
        figure.suptitle("reduced", x=0.99, ha="right", color="#B00000", weight="bold")


def smallest_label(figure):
    """(points, text) of its smallest words where the figure, which was drawn, is shown SHOWN_WIDTH wide."""
    cut = plt.rcParams["savefig.bbox"] == "tight"
    width = figure.get_tightbbox().width + 2 * plt.rcParams["savefig.pad_inches"] if cut else figure.get_figwidth()
    words = [text for text in figure.findobj(matplotlib.text.Text) if text.get_visible() and text.get_text()]
    return min(((text.get_fontsize() * SHOWN_WIDTH / width, text.get_text()) for text in words), default=(math.inf, ""))


def save(figure, path, reduced):
    """Writes a figure and closes it. One that cannot be read where pages are narrow is a fault of its script: AssertionError."""
    stamp(figure, reduced)
    if any(axes.get_aspect() != "auto" for axes in figure.axes):  # a second pass settles where panels to scale lie
        figure.draw_without_rendering()
    with whole_file.aside(path) as stream:
        figure.savefig(stream, format=pathlib.Path(path).suffix[1:] or None, metadata={"Software": None})
        points, text = smallest_label(figure)
        if points < LEAST_LABEL:
            raise AssertionError(f"{path}: \"{text}\" would have {points:.1f} points, less than {LEAST_LABEL:g}, in a picture {96 * SHOWN_WIDTH:.0f} pixels wide")
    plt.close(figure)


def log_scale(axes, which):
    """A logarithmic axis, "x" or "y", where any line or point has a positive value on it: grains at rest have none."""
    # Lines across the axes (axvline) count from 0 to 1 whatever is drawn.
    drawn = [getattr(line, f"get_{which}data")() for line in axes.get_lines() if line.get_transform() == axes.transData]
    drawn += [points.get_offsets()[:, "xy".index(which)] for points in axes.collections if len(points.get_offsets())]
    if any(value > 0 for values in drawn for value in values):
        getattr(axes, f"set_{which}scale")("log")
        if which == "x":
            axes.xaxis.set_minor_formatter(FewNumbers())


class FewNumbers(matplotlib.ticker.LogFormatterSciNotation):
    """Numbers at a logarithmic axis of less than a decade along x: as many as stand beside one another."""

    def __init__(self):
        super().__init__(labelOnlyBase=False)

    def set_locs(self, locs=None):
        super().set_locs(locs)
        low, high = self.axis.get_view_interval()
        decades = abs(math.log10(high / low)) if low > 0 else 2
        if 0.2 < decades <= 1:
            self._sublabels = {1, 2, 5} if decades > 0.6 else {1, 2, 3, 5} if decades > 0.4 else {1, 2, 3, 4, 5, 6, 8}


def room_above(axes, share):
    """Room for a legend above the curves: a share of the axis as it is."""
    change = axes.yaxis.get_transform()
    low, high = change.transform(axes.get_ylim())
    axes.set_ylim(top=change.inverted().transform(high + share * (high - low)))


def positive(values):
    """What a logarithmic axis can show; NaN in the place of all else."""
    return np.where(np.asarray(values) > 0, values, np.nan)


def band(axes, x, y, half_width, color, label=None, marker="o", foot=None, **line):
    """A curve with its 99 % interval as a band around it. x horizontal, y vertical. For a logarithmic axis `foot`, a share of the value, is where a
    band ends that reaches zero, instead of taking the axis with it; values are positive then."""
    y = np.asarray(y, float) if foot is None else positive(y)
    axes.plot(x, y, marker=marker, color=color, label=label, **line)
    if half_width is not None:
        low = y - half_width
        axes.fill_between(x, low if foot is None else np.maximum(low, foot * y), y + half_width, color=color, alpha=0.25, linewidth=0)


def depth_axes(axes, H, label, surface):
    """Axes over depth with marks at the surface, and dotted at the interface where it is known; `surface` is a style of lines."""
    for z, line in ((0, surface), (-H, ":")):
        if math.isfinite(z):
            axes.axvline(z, color="0.4", linestyle=line, linewidth=1)
    axes.set_xlabel(axis_label("z"))
    axes.set_ylabel(label)


def discs(axes, x, z, radius, values=None, **colours):
    """Grains as they lie, to scale. Returns the collection."""
    drawn = matplotlib.collections.EllipseCollection(2 * radius, 2 * radius, np.zeros(len(radius)), units="x", offsets=np.column_stack([x, z]),
                                                     transOffset=axes.transData, **colours)
    if values is not None:
        drawn.set_array(values)
    return axes.add_collection(drawn, autolim=False)


def value_of(entry, key="value"):
    """A number, or that of a measurement; NaN where there is none."""
    value = entry.get(key) if isinstance(entry, dict) else entry if key == "value" else None
    return math.nan if value is None else value


def half_width_of(entry):
    """Of the 99 % interval of a measurement, or what the paper gives."""
    return value_of(entry, "half_width" if isinstance(entry, dict) and "half_width" in entry else "ci99")


def read_profiles(path):
    """(header, columns) of a profiles.csv of version 1; columns as arrays, NaN where the field is empty."""
    return result_files.read_table(path, "drumlin-profiles-1")[1:]


def shown_layers(profile):
    """(header, columns) without the loosest layers: a handful of grains in the air would stretch every axis with their error bars."""
    header, columns = profile
    shown = columns["nu"] > LEAST_SHOWN_NU
    return header, result_files.Columns(columns.path, {name: values[shown] for name, values in columns.items()})
