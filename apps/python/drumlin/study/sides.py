"""`drumlin compare --study`: particles and continuum over the speed of rotation; a law calibrated at one speed and asked for the others.

Pairs are contents of comparison.json (docs/formats/comparison.md) as `drumlin compare FIRST SECOND` leaves them, by (first folder, second folder,
"axis" or "surface"); errors of fields and what a side shows at the places of the other are taken from them."""

import math
from collections import Counter

import numpy as np

from ..errors import InputError
from .fits import ABSENT, Scalar, mean
from .laws import speed_laws
from .paper import paper_entries, paper_numbers, paper_speed_rpm
from .quantities import with_derived
from .runs import Speed, other_numerics, refused, require_one_study, same_speed, speed_groups

SCALARS = ("theta_deg", "Q", "H", "lambda", "shear_rate", "I_th")
READABLE = 80  # letters; the points of a table are more


def number(entry, key="value"):
    """A number of a JSON file, {"value": ...} or plain; NaN for null."""
    entry = entry.get(key) if isinstance(entry, dict) else entry if key == "value" else None
    return math.nan if entry is None else entry


def require_one_law(flows):
    """InputError unless all flows were made with the law and effects of the first, each at a speed of its own."""
    problems, first = [], flows[0]
    for i, flow in enumerate(flows):
        for key in sorted(flow.identity):
            ours, theirs = flow.identity[key], first.identity[key]
            if ours != theirs:
                text = f"{ours}, but {theirs} in {first.name}" if max(len(ours), len(theirs)) <= READABLE else f"another than in {first.name}"
                problems.append((flow.name, key, text, "one law and the same effects in all flows of a study"))
        problems += [(flow.name, "rotation", f"is the speed of {other.name}, too", "one flow per speed")
                     for other in flows[:i] if same_speed(flow.rotation_rpm, other.rotation_rpm)]
    return problems


def require_one_drum(run, flows):
    problems = []
    for flow in flows:
        for key, allowed in (("drum_radius", "the same drum on both sides"), ("diameter_m", "the same drum on both sides"),
                             ("reduced", "both reduced or both full")):
            ours, theirs = run.profile.header.get(key, "nothing"), flow.profile.header.get(key, "nothing")
            if key == "reduced":
                same = ours == theirs != "nothing"
            else:  # to 1e-3: the discs drawn against their mean
                same = abs(run.profile.number(key) - flow.profile.number(key)) <= 1e-3 * abs(run.profile.number(key))
            if not same:
                problems.append((flow.name, key, f"{theirs}, but {ours} in {run.name}", allowed))
    return problems


def pair(pairs, first, second, by):
    """The comparison of two sides; InputError where they could not be compared."""
    found = pairs[first.folder, second.folder, by]
    if "refused" in found:
        raise InputError(found["refused"])
    return found


def _of_zone(target, comparisons, relative):
    """(error, what the particles' intervals amount to by the same measure, places that the flow leaves undefined, remarks): means over the comparisons."""
    zones = [(comparison["errors"][target["quantity"]] or {}).get(target["zone"], {}) for comparison in comparisons]
    error, floor, size = (mean([number(zone.get(key)) for zone in zones]) for key in ("rel_l2" if relative else "rms", "interval_rms", "particles_rms"))
    layers, undefined = (sum(zone.get(key, 0) for zone in zones) for key in ("layers", "undefined"))
    remark = "a side has no such field" if not zones[0] else "" if layers + undefined else "no layer in this zone"
    return error, floor / size if relative else floor, f"{undefined} of {undefined + layers} layers undefined in the continuum" if undefined else "", remark


def _of_scalar(particles, continuum, relative):
    unit = abs(particles.value) if relative else 1
    remark = "not computed by the continuum" if math.isnan(continuum) else "not measured on the particles" if math.isnan(particles.value) else ""
    return abs(continuum - particles.value) / unit, particles.half / unit, "", remark


def judged_targets(comparisons, scalars):
    """The targets of docs/formats/comparison.md over several comparisons with one flow: fields by the mean of their errors, scalars as they stand here. A
    limit narrower than the particles' own interval asks for more than they know: that judges."""
    rows = []
    for target in comparisons[0]["targets"] if comparisons else []:
        sides, relative = scalars.get(target["quantity"]), target["measure"] == "relative"
        value, floor, undefined, remark = (_of_zone(target, comparisons, relative) if "zone" in target
                                           else _of_scalar(sides["particles"], sides["continuum"].value, relative))
        noisy = floor > target["limit"]
        outcome = "not_measured" if math.isnan(value) else "met" if value <= (floor if noisy else target["limit"]) else "missed"
        row = {key: target[key] for key in ("quantity", "zone", "measure", "limit") if key in target}
        row |= {"value": value, "outcome": "missed" if undefined else outcome, "judged_by": "noise floor" if noisy else "limit"}
        if noisy:
            row["noise_floor"] = floor
        remarks = [remark, f"the particles' own interval amounts to {floor:.2g}" if noisy else "", undefined]
        if any(remarks):
            row["remark"] = "; ".join(filter(None, remarks))
        if "zone" not in target and sides["particles"].ci99 is not None and math.isfinite(value):
            row["inside_interval"] = bool(abs(sides["continuum"].value - sides["particles"].value) <= sides["particles"].ci99)
        rows.append(row)
    return rows


def counts_of(targets):
    counts = Counter(target["outcome"] for target in targets)
    return {outcome: counts[outcome] for outcome in ("met", "missed", "not_measured")} | {
        "by_noise_floor": sum(target["judged_by"] == "noise floor" for target in targets)}


def _continuum(flow, comparisons, name):
    """What a flow shows of a scalar at the places of the runs, mean over them; without runs from its own surface."""
    if flow is None or not comparisons:
        return ABSENT if flow is None else Scalar(flow.scalars.get(name, ABSENT).value)
    found = [comparison["scalars"][name]["continuum"] for comparison in comparisons]
    value, ci99 = mean([number(one) for one in found]), mean([number(one, "ci99") for one in found])
    return Scalar(value, ci99 if math.isfinite(ci99) else None)


def _speed(rpm, group, flow, pairs, paper):
    """One entry of `speeds` in study.json; group or flow may be None. `paper`: {name: Scalar} of the paper at this speed."""
    runs = group.runs if group else []
    comparisons = [pair(pairs, run, flow, "axis") for run in runs] if flow else []
    scalars = {}
    for name in SCALARS:
        said = paper.get(name, ABSENT)
        scalars[name] = {"paper": said.value if said.ci99 is None else {"value": said.value, "half_width": float(said.ci99)},
                         "particles": group.scalars.get(name, ABSENT) if group else ABSENT, "continuum": _continuum(flow, comparisons, name)}
    targets = judged_targets(comparisons, scalars)
    particles, continuum = mean([run.cpu_seconds for run in runs]), flow.cpu_seconds if flow else math.nan
    return {"rotation_rpm": rpm, "role": "", "particles": [run.name for run in runs], "continuum": flow.name if flow else None, "scalars": scalars,
            "verdict": counts_of(targets), "targets": targets,
            "seconds": {"particles": particles, "continuum": continuum, "ratio": particles / continuum, "start": flow.start if flow else ""}}


def _role(speed, fitted_on, is_known):
    """What a speed can say of the law."""
    if speed["continuum"] is None or not speed["particles"]:
        return "particles only" if speed["continuum"] is None else "continuum only"
    return "calibrated" if fitted_on & set(speed["particles"]) else "predicted" if is_known else "unknown"


def _laws(groups, speeds, paper):
    """{law: formula and the coefficients of particles, continuum, paper (None: another drum)}; the continuum's slope is that of its surface alone."""
    of_continuum = []
    for speed in speeds:
        if speed["continuum"] is not None:
            scalars = {name: Scalar(one["continuum"].value) for name, one in speed["scalars"].items()}
            scalars["mu_eff"] = Scalar(math.tan(math.radians(scalars["theta_deg"].value)))
            of_continuum.append(Speed(speed["rotation_rpm"], [], scalars))
    said = {entry["quantity"]: Scalar(entry["value"], math.nan if entry["half_width"] is None else entry["half_width"])
            for entry in (paper_entries(paper) if paper else [])}
    theirs, laws = speed_laws(of_continuum), {}
    for name, law in speed_laws(groups).items():
        if name.endswith("_com"):
            continue
        laws[name] = {"formula": law["formula"], "particles": law["coefficients"], "continuum": theirs[name]["coefficients"]}
        known = {quantity.removeprefix(name + "."): value for quantity, value in said.items() if quantity.startswith(name + ".")}
        if known:
            laws[name]["paper"] = known
    return laws


def _warnings(runs, flows, speeds):
    warnings = [f"{run.name}: {warning}" for run in runs for warning in run.warnings] + other_numerics(flows)
    for speed in speeds:
        text = f"{speed['rotation_rpm']:f}"
        rpm = text[:text.index(".") + 2]
        if speed["role"] == "particles only":
            warnings.append(f"no flow at {rpm} rpm, the speed of {speed['particles'][0]}")
        if speed["role"] == "continuum only":
            warnings.append(f"no particle run at {rpm} rpm, the speed of {speed['continuum']}")
    if not any(speed["role"] == "calibrated" for speed in speeds):
        warnings.append("the law was fitted on none of these runs: which speed is calibrated and which predicted is not known")
    return warnings


@np.errstate(all="ignore")
def compared_speeds(runs, flows, pairs, paper):
    """The content of study.json (docs/formats/comparison-study.md), but format, law and origins: each flow against every run of its speed, by the axis.
    InputError where they do not belong together: one side empty, other drums, laws or effects, two flows at one speed. A speed that one side lacks is kept
    and warned of. `paper`: the folder data/paper."""
    for side, what in ((runs, "measured particle run"), (flows, "continuum flow")):
        if not side:
            raise InputError(f"a study of both sides needs a {what}; there is none")
    require_one_study(runs)
    if problems := require_one_law(flows) + require_one_drum(runs[0], flows):
        raise refused(problems)
    for run in runs:
        run.scalars = with_derived(run)
    groups, speeds, is_papers = speed_groups(runs), [], True
    rotations = [group.rotation_rpm for group in groups]
    rotations += [flow.rotation_rpm for flow in flows if not any(same_speed(rpm, flow.rotation_rpm) for rpm in rotations)]
    for rpm in sorted(rotations):
        group, flow = (next((one for one in side if same_speed(rpm, one.rotation_rpm)), None) for side in (groups, flows))
        papers = paper_speed_rpm(group.runs[0].profile if group else flow.profile, paper)
        is_papers = is_papers and papers is not None
        speeds.append(_speed(rpm, group, flow, pairs, {} if papers is None else paper_numbers(paper, papers)))
    fitted_on = set(flows[0].fitted_on)
    is_known = any(run.name in fitted_on for run in runs)
    for speed in speeds:
        speed["role"] = _role(speed, fitted_on, is_known)
    content = {"warnings": _warnings(runs, flows, speeds), "fitted_on": flows[0].fitted_on, "speeds": speeds,
               "laws": _laws(groups, speeds, paper if is_papers else None)}
    # Predictions count, not what was fitted; where no speed is known to be one, those of unknown role.
    verdicts = [{"role": role} | counts_of([target for speed in speeds if speed["role"] == role for target in speed["targets"]])
                for role in ("predicted", "unknown")]
    content["verdict"] = verdicts[0] if verdicts[0]["met"] + verdicts[0]["missed"] else verdicts[1]
    return content
