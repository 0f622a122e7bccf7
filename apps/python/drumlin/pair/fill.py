"""The outline of material at rest between walls: from its surface, or from its area under a level one. Lengths in mm, x to the right, z upwards."""

import dataclasses

import numpy as np

from ..errors import InputError

NOT_HELD = "the walls do not hold the grains together where the flow begins: no outline of the material"


def _crossing(difference, inner, outer):
    for _ in range(60):
        middle = 0.5 * (inner + outer)
        inner, outer = (middle, outer) if difference(middle) < 0 else (inner, middle)
    return inner


@dataclasses.dataclass
class Line:
    """A straight wall. `stays`: it is there when the flow begins."""

    begin: np.ndarray
    end: np.ndarray
    stays: bool = True

    @property
    def is_upright(self):
        return abs(self.end[0] - self.begin[0]) < 1e-3 * np.linalg.norm(self.end - self.begin)

    def height(self, x):
        """z at x; NaN beyond its ends."""
        (x_0, z_0), (x_1, z_1) = sorted((tuple(self.begin), tuple(self.end)))
        inside = (x >= x_0 - 1e-9) & (x <= x_1 + 1e-9) & (not self.is_upright)
        return np.where(inside, z_0 + (x - x_0) * (z_1 - z_0) / max(x_1 - x_0, 1e-12), np.nan)


@dataclasses.dataclass
class Walls:
    """What holds the material, and a point of it. circle: (x, z, radius), the material inside."""

    lines: list
    seed: tuple
    circle: tuple | None = None

    def heights(self, x, staying=False):
        """z of each wall at x, (walls, places); NaN beyond its ends, infinite beyond the circle."""
        found = [line.height(x) for line in self.lines if line.stays or not staying]
        if self.circle:
            found.append(np.where(abs(x - self.circle[0]) > self.circle[2], np.inf, self.circle[1] - self.half_chord(x)))
        return np.array(found).reshape(-1, *np.shape(x))

    def floor(self, x, top, staying=False):
        """The highest wall below `top` at each x; minus infinity without one."""
        heights = self.heights(np.asarray(x, float), staying)
        return np.max(np.where(heights <= top + 1e-9, heights, -np.inf), axis=0, initial=-np.inf)

    def half_chord(self, x):
        return np.sqrt(np.maximum(self.circle[2] ** 2 - (x - self.circle[0]) ** 2, 0.0))

    def under(self, top):
        """The surface, nowhere above the circle."""
        return (lambda x: np.minimum(top(x), self.circle[1] + self.half_chord(x))) if self.circle else top

    def limit(self, side, top):
        """x where the material ends on that side (-1, 1): at an upright wall that holds most of its height there, or where the floor meets its top."""
        x, step = self.seed[0], 1e-3 * self.extent()
        upright = sorted(((side * line.begin[0], line) for line in self.lines if line.is_upright and side * line.begin[0] > side * x), key=lambda each: each[0])
        ends = []
        for at, line in upright:
            inside = side * at - side * 1e-6
            low, high = float(self.floor(inside, top(inside))), float(top(inside))
            covered = min(high, max(line.begin[1], line.end[1])) - max(low, min(line.begin[1], line.end[1]))
            if covered > 0.5 * (high - low):
                ends.append(side * at)
                break
        last = ends[0] if ends else x + side * self.extent()
        places = np.append(np.arange(x, last, side * step), last - side * 1e-9)
        heights, tops = self.heights(places), top(places)
        below = np.where(heights <= tops + 1e-9, heights, -np.inf)
        floor = below.argmax(axis=0)
        up = np.append(False, heights[floor[:-1], np.arange(1, len(places))] >= tops[1:])  # the floor comes up to the surface
        met = np.flatnonzero(up | np.isneginf(below.max(axis=0, initial=-np.inf)))
        if len(met) and up[k := met[0]]:
            return _crossing(lambda at: self.heights(np.asarray(at))[floor[k - 1]] - top(at), places[k - 1], places[k])
        if len(met) or not ends:
            raise InputError(NOT_HELD)
        return last

    def extent(self):
        points = np.array([point for line in self.lines for point in (line.begin, line.end)] or [self.seed])
        return max(float(np.ptp(points, axis=0).max()), 2 * self.circle[2] if self.circle else 0.0)

    def outline(self, top, nodes=()):
        """Bottom and top of the material, (points, 2) each, from left to right. nodes: x at which the top bends."""
        top = self.under(top)
        left, right = self.limit(-1, top), self.limit(1, top)
        ends = [point[0] for line in self.lines for point in (line.begin, line.end)]
        round_x = self.circle[0] - self.circle[2] * np.cos(np.linspace(0, np.pi, 91)) if self.circle else []
        inner = np.array(sorted({x for x in (*ends, *nodes, *round_x) if left < x < right}))
        # Of a step in the floor both sides.
        places = np.concatenate([[left], *([x - 1e-7, x + 1e-7] for x in inner), [right]])
        just_inside = np.clip(places, left + 1e-9, right - 1e-9)
        bottom = np.column_stack([places, self.floor(just_inside, top(just_inside))])
        tops = np.array([left, *inner, right])
        return bottom, np.column_stack([tops, top(np.clip(tops, left + 1e-9, right - 1e-9))])


def straightened(points):
    """Without points that lie on the line between their neighbours, and without doubles."""
    kept = [points[0]]
    for point, after in zip(points[1:-1], points[2:]):
        (a, b), (c, d) = point - kept[-1], after - kept[-1]
        if abs(a * d - b * c) > 1e-5 * (1e-9 + np.hypot(c, d)) and np.hypot(a, b) > 1e-6:
            kept.append(point)
    return np.array([*kept, points[-1]])


def joined(lines, shared):
    """Walls that met before they were moved, {(line, end): (line, end)}, meet where they now cross."""
    for (i, a), (j, b) in shared.items():
        d_1, d_2 = lines[i].end - lines[i].begin, lines[j].end - lines[j].begin
        cross = d_1[0] * d_2[1] - d_1[1] * d_2[0]
        if abs(cross) > 1e-9 * np.hypot(*d_1) * np.hypot(*d_2):
            apart = lines[j].begin - lines[i].begin
            point = lines[i].begin + (apart[0] * d_2[1] - apart[1] * d_2[0]) / cross * d_1
            setattr(lines[i], a, point)
            setattr(lines[j], b, point)


def area_between(bottom, top):
    x = np.union1d(bottom[:, 0], top[:, 0])
    depth = np.interp(x, *top.T) - np.interp(x, *bottom.T)
    return float(np.sum(0.5 * np.diff(x) * (depth[1:] + depth[:-1])))


def level_fill(walls, area):
    """Bottom and top of material of that area under a level surface."""
    def under(z):
        return walls.outline(lambda x: np.full(np.shape(x), z))
    low, high = float(walls.floor(*walls.seed)) + 1e-3, walls.seed[1] + walls.extent()
    for _ in range(50):
        z = 0.5 * (low + high)
        try:
            low, high = (z, high) if area_between(*under(z)) < area else (low, z)
        except InputError:  # above the walls
            high = z
    if area_between(*under(low)) < 0.999 * area:
        raise InputError(NOT_HELD)
    return under(low)


def surface_fill(walls, x, z, margin):
    """Bottom and top of material under a surface through these points; those within `margin` of its ends are not taken: a kernel reaches over walls."""
    def top(at):
        return np.interp(at, x, z)
    left, right = walls.limit(-1, walls.under(top)), walls.limit(1, walls.under(top))
    inside = (x > left + margin) & (x < right - margin)
    x, z = x[inside], z[inside]
    return walls.outline(lambda at: np.interp(at, x, z), x)


def holes(walls, bottom):
    """Pieces of the bottom that no wall holds once the others are gone, [(from, to)], each between the ends of two that stay, on which it is then drawn."""
    found, wide = [], np.flatnonzero(np.diff(bottom[:, 0]) > 1e-6)  # between them are steps
    begins, stops = bottom[wide], bottom[wide + 1]
    middles = 0.5 * (begins + stops)
    held = abs(walls.floor(middles[:, 0], middles[:, 1] + 1e-6, staying=True) - middles[:, 1]) < 1e-4
    ends = np.array([point for line in walls.lines if line.stays for point in (line.begin, line.end)])
    # From the first piece of each hole to its last.
    edges = np.flatnonzero(np.diff(np.concatenate([[True], held, [True]]).astype(int)))
    for first, after in edges.reshape(-1, 2) if len(ends) else []:
        corners = begins[first], stops[after - 1]
        begin, end = (ends[np.argmin(np.hypot(*(ends - corner).T))] for corner in corners)
        middle, width = 0.5 * (begin + end), np.hypot(*(end - begin))
        near = all(np.hypot(*(corner - at)) < 0.5 * width for corner, at in zip(corners, (begin, end)))
        depth = middle[1] - float(walls.floor(middle[0], middle[1] - 1e-3, staying=True))
        if near and depth > 1.5 * width:
            found.append((begin, end))
    return found


def closed_outline(bottom, top):
    """The two as one outline, anticlockwise."""
    bottom, top = straightened(bottom), straightened(top)
    upper = [point for point in top[::-1] if min(np.hypot(*(bottom[k] - point)) for k in (0, -1)) > 1e-6]
    return [[float(round(value, 6)) for value in point] for point in (*bottom, *upper)]
