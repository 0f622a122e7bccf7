"""One contract for every command of the table (`drumlin --commands`): usage and inputs that are refused, outputs that are kept, signals, lost streams.

usage: contract.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import json
import shutil
import signal
import time

from command import SHORT_RUN, bytes_below, given, require, require_whole_files
from signals import PATIENCE, SIGNALS, started
from streams import by_shell, without_reader

# What makes a call of a command short, or a call at all; a command that is not named here needs nothing but its options.
MORE = {"run": SHORT_RUN, "measure": ["--parts", "none"], "export": ["--vtu", "--snapshots", "last"], "cost": ["--effects", "--seconds", "0.01"],
        "calibrate": ["--accept-unsteady", "--draws", "16", "--from", "profiles"], "compare": ["--accept-unsteady"], "flow": ["--set", "output.figures=false"],
        "pair": ["--scene-only"], "law": ["--extrapolate"], "sweep": SHORT_RUN}


class Contract:
    """A command with the words of one call of it."""

    def __init__(self, drumlin, command, samples, folder):
        self.drumlin, self.command, self.folder = drumlin, command, folder
        self.options = {option["name"]: option for option in command["options"]}
        self.result = folder / ("-".join(command["name"].split()) + "-" + self.options["output"]["kind"] if "output" in self.options else "none")
        # What stands in the folder of its run unless told does so here.
        self.has_output = "output" in self.options and (self.options["output"]["is_required"] or "run" not in self.options)
        self.samples = samples | ({"output": self.result} if self.has_output else {})

    def value_of(self, option):
        name = option["name"]
        return self.samples.get(name if name in self.samples else option["kind"], option["choices"][0] if option["choices"] else "text")

    def words(self, **changed):
        """A call with the value of each option that it needs; None leaves one out."""
        words = self.command["name"].split()
        for name, option in self.options.items():
            if option["is_positional"] or option["is_required"] or name in self.samples or name in changed:
                value = changed.get(name, self.value_of(option))
                if value is not None:
                    words += [value] if option["is_positional"] else ["--" + name, value]
        return [*words, *MORE.get(self.command["name"], [])]

    def others(self):
        """Each option that decides the results, with another value than its own."""
        for name, option in self.options.items():
            default, other = option["default"], None
            if option["choices"]:
                other = next((choice for choice in option["choices"] if default and choice != default), None)
            elif option["kind"] in ("INT", "FLOAT") and default is not None:
                other = default + 1
            if option["decides"] and not option["needs"] and "--" + name not in self.words() and (other or default is False):
                yield ["--" + name] if other is None else ["--" + name, other]

    def refuses(self, *words, reason, said_as=""):
        before = bytes_below(self.folder)
        _, said = self.drumlin(*words, code=2)
        require(said.strip() and said_as in said, f"{reason}: {words} was refused with {said!r}")
        require(bytes_below(self.folder) == before, f"{reason}: {words} touched files")
        return 1

    def wrong_usage(self):
        tried = self.refuses(*self.words(), "--no-such-option", reason="an unknown option")
        for name, option in self.options.items():
            if option["is_required"]:
                tried += self.refuses(*self.words(**{name: None}), reason=f"without {name}")
            if option["kind"] in ("INT", "FLOAT"):
                for value in ("two", "nan"):
                    tried += self.refuses(*self.words(**{name: value}), reason="no number")
            if option["choices"]:
                tried += self.refuses(*self.words(**{name: "neither"}), reason="no choice")
        return tried

    def wrong_inputs(self, wrong):
        inputs = [name for name, option in self.options.items() if option["is_of_paths"] and name != "output" and (option["is_positional"] or option["is_required"])]
        return sum(self.refuses(*self.words(**{name: path}), reason=reason) for name in inputs for reason, path in wrong.items())

    def leaves_results(self):
        return "resume" in self.options and self.command["name"] != "cost"

    def results_stay(self, theirs):
        """A result is made once, kept, found again and replaced; what is not ours is never touched."""
        if not self.leaves_results():
            return
        if self.has_output:
            for more in ([], ["--resume"], ["--overwrite"]):
                self.refuses(*self.words(output=theirs / "keep.txt" if "." not in self.result.name else theirs), *more, reason="what is not ours")
            self.refuses(*self.words(output=self.folder / ("x" * 300)), reason="a name that nothing can have")
        self.drumlin(*self.words())
        before = bytes_below(self.folder)
        self.refuses(*self.words(), reason="an existing output")
        said, _ = self.drumlin(*self.words(), "--resume")
        require("done already" in said or "nothing to do" in said, f"{self.command['name']} --resume: {said}")
        require(bytes_below(self.folder) == before, f"{self.command['name']} --resume touched files")
        for other in self.others():
            self.refuses(*self.words(), *other, "--resume", reason="what was not requested", said_as="other")

    def ends_by_signals(self):
        """At any moment, with its code, without parts of files."""
        more = ["--overwrite"] if "overwrite" in self.options else []
        for step, (number, code) in enumerate(SIGNALS.items()):
            process = started([self.drumlin.executable, *self.words(), *more])
            time.sleep(0.03 + 0.1 * step)  # anywhere, the beginning and the end included
            process.send_signal(number)
            process.wait(PATIENCE)
            # Before main() has begun, the signal ends the process itself; after its end it comes too late.
            require(process.returncode in (code, -number, 0, 3), f"{self.words()}: exit code {process.returncode} instead of {code}")
            require_whole_files(self.folder)
        if more:  # what was interrupted is made
            self.drumlin(*self.words(), *more)

    def says_what_is_lost(self):
        """Output that cannot be written is code 74, that nobody reads ends the command by SIGPIPE; no abort, no message without need."""
        for words in (self.words() + (["--resume"] if self.leaves_results() else ["--overwrite"] if "overwrite" in self.options else []),
                      [*self.command["name"].split(), "--help"]):
            result = by_shell(self.drumlin.executable, words, ">/dev/full")
            require(result.returncode == 74 and "lost" in result.stderr, f"{words}: exit code {result.returncode} instead of 74\n{result.stderr}")
            result = without_reader([self.drumlin.executable, *words])
            ends = (-signal.SIGPIPE, 128 + signal.SIGPIPE)  # the latter where it hands on how its own program ended
            require(result.returncode in ends and not result.stderr, f"{words}: a gone reader gives {result.returncode}\n{result.stderr}")


def samples_in(drumlin, here, data, folder):
    """A value for each kind of option, or for an option by its name."""
    run, flow = folder / "run", folder / "flow"
    scene, flow_scene, law = here / "tiny-drum.toml", here / "tiny-drum-flow.toml", data / "rheology" / "paper.toml"
    drumlin("run", scene, "-o", run, *SHORT_RUN)
    drumlin("measure", run, "--parts", "maps")
    drumlin("flow", flow_scene, "--rheology", law, "-o", flow, *MORE["flow"])
    csv = folder / "csv"
    csv.mkdir()
    (csv / "grains-0.csv").write_text("time_s,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0,0,0,0,0,1e-3\n", encoding="utf-8")
    (csv / "import.toml").write_text('format = "drumlin-import-1"\ntitle = "A disc"\n[grains]\ndensity_kg_m3 = 2700\n[csv]\ngrains = ["grains-*.csv"]\n', encoding="utf-8")
    (csv / "runs.csv").write_text("friction,theta_deg\n" + "".join(f"{0.1 * k},{20 + k}\n" for k in range(1, 9)), encoding="utf-8")
    (csv / "question.toml").write_text('format = "drumlin-question-1"\nunknowns = { friction = [0.1, 0.8] }\n[[scenes]]\ntable = "runs.csv"\n'
                                       'measured = [{ quantity = "theta_deg", value = 24, interval = 0.5 }]\n', encoding="utf-8")
    return {"SCENE.toml": scene, "QUESTION.toml": csv / "question.toml", "RHEOLOGY.toml": law, "RUN": run, "DIR": run, "FLOWRUN": flow, "FIELDS": flow, "LIMITS.toml": data / "limits" / "bed.toml",
            "PROBLEM.h5": data / "problems" / "drum-300-mu-0.4-flow.h5", "DESCRIPTION.toml": csv / "import.toml", "INT": "1", "FLOAT": "1",
            "KEY=VALUE:VALUE...": "seed=1:2", "NAME": "drum-smoke"}


def main():
    with given() as (drumlin, here, data, folder):
        (folder / "samples").mkdir()
        samples = samples_in(drumlin, here, data, folder / "samples")
        theirs = folder / "theirs"
        theirs.mkdir()
        (theirs / "keep.txt").write_text("years of work", encoding="utf-8")
        (folder / "empty.toml").touch()
        wrong = {"a missing file": folder / "missing", "a folder of something else": theirs, "an empty file": folder / "empty.toml",
                 "a name that nothing can have": folder / ("x" * 300)}
        commands, refused = json.loads(drumlin("--commands")[0]), 0
        for command in commands:
            name = command["name"]
            # Results that stand in the folder of a run are made in a copy of it.
            place = folder / "-".join(name.split())
            place.mkdir()
            own = samples | {"scene": samples["SCENE.toml"] if name != "flow" else here / "tiny-drum-flow.toml"}
            if any(option["name"] in ("run", "folder") for option in command["options"]) and name != "compare":
                own["RUN"] = own["DIR"] = place / "run"
                shutil.copytree(samples["RUN"], place / "run")
                if name == "measure":
                    shutil.rmtree(place / "run" / "measured")
            if name == "calibrate":
                own["RUN"] = data / "bed" / "6rpm-5turns-seed1"
            if name == "score":
                own["against"] = samples["RUN"]
            contract = Contract(drumlin, command, own, place)
            refused += contract.wrong_usage() + contract.wrong_inputs(wrong)
            contract.results_stay(theirs)
            contract.ends_by_signals()
            contract.says_what_is_lost()
            shutil.rmtree(place)
    print(f"{len(commands)} commands keep the contract; {refused} calls refused")


if __name__ == "__main__":
    main()
