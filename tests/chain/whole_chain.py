"""run -> measure -> calibrate -> flow -> compare on a tiny drum: exit codes, files, keys, and that repeating is free.

usage: whole_chain.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

import browser
import h5py
import numpy
import scipy.interpolate
import scipy.spatial
from command import bytes_below, given, has_address_sanitizer, read_json, require, require_keys
from vtu_file import arrays_of

RUN = ["wall_seconds", "cpu_seconds", "peak_memory_mb", "steps", "unconverged_steps", "revision", "seed"]
FLOW = ["theta_deg", "Q", "H", "lambda", "unknowns", "iterations", "residual", "seconds", "ill_posed_share"]
FIELDS = ["v_x", "v_z", "log10_shear_rate", "sigma_xx", "sigma_zz", "sigma_xz", "p", "log10_I", "mu", "k", "axis_angle_deg"]
FIGURES = {"drums", "velocity", "shear_rate", "stresses", "ratios", "friction", "slices", "maps_speed", "maps_shear_rate",
           "maps_pressure", "maps_sigma_xz", "maps_mu", "maps_axis_angle"}


def require_reduced(file, content):
    require(content["reduced"] is True, f"{file} does not say that it is reduced")


def check_run(run):
    require_keys(read_json(run / "run.json"), RUN, "run.json")
    for name in ("scene.toml", "log.csv", "snapshots"):
        require((run / name).exists(), f"the run left no {name}")
    require(len(list((run / "snapshots").glob("*.h5"))) == 40, "40 snapshots were asked for")


def check_measured(folder):
    measured = read_json(folder / "measured.json")
    require_reduced("measured.json", measured)
    require(len(list(folder.glob("*.png"))) > 0, "no figure was drawn")
    # Half a turn before the first snapshot: too short for the paper's protocol, and said to be.
    require(not measured["steadiness"]["steady"] and measured["steadiness"]["reasons"], "a short approach passes for steady")
    require(measured["H"]["sensitivity"]["changes"], "no window moves H")
    require(len(measured["slices"]) == 5 and all((folder / one["file"]).exists() for one in measured["slices"]),
            "five narrow slices were asked for")
    require((folder / "series.csv").exists(), "no series over time")
    # Rigid discs at rest under gravity in two dimensions: what a packing of them must show, however short the run.
    require(0.7 < measured["nu_bulk"]["value"] < 0.9, f"volume fraction {measured['nu_bulk']}")
    require(5 < measured["theta_deg"]["value"] < 40, f"slope {measured['theta_deg']}")


def check_flow(folder):
    flow = read_json(folder / "flow.json")
    require_keys(flow, FLOW, "flow.json")
    require_reduced("flow.json", flow)
    require((folder / "profiles.csv").exists(), "no profiles of the continuum")
    require(list(folder.glob("*.vtu")) and (folder / "maps.h5").exists(), "no VTU or no maps of the continuum")
    figures = {"maps", "profiles", "well_posedness", "newton", "sensitivity"}
    require({file.stem for file in folder.glob("*.png")} == figures, "figures of the continuum are missing")


def check_report(folder):
    comparison = read_json(folder / "comparison.json")
    require_reduced("comparison.json", comparison)
    for field in FIELDS:
        for zone in ("flowing", "static", "all"):
            require_keys(comparison["errors"][field][zone], ["rel_l2", "max", "inside_band"], f"errors.{field}.{zone}")
    for name in ("theta_deg", "Q", "H", "lambda"):
        require_keys(comparison["scalars"][name], ["particles", "continuum"], f"scalars.{name}")
    require(comparison["paper"] is None, "a tiny drum is none of the paper's")
    error = comparison["errors"]["sigma_zz"]["all"]["rel_l2"]
    require(error is not None and math.isfinite(error), "sigma_zz was not compared")
    page = (folder / "index.html").read_text(encoding="utf-8")
    require("reduced" in page and "data:image/png;base64," in page, "the page lacks its figures or the word reduced")
    for word in ("<script src", "<link", "src=\"http", "url(", "@import", "fetch("):
        require(word not in page, f"the page loads something: {word}")
    # What moves on top: the run's own grains, and points that start where they are.
    motion = read_json(folder / "motion.json")
    require("id=\"motion\"" in page and motion["sides"] == ["particles", "continuum"], "nothing moves on the page")
    require(len(motion["particles"]["number"]) == len(motion["tracers"]["number"]) == 40, f"{len(motion['particles']['number'])} frames")
    require(0 < motion["tracers"]["count"] <= len(motion["marked"]) < motion["particles"]["count"] == 350, "other tracers")
    links = set(re.findall(r'<a href="#(\w+)"', page))
    require(links and links <= set(re.findall(r' id="(\w+)"', page)), f"links that lead nowhere: {links}")
    drawn = {file.stem for file in folder.glob("*.png")}
    require(drawn == FIGURES, f"figures are missing or new: {drawn ^ FIGURES}")
    require(len(comparison["slices"]) == 5 and len(list((folder / "overlay_slices").glob("*.csv"))) == 5, "five slices")
    require(set(comparison["maps"]["zones"]) == {"flowing", "static", "upstream", "middle", "downstream", "all"}, "zones of the maps")
    require((folder / "overlay.csv").exists() and (folder / "overlay_maps.h5").exists(), "overlays are missing")
    require(comparison["registration"]["by"] == "axis", "registered by the axis")
    require(comparison["particles"]["unsteady"], "an unsteady run was accepted and not called so")


def check_motion(folder):
    """What moves on the page: both canvases change with the frame, nothing is loaded, and a phone shows it whole."""
    program = browser.executable()
    if program is None:
        print("compare: no Chromium is installed, the page was not opened")
        return
    file = folder / "index.html"
    pixels = "['left', 'right'].map(n => { const c = document.getElementById('motion-' + n); return c.toDataURL(); })"
    for size in ((1200, 900, 1, False), (390, 844, 2, True)):
        with browser.Browser(program, *size) as page:
            page.open(file.as_uri())
            page.wait_for("document.readyState === 'complete' && !!document.getElementById('motion-clock')?.textContent")
            before = page.value(pixels)
            page.value("(() => { const s = document.getElementById('motion-scrub'); s.value = 20; s.dispatchEvent(new Event('input')); })()")
            require(all(a != b for a, b in zip(before, page.value(pixels))), "a side that does not move")
            require(page.value("document.documentElement.scrollWidth <= innerWidth"), "wider than the screen")
            require(not page.faults() and all(url.startswith(("data:", file.as_uri())) for url in page.requests()),
                    f"{page.faults()} {page.requests()}")
    print("compare: the page moves")


def check_overlay(drumlin, run, flow, folder):
    """Both sides lie upon each other in ParaView: one wall, surfaces that slope alike, the same velocities at the grains; stresses are those of maps.h5."""
    drumlin("export", run, "--vtu", "--snapshots", "last", "-o", folder / "vtu")
    number = max(int(file.stem) for file in (run / "snapshots").glob("*.h5"))
    walls, grains = (arrays_of(folder / "vtu" / kind / f"{number:06}.vtu") for kind in ("walls", "grains"))
    cells, told = arrays_of(flow / "flow.vtu"), read_json(flow / "flow.json")
    with h5py.File(flow / "maps.h5") as file:
        d, second, rho = (file["scales/" + name][()] for name in ("length_m", "time_s", "density_kg_m3"))
        z, x, stress = (file[name][:] for name in ("z", "x", "fields/sigma_xz"))
    points = cells["Points"][:, :2].astype(float)
    radius = numpy.hypot(*walls["Points"][:, :2].T).max()
    require(abs(numpy.hypot(*points.T).max() - radius) < 1e-5 * radius, f"walls of {radius} and {numpy.hypot(*points.T).max()} m")
    # Axes of the flow at the axis of the drum: x downslope to the right.
    slope, offset = math.radians(told["theta_deg"]), told["chord_offset"] * d
    turned = numpy.column_stack([points @ (math.cos(slope), -math.sin(slope)), points @ (math.sin(slope), math.cos(slope))])
    surface = turned[turned[:, 1] > turned[:, 1].max() - 1e-6, 0]
    chord = 2 * math.sqrt(radius**2 - offset**2)
    require(abs(turned[:, 1].max() + offset) < 1e-6 and abs(numpy.ptp(surface) - chord) < 1e-5 * chord, f"a surface at {turned[:, 1].max()} m of {surface} m")
    places, speeds = grains["Points"][:, :2], grains["velocity_m_s"][:, :2]
    require(numpy.linalg.norm(places.mean(axis=0) - points.mean(axis=0)) < 2 * d, f"grains about {places.mean(axis=0)}, the flow about {points.mean(axis=0)} m")
    away, nearest = scipy.spatial.cKDTree(points).query(places)
    near = (away < d) & (numpy.hypot(*places.T) > radius - 3 * d)  # at the wall, with which both move
    there = cells["velocity_m_s"][nearest[near], :2]
    factor = (speeds[near] * there).sum() / (there**2).sum()
    require(near.sum() > 50 and abs(factor - 1) < 0.2, f"velocities of {near.sum()} grains are {factor:.2f} times those of the flow")
    # sigma_xz in the axes of the flow again, at the nodes of the map, over rho0 g d.
    xx, zz, xz = (cells[f"sigma_{name}_Pa"].astype(float) for name in ("xx", "zz", "xz"))
    cosine, sine = math.cos(2 * slope), math.sin(2 * slope)
    along = (cosine * xz - 0.5 * sine * (xx - zz)) / (rho * (d / second)**2)
    nodes = numpy.stack(numpy.meshgrid(x * d, z * d - offset), axis=-1)
    found = scipy.interpolate.LinearNDInterpolator(turned, along)(nodes)
    both = numpy.isfinite(stress) & numpy.isfinite(found)
    share = math.sqrt(((found - stress)[both]**2).sum() / (stress[both]**2).sum())
    require(both.sum() > 100 and share < 0.1, f"sigma_xz of {both.sum()} nodes differs from maps.h5 by {share:.3f}")
    print(f"flow.vtu lies upon the grains: {near.sum()} velocities, {both.sum()} stresses")


def check_edited_flow_is_refused(drumlin, run, flow, folder):
    other = folder / "other"
    shutil.copytree(flow, other)
    text = (other / "profiles.csv").read_text(encoding="utf-8")
    (other / "profiles.csv").write_text(re.sub(r"# rotation = .*", "# rotation = 0.05", text), encoding="utf-8")
    _, said = drumlin("compare", run, other, "-o", folder / "mixed", "--accept-unsteady", code=2)
    require("profiles.csv" in said and "manifest.txt" in said, f"a file that was changed by hand was taken: {said}")


def check_study(drumlin, runs, folder):
    """Two runs of one drum, equal to the byte: their laws over speed are those of one speed."""
    drumlin("measure", "--study", *runs, code=2)  # no place for the results
    drumlin("measure", runs[0], "--study", *runs, "-o", folder, code=2)  # one run or several
    drumlin("measure", "--study", *runs, "-o", folder)
    study = read_json(folder / "study.json")
    require_reduced("study.json", study)
    require(len(study["speeds"]) == 1 and study["speeds"][0]["runs"] == [run.name for run in runs], "one speed, two runs")
    require((folder / "index.html").exists(), "no page")
    before = bytes_below(folder)
    drumlin("measure", "--study", *runs, "-o", folder, code=2)
    drumlin("measure", "--study", *runs, "-o", folder, "--resume")
    require(bytes_below(folder) == before, "repeating the study changed files")
    print("study: two runs together, repeated")


def check_readers(files, folder):
    """docs/cookbook/read_results.py reads all that the chain leaves."""
    script = pathlib.Path(__file__).resolve().parents[2] / "docs" / "cookbook" / "read_results.py"
    if has_address_sanitizer(sys.argv[1]):
        print("read_results.py: left out, a build with sanitizers has no Python package")
        return
    package = os.environ | {"PYTHONPATH": str(pathlib.Path(sys.argv[1]).parent / "python")}
    result = subprocess.run([sys.executable, "-B", script, *files, "-o", folder / "look.png"], capture_output=True, text=True, check=False, env=package)
    require(result.returncode == 0, result.stdout + result.stderr)
    for said in ("log.csv: log: ", "run.json: run (reduced): finished, 350 grains", "snapshot: time ", "scene.toml: drumlin-scene-1: ",
                 "measured (reduced): theta_deg = ", "profiles.csv: drumlin-profiles-1: ", "forces.csv: forces: ",
                 "force_distributions.csv: drumlin-force-distributions-1: ", "maps.h5: maps: ", "rheology.toml: law: mu = ",
                 "continuum (reduced): theta = ", "comparison (reduced): ", "contact problem: "):
        require(said in result.stdout, f"{said!r} is not said:\n{result.stdout}")
    require((folder / "look.png").stat().st_size > 20000, "an empty picture")
    print("read_results.py: everything read")


def check_measurements(drumlin, run, flow, law, folder):
    """What is exported of a run stands in its place: the same comparison, and the same law but for the rounding of packed maps."""
    kept = folder / "kept" / run.name
    drumlin("export", run, code=2)
    drumlin("export", run, "--measurements", code=2)
    drumlin("export", run, "--measurements", "-o", kept)
    sizes = [sum(path.stat().st_size for path in folder_of.rglob("maps.h5")) for folder_of in (kept, run)]
    require(0 < sizes[0] < sizes[1], f"maps of {sizes} bytes")
    require(b"sigma_xz_kinetic\n" in (kept / "measured" / "maps.h5").read_bytes(), "the kinetic stress is not in the maps")
    drumlin("calibrate", kept, "-o", folder / "kept.toml", "--accept-unsteady")
    laws = [tomllib.loads(file.read_text(encoding="utf-8"))["mu"] for file in (law, folder / "kept.toml")]
    for key in laws[0]:
        if key not in ("law", "covariance"):
            pairs = zip(*(value if isinstance(value, list) else [value] for value in (laws[0][key], laws[1][key])))
            require(all(abs(a - b) <= 2e-3 * abs(a) for a, b in pairs), f"{key}: {laws}")
    drumlin("compare", kept, flow, "--beside", flow, "-o", folder / "kept-report", "--accept-unsteady")
    judged = read_json(folder / "kept-report" / "comparison.json")
    require(judged["beside"]["verdict"] == judged["verdict"] and judged["beside"]["kind"] == "continuum", f"a flow beside itself: {judged['beside']}")
    require(all(target["beside"] == {key: target[key] for key in ("value", "outcome")} for target in judged["targets"]), "other errors beside")
    print("export --measurements: calibrated and compared in the place of the run")


def main():
    with given() as (drumlin, here, folder):
        run, flow, report, law = folder / "run", folder / "flow", folder / "report", folder / "rheology.toml"
        steps = [
            (["run", here / "tiny-drum.toml", "-o", run], run, lambda: check_run(run)),
            (["measure", run], run / "measured", lambda: check_measured(run / "measured")),
            (["calibrate", run, "-o", law, "--accept-unsteady"], law, lambda: require(law.exists(), "no law")),
            (["flow", here / "tiny-drum-flow.toml", "--rheology", law, "--law-draws", "3", "-o", flow], flow, lambda: check_flow(flow)),
            (["compare", run, flow, "-o", report, "--accept-unsteady"], report, lambda: (check_report(report), check_motion(report))),
        ]
        for words, result, check in steps:
            drumlin(*words)
            check()
            print(f"{words[0]}: done, checked")
        before = bytes_below(folder)
        # A flow of other inputs is not what was requested; other options, of any command: contract.py.
        others = [["flow", here / "tiny-drum-flow.toml", "--rheology", law, "--law-draws", "2", "-o", flow],
                  ["flow", folder / "nowhere.toml", "--rheology", law, "--law-draws", "3", "-o", flow]]
        for words in others:
            _, said = drumlin(*words, "--resume", code=2)
            require("other" in said or "nowhere.toml" in said, f"{words}: {said}")
        for words in (["calibrate", run, run], ["calibrate", run, "--validate", run]):
            _, said = drumlin(*words, "-o", folder / "twice.toml", "--accept-unsteady", code=2)
            require("named twice" in said, f"{words}: {said}")
        # What an interrupted calibration has left is written anew.
        once, again = folder / "once.toml", ["calibrate", run, "-o", folder / "once.toml", "--accept-unsteady"]
        drumlin(*again)
        content = once.read_bytes()
        once.unlink()
        drumlin(*again)
        require(once.read_bytes() == content, "the law of a call that was interrupted differs")
        for file in folder.glob("once.*"):
            file.unlink()
        (folder / "mine.json").write_text("years of work", encoding="utf-8")
        drumlin("calibrate", run, "-o", folder / "mine.toml", "--accept-unsteady", code=2)
        drumlin("calibrate", run, "-o", run / "run.json", "--accept-unsteady", "--overwrite", code=2)
        require((folder / "mine.json").read_text(encoding="utf-8") == "years of work" and not (folder / "mine.toml").exists(), "calibrate took a file of somebody else")
        require(bytes_below(folder / "run") == {name[4:]: content for name, content in before.items() if name.startswith("run/")}, "a refused command changed the run")
        (folder / "mine.json").unlink()
        check_measurements(drumlin, run, flow, law, folder)
        check_overlay(drumlin, run, flow, folder)
        check_readers([run, law, flow, report, here.parents[1] / "data" / "problems" / "drum-300-mu-0.4-flow.h5"], folder)
        check_edited_flow_is_refused(drumlin, run, flow, folder)
        # The scene that a run leaves makes the same run again; so does another number of threads.
        again = folder / "again"
        drumlin("run", run / "scene.toml", "-o", again, "--threads", "2")
        same = bytes_below(run / "snapshots") == bytes_below(again / "snapshots")
        require(same, "the resolved scene does not give the same snapshots again")
        print("run: repeated from its own scene.toml with two threads, byte for byte")
        drumlin("measure", again, "--parts", "none")
        check_study(drumlin, [run, again], folder / "study")


if __name__ == "__main__":
    main()
