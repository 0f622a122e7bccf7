"""Tables of runs in place of a scene: a line for each run, with the unknowns, the settings and what was measured as columns."""

import numpy as np

from ..errors import InputError
from ..figures.result_files import read_table
from .observables import NORMAL_99


def _chosen(columns, settings, ranges, column):
    """Which rows have the settings, and their unknowns in the ranges and as they equal each other."""
    kept = np.ones(len(next(iter(columns.values()))), bool)
    for name, value in settings.items():
        values = column(name)
        kept &= values == value if isinstance(value, str) else np.isclose(values.astype(float), value, rtol=1e-9, atol=1e-12)
    for name, prior in ranges.items():
        if isinstance(prior, str):
            kept &= np.isclose(column(name), column(prior), rtol=1e-9) if name in columns else True
        else:
            kept &= (column(name) >= prior[0] * (1 - 1e-9)) & (column(name) <= prior[1] * (1 + 1e-9))
    return kept


def read(scene, ranges):
    """(points of the free unknowns, values, standard errors) of the rows that a scene of a question names; NaN where a number is missing. A column
    QUANTITY_ci99 holds half widths of 99 % intervals."""
    _, _, columns = read_table(scene.scene)

    def column(name):
        if name not in columns:
            raise InputError(f"{scene.scene}: holds no column {name} (it holds {', '.join(columns)})")
        return columns[name]
    for one in scene.measured:
        if one.z is not None:
            raise InputError(f"{scene.scene}: {one.quantity}: a profile is no column (allowed: one number a row)")
    kept = _chosen(columns, scene.settings, ranges, column)
    if not kept.any():
        raise InputError(f"{scene.scene}: 0 rows of {len(kept)} have the settings of {scene.name} and unknowns within their ranges")
    points = np.column_stack([column(name)[kept] for name, prior in ranges.items() if not isinstance(prior, str)])
    values = np.column_stack([column(one.quantity)[kept] for one in scene.measured])
    errors = np.column_stack([columns.get(one.quantity + "_ci99", np.full(len(kept), np.nan))[kept] / NORMAL_99 for one in scene.measured])
    return points, values, errors
