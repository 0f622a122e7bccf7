"""Pairs of discs that overlap by more than hard discs may: what pictures, report and player show of them."""

import numpy as np
import scipy.spatial

DEEP = 1e-3  # d: beyond what the solver of contacts leaves
SIGNAL = "#ff00c8"  # of no scale of colours


def images_of(x, z, reach, period, cell, offset):
    """(places, grain of each): all grains, and of those near the borders of a periodic domain the images beyond."""
    length = period[1] - period[0] if period is not None else 0.0
    height = cell[1][1] - cell[0][1] if cell is not None else 0.0
    low, high = np.array([x.min(), z.min()]) - reach, np.array([x.max(), z.max()]) + reach
    places, owners = [np.column_stack([x, z])], [np.arange(len(x))]
    for row in (-1, 0, 1) if height else (0,):
        along = np.mod(row * offset, length) if height else 0.0
        for column in (-2, -1, 0, 1) if length else (0,):
            if row == column == 0:
                continue
            moved = places[0] + [along + column * length, row * height]
            near = np.all((moved > low) & (moved < high), axis=1)
            places.append(moved[near])
            owners.append(owners[0][near])
    return np.concatenate(places), np.concatenate(owners)


def deep_overlaps(x, z, radius, period=None, cell=None, offset=0.0, container=None):
    """(i, j, depth) of the pairs that overlap by more than DEEP, each once, j = -1: with the container (x, z, radius) around
    them. Periodic in x, in a cell (lower left, upper right corner) in z as well, whose image above is displaced by `offset`."""
    if not len(x):
        return np.zeros(0, dtype=int), np.zeros(0, dtype=int), np.zeros(0)
    x, z, radius = (np.asarray(values, dtype=float) for values in (x, z, radius))
    places, owner = images_of(x, z, 2 * radius.max(), period, cell, offset)
    # Each pair is found by its larger disc, or by both.
    found = scipy.spatial.cKDTree(places).query_ball_point(places[:len(x)], 2 * radius - DEEP)
    i = np.repeat(np.arange(len(x)), [len(near) for near in found])
    image = np.concatenate(found).astype(int)
    j = owner[image]
    depth = radius[i] + radius[j] - np.hypot(*(places[i] - places[image]).T)
    chosen = (i != j) & (depth > DEEP)
    i, j, depth = np.minimum(i, j)[chosen], np.maximum(i, j)[chosen], depth[chosen]
    order = np.lexsort((-depth, j, i))  # of a pair that meets twice the deeper one
    _, first = np.unique(i[order] * len(x) + j[order], return_index=True)
    i, j, depth = i[order][first], j[order][first], depth[order][first]
    if container is not None:
        beyond = np.hypot(x - container[0], z - container[1]) + radius - container[2]
        out, = np.nonzero(beyond > DEEP)
        i, j, depth = np.concatenate([i, out]), np.concatenate([j, np.full(len(out), -1)]), np.concatenate([depth, beyond[out]])
    return i, j, depth


def words_of(depth):
    """What a caption says of them."""
    if not len(depth):
        return f"no overlap beyond {DEEP:g} d"
    return f"{len(depth)} overlap{'s' * (len(depth) > 1)} beyond {DEEP:g} d, the deepest {depth.max():.2g} d"
