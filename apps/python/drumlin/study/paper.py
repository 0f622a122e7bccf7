"""Every number and statement of the paper (data/paper) against what a study found."""

import math
import pathlib

from .fits import ABSENT, Scalar
from .runs import read_toml, refused

FORM = "drumlin-paper-1"
NEAR, WIDE = 0.1, 0.25  # shares of the paper's value (or scale)
EXPECTED = ("zero", "not zero", "positive", "collapse", "no collapse")
VERDICTS = ("agrees", "open", "near", "differs", "imposed", "not measured")
INSIDE, OUTSIDE = ("agrees", "inside the interval"), ("differs", "outside the interval")


def _table(folder, name, key):
    content = read_toml(pathlib.Path(folder) / name, FORM)
    if key not in content:
        raise refused([(f"{pathlib.Path(folder) / name}:1", key, "is missing", "an array of tables")])
    return content, content[key]


def _entry(row, **changes):
    """quantity, rotation_rpm (None: every speed), expects, value (x downslope, whatever the paper's axis), half_width, source, remark."""
    value = float(row.get("value", math.nan))
    return {"quantity": row.get("name", ""), "rotation_rpm": row.get("rotation_rpm"), "expects": "value", "half_width": row.get("half_width"),
            "value": -value if row.get("x_axis") == "upslope" else value, "source": row.get("source", ""), "remark": row.get("remark", "")} | changes


def _claims(folder):
    for claim in _table(folder, "claims.toml", "claim")[1]:
        if claim.get("expects") not in EXPECTED:
            raise refused([(str(pathlib.Path(folder) / "claims.toml"), "expects", "is missing or not known here", ", ".join(EXPECTED))])
        yield _entry(claim, expects=claim["expects"], value=0.0, remark=claim.get("statement", ""))


def paper_entries(folder):
    """Table I (18 entries), the observables that no law repeats, the coefficients of the laws as LAW.COEFFICIENT, the claims. The paper does not say how it
    measures the slope: what rests on it is asked again of the angle of the centre of mass."""
    table, rows = _table(folder, "rotations.toml", "rotation")
    entries = [_entry(row, quantity=name, value=float(row[name]), source=table["source"]) for name in ("Q", "theta_deg", "H") for row in rows]
    entries += [_entry(row) for row in _table(folder, "observables.toml", "observable")[1] if "law" not in row]
    # Neither the range of a law is a result, nor the volume fraction that a stress is expected from.
    entries += [_entry(law, quantity=f"{law['name']}.{coefficient}", value=float(value), remark=law["formula"])
                for law in _table(folder, "laws.toml", "law")[1] for coefficient, value in law["coefficients"].items()
                if coefficient not in ("I_min", "I_max", "nu")]
    entries += _claims(folder)
    remark = "the same entry, with the angle of the centre of mass as the slope"
    for entry in list(entries):
        law, dot, coefficient = entry["quantity"].partition(".")
        if entry["quantity"] == "theta_deg":
            entries.append(entry | {"quantity": "theta_com_deg", "remark": remark})
        elif dot and law in ("effective_friction", "shear_rate"):
            entries.append(entry | {"quantity": f"{law}_com.{coefficient}", "remark": remark})
    return entries


def paper_speed_rpm(profile, folder):
    """The paper's speed whose drum a profile's header describes: 450 mm, full size, one of six speeds, each to 1 %, in gravity of 9.81 m/s2; else None."""
    def close(a, b):
        return abs(a - b) <= 0.01 * abs(b)

    d, radius = profile.number("diameter_m"), profile.number("drum_radius")
    drum = read_toml(pathlib.Path(folder) / "experiment.toml", FORM)["drum"]["diameter_mm"]
    if profile.header.get("reduced") != "false" or not close(2e3 * radius * d, drum):
        return None
    rpm = profile.number("rotation") / math.sqrt(d / 9.81) * 30 / math.pi
    speeds = [row["rotation_rpm"] for row in _table(folder, "rotations.toml", "rotation")[1]]
    return next((speed for speed in speeds if close(rpm, speed)), None)


def paper_numbers(folder, rpm):
    """{name: Scalar} of the paper at one of its speeds: Table I, then the observables, those stated for this very speed before those for all."""
    found = {}
    for row in _table(folder, "rotations.toml", "rotation")[1]:
        if row["rotation_rpm"] == rpm:
            found |= {name: Scalar(float(row[name])) for name in ("theta_deg", "Q", "H")}
    rows = _table(folder, "observables.toml", "observable")[1]
    for row in [row for row in rows if row.get("rotation_rpm") == rpm] + [row for row in rows if "rotation_rpm" not in row]:
        found.setdefault(row["name"], Scalar(float(row["value"]), row.get("half_width")))
    return found


def paper_shear_rate(folder, rpm, theta_deg):
    """The paper's shear rate at a speed: stated, else by its own law at its own slope."""
    stated = paper_numbers(folder, rpm).get("shear_rate")
    if stated is not None:
        return stated.value
    law = next(law for law in _table(folder, "laws.toml", "law")[1] if law["name"] == "shear_rate")["coefficients"]
    Phi = math.radians(law["Phi_deg"])
    return law["c"] * math.sqrt((math.sin(math.radians(theta_deg)) - math.sin(Phi)) / math.cos(Phi))


def _against(expected, half_width, wide, near, ours):
    """Of a number: inside our interval plus the paper's half width, or near, or outside."""
    difference, interval = abs(ours.value - expected), ours.ci99 or 0
    if difference <= interval + half_width:
        return ("open", "inside a wide interval") if interval > wide else INSIDE
    return ("near", "within 10 %") if difference <= near else OUTSIDE


def verdict_on(entry, ours=ABSENT, scale=1.0, limit=1.0):
    """(verdict, reason) by the table of docs/formats/study.md. `scale`: what zero is small against; `limit`: of the ratio of a collapse."""
    expects, value = entry["expects"], entry["value"]
    if not math.isfinite(ours.value):
        return "not measured", "not measured"
    if entry["quantity"] == "Q":
        return "imposed", "fill and speed give it"
    if expects == "value":
        return _against(value, entry["half_width"] or 0, WIDE * abs(value), NEAR * abs(value), ours)
    if expects == "zero":
        return _against(0, 0, WIDE * scale, NEAR * scale, ours)
    if expects in ("not zero", "positive"):
        if not abs(ours.value) > (math.inf if ours.ci99 is None else ours.ci99):
            return "near", "the interval holds zero"
        return INSIDE if expects == "not zero" or ours.value > 0 else OUTSIDE
    one_curve = ours.value <= limit
    if one_curve == (expects == "collapse"):
        return INSIDE
    return ("near" if not one_curve and ours.value <= 2 * limit else "differs"), "outside the interval"


def judged(entry, ours=ABSENT, scale=1.0, limit=1.0):
    """A row of paper_table in study.json."""
    verdict, reason = verdict_on(entry, ours, scale, limit)
    row = {"quantity": entry["quantity"], "rotation_rpm": None if entry["rotation_rpm"] is None else float(entry["rotation_rpm"]), "expects": entry["expects"]}
    if entry["expects"] == "value":
        row["paper"] = entry["value"]
    if entry["half_width"] is not None:
        row["paper_half_width"] = float(entry["half_width"])
    row["ours"] = ours
    if entry["expects"] == "zero":
        row["scale"] = scale
    if entry["expects"] in ("collapse", "no collapse"):
        row["limit"] = limit
    return row | {"verdict": verdict, "reason": reason, "source": entry["source"]} | ({"remark": entry["remark"]} if entry["remark"] else {})
