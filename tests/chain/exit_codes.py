"""What cannot be done says so: exit code 2, a message on standard error, nothing written, nothing lost.

usage: exit_codes.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import shutil

from command import SHORT_RUN, Drumlin, bytes_below, given, read_json, require


def cell_too_short(drumlin, data, folder):
    """A run that ends before a step keeps its log, and its run.json says how it ended."""
    text = (data / "scenes" / "biaxial-cell.toml").read_text(encoding="utf-8").replace("count = 300", "count = 9").replace(
        "{ xx = { pressure_n_m2 = 1000 }, zz = { pressure_n_m2 = 1000 } }", "{ xx = { rate_per_s = -20 }, zz = { rate_per_s = -20 } }")
    scene, run = folder / "short-cell.toml", folder / "short-cell"
    scene.write_text(text.replace("log_every_steps = 10", "log_every_steps = 1"), encoding="utf-8")
    _, said = drumlin("run", scene, "-o", run, code=3)
    report, steps = read_json(run / "run.json"), len((run / "log.csv").read_text(encoding="utf-8").splitlines()) - 1
    require(f"step {steps + 1}: the cell has become shorter" in said, f"a short cell, after {steps} steps:\n{said}")
    require(report["status"] == "not converged" and report["steps"] == steps > 100, f"a short cell: {report['status']}, {report['steps']} steps")


def layer_at_rest(drumlin, data, folder):
    """A layer below the yield slope creeps at the speed of eps alone: its results are there, and nobody takes them for a flow."""
    law, output = folder / "jop.toml", folder / "layer"
    law.write_text('format = "drumlin-rheology-1"\nreduced = false\n[mu]\nlaw = "jop"\nmu_s = 0.383\nmu_2 = 0.643\nI_0 = 0.279\n'
                   "[packing]\nnu = 0.82\n[fitted_on]\nruns = []\n", encoding="utf-8")
    words = ["flow", data / "scenes" / "incline-flow.toml", "--rheology", law, "--set", "incline.slope_deg=20.9", "--set", "output.figures=false", "-o", output]
    _, said = drumlin(*words, code=3)
    flow = read_json(output / "flow.json")
    require("does not flow" in said and len(flow["missed"]) == 1 and flow["missed"][0] in said, f"a layer at rest:\n{said}")
    require(abs(flow["checks"]["eps_share"] - 1) < 1e-6 and (output / "profiles.csv").exists(), f"a layer at rest: {flow['checks']}")
    _, said = drumlin(*words, "--resume", code=3)
    require("does not flow" in said, f"a layer at rest, done already:\n{said}")
    _, said = drumlin("compare", output, output, "-o", folder / "comparison", code=2)
    require("does not flow" in said, f"a layer at rest, compared:\n{said}")


def main():
    with given() as (drumlin, here, data, folder):
        scene, flow_scene = here / "tiny-drum.toml", here / "tiny-drum-flow.toml"
        law, limits = data / "rheology" / "paper.toml", data / "limits" / "bed.toml"
        missing, full, long = folder / "missing", folder / "full", folder / ("x" * 300)
        full.mkdir()
        (full / "keep.txt").write_text("years of work", encoding="utf-8")
        (folder / "empty.toml").write_text("", encoding="utf-8")
        record = folder / "a-record-of-runs-whose-scene-cannot-be-read.json"
        record.write_text('{"format": "drumlin-cost-1", "kind": "particles", "scene": "nonsense = [", "points": []}', encoding="utf-8")
        before = bytes_below(folder)
        output = folder / "output"
        refused = {
            "a missing file": [
                ["run", missing, "-o", output], ["measure", missing], ["calibrate", missing, "-o", output],
                ["flow", missing, "--rheology", law, "-o", output], ["flow", flow_scene, "--rheology", missing, "-o", output],
                ["compare", missing, missing, "-o", output], ["score", missing, "--limits", limits, "-o", output], ["score", full, "--limits", missing, "-o", output],
                ["scene", "check", missing], ["solve-contacts", missing]],
            "a folder in place of a file": [
                ["run", full, "-o", output], ["calibrate", full, "-o", output], ["measure", full],
                ["flow", full, "--rheology", law, "-o", output], ["flow", flow_scene, "--rheology", full, "-o", output],
                ["flow", flow_scene, "--rheology", law, "--from", full, "-o", output],
                ["compare", full, full, "-o", output], ["score", full, "--limits", limits, "-o", output], ["scene", "check", full], ["solve-contacts", full]],
            "a file in place of a folder": [
                ["run", scene, "-o", full / "keep.txt"], ["measure", scene], ["compare", scene, scene, "-o", output],
                ["flow", flow_scene, "--rheology", law, "-o", full / "keep.txt"]],
            "a name that nothing can have": [
                ["run", long, "-o", output], ["run", scene, "-o", long], ["measure", long], ["report", long], ["export", long, "-o", output],
                ["calibrate", long, "-o", output], ["flow", long, "--rheology", law, "-o", output],
                ["flow", flow_scene, "--rheology", law, "-o", long], ["compare", long, long, "-o", output], ["accept", long, "--reason", "x"],
                ["scene", "check", long], ["solve-contacts", long]],
            "an empty file": [
                ["run", folder / "empty.toml", "-o", output], ["scene", "check", folder / "empty.toml"],
                ["flow", folder / "empty.toml", "--rheology", law, "-o", output],
                ["flow", flow_scene, "--rheology", folder / "empty.toml", "-o", output],
                ["solve-contacts", folder / "empty.toml"]],
            "a record of something else": [["run", scene, "-o", output, "--accuracy", record]],
            "an existing output": [
                ["run", scene, "-o", full], ["flow", flow_scene, "--rheology", law, "-o", full]],
            "a folder that is not ours, to be overwritten": [
                ["run", scene, "-o", full, "--overwrite"],
                ["flow", flow_scene, "--rheology", law, "-o", full, "--overwrite"]],
            "an unknown command or key": [["jump"], ["run", scene, "-o", output, "--set", "no_such_key=1"]],
        }
        for reason, commands in refused.items():
            for words in commands:
                _, said = drumlin(*words, code=2)
                require(said.strip(), f"{reason}: {words} was refused without a word")
                require(not output.exists(), f"{reason}: {words} left an output")
                require(bytes_below(folder) == before, f"{reason}: {words} touched files")
        print(f"{sum(map(len, refused.values()))} commands refused with exit code 2")
        cell_too_short(drumlin, data, folder)
        layer_at_rest(drumlin, data, folder)
        alone = shutil.copy(drumlin.executable, folder / "drumlin-alone")  # no data, no scripts beside it
        said, _ = Drumlin(str(alone))("run", scene, "-o", folder / "alone", *SHORT_RUN)
        require("scenes and records" not in said and read_json(folder / "alone/run.json")["status"] == "finished", said)


if __name__ == "__main__":
    main()
