"""What cannot be done says so: exit codes and messages that no contract of all commands (contract.py) covers.

usage: exit_codes.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import shutil

from command import SHORT_RUN, Drumlin, given, read_json, require


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
        scene, record, output = here / "tiny-drum.toml", folder / "a-record-of-runs-whose-scene-cannot-be-read.json", folder / "output"
        record.write_text('{"format": "drumlin-cost-1", "kind": "particles", "scene": "nonsense = [", "points": []}', encoding="utf-8")
        (folder / "full").mkdir()
        flow = ["flow", here / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", output]
        for words, told in ((["run", scene, "-o", output, "--accuracy", record], ""), (["run", scene, "-o", output, "--set", "no_such_key=1"], "no_such_key"),
                            ([*flow, "--from", folder / "full"], "full"), (["jump"], "no command"), (["mesure", "x"], "did you mean \"measure\"?")):
            _, said = drumlin(*words, code=2)
            require(said.strip() and told in said and not output.exists(), f"{words}: {said}")
        cell_too_short(drumlin, data, folder)
        layer_at_rest(drumlin, data, folder)
        alone = shutil.copy(drumlin.executable, folder / "drumlin-alone")  # no data, no scripts beside it
        said, _ = Drumlin(str(alone))("run", scene, "-o", folder / "alone", *SHORT_RUN)
        require("scenes and records" not in said and read_json(folder / "alone/run.json")["status"] == "finished", said)


if __name__ == "__main__":
    main()
