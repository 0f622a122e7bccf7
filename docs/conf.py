"""The manual as a site: docs/build writes it. README.md is its first page; commands and the Python package tell of themselves, notebooks are executed
where DRUMLIN_NOTEBOOKS is set."""

import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("DRUMLIN_BUILD", ROOT / "build"))
sys.path.insert(0, str(BUILD / "python"))

project = "Drumlin"
version = release = re.search(r"project\(drumlin VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
copyright = "the founders of Drumlin"  # pylint: disable=redefined-builtin
NOTEBOOKS = "DRUMLIN_NOTEBOOKS" in os.environ
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax", *(["nbsphinx"] if NOTEBOOKS else [])]
myst_enable_extensions = ["dollarmath", "amsmath"]
nbsphinx_execute, nbsphinx_timeout = "always", 1800
myst_heading_anchors = 4
myst_update_mathjax = False
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"  # Debian's MathJax 2, beside the pages: docs/build copies it
autodoc_member_order = "bysource"
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_title = f"Drumlin {version}"
exclude_patterns = ["figures", "cookbook/*.py", *([] if NOTEBOOKS else ["notebooks"])]
suppress_warnings = ["myst.header"]


def commands():
    """A page from the help of every command."""
    program = BUILD / "drumlin"

    def help_of(*words):
        return subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout.split("\nNew here:")[0].rstrip()

    names = re.findall(r"^  ([a-z-]+)  ", help_of().split("Subcommands:")[1], re.M)
    return "# Commands\n\n" + "\n\n".join(f"## drumlin {name}\n\n```text\n{help_of(name)}\n```" for name in names) + "\n"


def python():
    return "# The Python package\n\n[Notebooks](cookbook/python.md)\n\n```{eval-rst}\n.. automodule:: drumlin\n   :members:\n   :imported-members:\n```\n"


def links_within(text, here):
    """A link to a file of the tree that is no page becomes its name: the site is read without the tree."""
    def plain(link):
        words, target = link[1], link[2].split("#")[0]
        if "://" in target or not target:
            return link[0]
        file = pathlib.Path(os.path.normpath(here / target))
        inside = file.is_relative_to(ROOT / "docs") and file.suffix in (".md", ".png", *([".ipynb"] if NOTEBOOKS else []))
        if file == ROOT / "README.md":
            return f"{{doc}}`{words} </index>`"
        return link[0] if inside else f"{words} (`{file.relative_to(ROOT) if file.is_relative_to(ROOT) else target}`)"

    return re.sub(r"(?<!!)\[([^\]\n]+)\]\(([^)\s]+)\)", plain, text)


def with_keys(text):
    """Below "Printed by `COMMAND`" what it prints."""
    def printed(line):
        program, *words = line[1].split()
        return line[0] + "\n\n" + subprocess.run([BUILD / program, *words], check=True, capture_output=True, text=True).stdout

    return re.sub("^Printed by `([^`]+)`.*$", printed, text, flags=re.MULTILINE)


def read(_, page, text):
    if page == "index":
        readme = links_within((ROOT / "README.md").read_text(encoding="utf-8"), ROOT)
        own = text[0] if NOTEBOOKS else re.sub(r"^notebooks/.*\n", "", text[0], flags=re.MULTILINE)
        text[0] = readme.replace("](docs/", "](") + "\n" + own
    elif not page.startswith("notebooks/"):
        text[0] = with_keys(links_within(text[0], (ROOT / "docs" / page).parent))
    if page == "formats/README":
        text[0] += "\n```{toctree}\n:hidden:\n:glob:\n[!R]*\n```\n"


def setup(app):
    made = pathlib.Path(app.srcdir)
    for name, page in (("commands", commands), ("python", python)):
        (made / f"{name}.md").write_text(page(), encoding="utf-8")
    app.connect("source-read", read)
