"""The tables of results in README and docs, printed from the files in data/ into the pages that show them.

usage: result_tables.py [--check] PAGE...
In a page a table stands between `<!-- table NAME -->` and `<!-- end of table -->`, NAME one of TABLES below. Without --check the pages are
written anew where a table changed. With it nothing is written: the exit code is 1 if a page differs, and the first difference is printed.
"""

import csv
import json
import math
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "apps" / "figures"))

import numpy as np  # noqa: E402
import result_files  # noqa: E402  (they lie there)
import whole_file  # noqa: E402

DATA = ROOT / "data"
SPEEDS = (2, 4, 5, 6, 10, 15)


def read(name):
    text = (DATA / name).read_text()
    return tomllib.loads(text) if str(name).endswith(".toml") else json.loads(text)


def number(value, digits=3):
    """To `digits` significant digits, without exponent."""
    if value is None or not math.isfinite(value):
        return ""
    if value == 0:
        return "0"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def interval(scalar):
    """A value with its 99 % interval, both to the second digit of the interval."""
    value, width = scalar["value"], scalar.get("ci99")
    if not width:
        return number(value)
    places = max(0, 1 - math.floor(math.log10(width)))
    return f"{value:.{places}f} +- {width:.{places}f}"


def table(head, rows):
    lines = ["| " + " | ".join(row) + " |" for row in [head, *rows]]
    return "\n".join([lines[0], "|" + "---|" * len(head), *lines[1:]])


def paper_rows():
    """The paper's entries against the runs of data/bed: the cells of each."""
    lines = (DATA / "memory/paper-table.csv").read_text().splitlines()
    return list(csv.reader(lines[2:]))


def rotations():
    return {entry["rotation_rpm"]: entry for entry in read("paper/rotations.toml")["rotation"]}


def observables():
    return {(entry["name"], entry.get("rotation_rpm")): entry["value"] for entry in read("paper/observables.toml")["observable"]}


def summary():
    """6 rpm in a few rows, with what each side costs."""
    record, paper, said = read("cost/drum-6rpm.json"), rotations()[6], observables()
    both = record["comparison"]["scalars"]
    rows = [[words, number(stated), interval(both[key]["particles"]), number(both[key]["continuum"]["value"] if isinstance(both[key]["continuum"], dict) else both[key]["continuum"])]
            for words, key, stated in (("slope theta (deg)", "theta_deg", paper["theta_deg"]), ("flow rate Q", "Q", paper["Q"]),
                                       ("depth of the flowing layer H", "H", paper["H"]), ("shear rate of the flowing layer", "shear_rate", said[("shear_rate", 6)]))]
    counts = record["comparison"]["verdict"]
    alone = [target["beside"]["outcome"] for target in record["comparison"]["targets"]]
    return table(["", "paper", "particles (99 %)", "continuum"], rows + [
        ["processor seconds", "", f"{record['particles']['cpu_seconds']:.0f}", f"{record['continuum']['cpu_seconds']:.0f}"]]) + (
        f"\n\nTargets met with memory of the axes: {counts['met']} of {counts['met'] + counts['missed']}, {counts['by_noise_floor']} of them judged by the noise floor of the "
        f"particles; with mu(I) alone: {alone.count('met')} of {len(alone)}.")


def times():
    """What is to be waited for, of one record."""
    calls = {call["command"]: call for call in read("cost/build.json")["calls"]}
    bare = next(call for command, call in calls.items() if command.startswith(".ci/install"))

    def minutes(seconds):
        return f"{seconds / 60:.1f} min"

    return table(["", "wall time"], [
        ["build all programs, packages in place", minutes(calls["cmake --build BUILD --target programs"]["wall_seconds"])],
        ["from a bare Debian 12 to a measured small drum with its law, without the continuum", minutes(sum(bare["wall_seconds"]))],
        ["`./reproduce`, build included, packages in place", minutes(calls["./reproduce"]["wall_seconds"])],
        ["`./check` after it", minutes(calls["./check"]["wall_seconds"])]])


def headline():
    """6 rpm: what one ./reproduce gives, and what several seeds say."""
    record, paper, said = read("cost/drum-6rpm.json"), rotations()[6], observables()
    both = record["comparison"]["scalars"]
    friction = next(law["coefficients"] for law in read("paper/laws.toml")["law"] if law["name"] == "friction")

    def row(name, key, stated, continuum=None):
        flow = both[key]["continuum"]
        if continuum is None:
            continuum = interval(flow) if isinstance(flow, dict) else number(flow)
        return [name, number(stated), interval(both[key]["particles"]), continuum]

    share = 0.4 * said[("shear_rate", 6)] * paper["H"] ** 2 / paper["Q"]
    sizes, particles, flow = drums()
    others, predicted = [size for size in sizes if size != 450], flow("axes and stress ratio of 450 mm")
    return table(["", "paper", "particles", "continuum"], [
        row("slope theta (deg)", "theta_deg", paper["theta_deg"]),
        row("flow rate Q", "Q", paper["Q"]),
        row("depth of the flowing layer H", "H", paper["H"]),
        row("shear rate of the flowing layer", "shear_rate", said[("shear_rate", 6)]),
        row("decay length lambda", "lambda", said[("lambda", 6)]),
        row("I at z = -H", "I_th", said[("I_th", None)]),
        row("volume fraction of the bulk", "nu_bulk", said[("nu_bulk", None)], "taken over"),
        ["a, b of mu = a + b ln I", f"{friction['a']:g}, {friction['b']:g}", interval(both["mu_a"]["particles"]) + ", " + interval(both["mu_b"]["particles"]), "a table from the tensors"],
        row("linear share of Q, 0.4 shear rate H^2/Q", "linear_layer_share", share),
        [f"theta (deg) in drums of {', '.join(f'{size:g}' for size in others)} mm, law of 450 mm (`data/sizes/sizes.json`)", "", *(", ".join(of("theta_deg", size) for size in others) for of in (particles, predicted))],
        ["cost (processor seconds)", "", f"{record['particles']['cpu_seconds']:.0f}", f"{record['continuum']['cpu_seconds']:.0f}"],
    ]) + "\n\n" + seeds_together()


def seeds_together():
    found = {row[0]: row[3] for row in paper_rows() if row[1] == "6"}
    return (f"{len(list(DATA.glob('bed/6rpm-*')))} seeds of five turns at 6 rpm (`data/memory/paper-table.csv`): H {found['H']}, lambda {found['lambda']}, shear rate {found['shear_rate']}, "
            f"theta {found['theta_deg']} deg.")


def targets():
    """Errors of the one ./reproduce, with memory and without."""
    words = {"log10_shear_rate": "log10 shear rate", "axis_angle_deg": "axes (deg)", "theta_deg": "theta (deg)", "H": "H (d)"}
    zones = {"static": ", bed", "flowing": ", flow", "all": "", None: ""}
    rows = []
    for target in read("cost/drum-6rpm.json")["comparison"]["targets"]:
        floor = f" ({number(target['noise_floor'], 2)})" if target["judged_by"] == "noise floor" else ""
        rows.append([words.get(target["quantity"], target["quantity"]) + zones[target.get("zone")], f"{target['limit']:g}{floor}",
                     *(judged({"value": side["value"], "met": side["outcome"] == "met"}) for side in (target, target["beside"]))])
    return table(["", "limit (noise floor, where it judges)", "with memory", "mu(I) alone"], rows)


def verdicts():
    rows = paper_rows()
    count = {word: sum(row[4] == word for row in rows) for word in ("agrees", "open", "near", "differs", "imposed")}
    return (f"Of {len(rows)} entries {count['agrees']} agree, {count['open']} are open, {count['near']} are near, {count['differs']} differ, and {count['imposed']} are imposed.")


def paper_differs():
    return table(["quantity", "rpm", "paper", "ours (99 %)"], [row[:4] for row in paper_rows() if row[4] == "differs"])


def folder_of(rpm):
    return DATA / f"bed/{rpm}rpm-{5 if rpm == 6 else 3}turns-seed1/measured"


def read_profile(rpm):
    """Columns of a profile at x = 0, from the surface downwards, where v_x is known."""
    _, header, columns = result_files.read_table(folder_of(rpm) / "profiles.csv")
    order = np.argsort(-columns["z"], kind="stable")
    order = order[np.isfinite(columns["v_x"][order])]
    return {name: values[order] for name, values in columns.items()} | {name: float(header[name]) for name in ("rotation", "axis_depth")}


def crossing(profile, name, level, highest=math.inf):
    """The highest place z below `highest` at which a column passes through `level`."""
    z, left = profile["z"], profile[name] - level
    for i in np.flatnonzero((left[:-1] * left[1:] <= 0) & (left[:-1] != left[1:]) & (z[:-1] < highest)):
        return z[i] + (z[i + 1] - z[i]) * left[i] / (left[i] - left[i + 1])
    return math.nan


def at_surface(profile):
    """v_x at z = 0."""
    return np.interp(0, profile["z"][::-1], profile["v_x"][::-1])


def line_depth(profile, keep):
    """Where the straight line through the layers below z = 0 that `keep` takes reaches zero."""
    kept = (profile["z"] <= 0) & keep
    z, v = profile["z"][kept], profile["v_x"][kept]
    slope, level = np.polyfit(z, v, 1)
    return level / slope


def depths():
    """H of each speed by each definition."""
    paper = rotations()
    runs = [read_profile(rpm) for rpm in SPEEDS]

    def of(definition):
        return [definition(run) for run in runs]

    def share(part):
        return lambda run: line_depth(run, run["v_x"] > part * at_surface(run))

    def shifted(level):
        return lambda run: share(0.3)(run) + crossing(run, "nu", level)

    def in_laboratory(run):
        return share(0.3)(run | {"v_x": run["v_x"] + run["rotation"] * (run["z"] + run["axis_depth"])})

    def steepest(run):
        at = np.argmax(np.where(run["z"] <= 0, np.nan_to_num(run["shear_rate"]), -1))
        return run["v_x"][at] / run["shear_rate"][at] - run["z"][at]

    stated = [paper[rpm]["H"] for rpm in SPEEDS]
    found = {
        "line where v_x > 0.3 v_x(0): the project's": of(share(0.3)),
        "line through the top 5 d": of(lambda run: line_depth(run, run["z"] > -5)),
        "steepest tangent": of(steepest),
        "surface where nu = 0.4": of(shifted(0.4)),
        "surface where nu = 0.78": of(shifted(0.78)),
        "velocity of the laboratory": of(in_laboratory),
        "v_x = 0.2 v_x(0)": of(lambda run: -crossing(run, "v_x", 0.2 * at_surface(run), 0)),
        "I = 0.018, the paper's I_th": of(lambda run: -crossing(run, "I", 0.018, -5)),
    }
    found["the project's, less 4.4 d (fitted to the paper)"] = [H - 4.4 for H in found["line where v_x > 0.3 v_x(0): the project's"]]

    def misfit(values):
        return number(math.sqrt(sum((mine / theirs - 1) ** 2 for mine, theirs in zip(values, stated)) / len(stated)), 2)

    rows = [["**paper**", *(f"**{H:g}**" for H in stated), ""]]
    rows += [[name, *(f"{H:.1f}" for H in values), misfit(values)] for name, values in found.items()]
    return table(["definition of H", *(f"{rpm}" for rpm in SPEEDS[:-1]), "15 rpm", "misfit"], rows)


def outcome(target):
    places = {"deg": 1, "d": 1}.get(target["measure"], 3)
    text = f"{target['value']:.{places}f}"
    return text if target["outcome"] == "met" else f"**{text}**"


def speeds():
    """The continuum with mu(I), inertia and a moving surface against one-turn runs."""
    wanted = [("v_x", "flowing"), ("sigma_zz", "all"), ("sigma_xz", "flowing"), ("sigma_xz", "static"), ("sigma_xx", "all"), ("log10_shear_rate", "static"), ("axis_angle_deg", "all")]
    record = read("cost/speeds-flow.json")
    first = record["speeds"][0]["targets"]
    limits = {(t["quantity"], t.get("zone")): t["limit"] for t in first}
    head = ["rpm", "theta (deg): particles", "continuum", "H: particles", "continuum", "lambda: particles", "continuum"]
    words = {"log10_shear_rate": "log10 shear rate", "axis_angle_deg": "axes (deg)", "all": ""}
    head += [" ".join(words.get(word, word) for word in key).strip() + f" ({limits[key]:g})" for key in wanted]
    rows = []
    for speed in record["speeds"]:
        targets = {(t["quantity"], t.get("zone")): t for t in speed["targets"]}
        row = [f"{speed['rotation_rpm']:.0f}"]
        for name, places in (("theta_deg", 2), ("H", 1), ("lambda", 1)):
            both = speed["scalars"][name]
            value = f"{both['continuum']:.{places}f}"
            row += [interval(both["particles"]), value if targets[(name, None)]["outcome"] == "met" else f"**{value}**"]
        rows.append(row + [outcome(targets[key]) for key in wanted])
    return table(head, rows)


def effects_over_speed():
    """Slope, and H in brackets, with effects named one after the other."""
    record, whole = read("cost/effects-over-speed.json"), read("cost/speeds-flow.json")
    by_speed = {f"{speed['rotation_rpm']:.0f}": speed["scalars"] for speed in whole["speeds"]}
    shown = [str(rpm) for rpm in record["speeds_rpm"]]

    def pair(theta, H):
        return f"{theta:.1f} ({H:.1f})"

    rows = [["particles", *(pair(by_speed[rpm]["theta_deg"]["particles"]["value"], by_speed[rpm]["H"]["particles"]["value"]) for rpm in shown)]]
    rows += [[name, *(pair(flow["theta_deg"], flow["H"]) for flow in flows)] for name, flows in record["flows"].items()]
    rows += [["inertia and moving surface", *(pair(by_speed[rpm]["theta_deg"]["continuum"], by_speed[rpm]["H"]["continuum"]) for rpm in shown)]]
    return table(["theta in deg (H)", *(f"{rpm} rpm" for rpm in shown)], rows)


ROWS = {  # of the limits, in the order of data/limits/bed.toml; at x = 0 where no place is named
    ("sigma_xz", "centre", "static"): "sigma_xz, bed",
    ("traction_ratio", "wall", ""): "wall traction ratio",
    ("axis_angle_deg", "centre", "all"): "axes (deg)",
    ("log10_shear_rate", "centre", "static"): "log10 shear rate, bed",
    ("lambda", "scalar", ""): "lambda",
    ("sigma_xx", "centre", "all"): "sigma_xx",
    ("sigma_zz", "centre", "all"): "sigma_zz",
    ("sigma_xz", "centre", "flowing"): "sigma_xz, flow",
    ("v_x", "centre", "flowing"): "v_x, flow",
    ("theta_deg", "scalar", ""): "theta (deg)",
    ("H", "scalar", ""): "H (d)",
    ("sigma_xz", "map", "static"): "sigma_xz, bed, map",
    ("axis_angle_deg", "map", "all"): "axes (deg), map",
    ("log10_shear_rate", "map", "static"): "log10 shear rate, bed, map",
}


def judged(cell):
    if cell is None or cell["value"] is None:
        return ""
    return number(cell["value"]) if cell["met"] else f"**{number(cell['value'])}**"


BLIND = (3, 8, 12)


def by_row(rows):
    """{(quantity, where, zone): row} by the axis."""
    return {(row["quantity"], row["where"], row["zone"]): row for row in rows if row["registered_by"] == "axis"}


def limits():
    """The flow with memory at all speeds."""
    found = by_row(read("memory/limits-speeds.json")["limits"]["rows"])
    cells = {key: {round(cell["rotation_rpm"]): cell for cell in found[key]["cells"]} for key in ROWS}
    shown = sorted(next(iter(cells.values())))
    head = [f"{rpm}{' (blind)' if rpm in BLIND else ''}" for rpm in shown]
    head[-1] += " rpm"
    rows = []
    for key, name in ROWS.items():
        row = found[key]
        worst = f" in the mean, each {row['must_worst']:g}" if "must_worst" in row else ""
        rows.append([name, f"{row['must']:g}{worst}; {row['aim']:g}", number(cells[key][6]["floor"], 2), *(judged(cells[key].get(rpm)) for rpm in shown)])
    return table(["", "must; aim", "noise floor, 6 rpm", *head], rows)


def scores():
    """Continua at 6 rpm as `drumlin score` judges them."""
    laws = {name: by_row(entry["score"]["rows"]) for name, entry in read("memory/scores-6rpm.json")["laws"].items()}
    rows = [[name, *(judged({"value": found[key]["error"], "met": found[key]["met"]}) for found in laws.values())] for key, name in ROWS.items()]
    rows.append(["met, of 14", *(str(sum(bool(found[key]["met"]) for key in ROWS)) for found in laws.values())])
    return table(["", *laws], rows)


def drums():
    """Diameters of the half filled drums with friction 0.4, and the words of a quantity at one: of the particles, and of the flow with a law."""
    record = read("sizes/sizes.json")
    runs = [run for run in record["runs"] if run["filling"] == "half" and run["friction"] == 0.4]

    def particles(key, diameter):
        values = [run["layer"][key] if key in run["layer"] else run[key]["value"] for run in runs if run["diameter_mm"] == diameter]
        return number(sum(values) / len(values))

    def flow(law):
        found = {one["diameter_mm"]: one["scalars"] for one in record["continuum"] if one["law"] == law}

        def word(key, diameter):
            value = found.get(diameter, {}).get(key, {}).get("continuum")
            return number(value["value"] if isinstance(value, dict) else value)
        return word

    return sorted({run["diameter_mm"] for run in runs}), particles, flow


def sizes():
    """Half filled drums with friction 0.4 of four sizes, and the continuum of the same drums, read at the same places."""
    record, (diameters, particles, flow) = read("sizes/sizes.json"), drums()
    words = {"theta_deg": "theta (deg)", "H": "H (d)", "shear_rate": "shear rate", "lag_deg": "lag (deg)"}

    def row(name, value):
        return [name, *(value(key, diameter) for key in words for diameter in diameters)]

    rows = [row("particles", particles), row("power of D", lambda key, diameter: interval(record["powers"]["0.4"][key]) if diameter == diameters[0] and key != "lag_deg" else "")]
    laws = [one["law"] for one in record["continuum"]]
    rows += [row(law, flow(law)) for law in dict.fromkeys(laws) if laws.count(law) > 1]
    return table(["", *(f"{name}: {diameter:g} mm" if diameter == diameters[0] else f"{diameter:g}" for name in words.values() for diameter in diameters)], rows)


def spheres():
    return read("spheres/incline.json")


def slopes_of_spheres():
    """What was measured of the core of each incline of spheres, beside the law of Jop et al."""
    rows, limit = [], spheres()["limits"]["mu"]
    for row in spheres()["runs"]:
        stress = row["mu"]["value"]
        bold = "**" if abs(stress - row["mu_jop"]) > limit else ""
        rows.append([f"{row['theta_deg']:.0f}", interval(row["mu"]), interval(row["I"]), number(row["I_jop"]), f"{bold}{stress - row['mu_jop']:+.3f}{bold}",
                     interval(row["N1_over_p"]), interval(row["N2_over_p"]), interval(row["nu"]), interval(row["coordination"])])
    return table(["slope (deg)", "mu", "I", "I of Jop's law at tan(slope)", f"mu less Jop's at I ({limit})", "(sigma_xx - sigma_zz)/p", "(sigma_zz - sigma_yy)/p", "nu", "contacts of a grain"], rows)


def law_of_spheres():
    record = spheres()
    law, jop = record["law"], record["jop"]
    theirs = jop[0], jop[1] - jop[0], jop[2]
    ranges = [f"{one['low']:.2f} to {one['high']:.2f}" if one["high"] < 10 else f"from {one['low']:.2f} on" for one in law["ranges"]]
    return table(["", "fitted", "99 % of the draws", "Jop et al."],
                 [[name, f"{ours:.3f}", within, f"{other:.3f}"] for name, ours, within, other in zip(("mu_s", "mu_2 - mu_s", "I_0"), law["coefficients"], ranges, theirs)])


def flows_of_spheres():
    flows, limits_of = [(row, row["flow"]) for row in spheres()["runs"]], spheres()["limits"]
    judged = [(name, limits_of[name]) for name in ("rms", "rms_of_shape")]
    return table(["slope (deg)", "surface speed: spheres", "continuum", *(f"{words} ({limit})" for words, (_, limit) in zip(("v_x, rms", "its shape"), judged))],
                 [[f"{row['theta_deg']:.0f}", number(flow["surface_speed_of_spheres"]), number(flow["surface_speed"]),
                   *(("**{:.3f}**" if flow[name] > limit else "{:.3f}").format(flow[name]) for name, limit in judged)] for row, flow in flows])


TABLES = {
    "summary": summary,
    "times": times,
    "headline": headline,
    "targets": targets,
    "verdicts": verdicts,
    "entries that differ": paper_differs,
    "definitions of H": depths,
    "mu(I) over speed": speeds,
    "effects over speed": effects_over_speed,
    "limits": limits,
    "scores": scores,
    "sizes": sizes,
    "slopes of spheres": slopes_of_spheres,
    "law of spheres": law_of_spheres,
    "flows of spheres": flows_of_spheres,
}
PLACE = re.compile(r"(<!-- table (?P<name>[^>]*) -->\n)(?P<text>.*?)(<!-- end of table -->)", re.DOTALL)


def renewed(page):
    def printed(match):
        name = match["name"]
        if name not in TABLES:
            raise SystemExit(f"{page}: no table is called '{name}'; there are {', '.join(TABLES)}")
        return f"{match[1]}{TABLES[name]()}\n{match[4]}"

    return PLACE.sub(printed, page.read_text())


def main():
    words = sys.argv[1:]
    check = "--check" in words
    pages = [pathlib.Path(word) for word in words if word != "--check"]
    if not pages:
        raise SystemExit(__doc__)
    failures = 0
    for page in pages:
        now, old = renewed(page), page.read_text()
        if now == old:
            continue
        if not check:
            whole_file.write_text(page, now)
            print(f"written: {page}")
            continue
        failures += 1
        line = next(k for k, (a, b) in enumerate(zip(old.splitlines() + [""], now.splitlines() + [""])) if a != b)
        print(f"{page}, line {line + 1}: not what data/ says\n  there: {(old.splitlines() + [''])[line]}\n  data/: {(now.splitlines() + [''])[line]}")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
