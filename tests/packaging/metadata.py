"""What names the project in other tongues says the same as CMakeLists.txt, CITATION.cff and setup.py: codemeta.json and the recipe for conda.

usage: metadata.py SOURCES
"""

import json
import pathlib
import re
import sys
import tomllib

import jinja2
import yaml

from installed import require

# What CodeMeta 3.0 and schema.org know of a SoftwareSourceCode, as far as we say it.
TERMS = {"@context", "type", "name", "description", "version", "datePublished", "license", "author", "programmingLanguage", "operatingSystem", "runtimePlatform",
         "softwareRequirements", "softwareSuggestions", "keywords", "applicationCategory", "readme", "buildInstructions", "referencePublication"}
SECTIONS = {"package", "source", "build", "requirements", "test", "about"}


def one(pattern, text):
    found = re.findall(pattern, text)
    require(len(found) == 1, f"{pattern}: found {len(found)} times")
    return found[0]


def require_codemeta(sources, project, needed):
    data = json.loads((sources / "codemeta.json").read_text(encoding="utf-8"))
    cited = yaml.safe_load((sources / "CITATION.cff").read_text(encoding="utf-8"))
    require(set(data) <= TERMS, f"codemeta.json: unknown terms {set(data) - TERMS}")
    require(data["@context"] == "https://w3id.org/codemeta/3.0" and data["type"] == "SoftwareSourceCode", "codemeta.json: not of CodeMeta 3.0")
    paper, said = cited["references"][0], data["referencePublication"]
    same = {"version": (data["version"], cited["version"], project["version"]), "name": (data["name"].lower(), project["name"]),
            "description": (data["description"], project["description"]), "date": (data["datePublished"], str(cited["date-released"])),
            "license": (data["license"].removeprefix("https://spdx.org/licenses/"), cited["license"], project["license"]),
            "authors": ([author["name"] for author in data["author"]], [author["name"] for author in cited["authors"]]),
            "requirements": (data["softwareRequirements"], needed), "paper": (said["name"], paper["title"]),
            "its authors": ([author["familyName"] for author in said["author"]], [author["family-names"] for author in paper["authors"]])}
    for what, values in same.items():
        require(all(value == values[0] for value in values), f"{what} differs: {values}")
    for key in ("readme", "buildInstructions"):
        require((sources / data[key]).is_file(), f"codemeta.json: {key}: {data[key]} is no file")


def rendered(recipe, selectors):
    """The recipe as conda-build reads it: lines kept by their selector, Jinja with the functions that it gives, YAML."""
    lines = [line for line in recipe.read_text(encoding="utf-8").splitlines() if not (found := re.search(r"# \[not (\w+)\]$", line)) or found[1] not in selectors]
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined)
    return yaml.safe_load(environment.from_string("\n".join(lines)).render(PYTHON="python", compiler=lambda language: f"{language}_compiler"))


def require_conda(sources, project, needed):
    recipe = rendered(sources / "packaging/conda/meta.yaml", {"linux"})
    require(set(recipe) == SECTIONS, f"sections of the recipe: {sorted(recipe)}")
    require(recipe["package"] == {"name": project["name"], "version": project["version"]}, f"package of the recipe: {recipe['package']}")
    require(recipe["about"]["license"] == project["license"] and recipe["about"]["summary"] == project["description"], f"about: {recipe['about']}")
    require("skip" not in recipe["build"] and "skip" in rendered(sources / "packaging/conda/meta.yaml", {"osx"})["build"], "the recipe is for Linux")
    python, *others = recipe["requirements"]["run"]
    require(python == f"python {project['python']}" and [name.removesuffix("-base") for name in others] == needed, f"the recipe runs with {python}, {others}")
    for part, names in recipe["requirements"].items():
        require(len(set(names)) == len(names) and all(isinstance(name, str) for name in names), f"requirements of {part}: {names}")


def main():
    sources = pathlib.Path(sys.argv[1])
    listed, setup = ((sources / name).read_text(encoding="utf-8") for name in ("CMakeLists.txt", "setup.py"))
    name, version = one(r"^project\((\S+) VERSION (\S+)", listed[listed.index("project("):])
    project = {"name": name, "version": version, "description": one(r'DESCRIPTION "(.*)"', listed), "license": one(r'license="(.*)"', setup),
               "python": one(r'python_requires="(.*)"', setup)}
    require(one(r'description="(.*)"', setup) == project["description"], "setup.py has another description")
    needed = json.loads(one(r"NEEDED = (\[.*\])", setup))
    require_codemeta(sources, project, needed)
    require_conda(sources, project, needed)
    wheels = tomllib.loads((sources / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["cibuildwheel"]
    require(wheels["build"] == "cp311-* cp312-* cp313-*", f"wheels are built for {wheels['build']}")
    print("codemeta.json and the recipe say what the project says")


if __name__ == "__main__":
    main()
