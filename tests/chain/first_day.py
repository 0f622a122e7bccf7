"""What somebody meets on the first day: scenes to start from, a page for a run, and completion in a shell.

usage: first_day.py DRUMLIN FOLDER_OF_TEMPLATES [--chains]
  --chains  the scenes as a user types them, to their law or pair, and no other part
"""

import re
import subprocess
import sys
import tomllib

from command import given, read_json, require

# What makes a run of each scene of grains short where its numbers do not matter.
SHORT = {"drum": ["stages.0.duration_s=0.02", "stages.1.turns=0.005", "stages.2.turns=0.01", "stages.2.snapshots=3"],
         "shear": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.2.duration_s=0.02", "stages.2.snapshots=2"],
         "chute": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.1.snapshots=4"],
         "silo": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.1.snapshots=3"]}
FLOWS = ["drum-flow", "shear-flow", "chute-flow", "silo-flow"]


def written(drumlin, templates, kind, folder):
    """A kind is written as data/templates holds it, with its own name, comments and no long line, and not written over."""
    file = folder / f"{kind}.toml"
    said, _ = drumlin("new", kind, "-o", file)
    text = file.read_text(encoding="utf-8")
    require(f"{file}: a commented" in said and "next: drumlin " in said, said)
    require(text == (templates / f"{kind}.toml").read_text(encoding="utf-8").replace("THIS.toml", str(file)), f"{kind}: another text")
    commented = [line for line in text.splitlines() if "#" in line]
    require(len(commented) > 7 and max(map(len, text.splitlines())) <= 160 + len(str(file)), f"{kind}: hardly a comment, or long lines")
    _, refused = drumlin("new", kind, "-o", file, code=2)
    require("exists already" in refused, refused)
    drumlin("new", kind, "-o", file, "--overwrite")
    return file


def scenes(drumlin, templates, folder):
    """Each kind of grains checks and runs; the program holds what data/templates holds."""
    require(sorted(file.stem for file in templates.glob("*.toml")) == sorted([*SHORT, *FLOWS]), "a template without a test, or the other way round")
    for kind, changes in SHORT.items():
        file = written(drumlin, templates, kind, folder)
        checked, _ = drumlin("scene", "check", file)
        require(": ok\n" in checked and "warning" not in checked, checked)
        drumlin("run", file, "-o", folder / kind, *(word for change in changes for word in ("--set", change)))
        require(read_json(folder / kind / "run.json")["status"] == "finished", f"{kind} does not run")
    # A name that a comment cannot hold is not put into one.
    odd = folder / "a\nformat = 'b'.toml"
    drumlin("new", "silo", "-o", odd)
    require("THIS.toml" in odd.read_text(encoding="utf-8"), "a name with a new line became a line of the scene")
    _, refused = drumlin("new", "avalanche", "-o", folder / "x.toml", code=2)
    require("drum" in refused and not (folder / "x.toml").exists(), refused)


def measured(drumlin, scene, run, *changes, words=("--parts", "none")):
    """What `measure` prints of a run of the scene as it is."""
    drumlin("run", scene, "-o", run, *changes)
    return drumlin("measure", run, *words)[0]


def chains(drumlin, templates, folder):
    """As their heads and the lines "next:" say: drum and shear go to a law, whose flow is compared, chute and silo to their pair. All by the scenes as
    they are written; `measure` says of a chute that has come to rest that nothing flows, and of a run that is too short how it goes on."""
    place = folder / "whole"
    place.mkdir()
    files = {kind: written(drumlin, templates, kind, place) for kind in [*SHORT, *FLOWS]}
    law, flow = place / "rheology.toml", lambda kind, law_name: drumlin("flow", files[kind], "--rheology", law_name, "-o", place / f"{kind}-run")[0]

    said = measured(drumlin, files["drum"], place / "drum", words=("--parts", "maps"))
    require("\nsteady: " in said and f"next: drumlin calibrate {place / 'drum'}" in said, said)
    said, _ = drumlin("calibrate", place / "drum", "-o", law)
    require("next: drumlin new drum-flow" in said, said)
    said = flow("drum-flow", law)
    require("next: drumlin compare RUN" in said, said)
    drumlin("compare", place / "drum", place / "drum-flow-run", "-o", place / "report")
    require((place / "report/index.html").exists(), "no report")

    said = measured(drumlin, files["shear"], place / "shear")
    require("\nsteady: " in said and "next: drumlin calibrate" in said, said)
    said, _ = drumlin("calibrate", place / "shear", "-o", law, "--overwrite")
    found, band = re.search(r"with I from (\S+) to (\S+),", said), re.search(r"\* log .*band at I = \S+: \+- (\S+)", said)
    require(float(found[2]) > 10 * float(found[1]) and float(band[1]) < 0.1 and "warning" not in said, said)
    require(0.2 < tomllib.loads(law.read_text(encoding="utf-8"))["mu"]["a"] < 0.7, "not the law of such grains")

    drumlin("law", "--friction", "0.4", "-o", library := place / "law.toml")
    said = measured(drumlin, files["chute"], place / "chute")
    require("\nsteady: " in said and f"next: drumlin pair {place / 'chute'}/scene.toml --run {place / 'chute'} --law LAW" in said, said)
    drumlin("pair", place / "chute" / "scene.toml", "--run", place / "chute", "--law", library, "-o", place / "chute-pair")
    require((place / "chute-pair/report/index.html").exists(), "no report of the chute")
    said = flow("chute-flow", library)
    require("next: drumlin compare" in said, said)
    drumlin("compare", place / "chute", place / "chute-flow-run", "-o", place / "chute-report")
    errors = read_json(place / "chute-pair/report/comparison.json")["errors"]
    # The layers on the rough base hardly move, which no law over I knows: the speed above them is 40 to 70 % less than the continuum's.
    require(errors["sigma_xz"]["bulk"]["rel_l2"] < 0.15 and errors["I"]["bulk"]["rel_l2"] < 0.25, f"another flow: {errors['sigma_xz']} {errors['I']}")
    said = flow("shear-flow", library)
    require(abs(read_json(place / "shear-flow-run/flow.json")["I"] - 0.0506) < 0.001, "I = 8/s d sqrt(rho/P)")

    said = measured(drumlin, files["silo"], place / "silo", words=("--since", "0.5", "--parts", "none"))
    require("\nsteady: " in said and "calibrate" not in said and f"next: drumlin pair {place / 'silo'}/scene.toml" in said, said)
    rate = read_json(place / "silo/run.json")["regions"][0]["rate"]
    require(rate["ci99"] < 0.25 * rate["grains_per_s"], f"no steady rate: {rate}")
    drumlin("pair", place / "silo" / "scene.toml", "--run", place / "silo", "--law", library, "--case", "silo", "-o", place / "silo-pair")
    require((place / "silo-pair/report/index.html").exists(), "no report of the silo")
    said = flow("silo-flow", library)
    require("next: open the pictures" in said, said)

    said = measured(drumlin, files["chute"], place / "resting", "--set", "effects.gravity.direction_deg=-72", "--set", "stages.1.snapshots=40")
    require("nothing flows" in said and "next: let it flow" in said and "calibrate" not in said, said)
    require(not read_json(place / "resting/measured/measured.json")["steadiness"]["flows"], "it flows")
    _, said = drumlin("calibrate", place / "resting", "-o", place / "none.toml", code=2)
    require("nothing flows" in said, said)
    said, _ = drumlin("measure", place / "silo", "--overwrite", "--parts", "none")  # its start, too
    require("not steady" in said and "--since" in said, said)
    said = measured(drumlin, files["shear"], place / "short", "--set", "stages.2.duration_s=0.1", "--set", "stages.2.snapshots=10")
    found = re.search(r"next: drumlin run (\S+) -o (\S+) --extend (\S+), then", said)
    require("not steady" in said and found, said)
    drumlin("run", found[1], "-o", found[2], "--extend", found[3])
    drumlin("measure", found[2], "--overwrite", "--parts", "none")


def require_page(folder, *words):
    page = (folder / "index.html").read_text(encoding="utf-8")
    for word in words:
        require(word in page, f"{folder}: {word!r} is not on the page")
    for word in ("<script src", "<link", "http://", "https://", "src=\"http", "@import"):
        require(word not in page, f"{folder}: the page says {word}")
    links = set(re.findall(r'<a href="#(\w+)"', page))
    require(len(links) == 5 and links <= set(re.findall(r' id="(\w+)"', page)), f"links that lead nowhere: {links}")
    return page


def reports(drumlin, folder):
    """A page without measurements, and with them; of a run that is still going on; a title is escaped; done is done."""
    run = folder / "silo"
    drumlin("report", run)
    page = require_page(run / "report", "My silo", "nothing was measured yet", "grains taken out", "player.html")
    require(page.count("data:image/png;base64,") == 4, "other pictures than speed, forces, log and time")
    said, _ = drumlin("report", run, "--resume")
    require("done already" in said, said)
    drumlin("report", run, code=2)
    manifest = (run / "report" / "manifest.txt").read_text(encoding="utf-8")
    for name in ("index.html", "player.html", "report.json", "speed.png"):
        require(f"  {name}\n" in manifest, f"{name} is not in the manifest")

    run = folder / "drum"
    drumlin("measure", run, "--parts", "none")
    drumlin("report", run)
    page = require_page(run / "report", "slope θ (deg)", "798 rigid discs")
    report = read_json(run / "report" / "report.json")
    require(report["measured"]["theta_deg"] == read_json(run / "measured" / "measured.json")["theta_deg"], "other numbers than measured")
    require(report["measured_figures"] and page.count("data:image/png;base64,") == 4 + len(report["measured_figures"]), "figures are missing")
    require("format = &#34;drumlin-scene-1&#34;" in page, "the scene is not on the page, or not escaped")

    # What was measured of another state of the run is not shown as if it were of this one.
    drumlin("run", run / "scene.toml", "-o", run, "--extend", "0.02")
    said, _ = drumlin("report", run, "--overwrite")
    require("without measurements" in said and read_json(run / "report" / "report.json")["measured"] is None, said)

    bad = folder / "titled.toml"
    bad.write_text((folder / "shear.toml").read_text(encoding="utf-8").replace('"My shear cell"', "\"<script>alert('x')</script>\""), encoding="utf-8")
    drumlin("run", bad, "-o", folder / "titled", *(word for change in SHORT["shear"] for word in ("--set", change)), "--set", "stages.2.snapshots=0")
    drumlin("report", folder / "titled")
    page = require_page(folder / "titled" / "report", "&lt;script&gt;alert")
    require("<script" not in page and "player.html" not in page and not (folder / "titled" / "report" / "player.html").exists(), "a player of nothing")
    for words in (["report", folder / "nowhere"], ["report", folder / "drum", "-o", folder / "drum", "--overwrite"]):
        _, said = drumlin(*words, code=2)
        require(said.strip(), f"{words} was refused without a word")


def completes(drumlin):
    script, _ = drumlin("--completion", "bash")
    _, refused = drumlin("--completion", "tcsh", code=2)
    require("bash" in refused, refused)

    def offered(*words):
        line = " ".join(f"'{word}'" for word in words)
        ask = f"{script}\nCOMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _drumlin; printf '%s\\n' \"${{COMPREPLY[@]}}\""
        result = subprocess.run(["bash", "--norc", "-c", ask], capture_output=True, text=True, check=False)
        require(result.returncode == 0 and not result.stderr, result.stderr)
        return result.stdout.split()

    require({"run", "plot", "new", "report", "solve-contacts", "--version"} <= set(offered("drumlin", "")), "commands are missing")
    require(offered("drumlin", "pl") == ["plot"], f"{offered('drumlin', 'pl')}")
    require(offered("drumlin", "plot", "RUN", "--pl") == ["--player"], f"{offered('drumlin', 'plot', 'RUN', '--pl')}")
    require(offered("drumlin", "new", "") == [*SHORT, *FLOWS], f"{offered('drumlin', 'new', '')}")
    require(offered("drumlin", "scene", "ch") == ["check"], f"{offered('drumlin', 'scene', 'ch')}")
    require(offered("drumlin", "scene", "keys", "--m") == ["--markdown"], f"{offered('drumlin', 'scene', 'keys', '--m')}")
    require(offered("drumlin", "plot", "RUN", "--color", "sp") == ["speed", "spin"], "colours")
    require(offered("drumlin", "run", "sc") == [], "files are bash's own business")


def main():
    with given() as (drumlin, templates, folder):
        if "--chains" in sys.argv:
            chains(drumlin, templates, folder)
            return
        completes(drumlin)
        scenes(drumlin, templates, folder)
        reports(drumlin, folder)
        chains(drumlin, templates, folder)
    print("scenes to start from run, and go through to their law or pair; runs have their page; the shell completes")


if __name__ == "__main__":
    main()
