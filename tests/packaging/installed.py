"""Installs into a prefix, moves it, looks for paths of the tree in it, runs the commands from there, builds the examples against it and runs them.

usage: installed.py CMAKE BUILD_FOLDER SOURCES COMPILER
"""

import os
import pathlib
import re
import subprocess
import sys
import tarfile
import tempfile

TINY = ["--set", "stages.0.duration_s=0.02", "--set", "stages.1.turns=0.002", "--set", "stages.2.turns=0.002", "--set", "stages.2.snapshots=1"]


def require(condition, message):
    if not condition:
        sys.exit(message)


def run(*words, **keywords):
    # Nothing of the tree may help: no library path, no folder of Python, another current folder.
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("LD_", "PYTHON", "CMAKE_", "DRUMLIN_"))}
    environment |= keywords.pop("environment", {})
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, env=environment, check=False, **keywords)
    require(result.returncode == 0, f"{' '.join(map(str, words))}\nexit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout


def places_of(prefix):
    """What the rest of the test needs of an installed tree, each there once."""
    names = ["bin/drumlin", "bin/drumlin-flow", "include/drumlin/particles/stepping/run_through.hpp", "share/drumlin/scenes/drum-smoke.toml",
             "share/drumlin/rheology/paper.toml", "share/drumlin/paper/observables.toml", "share/man/man1/drumlin.1", "share/fish/vendor_completions.d/drumlin.fish",
             "share/zsh/site-functions/_drumlin", "share/bash-completion/completions/drumlin", "share/doc/drumlin/docs/tutorial.md", "lib/python3/dist-packages/drumlin/__init__.py",
             "lib/python3/dist-packages/drumlin/figures/quantities.md", "lib/python3/dist-packages/drumlin/figures/style.py", "lib/python3/dist-packages/drumlin/pages/comparison.html"]
    for name in names:
        require((prefix / name).exists(), f"{name} is not installed")
    require(list(prefix.glob("lib/**/cmake/Drumlin/DrumlinConfig.cmake")), "DrumlinConfig.cmake is not installed")
    require(not list(prefix.rglob("detail")), "private headers are installed")


def require_no_path(prefix, paths):
    for file in prefix.rglob("*"):
        if file.is_file():
            content = file.read_bytes()
            for path in paths:
                require(str(path).encode() not in content, f"{file.relative_to(prefix)} holds the path {path}")


def require_commands(prefix, folder, sources):
    version = re.search(r"VERSION (\S+)", (sources / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1])[1]
    for name in ("drumlin", "drumlin-flow"):
        said = run(prefix / "bin" / name, "--version")
        require(re.match(rf"{name} {re.escape(version)} \(revision \S+, .*\)$", said), f"{name} --version says {said}")
    scene = prefix / "share/drumlin/scenes/drum-smoke.toml"
    run(prefix / "bin/drumlin", "run", scene, "-o", folder / "RUN", *TINY, cwd=folder)
    run(prefix / "bin/drumlin", "plot", folder / "RUN", cwd=folder)  # the figure scripts are found
    require(list((folder / "RUN").rglob("*.png")), "no picture was drawn")
    run(prefix / "bin/drumlin", "report", folder / "RUN", "--bundle", folder / "fault.tar.gz")
    with tarfile.open(folder / "fault.tar.gz") as bundle:
        names = {name.removeprefix("fault/") for name in bundle.getnames()}
    require(names >= {"scene.toml", "run.json", "log.csv", "manifest.txt", "versions.txt"}, f"the bundle holds {names}")
    require("drum-6rpm " in run(prefix / "bin/drumlin", "scene", "list"), "no list of scenes")
    run(prefix / "bin/drumlin", "scene", "check", "drum-smoke")
    package = {"PYTHONPATH": str(prefix / "lib/python3/dist-packages")}
    program = "import drumlin, sys; print(drumlin.version(), drumlin.read('RUN').snapshots[0].name, drumlin.program(), sep='|')"
    said = run("/usr/bin/python3", "-B", "-c", program, cwd=folder, environment=package).strip().split("|")
    require(said[0].startswith(version) and said[2] == str(prefix / "bin/drumlin"), f"the package says {said}")


def require_examples(cmake, prefix, folder, sources, compiler):
    build = folder / "examples"
    run(cmake, "-S", sources / "apps/examples", "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={compiler}",
        "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", cwd=folder)
    commands = (build / "compile_commands.json").read_text(encoding="utf-8")
    require("-Werror" not in commands and "-Wall" not in commands, "our warnings reach the programs of users")
    require("-ffp-contract=off" in commands and "-std=" in commands, "what inline functions need does not reach the programs of users")
    require(str(sources / "coupling") not in commands and f"-I{sources}" not in commands, "the examples see the sources")
    run(cmake, "--build", build)
    expected = {"box_of_discs": r"60 discs at rest .* carries (0\.99|1\.00)", "one_contact": r"converged after \d+ sweeps(.|\n)*a guess has residual 0\.[1-9]",
                "law_from_arrays": r"mu = 0\.3[45]\d* \+ 0\.0[12]\d* ln I(.|\n)*well-posed\n$",
                "flow_of_own_law": r"iterations; off the solution by quadrature by \d\.\de-\d"}
    for name, text in expected.items():
        said = run(build / name, cwd=folder)
        require(re.search(text, said), f"{name} says\n{said}")
    run(prefix / "bin/drumlin", "scene", "keys", cwd=folder)
    require("[mu]" in (folder / "rheology.toml").read_text(encoding="utf-8"), "no law was written")


def main():
    cmake, compiler = sys.argv[1], sys.argv[4]
    build, sources = (pathlib.Path(word).resolve() for word in sys.argv[2:4])
    with tempfile.TemporaryDirectory(prefix="drumlin-installed-") as name:
        folder = pathlib.Path(name).resolve()
        run(cmake, "--install", build, "--prefix", folder / "first")
        prefix = folder / "moved" / "here"
        prefix.parent.mkdir()
        (folder / "first").rename(prefix)
        places_of(prefix)
        require_no_path(prefix, [build, sources, folder / "first"])
        require_commands(prefix, folder, sources)
        require_examples(cmake, prefix, folder, sources, compiler)
    print("installed, moved, found by two programs, a package and four examples")


if __name__ == "__main__":
    main()
