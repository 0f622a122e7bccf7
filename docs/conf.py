"""The manual as a site: docs/build writes it. README.md gives pages of its own; commands, the Python package and the public headers of the libraries
tell of themselves (Doxygen, breathe); notebooks are executed where DRUMLIN_NOTEBOOKS is set."""

import inspect
import logging
import os
import pathlib
import re
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("DRUMLIN_BUILD", ROOT / "build"))
sys.path.insert(0, str(BUILD / "python"))

project = "Drumlin"
version = release = re.search(r"project\(drumlin VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
copyright = "the founders of Drumlin"  # pylint: disable=redefined-builtin
NOTEBOOKS = "DRUMLIN_NOTEBOOKS" in os.environ
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", "breathe", *(["nbsphinx"] if NOTEBOOKS else [])]
breathe_default_project = "drumlin"
breathe_show_include = False
myst_enable_extensions = ["dollarmath", "amsmath"]
nbsphinx_execute, nbsphinx_timeout, nbsphinx_requirejs_path = "always", 1800, ""  # no page asks another host for a script
myst_heading_anchors = 4
myst_update_mathjax = False
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"  # Debian's MathJax 2, beside the pages: docs/build copies it
autodoc_member_order, autodoc_typehints = "bysource", "description"
html_theme = "furo"
highlight_language = "console"  # of blocks that name none
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_title = f"Drumlin {version}"
exclude_patterns = ["figures", "cookbook/*.py", "doxygen", *([] if NOTEBOOKS else ["notebooks"])]
suppress_warnings = ["myst.header"]


# What each page of the sidebar holds below it.
NOTEBOOK_PAGES = ["first-drum", "profiles-and-laws", "flow-and-comparison", "sweep", "own-scene", "contact-problems", "lammps", "accuracy-and-time", "infer"]
BELOW = {
    "conventions": ["glossary"],
    "scenes": ["cookbook/your-own-scene", "cookbook/pairs", "cookbook/infer", "effects"],
    "scaling": ["robustness"],
    "cookbook/python": [f"notebooks/{name}" for name in NOTEBOOK_PAGES] if NOTEBOOKS else [],
    "theory/solvers": ["cookbook/contact-problems", "theory/impacts", "theory/energy", "theory/moving-cell"],
    "theory/rheology": ["theory/dilatancy", "theory/free-surface"],
    "theory/coarse-graining": ["theory/statistics"],
    "results": ["results/paper", "results/continuum", "results/bed", "results/laws", "results/spheres"],
    "verification": ["convergence", "hard-cases", "cost"],
    "formats/README": sorted(f"formats/{page.stem}" for page in (ROOT / "docs/formats").glob("[!R]*.md") if page.stem != "import"),
    "contributing": ["architecture", "decisions", "support", "changes"],
}
# Files beside docs that are pages, or parts of some.
PAGE_OF = {"README.md": "index", "README.md#install": "install", "README.md#results": "results", "CONTRIBUTING.md": "contributing", "CHANGELOG.md": "changes"}


def commands():
    """A page from the help of every command."""
    program = BUILD / "drumlin"

    def help_of(*words):
        return subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout.split("\nNew here:")[0].rstrip()

    names = re.findall(r"^  ([a-z-]+)  ", help_of().split("Subcommands:")[1], re.M)
    keys = "Keys of files: [scene](formats/scene.md#keys), [flow](formats/flow.md), [law](formats/rheology.md)."
    return f"# Commands and keys\n\n{keys}\n\n" + "\n\n".join(f"## drumlin {name}\n\n```text\n{help_of(name)}\n```" for name in names) + "\n"


# The names of the package by what they are for; each module's own page of names follows its group.
PYTHON = {"Run and measure": ["run", "measure", "solve_flow", "compare", "make_pair", "infer", "score", "command", "program"],
          "Many runs": ["sweep", "SweptRun", "run_all", "Outcome"], "Read": ["read", "Folder", "Arrays", "value_of"],
          "Look": ["show", "Picture"], "Step a scene": ["Simulation", "resolved", "toml_of"], "Laws": ["Law", "calibrate", "CalibratedLaw", "law", "LibraryLaw"],
          "Contact problems": ["solve_contacts", "ContactSolution", "contact_residual", "contact_solvers"],
          "Errors": ["DrumlinError", "InputError", "NotConvergedError", "IoError", "Interrupted", "Killed"]}


def python():
    import drumlin

    missing = set(drumlin.__all__) - {"errors", "plot", "study", "version"} - set().union(*PYTHON.values())
    if missing:
        raise SystemExit(f"docs/conf.py: in no group of PYTHON: {missing}")
    page = "# The Python package\n\n[Notebooks and examples](cookbook/python.md). Each name is one of `drumlin`.\n"
    for group, names in PYTHON.items():
        page += f"\n## {group}\n\n```{{eval-rst}}\n"
        for name in names:
            kind = "exception" if group == "Errors" else "class" if inspect.isclass(getattr(drumlin, name)) else "function"
            page += f".. auto{kind}:: drumlin.{name}\n" + ("   :members:\n" if kind == "class" else "") + "\n"
        page += "```\n"
    return page + "\n## Draw on axes of your own\n\n```{eval-rst}\n.. automodule:: drumlin.plot\n   :members:\n   :exclude-members: show, Picture\n```\n"


# A header opens with a comment that says what it is: of the file, to Doxygen. Without their namespaces, which the pages name, headers declare nothing twice.
DOXYGEN = r"""
INPUT_FILTER = "sed -e '2{s|^//|/// \\file\n///|;:a;n;s|^//|///|;ta;}' -e '/^namespace drumlin.* {$/d' -e '/^}  . namespace drumlin/d'"
EXTRACT_ALL = YES
STRIP_FROM_PATH = .
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
QUIET = YES
WARN_AS_ERROR = FAIL_ON_WARNINGS
"""
LIBRARIES = ("particles", "coupling", "continuum")


def included(file):
    """Public headers that a file includes."""
    text = (ROOT / file).read_text(encoding="utf-8")
    return {name for name in re.findall(r'^#include "(\w+/.*\.hpp)"', text, re.M) if not {"detail", "distributed"} & set(name.split("/"))}


def cpp(made):
    """Every public header by its first sentence; those that the lessons include, and what these include, in full, a page for each library."""
    lessons = set().union(*(included(lesson) for lesson in (ROOT / "apps/examples").glob("*.cpp")))
    described = sorted(lessons.union(*map(included, lessons)))
    subprocess.run(["doxygen", "-"], input=f"{DOXYGEN}\nOUTPUT_DIRECTORY = {made / 'doxygen'}\nINPUT = {' '.join(described)}", cwd=ROOT, check=True, text=True)
    for file in (made / "doxygen/xml").glob("*.xml"):  # what is private is nobody's business
        text = re.sub(r'<sectiondef kind="private.*?</sectiondef>', "", file.read_text(encoding="utf-8"), flags=re.DOTALL)
        file.write_text(text, encoding="utf-8")
    (made / "cpp").mkdir()
    holds = dict(re.findall(r"^\| `([a-z0-9_/]+)` \| (.*?) \| .* \|$", (ROOT / "docs/architecture.md").read_text(encoding="utf-8"), re.M))
    page = ("# The C++ libraries\n\n[How to use them](cookbook/libraries.md). In full, what programs start from: "
            + ", ".join(f"[{library}](cpp/{library}.md)" for library in LIBRARIES) + ". Every public header:\n")
    for library in LIBRARIES:
        headers = [header.relative_to(ROOT) for header in sorted((ROOT / library).rglob("*.hpp")) if not {"detail", "distributed"} & set(header.parts)]
        for folder in sorted({header.parent for header in headers}):
            page += f"\n## {folder}\n\n{links_within(holds[str(folder)], ROOT / 'docs')}\n\n"
            for header in (header for header in headers if header.parent == folder):
                opening = re.match(r"#pragma once\n((?://.*\n)+)", (ROOT / header).read_text(encoding="utf-8"))[1].replace("\n//", "").removeprefix("// ")
                page += f"- `{header.name}`: {re.split(r'[.:]?(?:(?<=[.]) |  |$)', opening.strip())[0]}\n"
        own = [header for header in described if header.startswith(f"{library}/")]
        spaces = sorted({space for header in own for space in re.findall(r"^namespace (drumlin\S*) {", (ROOT / header).read_text(encoding="utf-8"), re.M)})
        (made / f"cpp/{library}.md").write_text(f"# drumlin/{library}\n\nNamespaces: {', '.join(spaces)}.\n" + "".join(
            f"\n## {header}\n\n```{{eval-rst}}\n.. doxygenfile:: {header}\n```\n" for header in own), encoding="utf-8")
    return page + toctree(f"cpp/{library}" for library in LIBRARIES)


def toctree(pages):
    return "\n```{toctree}\n:hidden:\n" + "\n".join(f"/{page}" for page in pages) + "\n```\n"


def links_within(text, here):
    """Links of a file of the tree that is read in the folder `here`, as the site has them: to a page, or the name of a file that is none."""
    def plain(link):
        words, (target, _, heading) = link[1], link[2].partition("#")
        if "://" in target or not target:
            return link[0]
        file = pathlib.Path(os.path.normpath(here / target))
        name = str(file.relative_to(ROOT)) if file.is_relative_to(ROOT) else target
        page = PAGE_OF.get(f"{name}#{heading}", PAGE_OF.get(name))
        if page:
            return f"{{doc}}`{words} </{page}>`"
        inside = file.is_relative_to(ROOT / "docs") and file.suffix in (".md", ".png", *([".ipynb"] if NOTEBOOKS else []))
        return link[0] if inside else f"`{name}`" if words == name else f"{words} (`{name}`)"

    return re.sub(r"(?<!!)\[([^\]\n]+)\]\(([^)\s]+)\)", plain, text)


def of_root(name, *headings):
    """A file beside docs, or sections of it, as a page in docs has them; what is above the first heading has the name ""."""
    text = (ROOT / name).read_text(encoding="utf-8")
    if headings:
        sections = dict(re.findall(r"(?:^|\n)(?:## (.*)\n)?((?:(?!\n## )[\s\S])+)", text))
        text = "\n".join((f"## {heading}\n" if heading else "") + sections[heading] + "\n" for heading in headings)
    return links_within(text, ROOT).replace("](docs/", "](")


def with_keys(text):
    """Below "Printed by `COMMAND`" what it prints."""
    def printed(line):
        program, *words = line[1].split()
        return line[0] + "\n\n" + subprocess.run([BUILD / program, *words], check=True, capture_output=True, text=True).stdout

    return re.sub("^Printed by `([^`]+)`.*$", printed, text, flags=re.MULTILINE)


def read(_, page, text):
    if page == "index":
        text[0] = of_root("README.md", "") + links_within(text[0], ROOT / "docs")
    elif page == "install":
        text[0] = "# Install\n\n" + of_root("README.md", "Install", "First result").removeprefix("## Install\n") + "\n" + links_within(text[0].split("\n\n", 2)[2], ROOT / "docs")
    elif page == "browser" and "DRUMLIN_BROWSER" in os.environ:  # the page itself in place of its picture
        text[0] = links_within(re.sub(r"!\[.*", '```{raw} html\n<iframe src="_static/browser/index.html" title="A drum" style="width:100%; height:820px; border:0"></iframe>\n```', text[0]),
                               ROOT / "docs")
    elif (pathlib.Path(ROOT / "docs" / page).with_suffix(".md")).exists():
        text[0] = with_keys(links_within(text[0], (ROOT / "docs" / page).parent))
    if page == "gallery/README":  # what is indented has no language
        text[0] = re.sub(r"(?:^    .+\n)+", lambda lines: f"```sh\n{textwrap.dedent(lines[0])}```\n", text[0], flags=re.MULTILINE)
    if BELOW.get(page):
        text[0] += toctree(BELOW[page])


def setup(app):
    made = pathlib.Path(app.srcdir)
    app.config.breathe_projects = {"drumlin": str(made / "doxygen/xml")}
    pages = {"commands": commands(), "python": python(), "cpp": cpp(made), "results": of_root("README.md", "Results").replace("## ", "# ", 1),
             "contributing": of_root("CONTRIBUTING.md"), "changes": of_root("CHANGELOG.md")}
    for name, text in pages.items():
        (made / f"{name}.md").write_text(text, encoding="utf-8")
    for name in ("domains.cpp", "util.cfamily"):  # they warn of C++20 that they do not parse, and show it as it is; and of equal names of two namespaces
        logging.getLogger(f"sphinx.sphinx.{name}").addFilter(lambda record: False)
    app.connect("source-read", read)
