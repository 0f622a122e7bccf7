"""The contents of study.json as tables in Markdown, and as what the commands print; plain() makes JSON of them first."""

import json
import math

from .fits import Scalar
from .paper import VERDICTS

NOT_THE_PAPERS = "This drum is none of the paper's six; its numbers do not apply.\n"


def plain(value):
    """What JSON holds: a Scalar as {"value", "ci99"}, or its number where it has no interval; what was not computed as null."""
    if isinstance(value, Scalar):
        value = value.value if value.ci99 is None else {"value": value.value, "ci99": value.ci99}
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return value


def shown(entry, digits=4):
    """"19.7 +- 0.2" of a number, plain or not; a dash for what was not measured."""
    entry = plain(entry)
    if not isinstance(entry, dict):
        return "-" if entry is None else f"{entry:.{digits}g}"
    half = entry.get("ci99", entry.get("half_width"))
    return shown(entry["value"], digits) + (f" +- {half:.2g}" if half is not None and entry["value"] is not None else "")


def _table(head, rows):
    return "".join(f"| {' | '.join(row)} |\n" for row in [head]) + "|" + "---|" * len(head) + "\n" + "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _paper_words(row):
    if row["expects"] == "value":
        return shown(row["paper"]) + (f" +- {row['paper_half_width']:.2g}" if "paper_half_width" in row else "")
    return row["expects"] + (f" (limit {shown(row['limit'])})" if "limit" in row else "")


def paper_table(content):
    """One line per entry of the paper."""
    if content["paper_table"] is None:
        return NOT_THE_PAPERS
    rows = [(row["quantity"], "all" if row["rotation_rpm"] is None else shown(row["rotation_rpm"]), _paper_words(row), shown(row["ours"]),
             "**differs**" if row["verdict"] == "differs" else row["verdict"], row["reason"], row["source"].replace("|", "\\|"))
            for row in content["paper_table"]]
    return _table(("quantity", "rpm", "paper", "ours (99 %)", "verdict", "why", "where in the paper"), rows)


def study_text(content):
    """What `drumlin measure --study` prints."""
    lines = [f"warning: {warning}" for warning in content["warnings"]] + ["", "laws over the speed of rotation (99 %)"]
    for name, law in content["laws"].items():
        lines.append(f"  {name:28} {law['formula']}")
        for key, c in law["coefficients"].items():
            value, half = (math.nan if c[part] is None else c[part] for part in ("value", "ci99"))
            lines.append(f"  {'':28}   {key} = {value:.4g} +- {half:.2g}")
    for column, found in content["collapse"].items():
        if found["collapse"] is None:
            ratio, limit, words = math.nan, math.nan, "unknown: requires runs of two speeds"
        else:
            ratio, limit, words = found["ratio"], found["limit"], "one curve" if found["collapse"] else "not one curve"
        lines.append(f"  {column + '(I)':28} spread between speeds / intervals = {ratio:.2f} (limit {limit:.2f}): {words}")
    text = "\n".join(lines) + f"\n\n{paper_table(content)}\n"
    if content["verdict"] is None:
        return text
    counts = ", ".join(f"{content['verdict'][verdict]} {words}" for verdict, words in zip(VERDICTS, ("agree", "open", "near", "differ", *VERDICTS[4:])))
    return text + counts + "\n"


def _name(target):
    return target["quantity"], target.get("zone")


def verdict_lines(speeds):
    """"5 rpm, predicted: 9 of 11 targets met; missed: ..." for each speed."""
    lines = []
    for speed in speeds:
        met, missed = speed["verdict"]["met"], speed["verdict"]["missed"]
        misses = [f"{' '.join(filter(None, _name(target)))} {shown(target['value'], 2)} (limit {target['limit']:g} {target['measure']}"
                  + ("; inside the particles' interval)" if target.get("inside_interval") else ")")
                  for target in speed["targets"] if target["outcome"] == "missed"]
        if met + missed:
            noise = [f"{' '.join(filter(None, _name(target)))} {shown(target['value'], 2)} (limit {target['limit']:g}, noise floor {shown(target['noise_floor'], 2)})"
                     for target in speed["targets"] if target["outcome"] == "met" and target["value"] > target["limit"]]
            lines.append(f"{speed['rotation_rpm']:.3g} rpm, {speed['role']}: {met} of {met + missed} targets met"
                         + (f", by the noise floor alone: {', '.join(noise)}" if noise else "") + (f"; missed: {', '.join(misses)}" if misses else ""))
    return lines


def _target_cell(target):
    text = "-" if target["value"] is None else f"{target['value']:.3f}"
    if target["outcome"] != "missed":
        return text
    return f"**{text}**" + (" (inside the interval)" if target.get("inside_interval") else "")


def speed_table(content):
    """A line per speed with the results of all sides, a line per target with its value at each speed."""
    three, two = ("paper", "particles", "continuum"), ("particles", "continuum")
    columns = [(name, side) for name, sides in (("theta_deg", three), ("H", three), ("lambda", three), ("shear_rate", two), ("I_th", two)) for side in sides]
    words = {"theta_deg": "theta (deg)", "shear_rate": "shear rate"}
    firsts = {(name, next(side for other, side in columns if other == name)) for name, _ in columns}
    head = [f"{words.get(name, name)}: {side}" if (name, side) in firsts else side for name, side in columns]
    rows = [[f"{speed['rotation_rpm']:.3g}", speed["role"], *(shown(speed["scalars"][name][side]) for name, side in columns),
             *(shown(speed["seconds"][side]) for side in two)] for speed in content["speeds"]]
    text = _table(["rpm", "", *head, "seconds: particles", "continuum"], rows).replace("|  |", "| |") + "\nErrors of the continuum; bold: missed.\n\n"
    compared = [speed for speed in content["speeds"] if speed["targets"]]
    if not compared:
        return text
    head = ["target", "limit", *(f"{speed['rotation_rpm']:.3g} rpm, {speed['role']}" for speed in compared)]
    rows = [[", ".join(filter(None, _name(targets[0]))), f"{targets[0]['limit']:g} {targets[0]['measure']}", *map(_target_cell, targets)]
            for targets in zip(*(speed["targets"] for speed in compared))]
    return text + _table(head, rows)


def _limit_cell(cell):
    text = shown(cell["value"], 3)
    if cell["met"] is False:
        text = f"**{text}**"
    return text if cell["floor"] is None else text + f" ({shown(cell['floor'], 3)}{'*' if cell['floor_of_other_speeds'] else ''})"


def _limit_rows(judged, by):
    for row in judged["rows"]:
        if row["registered_by"] == by:
            worst = f", one speed {shown(row['must_worst'], 3)}" if "must_worst" in row else ""
            yield [f"{' '.join(filter(None, _name(row)))}, {row['where']}, {row['measure']}", f"{shown(row['must'], 3)}{worst}; {shown(row['aim'], 3)}",
                   *map(_limit_cell, row["cells"]), row["must_outcome"], row["aim_outcome"]]


def limits_table(judged):
    """A line per limit with its value and noise floor at each speed, first by the axis, then by the surface."""
    speeds = [f"{rpm:.3g} rpm" for rpm in judged["speeds_rpm"]]
    tables = [_table([f"by the {by}", "must; aim", *speeds, "must", "aim"], _limit_rows(judged, by)) for by in ("axis", "surface")]
    text = ("Errors of the continuum; in brackets the noise floor, the same between two seeds (*: that of other speeds); bold: beyond the limit.\n\n"
            + "\n".join(tables))
    names = judged["judged_by_calibrating_runs"]
    if names:
        text += f"\nJudged by runs that calibrated the law, since their speed has no others: {json.dumps(names, separators=(',', ':'))}\n"
    return text


def score_table(name, content):
    """What `drumlin score` prints: a line per limit, by the axis."""
    words = {True: "yes", False: "**no**", None: "not measured"}
    rows = [[f"{' '.join(filter(None, _name(row)))}, {row['where']}, {row['measure']}", shown(row["error"], 3), f"{shown(row['limit'], 3)}; {shown(row['aim'], 3)}",
             shown(row["noise_floor"], 3), words[row["met"]]] for row in content["rows"] if row["registered_by"] == "axis"]
    counts = ", ".join(f"{count} {outcome.replace('_', ' ')}" for outcome, count in content["verdict"].items())
    runs = f"{', '.join(content['against'])}{' (which calibrated its law)' if content['calibrated_on_them'] else ''}"
    return f"{name} at {shown(content['rotation_rpm'])} rpm against {runs}: {counts}\n\n" + _table(["quantity", "error", "limit; aim", "noise floor", "met"], rows)
