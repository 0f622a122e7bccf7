"""What `drumlin calibrate` starts with --memory or --nonlocal once it has fitted mu(I): prints JSON with the tables that the law gains (TOML), the keys that
its record gains, and what the command says. A refusal is printed and ends with exit code 2.

usage: command.py OPTIONS NAME MAPS [NAME MAPS...]
  OPTIONS  JSON: fitted (how many of the runs; the others are held out), draws, memory, nonlocal, own_weight, I_min and I_max (null: no choice)
  MAPS     measured/maps.h5 of the run
"""

import json
import sys

import numpy as np
from drumlin import _drumlin
from drumlin.bed import amount, memory, spreading
from drumlin.bed.paths import BED, Paths
from drumlin.errors import InputError
from drumlin.figures import result_files


def plain(value):
    """What JSON holds; what was not computed as null."""
    if isinstance(value, dict):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(one) for one in value]
    if isinstance(value, (np.bool_, np.integer)):
        return value.item()
    if isinstance(value, float):
        return float(value) if np.isfinite(value) else None
    return value


def bed_of(file, options, own_weight=0.0):
    header, x, z, fields, half_widths = result_files.read_maps(file)
    numbers = {key: float(header[key]) for key in ("axis_depth", "drum_radius", "rotation", "interval_factor") if key in header}
    chosen = {key: options[key] for key in ("I_min", "I_max") if options[key] is not None}
    return _drumlin.bed(x, z, fields, half_widths, numbers, own_weight=own_weight, **chosen), x, z


def amounts_of(bed):
    return [bed.blocks[key] for key in ("I", "amount", "I_error", "amount_error")]


def table_of(beds, draws):
    """|s|/p over I."""
    points = [amounts_of(bed) for bed in beds]
    every = np.concatenate([inertial for inertial, *_ in points])
    if every.size < 24:
        raise InputError(f"--memory, --nonlocal: the amount of the stress is known in {every.size} blocks of the maps alone (needed: 24); take longer runs or "
                         "a larger drum")
    return _drumlin.fitted(points, "table", _drumlin.table_knots(every), draws)


def toml_of(tables):
    return "".join(f"[{name}]\n" + "".join(f"{key} = {json.dumps(plain(value))}\n" for key, value in keys.items()) for name, keys in tables.items())


def fit_record(fit):
    coefficients = zip(memory.NAMES, fit.law, fit.free, fit.ci99_sectors, fit.ci99_runs)
    return ({name: {"value": value, "held": not free, "ci99_sectors": sectors, "ci99_runs": runs} for name, value, free, sectors, runs in coefficients}
            | {"c_rho": fit.law.c_rho, "converged": fit.converged, "paths": fit.paths, "rms": fit.rms, "cost": fit.cost,
               "correlation": dict(zip(("c_m", "c_chi", "m_chi"), fit.correlation))})


def amount_record(found):
    """The key "remembered_amount"."""
    law, halves = found.law, dict(zip(("swelling", "lag", "creep"), found.ci99))
    record = {key: {"value": law[key], "ci99_sectors": halves[key]} for key in ("swelling", "lag")}
    creep = {"slope": {"value": law["creep"]["slope"], "ci99_sectors": halves["creep"]}, "ratio": law["creep"]["ratio"]} if "creep" in law else None
    return record | {"creep": creep, "own_weight": law["own_weight"], "c_nu": law["c_nu"], "c_psi": law["c_psi"], "rms_misfit": found.table.rms_misfit,
                     "trials": found.trials, "measured_dilatancy": found.measured, "runs": found.scores, "held_out": found.predictions}


def fit_text(what, fit):
    def shown(value, free, sectors, runs):
        over_runs = f", +- {runs:.2f} over runs" if np.isfinite(runs) else ""
        return f"{value:.2f} +- {sectors:.2f} (over sectors{over_runs})" if free else f"{value:.2f} (held)"

    each = (f"{name} = {shown(*of)}" for name, *of in zip(memory.NAMES, fit.law, fit.free, fit.ci99_sectors, fit.ci99_runs))
    return f"  {what}: {', '.join(each)}; rms of s/p {fit.rms:.4f} over {fit.paths} paths\n"


def scores_text(record):
    return "".join(f"  {what} {one['run']}: axes {one['bed']['axes_deg']:.1f} deg off in the bed, {one['flow']['axes_deg']:.1f} in the flow (without memory "
                   f"{one['bed']['axes_deg_without_memory']:.1f}, {one['flow']['axes_deg_without_memory']:.1f}); s/p {one['bed']['rms']:.4f}, "
                   f"{one['flow']['rms']:.4f}\n" for what, key in (("fitted", "runs"), ("predicted", "held_out")) for one in record[key])


def amount_text(found):
    law, (swelling, lag, creep) = found.law, found.ci99
    own = "the particles show no dilatancy of their own to compare it with"
    if found.measured:
        own = ("with the particles' own dilatancy, c_psi = {c_psi:g}, times {coefficient[value]:.2f} +- {coefficient[ci99_sectors]:.2f}"
               .format(**found.measured))
    crept = f", creep {law['creep']['slope']:.4f} +- {creep:.4f} per ln(|D|/|W|) below {law['creep']['ratio']:g}" if "creep" in law else ""
    return (f"  the amount: swelling {law['swelling']:.4f} +- {swelling:.4f} per ln I, c_nu = {law['c_nu']:g}, c_psi = {law['c_psi']:g}, lag "
            f"{law['lag']:.3f} +- {lag:.3f}{crept}; {own}\n"
            + "".join(f"  {what} {one['run']}: |s|/p {one['bed']['rms']:.4f} off in the bed, {one['flow']['rms']:.4f} in the flow (mu(I) alone "
                      f"{one['bed']['rms_alone']:.4f}, {one['flow']['rms_alone']:.4f})\n"
                      for what, scores in (("fitted", found.scores), ("predicted", found.predictions)) for one in scores))


def untold_text(sentences):
    return "  what the runs cannot tell\n" + "".join(f"  - {sentence}\n" for sentence in sentences)


def memory_of(runs, held_out, options, table):
    """(tables of the law, record, text) of --memory."""
    beds, own_weight = [bed for _, bed in runs], options["own_weight"]
    found = memory.axes_of(beds, table.at)
    law, line = found.law, memory.bed_line([amounts_of(bed) for bed in beds])
    keys = {"c": law.c, "m": law.m, "chi_deg": np.degrees(law.chi), "c_rho": law.c_rho, "I_low": law.I_low, "I_high": law.I_high}
    curve = {"I": table.knots, "mu": np.cumsum(table.coefficients)}
    tables, remembered, said = {}, None, ""
    if own_weight is not None:
        remembered = amount.amount_of(runs, held_out, law, table, own_weight)
        curve = {"I": remembered.table.knots, "mu": np.cumsum(remembered.table.coefficients)}
        tables["memory.amount"] = {key: value for key, value in remembered.law.items() if key != "creep"}
        if "creep" in remembered.law:
            tables["memory.amount.creep"] = remembered.law["creep"]
        said = amount_text(remembered)
    every = {key: np.concatenate([bed.blocks[key] for bed in beds]) for key in beds[0].blocks}
    untold = memory.untold(found, table, beds)
    scores = [[memory.score(name, Paths([bed], table.at), law) for name, bed in group] for group in (runs, held_out)]
    record = {
        "law": law._asdict(),
        "amount": {"points": [{"run": name, "I": bed.blocks["I"], "amount": bed.blocks["amount"]} for name, bed in runs],
                   "rms_misfit": table.rms_misfit, "range_of_validity": table.range, "curve": table.curve,
                   "bed_line": line and dict(zip("ab", line.coefficients)) | {"rms_misfit": line.rms_misfit, "points": line.points}},
        "free": fit_record(found.free), "bed_alone": fit_record(found.bed_alone), "bounded": fit_record(found.bounded),
        "trials": {"chi_range": found.leads, "c_rho": [{"c_rho": trial.law.c_rho, "c": trial.law.c, "chi": trial.law.chi, "rms": trial.rms,
                                                        "cost": trial.cost, "told_apart": apart} for trial, apart in found.carried]},
        "runs": scores[0], "held_out": scores[1], "arcs": memory.axes_on_arcs(Paths(beds, table.at), law, beds[0].radius),
        "dilation": memory.dilation(every), "remembered_amount": remembered and amount_record(remembered),
        "from_displacements": [bed.share_from_displacements for bed in beds], "untold": untold}
    head = (f"memory of the axes\n  |s|/p: a table of {table.points} points, I from {table.range[0]:.1e} to {table.range[1]:.1e}, rms {table.rms_misfit:.4f}")
    if line:
        head += f"; below I = {BED:g} {line.coefficients[0]:.3f} + {line.coefficients[1]:.4f} ln I, rms {line.rms_misfit:.4f}"
    held = "" if found.bounded.free[1] else fit_text("m held", found.bounded)
    return {"memory": keys | curve} | tables, record, (
        head + "\n" + fit_text("the bed alone, chi at every I", found.bed_alone) + fit_text("bed and flow", found.free) + held
        + f"  the law: c = {law.c:.2f}, m = {law.m:.2f}, chi = {law.chi:.2f} below I = {law.I_low:g}, atan(1/c) above {law.I_high:g}, c_rho = {law.c_rho:g}\n"
        + scores_text(record) + said + untold_text(untold))


def spreading_of(grids, table):
    """(tables of the law, record, text) of --nonlocal."""
    found = spreading.spreading_of(np.hstack([spreading.points_of(*grid) for grid in grids]), table.at)
    record, untold = found.record, found.untold()

    def shown(value, half):
        return f"{value:.3g}" + ("" if half is None else f" +- {half:.2g}")

    text = (f"nonlocal fluidity with a threshold, from {record['points']} points\n  A = {shown(found.amplitude, found.amplitude_ci99)}, mu_s = "
            f"{shown(found.mu_s, found.mu_s_ci99)} (99 %, over sectors); |s|/p of the bed {record['rms_bed']:.4f} off, without a threshold "
            f"{record['rms_local_bed']:.4f}\n"
            + "".join(f"  mu_s = {one['mu_s']:.2f}: A = {one['amplitude']:.2f}, bed {one['rms_bed']:.4f} off\n" for one in record["given_mu_s"])
            + "  measured: mu, I, lap g/g (per d^2), xi (d)\n"
            + "".join("    {mu[0]:.2f} to {mu[1]:.2f}  {I:.1e}  {curvature:+.3f}  ".format(**one) + (f"{one['xi']:.1f}\n" if one["curvature"] > 0 else "none\n")
                      for one in record["lengths"]) + untold_text(untold))
    head = {key: getattr(found, key) for key in ("amplitude", "mu_s", "amplitude_ci99", "mu_s_ci99")}
    return {"nonlocal": found.law} if found.is_told else {}, head | record | {"untold": untold}, text


def main(options, *words):
    options = json.loads(options)
    names = [name.encode("utf-8", "surrogateescape").decode("utf-8", "replace") for name in words[::2]]
    grids = [bed_of(file, options, options["own_weight"] or 0.0) for file in words[1::2]]
    every = [(name, bed) for name, (bed, _, _) in zip(names, grids)]
    runs, held_out = every[:options["fitted"]], every[options["fitted"]:]
    table = table_of([bed for _, bed in runs], options["draws"])
    tables, record, said = {}, {}, ""
    parts = {"memory": lambda: memory_of(runs, held_out, options, table), "nonlocal": lambda: spreading_of(grids[:options["fitted"]], table)}
    for key, part in parts.items():
        if options[key]:
            gained, record[key], text = part()
            tables |= gained
            said += text
    print(json.dumps({"tables": toml_of(tables), "record": plain(record), "said": said}))


if __name__ == "__main__":
    main(*sys.argv[1:])
