"""Writes a page of results: one HTML file with its figures inside, which loads nothing from elsewhere.

usage: write_page.py TEMPLATE CONTENT.json FOLDER [FAILURES.txt]

TEMPLATE is a file of apps/pages, CONTENT.json holds every number that the page shows, FOLDER the figures; the page becomes FOLDER/index.html.
FAILURES.txt says which figures could not be drawn and why; without it a figure that the page needs and FOLDER lacks is an error.
"""

import base64
import json
import pathlib
import sys

import jinja2

import formats
import whole_file
import words

TEMPLATES = pathlib.Path(__file__).resolve().parent


class Figures:
    """The PNG files of one folder, as a template asks for them."""

    def __init__(self, folder, some_failed):
        self.folder = folder
        self.some_failed = some_failed

    def has(self, name):
        return (self.folder / f"{name}.png").exists()

    def required(self, name):
        """As `has`; a figure that is missing although none failed is an error."""
        if not self.has(name) and not self.some_failed:
            raise FileNotFoundError(f"{self.folder / name}.png: is missing")
        return self.has(name)

    def named(self, prefix):
        return sorted(file.stem for file in self.folder.glob(f"{prefix}*.png"))

    def listed(self):
        """What figures.json says of each figure of a study; empty where the figures failed."""
        file = self.folder / "figures.json"
        if self.some_failed and not file.exists():
            return []
        content = json.loads(file.read_text(encoding="utf-8"))
        if content.get("format") != "drumlin-study-figures-1":
            raise ValueError(f"{file}: format: is missing or not known here (allowed: \"drumlin-study-figures-1\")")
        return [figure | {"name": figure["file"].removesuffix(".png")} for figure in content["figures"]]

    def motion(self):
        """What side_by_side.py left of a comparison; None where nothing moves, or the script failed."""
        file = self.folder / "motion.json"
        return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None

    def source(self, name):
        return "data:image/png;base64," + base64.b64encode((self.folder / f"{name}.png").read_bytes()).decode("ascii")


def environment(figures):
    """Every value is escaped, and a name that the content lacks is an error, not an empty cell."""
    result = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
                                trim_blocks=True, lstrip_blocks=True)
    result.filters.update(formats.FILTERS)
    result.globals.update(words=words, figures=figures)
    return result


def place_of(error):
    """", line 12 of comparison.html" where a template raised it."""
    trace, place = error.__traceback__, ""
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if file.endswith(".html"):
            place = f", line {trace.tb_lineno} of {pathlib.Path(file).name}"
        trace = trace.tb_next
    return place


def main():
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    template, source, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    try:
        failures = pathlib.Path(sys.argv[4]).read_text(encoding="utf-8") if len(sys.argv) == 5 else ""
        content = json.loads(source.read_text(encoding="utf-8"))
        figures = Figures(folder, bool(failures))
        text = environment(figures).get_template(template).render(content=content, failures=failures)
        whole_file.write_text(folder / "index.html", text)
    except whole_file.CannotWrite:
        raise
    except (jinja2.TemplateError, LookupError, OSError, TypeError, ValueError) as error:
        sys.exit(f"{source}: {type(error).__name__}: {error}{place_of(error)}")


if __name__ == "__main__":
    main()
