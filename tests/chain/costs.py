"""drumlin cost on flows: errors against the closed form fall with the mesh, points are kept, refusals, the price list; the statement of a flow.

usage: costs.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""


from command import given, read_json, require

CHUTE = """format = "drumlin-flow-scene-1"
title = "Upright chute"
reduced = true
[chute]
half_width_mm = 33
pressure_pa = 2400
[grains]
diameter_min_mm = 3.0
diameter_max_mm = 3.6
density_kg_m3 = 2700
[mesh]
surface_cell = 0.2
surface_zone = 2
growth = 0.25
[regularisation]
shear_rate = 1e-4
pressure = 1e-4
[solver]
tolerance = 1e-6
"""


def check_sweep(drumlin, work, law):
    (work / "chute.toml").write_text(CHUTE, encoding="utf-8")
    words = ["cost", work / "chute.toml", "--rheology", law, "-o", work / "cost", "--sweep", "mesh=1:2:3,eps=1e-2:1e-3"]
    drumlin(*words)
    report = read_json(work / "cost" / "cost.json")
    require(report["format"] == "drumlin-cost-1" and report["kind"] == "continuum" and report["reduced"] is True, "not the report of a flow")
    require(report["reference"] == "closed form", "a chute has a closed form")
    by_level = {point["levels"]: point for point in report["points"] if "mesh" in point["axes"]}
    mesh_errors = [by_level[level]["errors"]["v_x_mesh"] for level in (1, 2, 3)]
    # Third order in v_x: at least 4 where 8 is asymptotic.
    require(all(coarse > 4 * fine for coarse, fine in zip(mesh_errors, mesh_errors[1:])), f"errors by mesh: {mesh_errors}")
    by_eps = {point["eps"]: point["errors"]["v_x"] for point in report["points"] if "eps" in point["axes"]}
    require(by_eps[1e-2] > by_eps[1e-3] > by_eps[1e-4], f"errors by eps: {by_eps}")
    require(sum(point["default"] for point in report["points"]) == 1, "one point is the scene as it is")
    require((work / "cost" / "work_precision.png").exists(), "no figure")

    drumlin(*words, "--resume")  # of what is finished
    drumlin(*words, "--resume", "--set", "chute.pressure_pa=2500", code=2)


def check_refusals(drumlin, work, law):
    scene = work / "chute.toml"
    for words in (["--sweep", "mesh=1.5"], ["--statistics", "1"], ["--variants", "inertia"]):
        drumlin("cost", scene, "--rheology", law, "-o", work / "refused", *words, code=2)
    drumlin("cost", scene, "-o", work / "refused", code=2)
    drumlin("cost", "--effects", scene, "--rheology", law, "-o", work / "refused", "--variants", "gravity", code=2)


def check_prices(drumlin, work, here, data):
    scene = here / "tiny-drum-flow.toml"
    said, _ = drumlin("cost", "--effects", scene, "--rheology", data / "rheology" / "paper.toml", "-o", work / "prices",
                      "--set", "effects.wall_slip={friction=0.95}", "--set", "mesh.surface_cell=3")
    report = read_json(work / "prices" / "cost.json")
    rows = {row["effect"]: row for row in report["effects"]}
    require(list(rows) == ["none", "inertia", "wall_slip", "rotating_frame", "k", "nonlocal", "moving_surface", "as it is", "none, again"],
            f"rows {list(rows)}")
    require("refused" in rows["k"], "a law without k cannot show k")
    require(rows["none"]["scalars"] == rows["none, again"]["scalars"], "the same flow again differs")
    require(rows["as it is"]["scalars"] == rows["wall_slip"]["scalars"], "wall slip is all that the scene names")
    require(abs(rows["rotating_frame"]["change"]["theta_deg"]) < 1e-3 < abs(rows["inertia"]["change"]["theta_deg"]), "a frame acts, or inertia does not")
    require("moving_surface" in said and (work / "prices" / "prices.png").exists(), "no list or no figure")


def check_work(drumlin, work, here, data):
    """Solves repeated, from a neighbour and on two ranks find the same flow; a combination of effects; a time limit."""
    scene, law = here / "tiny-drum-flow.toml", data / "rheology" / "paper.toml"
    common = ["--set", "mesh.surface_cell=3"]
    drumlin("cost", scene, "--rheology", law, "-o", work / "work", "--sweep", "mesh=1", "--ranks", "1,2", "--neighbour", "drum.rotation_rpm=14",
            "--repeats", "2", *common)
    report = read_json(work / "work" / "cost.json")
    point = next(point for point in report["points"] if point["default"])
    kinds = [(entry["ranks"], entry["start"]) for entry in point["work"]]
    require(kinds == [(1, "cold"), (1, "neighbour"), (2, "cold"), (2, "neighbour")], f"entries {kinds}")
    cold, near = point["work"][:2]
    require(cold["iterations"] == point["iterations"] and near["iterations"] < cold["iterations"], f"{near['iterations']} of {cold['iterations']}")
    for entry in point["work"]:
        require(len(entry["load_before"]) == 2 and 0 < entry["seconds"]["least"] <= entry["seconds"]["median"], f"{entry['seconds']}")
        require(entry["assembled_unknowns"] > entry["unknowns"] and entry["peak_memory_mb"] > 10 and "assembly" in entry["phases"], f"{entry}")
    drumlin("cost", "--effects", scene, "--rheology", law, "-o", work / "combined", "--variants", "inertia,inertia+rotating_frame", *common)
    rows = {row["effect"]: row for row in read_json(work / "combined" / "cost.json")["effects"]}
    require(list(rows) == ["none", "inertia", "inertia+rotating_frame", "none, again"], f"rows {list(rows)}")
    both = rows["inertia+rotating_frame"]
    require(both["changes"] == ["effects.inertia={}", "effects.rotating_frame={}"] and "theta_deg" in both["change"], f"{both}")
    drumlin("cost", scene, "--rheology", law, "-o", work / "late", "--sweep", "mesh=1", "--time-limit", "0.01", *common, code=3)


def check_statement(drumlin, work, here, data):
    said, _ = drumlin("flow", here / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", work / "flow",
                      "--set", "mesh.levels=2", "--set", "boundary.entrainment_length=1")  # its layer is thin
    accuracy = read_json(work / "flow" / "flow.json")["accuracy"]
    require("accuracy: " in said and "half of the error by mesh" in said, f"no statement:\n{said}")
    said, _ = drumlin("flow", here / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "paper.toml", "-o", work / "flow-alone",
                      "--set", "mesh.levels=1", "--set", "solver.sensitivity=false")
    require("accuracy: no error was estimated\n  (--set solver.sensitivity=true" in said and "not known" not in said, f"rows without a value:\n{said}")
    for name, scalar in accuracy["scalars"].items():
        parts = [scalar[source] for source in ("mesh", "eps", "iteration")]
        require(None not in parts and abs(sum(parts) - scalar["error"]) <= 1e-12 * max(parts), f"{name}: {scalar}")
        require(scalar["iteration"] <= 1e-4 * abs(scalar["value"]), f"{name}: the iteration had not ended: {scalar}")
    require(accuracy["halving"]["mesh"]["set"] == ["mesh.levels=3", "mesh.surface_cell=0.75"], f"{accuracy['halving']}")


def main():
    with given() as (drumlin, here, data, work):
        check_sweep(drumlin, work, data / "rheology" / "paper.toml")
        check_refusals(drumlin, work, data / "rheology" / "paper.toml")
        check_prices(drumlin, work, here, data)
        check_work(drumlin, work, here, data)
        check_statement(drumlin, work, here, data)


if __name__ == "__main__":
    main()
