"""What somebody meets on the first day: scenes to start from, a page for a run, and completion in a shell.

usage: first_day.py DRUMLIN FOLDER_OF_TEMPLATES
"""

import re
import subprocess

from command import given, read_json, require

# What makes a run of each scene short.
SHORT = {"drum": ["stages.0.duration_s=0.02", "stages.1.turns=0.005", "stages.2.turns=0.01", "stages.2.snapshots=3"],
         "shear": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.1.snapshots=2"],
         "chute": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.1.snapshots=4"],
         "silo": ["stages.0.duration_s=0.02", "stages.1.duration_s=0.02", "stages.1.snapshots=3"]}


def scenes(drumlin, templates, folder):
    """Each kind is written, checks, runs, and is not written over; the program holds what data/templates holds."""
    require(sorted(file.stem for file in templates.glob("*.toml")) == sorted(SHORT), "a template without a test, or the other way round")
    for kind, changes in SHORT.items():
        file = folder / f"{kind}.toml"
        said, _ = drumlin("new", kind, "-o", file)
        text = file.read_text(encoding="utf-8")
        require(str(file) in said, said)
        require(text == (templates / f"{kind}.toml").read_text(encoding="utf-8").replace("THIS.toml", str(file)), f"{kind}: another text")
        commented = [line for line in text.splitlines() if "#" in line]
        require(len(commented) > 12 and max(map(len, text.splitlines())) <= 150, f"{kind}: hardly a comment, or long lines")
        checked, _ = drumlin("scene", "check", file)
        require(": ok\n" in checked and "warning" not in checked, checked)
        _, refused = drumlin("new", kind, "-o", file, code=2)
        require("exists already" in refused, refused)
        drumlin("new", kind, "-o", file, "--overwrite")
        drumlin("run", file, "-o", folder / kind, *(word for change in changes for word in ("--set", change)))
        require(read_json(folder / kind / "run.json")["status"] == "finished", f"{kind} does not run")
    # A name that a comment cannot hold is not put into one.
    odd = folder / "a\nformat = 'b'.toml"
    drumlin("new", "silo", "-o", odd)
    require("THIS.toml" in odd.read_text(encoding="utf-8"), "a name with a new line became a line of the scene")
    _, refused = drumlin("new", "avalanche", "-o", folder / "x.toml", code=2)
    require("drum" in refused and not (folder / "x.toml").exists(), refused)


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
    drumlin("run", bad, "-o", folder / "titled", *(word for change in SHORT["shear"] for word in ("--set", change)), "--set", "stages.1.snapshots=0")
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
    require(offered("drumlin", "new", "") == ["drum", "shear", "chute", "silo"], f"{offered('drumlin', 'new', '')}")
    require(offered("drumlin", "scene", "ch") == ["check"], f"{offered('drumlin', 'scene', 'ch')}")
    require(offered("drumlin", "scene", "keys", "--m") == ["--markdown"], f"{offered('drumlin', 'scene', 'keys', '--m')}")
    require(offered("drumlin", "plot", "RUN", "--color", "sp") == ["speed", "spin"], "colours")
    require(offered("drumlin", "run", "sc") == [], "files are bash's own business")


def main():
    with given() as (drumlin, templates, folder):
        completes(drumlin)
        scenes(drumlin, templates, folder)
        reports(drumlin, folder)
    print("scenes to start from run; runs have their page; the shell completes")


if __name__ == "__main__":
    main()
