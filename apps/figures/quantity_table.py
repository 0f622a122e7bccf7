"""What quantities are called: the table docs/formats/quantities.md, which the program holds too."""

import html
import pathlib
import re
import typing

HERE = pathlib.Path(__file__).resolve().parent
# Installed, it lies beside this file.
PAGE = next(page for page in (HERE / "quantities.md", HERE.parents[1] / "docs/formats/quantities.md") if page.exists())


class Quantity(typing.NamedTuple):
    label: str  # with mathematics between $
    unit: str = "1"
    compared: str = ""
    meaning: str = ""

    def symbol(self):
        """The label without what it is equal to."""
        return re.sub(r"^\$(.+?) = .*\$$", r"$\1$", self.label)

    def axis_label(self):
        unit = self.unit
        if not unit.isalpha() or unit == "d":
            unit = "$" + re.sub(r"sqrt\((.*?)\)", r"\\sqrt{\1}", unit).replace("rho0", r"\rho_0") + "$"
        return self.label + (f"  [{unit}]" if self.unit != "1" else "")

    def in_html(self):
        """The symbol, and its unit where that is a word."""
        return re.sub(r"\$(.*?)\$", _math_in_html, html.escape(self.symbol())) + (f" ({self.unit})" if self.unit.isalpha() else "")


def _math_in_html(found):
    text = re.sub(r"\\dot\\([a-zA-Z]+)", r"&\1;&#775;", found[1].replace(r"\log", "log").replace(r"\partial", r"\part"))
    text = html.unescape(re.sub(r"\\([a-zA-Z]+)", r"&\1;", text))
    return re.sub(r"_(?:\{(.*?)\}|(\w))", r"<sub>\1\2</sub>", text)


def _rows(part):
    cells = ([cell.strip() for cell in line[1:-1].split("|")] for line in part.splitlines() if re.match(r"\| (?!name )", line))
    return {name: Quantity(label or name, *rest) for name, label, *rest in cells}


FIELDS, SCALARS = map(_rows, PAGE.read_text(encoding="utf-8").split("\n## Scalars\n"))


def field(name):
    """Of a name that is made of another one too, as log10_I; labelled by its name where nothing better is known."""
    if name in FIELDS:
        return FIELDS[name]
    for made, outer in FIELDS.items():
        found = re.fullmatch(made.replace("NAME", "(.+)"), name)
        if found and found.groups():
            inner = field(found[1])
            return inner._replace(label=outer.label.replace("NAME", inner.symbol()), unit=outer.unit or inner.unit)
    return Quantity(name)


def axis_label(name):
    return field(name).axis_label()
