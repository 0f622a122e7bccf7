"""Which law says what of which geometry: a table of the errors of flows that were solved with laws from elsewhere (docs/scenes.md).

usage: law_transfer.py REPORT... [--laws LAW.json...] -o FOLDER
REPORT is a folder of `drumlin compare RUN FLOWRUN`, of layers or of drums, or the transfer.json of several; LAW.json the record of `drumlin calibrate`. A law is
called by what it was fitted on: the beginnings of the names of its runs, up to their first "-". FOLDER gets transfer.json and transfer.png; the table goes to the
standard output.
"""

import argparse
import json
import pathlib

import numpy as np

import script
import style
import whole_file

SCALARS = {"bulk_I": "I", "bulk_mu": "mu", "bulk_shear_rate": "shear_rate", "surface_speed": "surface_speed", "theta_deg": "theta_deg", "H": "H", "Q": "Q"}
FIELDS = ("v_x", "shear_rate", "sigma_zz", "sigma_xz", "mu", "I")


def law_of(runs):
    return " + ".join(sorted({name.split("-")[0] for name in runs}))


def both(sides):
    """(first, its interval, second) of a scalar of comparison.json."""
    first, second = sides["particles"], sides["continuum"]
    return first["value"], first.get("ci99"), second["value"] if isinstance(second, dict) else second


def above_base_layers(folder, zone):
    """Error of v_x in the bulk with the speed of its lowest layer taken off on both sides: what the layers next to the base do is not in it."""
    _, columns = style.read_profiles(folder / "overlay.csv")
    z = np.asarray(columns["z"])
    bulk = (z >= zone["from"]) & (z <= zone["to"])
    first, second = (np.asarray(columns[f"v_x_{side}"])[bulk] for side in ("particles", "continuum"))
    first, second = first - first[0], second - second[0]
    return float(np.sqrt(((second - first) ** 2).sum() / (first ** 2).sum()))


def row_of(folder):
    content = script.content_of(folder / "comparison.json")
    drum = content["format"] == "drumlin-comparison-1"
    zone = "flowing" if drum else "bulk"
    errors = {name: zones[zone] for name, zones in content["errors"].items() if zones is not None}
    row = {"scene": content["particles"]["name"], "geometry": "drum" if drum else content["geometry"], "report": folder.name,
           "law": law_of(content["continuum"]["flow"]["settings"]["law"]["fitted_on"]), "zone": zone, "errors": {}, "noise_floor": {}, "scalars": {}}
    for name in FIELDS:
        if name in errors:
            row["errors"][name] = errors[name]["rel_l2"]
            row["noise_floor"][name] = errors[name].get("floor_rel_l2")
    if not drum:
        row["errors"]["v_x_above_base_layers"] = above_base_layers(folder, content["zones"]["bulk"])
    for name, short in SCALARS.items():
        if name in content["scalars"]:
            first, interval, second = both(content["scalars"][name])
            known = first is not None and second is not None
            row["scalars"][short] = {"particles": first, "ci99": interval, "continuum": second,
                                     "error": second / first - 1 if known and first and short != "theta_deg" else None}
    row["revision"] = {"particles": content["particles"]["run"]["provenance"]["revision"], "continuum": content["continuum"]["flow"]["provenance"]["revision"],
                       "comparison": content["provenance"]["revision"]}
    return row


def law_row(file):
    content = script.content_of(file)
    form = next(form for form in content["forms"] if form["chosen"])
    fraction = content.get("volume_fraction")
    return {"law": law_of([run["run"] for run in content["runs"]]), "form": form["form"], "coefficients": form["coefficients"],
            "range": content["range_of_validity"], "rms": form["rms_misfit"], "points": form["points"],
            "runs": [{"run": run["run"], "rms": run["rms"], "bias": run["bias"]} for run in content["runs"]],
            "nu": fraction and {key: fraction[key] for key in ("at_rest", "slope", "rms")}}


def per_cent(value, signed=False):
    return "–" if value is None else f"{100 * value:{'+' if signed else ''}.1f} %"


def layers_table(rows):
    """Scenes over laws: errors of v, of v above the base layers, of I, of mu."""
    laws = list(dict.fromkeys(row["law"] for row in rows))
    lines = ["| v; v above the base layers; I; mu | " + " | ".join(f"law of {law}" for law in laws) + " | another seed: v |",
             "|---" * (len(laws) + 2) + "|"]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        of_scene = {row["law"]: row for row in rows if row["scene"] == scene}
        cells = []
        for law in laws:
            row = of_scene.get(law)
            cells.append("–" if row is None else "; ".join([
                per_cent(row["errors"]["v_x"]), per_cent(row["errors"]["v_x_above_base_layers"]),
                *(per_cent(row["scalars"][name]["error"], True) for name in ("I", "mu"))]))
        floor = next(iter(of_scene.values()))["noise_floor"].get("v_x")
        lines.append(f"| {scene} | " + " | ".join(cells) + f" | {per_cent(floor)} |")
    return lines


def drum_table(rows):
    lines = ["| scene | law of | v, flowing | shear stress, flowing | slope (deg) | H (d) |", "|---|---|---|---|---|---|"]
    for row in rows:
        said = [f"{sides['particles']:.1f}, {sides['continuum']:.1f}" for sides in (row["scalars"]["theta_deg"], row["scalars"]["H"])]
        lines.append("| " + " | ".join([row["scene"], row["law"], per_cent(row["errors"]["v_x"]), per_cent(row["errors"]["sigma_xz"]), *said]) + " |")
    return lines


def table_of(rows, laws):
    drums = [row for row in rows if row["geometry"] == "drum"]
    lines = layers_table([row for row in rows if row["geometry"] != "drum"])
    lines += ["", *drum_table(drums)] if drums else []
    if laws:
        lines += ["", "| law | mu | rms | largest bias of a run | nu |", "|---|---|---|---|---|"]
    for law in laws:
        worst = max(law["runs"], key=lambda run: abs(run["bias"]))
        nu = law["nu"] and f"{law['nu']['at_rest']:.3f} {law['nu']['slope']:+.3f} I (rms {law['nu']['rms']:.4f})"
        lines.append(f"| {law['law']} | {law['form']}: {', '.join(f'{c:.4f}' for c in law['coefficients'])} | {law['rms']:.4f} | "
                     f"{worst['bias']:+.4f} ({worst['run']}) | {nu or '–'} |")
    return "\n".join(lines) + "\n"


def drawn(rows, file):
    """Errors of v over the scenes."""
    names = {law: style.plain(law, 30) for law in sorted({row["law"] for row in rows})}
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure, (axes,) = style.panels(1, height=4.2)
    for index, (law, color) in enumerate(zip(names, [style.CONTINUUM, *style.OTHERS])):
        known = [(scenes.index(row["scene"]), 100 * row["errors"]["v_x"]) for row in rows if row["law"] == law]
        axes.bar([place + 0.8 * (index + 0.5) / len(names) - 0.4 for place, _ in known], [error for _, error in known],
                 0.8 / len(names), color=color, label=f"law of {names[law]}")
    floors = {row["scene"]: row["noise_floor"].get("v_x") for row in rows}
    for place, scene in enumerate(scenes):
        if floors[scene] is not None:
            axes.plot([place - 0.45, place + 0.45], [100 * floors[scene]] * 2, color="black", linewidth=1.2)
    axes.set_xticks(range(len(scenes)), [style.plain(scene, 20) for scene in scenes], rotation=40, ha="right")
    axes.set_ylabel("error of $v_x$  [%]" + (" (lines: another seed)" if any(floors.values()) else ""))
    axes.legend()
    style.save(figure, file, reduced=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reports", nargs="+", type=pathlib.Path)
    parser.add_argument("--laws", nargs="*", default=[], type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    options = parser.parse_args()
    style.use_style()
    rows, laws = [], [law_row(file) for file in options.laws]
    for report in options.reports:
        if report.is_dir():
            rows.append(row_of(report))
            continue
        before = script.content_of(report)
        rows += before["pairs"]
        laws += before["laws"]
    options.output.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"format": "drumlin-law-transfer-1", "laws": laws, "pairs": rows}, indent=1) + "\n"
    whole_file.write_text(options.output / "transfer.json", text)
    drawn(rows, options.output / "transfer.png")
    print(table_of(rows, laws), end="")


if __name__ == "__main__":
    main()
