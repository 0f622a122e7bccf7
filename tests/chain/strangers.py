"""What others have made or planted: folders of results, names, files of settings. Nothing outside is touched, nothing is executed.

usage: strangers.py DRUMLIN FOLDER_OF_THIS_TEST DATA
"""

import hashlib
import itertools
import os
import pathlib
import resource
import shutil
import subprocess

import h5py

from command import SHORT_RUN, bytes_below, given, require

PATIENCE = 300  # seconds for what takes less than one
EXISTING = ([], ["--resume"], ["--overwrite"])
SUBFOLDERS = {"plots": ["plot"], "report": ["report"], "history": ["history"], "vtu": ["export", "--vtu"],
              "measured": ["measure", "--parts", "none"]}


def called(executable, *words, cwd=None, limit=None, environment=None):
    """Exit code, and all that was printed as bytes."""
    done = subprocess.run([executable, *words], cwd=cwd, preexec_fn=limit, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env=environment, timeout=PATIENCE, check=False)
    return done.returncode, done.stdout


def sign(folder, command, contents, state="complete"):
    """A manifest as anybody can write it, and those of its files that are given."""
    text = f"# drumlin-manifest-1\n# command = {command}\n# state = {state}\n"
    for name, content in sorted(contents.items()):
        text += f"# bytes = {len(content)}\n{hashlib.sha256(content).hexdigest()}  {name}\n"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "manifest.txt").write_text(f"{text}# sum = {hashlib.sha256(text.encode()).hexdigest()}\n", encoding="utf-8")


def somewhere_else(folder):
    """Work of years, that no call below may change."""
    if not folder.exists():
        folder.mkdir()
        for name in ("replaced.txt", "removed.txt", "000001.h5"):
            (folder / name).write_text("years of work\n", encoding="utf-8")
    return bytes_below(folder)


def plant_new_results(target, command, elsewhere):
    """New results that seem to be whole, to be put in their places, one of them through a link."""
    sign(target, command, {"y/removed.txt": b"years of work\n"})
    (target / "y").symlink_to(elsewhere)
    sign(target / ".drumlin-new", command, {"y/replaced.txt": b"planted\n"})
    (target / ".drumlin-new" / "y").mkdir()
    (target / ".drumlin-new" / "y" / "replaced.txt").write_text("planted\n", encoding="utf-8")


def planted_results_stay_where_they_are(executable, scene, run, csv, folder):
    """Of every command that leaves a folder: new results planted in it, and a link in its place."""
    elsewhere, stranger = folder / "elsewhere", folder / "stranger"
    before, trials = somewhere_else(elsewhere), 0
    commands = {sub: [words[0], stranger, *words[1:]] for sub, words in SUBFOLDERS.items()}
    commands |= {"run": ["run", scene, *SHORT_RUN, "-o", stranger / "run"], "import": ["import", csv / "import.toml", "-o", stranger / "import"]}
    for (sub, words), existing, linked in itertools.product(commands.items(), EXISTING, (False, True)):
        if linked and sub not in SUBFOLDERS:  # a link that a user names stands for its folder
            continue
        shutil.copytree(run, stranger)
        if linked:
            sign(elsewhere, words[0], {"removed.txt": b"years of work\n"})
            (stranger / sub).symlink_to(elsewhere)
        else:
            plant_new_results(stranger / sub, words[0], elsewhere)
        code, said = called(executable, *words, *existing)
        (elsewhere / "manifest.txt").unlink(missing_ok=True)
        require(bytes_below(elsewhere) == before and code in (0, 2), f"{words} {existing}, a link: {linked}: {code}, or changed files elsewhere\n{said}")
        shutil.rmtree(stranger)
        trials += 1
    return trials


def a_named_link_stands_for_its_folder(executable, scene, folder):
    (folder / "real").mkdir()
    (folder / "named").symlink_to(folder / "real")
    for name in ("named/", "named"):
        code, said = called(executable, "run", scene, *SHORT_RUN, "-o", f"{folder}/{name}", "--overwrite")
        require(code == 0 and (folder / "real" / "run.json").exists(), f"-o {name}: {code}\n{said}")


def names_need_not_be_utf8(executable, scene, folder):
    """In a folder whose name is no text all commands work by the names below it; as a word such a name is refused, for results are UTF-8."""
    here = os.fsencode(folder) + b"/h\xe4r"
    os.mkdir(here)
    calls = [["run", scene, "-o", "run", *SHORT_RUN], ["measure", "run", "--parts", "none"], ["plot", "run", "--player"], ["history", "run"],
             ["export", "run", "--vtu"], ["run", scene, "-o", "run", *SHORT_RUN, "--resume"], ["compare", "run", "run", "--accept-unsteady", "-o", "compared"]]
    for words in calls:
        code, said = called(executable, *words, cwd=here)
        require(code == 0, f"{words}: {code}\n{said}")
    for words in ([*calls[0][:3], here + b"/run"], ["plot", here + b"/run"], ["plot", "run", "-o", b"\xe4"]):
        code, said = called(executable, *words, cwd=here)
        require(code == 2 and b"\xe4" in said and b"no UTF-8" in said, f"{words}: {code}\n{said}")
    return len(calls) + 3


def settings_of_the_current_folder(executable, scene, run, data, folder):
    """Files that a library looks for in the current folder: nothing of them is executed or refused."""
    trials = 0
    for kind in ("code", "options", "bytes"):
        current = folder / f"current-{kind}"
        current.mkdir()
        mark = current / "executed"
        if kind == "code":
            (current / "e.c").write_text(f'#include <stdio.h>\nvoid __attribute__((constructor)) e(void) {{ fopen("{mark}", "w"); }}\n', encoding="utf-8")
            subprocess.run(["cc", "-shared", "-fPIC", "-o", current / "e.so", current / "e.c"], check=True)
        content = {"code": b"-dll_prepend ./e.so\n", "options": b"-help\n-ksp_type nonsense\n-options_left\n", "bytes": b"\xff\xfe\x00: \x80\n"}[kind]
        for name in (".petscrc", "petscrc", "matplotlibrc"):
            (current / name).write_bytes(content)
        environment = os.environ | {"HOME": str(current)}
        if kind != "bytes":
            environment["PETSC_OPTIONS"] = content.decode().replace("\n", " ")
        plot, flow = ["plot", run, "--overwrite"], ["flow", scene.parent / "tiny-drum-flow.toml", "--rheology", data / "rheology" / "drum-6rpm.toml",
                                                    "-o", folder / f"flow-{kind}"]
        ranks = [scene, *SHORT_RUN, "-o", folder / f"ranks-{kind}"]
        for words in {"code": [flow, ranks], "options": [flow], "bytes": [plot]}[kind]:
            program = str(pathlib.Path(executable).parent / "drumlin-run") if words is ranks else executable
            code, said = called(program, *words, cwd=current, environment=environment)
            require(code == 0 and not mark.exists(), f"{words[0]}, {kind}: {code}, executed: {mark.exists()}\n{said}")
            trials += 1
    return trials


def contact_problems_of_others(executable, problem, folder):
    mu, q = "fclib_local/vectors/mu", "fclib_local/vectors/q"
    faults = [(mu, lambda values: values.reshape(-1, 1)), (mu, lambda values: values.reshape(2, -1)), (q, lambda values: values.reshape(-1, 2)), (mu, lambda values: values[1:])]
    for number, (name, of) in enumerate(faults):
        file = folder / f"problem-{number}.h5"
        shutil.copy(problem, file)
        with h5py.File(file, "r+") as content:
            values = content[name][:]
            del content[name]
            content[name] = of(values)
        code, said = called(executable, "solve-contacts", file)
        require(code == 2 and name.encode() in said, f"fault {number} of {name}: {code}\n{said}")
    return len(faults)


def nothing_to_do_needs_no_disk(executable, scene, run):
    """On a disk that takes nothing a finished run is finished."""
    before = bytes_below(run)
    code, said = called(executable, "run", scene, *SHORT_RUN, "-o", run, "--resume",
                        limit=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)))
    require(code == 0 and b"nothing to do" in said and bytes_below(run) == before, f"a finished run: {code}\n{said}")


def main():
    with given() as (drumlin, here, data, folder):
        executable, run = drumlin.executable, folder / "run"
        scene, problem = here / "tiny-drum.toml", data / "problems" / "drum-300-mu-0.4-flow.h5"
        drumlin("run", scene, "-o", run, *SHORT_RUN)
        csv = folder / "csv"
        csv.mkdir()
        (csv / "grains-0.csv").write_text("time_s,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0,0,0,0,0,1e-3\n", encoding="utf-8")
        (csv / "import.toml").write_text(
            'format = "drumlin-import-1"\ntitle = "A disc"\n[grains]\ndensity_kg_m3 = 2700\n[csv]\ngrains = ["grains-*.csv"]\n', encoding="utf-8")
        counts = {"planted": planted_results_stay_where_they_are(executable, scene, run, csv, folder),
                  "contact problems": contact_problems_of_others(executable, problem, folder)}
        a_named_link_stands_for_its_folder(executable, scene, folder)
        nothing_to_do_needs_no_disk(executable, scene, run)
        counts["no UTF-8"] = names_need_not_be_utf8(executable, scene, folder)
        counts["settings"] = settings_of_the_current_folder(executable, scene, run, data, folder)
    print(counts)


if __name__ == "__main__":
    main()
