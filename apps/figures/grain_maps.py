"""Grains of a snapshot as they lie, coloured by one of their quantities; force chains; animations and series of stills."""

import math
import textwrap

import h5py
import matplotlib.collections
import matplotlib.colors
import matplotlib.lines
import matplotlib.patches
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import PillowWriter

import grain_colours
import overlaps
import style
import whole_file
from result_files import number_of

BESIDE, ABOVE = 1.9, 1.1  # in, of labels, bar and title
RIM = 0.1  # in, by which labels reach out of the figure: the picture is cut around them
HIGHEST, SHORT_SIDE = 8.0, 2.0  # in, of a map
DPI = 250
TITLE = 56  # characters in a line of the title
WALL = "0.15"
GRAIN_CONTACT = style.PARTICLES
WALL_CONTACT = style.CONTINUUM
PULL = style.OTHERS[1]
MEAN_WIDTH = 0.22  # d: width of a line that carries the mean force...
MOST_POINTS = 4.0  # ... but no more than this, where a few grains fill the picture
MOST_MEANS = 4.5  # mean forces: lines do not grow beyond a grain
FAR = 1.0  # spans of the packing: what flies further out is left out of the picture, and counted
FEW = 10  # grains that touch something are no packing


def has_place(wall):
    """Whether all its numbers are finite: what is not stands as null in the file."""
    numbers = (value for name in ("x", "z", "radius") for value in (wall[name] if isinstance(wall.get(name), list) else [wall.get(name, 0)]))
    return all(value is not None and math.isfinite(value) for value in numbers)


class Grains:
    """One snapshot. Lengths in d, velocities in sqrt(g d), forces in rho0 g d^2; x and z as the arrays of the file."""

    def __init__(self, frame, period):
        self.frame = frame | {"walls": [wall for wall in frame["walls"] if has_place(wall)]}
        with h5py.File(frame["file"]) as snapshot:
            self.x, self.z, v_x, v_z, self.radius = (snapshot["grains/" + name][:]
                                                     for name in ("x", "z", "v_x", "v_z", "radius"))
            self.spin = snapshot["grains/spin"][:] if "grains/spin" in snapshot else None
            if not len(self.x):  # the snapshot does not say whether grains would spin
                self.spin = np.zeros(0)
            self.drum_spin = number_of(snapshot["wall/spin"]) if number_of(snapshot["container/radius"]) > 0 else 0.0
            self.center = center = number_of(snapshot["container/x"]), number_of(snapshot["container/z"])
            self.container_radius, self.wall_angle = number_of(snapshot["container/radius"]), number_of(snapshot["wall/angle"])
            self.contacts = {name: snapshot["contacts/" + name][:] for name in ("i", "j", "normal_x", "normal_z")}
            self.force = snapshot["contacts/impulse_n"][:] / number_of(snapshot["time_step"])
            # Lower left and upper right corner of a cell that is periodic in x and z, and what the image above is displaced by.
            self.cell = self.offset = None
            if "cell" in snapshot:
                corner = np.array([number_of(snapshot["cell/x"]), number_of(snapshot["cell/z"])])
                self.cell = corner, corner + [number_of(snapshot["period_x"]), number_of(snapshot["cell/height"])]
                self.offset = number_of(snapshot["cell/offset"])
            self.gravity = np.array([number_of(snapshot["gravity_x"]), number_of(snapshot["gravity_z"])])
        # What numbers each grain for a colour by id or by material.
        self.id = grain_colours.id_of(frame["file"], len(self.x))
        materials = frame.get("materials")
        self.material = None if materials is None else np.asarray(materials)
        # In a drum that turns all the bulk moves: what flows shows in the frame of the drum.
        self.speed = np.hypot(v_x - self.drum_spin * (self.z - center[1]), v_z + self.drum_spin * (self.x - center[0]))
        if self.cell is not None:
            (_, bottom), (_, top) = self.cell
            period = self.cell[0][0], self.cell[1][0]
            cells = np.floor((self.z - bottom) / (top - bottom))
            self.x, self.z = self.x - cells * self.offset, self.z - cells * (top - bottom)
        self.period = period
        if period is not None:
            self.x = period[0] + np.mod(self.x - period[0], period[1] - period[0])
        container = (*center, self.container_radius) if self.container_radius > 0 else None
        self.overlaps = overlaps.deep_overlaps(self.x, self.z, self.radius, self.period, self.cell, self.offset or 0.0, container)

    def overlap_words(self):
        return overlaps.words_of(self.overlaps[2])

    def touching(self):
        """Indices of the grains that carry a force."""
        i, j = self.contacts["i"], self.contacts["j"]
        return np.unique(np.concatenate([i, j[j >= 0]]))

    def chains(self):
        """Lines between the centres of grains in contact (n, 2, 2), their forces, and which of them end at a wall."""
        i, j = self.contacts["i"], self.contacts["j"]
        normal = np.column_stack([self.contacts["normal_x"], self.contacts["normal_z"]]).astype(float)
        wall = j < 0
        centers = np.column_stack([self.x, self.z])
        # From i against the normal: right across the seam of a periodic domain, too.
        reach = self.radius[i] + np.where(wall, 0, self.radius[np.where(wall, 0, j)])
        lines = np.stack([centers[i], centers[i] - reach[:, None] * normal], axis=1)
        force = self.force
        if self.period is not None:  # what crosses the seam is seen at both ends
            across = ~wall & (np.abs(self.x[i] - self.x[np.where(wall, 0, j)]) > (self.period[1] - self.period[0]) / 2)
            if self.cell is not None:
                across |= ~wall & (np.abs(self.z[i] - self.z[np.where(wall, 0, j)]) > (self.cell[1][1] - self.cell[0][1]) / 2)
            other = centers[j[across]]
            lines = np.concatenate([lines, np.stack([other, other + reach[across, None] * normal[across]], axis=1)])
            force, wall = np.concatenate([force, force[across]]), np.concatenate([wall, wall[across]])
        return lines, force, wall


def extent_of(snapshots):
    """Box around the discs of all snapshots, but for what has flown away: further from the middle 96 % of the grains that touch
    something (of all grains, where hardly one does) than these are wide. Where there is no grain at all, the walls."""
    shown = [s for s in snapshots if len(s.x)]
    if not shown:
        return extent_of_walls(snapshots)
    snapshots = shown
    low = np.min([[(s.x - s.radius).min(), (s.z - s.radius).min()] for s in snapshots], axis=0)
    high = np.max([[(s.x + s.radius).max(), (s.z + s.radius).max()] for s in snapshots], axis=0)
    touching = np.concatenate([np.column_stack([s.x, s.z])[s.touching()] for s in snapshots])
    places = touching if len(touching) > FEW * len(snapshots) else np.concatenate([np.column_stack([s.x, s.z]) for s in snapshots])
    core = np.quantile(places, [0.02, 0.98], axis=0)
    reach = FAR * (core[1] - core[0]).max() + 2
    return np.maximum(low, core[0] - reach), np.minimum(high, core[1] + reach)


def extent_of_walls(snapshots):
    """Box around all walls; of none, a unit about the origin."""
    corners = [[np.atleast_1d(wall[axis]) + sign * wall.get("radius", 0) for axis in ("x", "z")]
               for s in snapshots for wall in s.frame["walls"] for sign in (-1, 1)]
    if not corners:
        return np.array([-1.0, -1.0]), np.array([1.0, 1.0])
    places = np.concatenate([np.column_stack(one) for one in corners])
    return places.min(axis=0), places.max(axis=0)


class View:
    """The part of the plane that is shown: the window that was asked for, else all grains, whole containers, and of other walls
    what stands beside the grains."""

    def __init__(self, snapshots, window=None):
        low, high = extent_of(snapshots)
        if snapshots[0].period is not None:
            low[0], high[0] = snapshots[0].period
        near = 0.03 * (high - low).max() + 1
        limits = low - near, high + near
        for wall in (wall for s in snapshots for wall in s.frame["walls"]):
            x, z, radius = np.atleast_1d(wall["x"]), np.atleast_1d(wall["z"]), wall.get("radius", 0)
            box = np.array([x.min() - radius, z.min() - radius]), np.array([x.max() + radius, z.max() + radius])
            if wall["shape"] != "container":
                box = np.clip(box[0], *limits), np.clip(box[1], *limits)
            low, high = np.minimum(low, box[0]), np.maximum(high, box[1])
        if snapshots[0].period is not None:
            low[0], high[0] = snapshots[0].period
        if snapshots[0].cell is not None:  # it may grow and shrink
            low = np.min([s.cell[0] - s.radius.max(initial=0) for s in snapshots], axis=0)
            high = np.max([s.cell[1] + s.radius.max(initial=0) for s in snapshots], axis=0)
        margin = 0.01 * (high - low).max() + 0.2
        self.low, self.high = low - margin, high + margin
        if window is not None:
            self.low, self.high = np.array([window[0], window[2]]), np.array([window[1], window[3]])
        size = self.high - self.low
        self.inches = min((style.WIDEST - BESIDE - RIM) / size[0], HIGHEST / size[1])  # per d
        self.figure_size = np.maximum(size * self.inches, SHORT_SIDE)

    def outside(self, grains):
        """How many grains have their centres outside of the picture."""
        places = np.column_stack([grains.x, grains.z])
        return int(np.any((places < self.low) | (places > self.high), axis=1).sum())

    def axes(self, drawing, what, frame):
        figure, axes = plt.subplots(figsize=self.figure_size + [BESIDE, ABOVE])
        axes.set_aspect("equal")
        axes.set_xlim(self.low[0], self.high[0])
        axes.set_ylim(self.low[1], self.high[1])
        axes.grid(False)
        axes.set_xlabel(r"$x$  [$d$]")
        axes.set_ylabel(r"$z$  [$d$]")
        self.set_title(figure, drawing, what, frame)
        return figure, axes

    @staticmethod
    def set_title(figure, drawing, what, frame, outside=0, empty=False, deep=""):
        what += f" ({outside} grains outside of the picture)" if outside else ": no grains" if empty else ""
        state = "" if drawing["status"] == "finished" else f" (run {style.plain(drawing['status'])})"
        words = textwrap.fill(f"{what}, t = {frame['time_s']:.2f} s{state}", TITLE)
        figure.suptitle(style.title_of(f"{style.plain(drawing['title'], TITLE)}\n{words}{deep}", drawing["reduced"]))

    def set_title_of(self, figure, drawing, what, grains):
        """With the number of grains that the picture does not hold, unless a window was asked for, and with what overlaps."""
        self.set_title(figure, drawing, what, grains.frame, self.outside(grains) if drawing["window"] is None else 0, not len(grains.x),
                       f"\n{grains.overlap_words()}" if len(grains.overlaps[2]) else "")

    def add_marks(self, axes, grains):
        """Grains that overlap deeply, walls, and the borders of a periodic domain. Returns what was drawn, to be taken away before
        the next frame."""
        frame, period = grains.frame, grains.period
        i, j, _ = grains.overlaps
        deep = np.unique(np.concatenate([i, j[j >= 0]]))
        artists = [style.discs(axes, grains.x[deep], grains.z[deep], grains.radius[deep], facecolors=overlaps.SIGNAL, edgecolors=WALL,
                               linewidths=0.3)]
        for wall in frame["walls"]:
            if wall["shape"] == "container":
                artists.append(axes.add_patch(matplotlib.patches.Circle((wall["x"], wall["z"]), wall["radius"],
                                                                        fill=False, edgecolor=WALL, linewidth=1.6)))
                # Marks that turn with the wall, clockwise by its angle.
                angles = -wall["angle"] + np.arange(12) * math.pi / 6
                ends = np.stack([np.column_stack([wall["x"] + r * np.cos(angles), wall["z"] + r * np.sin(angles)])
                                 for r in (wall["radius"], 0.97 * wall["radius"])], axis=1)
                marks = matplotlib.collections.LineCollection(ends, colors=WALL, linewidths=[2.5] + 11 * [1.0])
                artists.append(axes.add_collection(marks, autolim=False))
                continue
            x, z, radius = np.atleast_1d(wall["x"]), wall["z"], wall.get("radius", 0)
            for shift in images(x.min() - radius, x.max() + radius, period):
                if wall["shape"] in ("segment", "arc"):
                    artist, = axes.plot(x + shift, z, color=WALL, linewidth=1.6, scalex=False, scaley=False)
                else:
                    artist = axes.add_patch(matplotlib.patches.Circle((wall["x"] + shift, z), radius, facecolor="0.6",
                                                                      edgecolor=WALL, linewidth=0.6))
                if period is not None:
                    artist.set_clip_path(self.period_of_plane(axes, period))
                artists.append(artist)
        if grains.cell is not None:
            low, high = grains.cell
            artists.append(axes.add_patch(matplotlib.patches.Rectangle(low, *(high - low), fill=False, edgecolor=WALL, linewidth=0.8,
                                                                       linestyle=(0, (6, 6)))))
        elif period is not None:
            artists += [axes.axvline(x, color=WALL, linewidth=0.8, linestyle=(0, (6, 6))) for x in period]
        if grains.gravity[0] != 0:  # one that points straight down needs no arrow
            artists.append(arrow_of(axes, grains.gravity / np.hypot(*grains.gravity)))
        return artists

    def period_of_plane(self, axes, period):
        """The strip of one period, beyond which nothing of a wall is drawn."""
        return matplotlib.patches.Rectangle((period[0], self.low[1]), period[1] - period[0], self.high[1] - self.low[1],
                                            transform=axes.transData)

    def add_grains(self, axes, grains, **colours):
        # A rim of a twentieth of a grain parts neighbours of one colour.
        return style.discs(axes, grains.x, grains.z, grains.radius, **({"linewidths": min(0.05 * self.inches * 72, 0.8)} | colours))


def arrow_of(axes, gravity):
    """The direction of gravity, beside the picture's lower right corner; `gravity` has length 1."""
    return axes.annotate("$g$", (1.07, 0.0), xytext=-44 * gravity, xycoords="axes fraction", textcoords="offset points", annotation_clip=False, ha="center",
                         va="center", fontsize=14, arrowprops={"arrowstyle": "-|>", "color": WALL, "linewidth": 2, "mutation_scale": 16})


def images(low, high, period):
    """Shifts by whole periods that bring something from low to high into the period: a wall that moves along leaves it at one
    side and comes in at the other. Without a period it stays where it is."""
    if period is None:
        return [0.0]
    length = period[1] - period[0]
    first, last = math.floor((period[0] - high) / length) + 1, math.ceil((period[1] - low) / length) - 1
    return [k * length for k in range(first, last + 1)]


def draw_colours(drawing, view, grains, colour):
    figure, axes = view.axes(drawing, colour.words, grains.frame)
    view.set_title_of(figure, drawing, colour.words, grains)
    discs = view.add_grains(axes, grains, cmap=colour.cmap, norm=colour.norm, edgecolors=colour.edges)
    discs.set_array(colour.of(grains))
    marks = view.add_marks(axes, grains)
    colour.add_scale(figure, axes, discs)
    return figure, axes, discs, marks


def draw_still(drawing, view, grains, colour, path):
    figure, *_ = draw_colours(drawing, view, grains, colour)
    style.save(figure, path, drawing["reduced"])


def draw_chains(drawing, view, grains, path):
    figure, axes = view.axes(drawing, "force chains", grains.frame)
    view.add_grains(axes, grains, facecolors="0.93", edgecolors="0.8")
    view.set_title_of(figure, drawing, "force chains", grains)
    view.add_marks(axes, grains)
    lines, force, wall = grains.chains()
    points = min(MEAN_WIDTH * view.inches * 72, MOST_POINTS)
    mean = np.abs(force).mean() if len(force) else math.nan
    keys = []
    for name, chosen, colour in [("between grains", ~wall & (force >= 0), GRAIN_CONTACT),
                                 ("with walls", wall & (force >= 0), WALL_CONTACT),
                                 ("pulling (cohesion)", force < 0, PULL)]:
        if not chosen.any():
            continue
        width = points * np.minimum(np.abs(force[chosen]) / mean, MOST_MEANS)
        axes.add_collection(matplotlib.collections.LineCollection(lines[chosen], linewidths=width, colors=colour,
                                                                  capstyle="round"), autolim=False)
        keys.append(matplotlib.lines.Line2D([], [], color=colour, linewidth=points,
                                            label=f"{style.plain(name, 30)}: {chosen.sum()}"))
    if keys:
        figure.legend(handles=keys, loc="upper center", ncol=len(keys), bbox_to_anchor=(0.5, 0.0),
                      title=rf"contacts; these widths carry the mean normal force, {mean:.3g} $\rho_0 g d^2$")
    else:
        axes.text(0.5, 0.02, "no contact carries a load", transform=axes.transAxes, ha="center")
    style.save(figure, path, drawing["reduced"])


def draw_snapshot(drawing, folder):
    """Returns {file: what it shows}: the colour that was asked for, else speed and spin; and force chains."""
    grains = Grains(drawing["snapshot"], drawing["period"])
    view = View([grains], drawing["window"])
    number = f"snapshot {drawing['snapshot']['number']}; {grains.overlap_words()}"
    plt.rcParams.update({"savefig.dpi": DPI, "savefig.bbox": "tight"})
    names = [drawing["color"]] if drawing["color"] else ["speed"] + ([] if grains.spin is None or not len(grains.x) else ["spin"])
    figures = {}
    for name in names:
        colour = grain_colours.Colour(name, [grains], drawing)
        draw_still(drawing, view, grains, colour, folder / f"{name}.png")
        figures[f"{name}.png"] = f"{colour.words.replace(', positive clockwise', '')}, {number}"
    draw_chains(drawing, view, grains, folder / "forces.png")
    figures["forces.png"] = f"normal forces of the contacts, {number}"
    return figures


def series(drawing):
    """Snapshots of a series, one view and one scale of colours for all of them."""
    snapshots = [Grains(frame, drawing["period"]) for frame in drawing["frames"]]
    return snapshots, View(snapshots, drawing["window"]), grain_colours.Colour(drawing["color"] or "speed", snapshots, drawing)


def draw_stills(drawing, folder):
    """stills/NNNNNN.png for each frame. Returns {file: what it shows}."""
    snapshots, view, colour = series(drawing)
    plt.rcParams.update({"savefig.dpi": DPI, "savefig.bbox": None})  # all of one size
    (folder / "stills").mkdir(exist_ok=True)
    figures = {}
    for grains in snapshots:
        number = grains.frame["number"]
        draw_still(drawing, view, grains, colour, folder / "stills" / f"{number:06d}.png")
        figures[f"stills/{number:06d}.png"] = f"{colour.words}, snapshot {number}"
    return figures


def draw_animation(drawing, folder):
    """Returns {file: what it shows}. The same view and colours in all frames."""
    snapshots, view, colour = series(drawing)
    plt.rcParams.update({"savefig.bbox": None})  # all frames of one size
    figure, axes, discs, marks = draw_colours(drawing, view, snapshots[0], colour)
    discs.remove()
    writer = PillowWriter(fps=12)
    with whole_file.aside(folder / "animation.gif") as stream, writer.saving(figure, stream, dpi=80):
        for grains in snapshots:
            # Anew for each frame: grains may come and go.
            discs = view.add_grains(axes, grains, cmap=colour.cmap, norm=colour.norm, edgecolors=colour.edges)
            discs.set_array(colour.of(grains))
            for artist in marks:
                artist.remove()
            marks = view.add_marks(axes, grains)
            view.set_title_of(figure, drawing, colour.words, grains)
            writer.grab_frame()
            discs.remove()
    plt.close(figure)
    return {"animation.gif": f"{colour.words}, {len(snapshots)} snapshots"}
