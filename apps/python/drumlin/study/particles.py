"""`drumlin measure --study`: laws of the particles over the speed of rotation, and the paper's table with verdicts."""

import math

import numpy as np

from .fits import ABSENT, Scalar
from .laws import I_MAX, I_MIN, collapse, curve, friction_collapse, speed_laws, speed_trend
from .paper import VERDICTS, judged, paper_entries, paper_numbers, paper_shear_rate, paper_speed_rpm
from .quantities import with_derived
from .runs import other_numerics, require_one_study, speed_groups

OF_SPEED = ("Q", "Q_expected", "H", "shear_rate", "shear_rate_laboratory", "layer_balance", "H_over_sqrt_Q")


def _scale(group, name):
    """What a derivative along x, said to vanish, is small against: gravity's pull along the slope for stresses, a change by the whole quantity over the 5 d
    by which the paper moves its slice for the others."""
    def value(key):
        return group.scalars.get(key, ABSENT).value

    if name.startswith("dsigma_"):
        return value("nu_bulk") * math.sin(math.radians(value("theta_deg")))
    if name.startswith("dnu_dx"):
        return value("nu_bulk") / 5
    if name.startswith("dv_dx"):
        return value("shear_rate") * value("H") / 2 / 5
    return 1.0


def findings(content, groups):
    """{quantity: (number, scale, limit)} over all speeds, as the entries of the paper name them: LAW.COEFFICIENT, NAME, NAME_trend, COLUMN_collapse."""
    found = {f"{law}.{name}": (c,) for law, entry in content["laws"].items() for name, c in entry["coefficients"].items()}
    for name, trend in content["over_all_speeds"].items():
        found |= {name: (trend["mean"],), name + "_trend": (trend["trend"],)}
    rates = [group.scalars.get("shear_rate", ABSENT) for group in groups]
    rates = sorted((rate for rate in rates if math.isfinite(rate.value)), key=lambda rate: rate.value) or [ABSENT]
    found |= {"shear_rate_lowest": (rates[0],), "shear_rate_highest": (rates[-1],)}
    found |= {column + "_collapse": (Scalar(one["ratio"]), 1.0, one["limit"]) for column, one in content["collapse"].items()}
    for law, name in (("static_velocity_fluctuation", "dv_exponent"), ("static_spin_fluctuation", "domega_exponent")):
        found[law + ".p"] = found.get(name, (ABSENT,))
    for name in "ab" if content["friction"] else "":
        # Layers of one run move together, which the fit cannot know: the interval is at least that of the speeds' own coefficients about their mean.
        value, ci99 = content["friction"][name]
        found["friction." + name] = (Scalar(value, max(ci99, found.get("mu_" + name, (ABSENT,))[0].ci99 or 0)),)
    return found


def _at_speed(entry, groups):
    name, rpm = entry["quantity"], entry["rotation_rpm"]
    group = next((group for group in groups if abs(group.rotation_rpm - rpm) <= 0.01 * rpm and name in group.scalars), None)
    return (ABSENT,) if group is None else (group.scalars[name], _scale(group, name))


def _consistency(group, paper, is_papers):
    """Whether the numbers of one speed belong together, ours and the paper's."""
    row = {"rotation_rpm": group.rotation_rpm} | {name: group.scalars.get(name, ABSENT) for name in OF_SPEED}
    row["Q_expected"] = row["Q_expected"].value
    numbers = paper_numbers(paper, round(group.rotation_rpm)) if is_papers else {}
    Q, H, theta = (numbers.get(name, ABSENT).value for name in ("Q", "H", "theta_deg"))
    rate = paper_shear_rate(paper, round(group.rotation_rpm), theta) if math.isfinite(H) else math.nan
    return row | {"paper_Q": Q, "paper_H": H, "paper_shear_rate": rate, "paper_layer_balance": 0.4 * rate * H**2 / Q,
                  "paper_H_over_sqrt_Q": H / math.sqrt(Q)}


@np.errstate(all="ignore")  # what was not measured is NaN
def study_of(runs, paper):
    """The content of study.json (docs/formats/study.md), but format and origins, of runs that read_run() gave; `paper`: the folder data/paper. Scalars
    and NaN stand in it as they are; plain() makes JSON of them. InputError where the runs do not belong together."""
    require_one_study(runs)
    for run in runs:
        run.scalars = with_derived(run)
    is_papers = all(paper_speed_rpm(run.profile, paper) is not None for run in runs)
    numerics = other_numerics(runs)
    groups = speed_groups(runs)
    warnings = []
    for run in runs:
        warnings += [f"{run.name}: {warning}" for warning in run.warnings] + [text for text in numerics if text.startswith(run.name + ": ")]
    content = {
        "warnings": warnings,
        "verdict": None,
        "runs": [{"name": run.name, "rotation_rpm": run.rotation_rpm, "warnings": run.warnings, "scalars": run.scalars} for run in runs],
        "speeds": [{"rotation_rpm": group.rotation_rpm, "runs": [run.name for run in group.runs], "scalars": group.scalars} for group in groups],
        "laws": speed_laws(groups),
        "over_all_speeds": {name: speed_trend(name, groups) for name in dict.fromkeys(name for group in groups for name in group.scalars)},
        "friction": friction_collapse(groups),
        "paper_friction": None,
        "collapse": {column: collapse(column, groups) for column in ("mu", "k", "nu")},
        "consistency": [_consistency(group, paper, is_papers) for group in groups],
        "paper_table": None,
    }
    if is_papers:
        entries, found = paper_entries(paper), findings(content, groups)
        content["paper_table"] = rows = [judged(entry, *(found.get(entry["quantity"], ()) if entry["rotation_rpm"] is None else _at_speed(entry, groups)))
                                         for entry in entries]
        content["verdict"] = {verdict: sum(row["verdict"] == verdict for row in rows) for verdict in VERDICTS}
        a, b = (next(entry["value"] for entry in entries if entry["quantity"] == "friction." + name) for name in "ab")
        content["paper_friction"] = {"a": a, "b": b, "curve": curve(a, b, I_MIN, I_MAX)}
    return content
