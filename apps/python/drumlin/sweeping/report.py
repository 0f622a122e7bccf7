"""The report of a sweep, renewed while it runs: sweep.json, a figure of numbers over settings, a page (docs/formats/sweep.md)."""

import json
import math
import time

from .. import _drumlin
from ..commands import draw
from ..errors import DrumlinError
from ..figures import whole_file
from ..study.fits import pooled_speeds

SHARE = 0.02  # of the time may go into reports
FIRST_S = 30  # no figure earlier, but at the end
MOST = 6  # quantities shown unless named
DRUM = ("theta_deg", "Q", "H", "shear_rate", "lambda", "nu_bulk")  # what says most of a drum


def _entry(one):
    known = math.isfinite(one.value)
    return {"value": float(one.value) if known else None} | ({"ci99": float(one.ci99)} if known and one.ci99 is not None and math.isfinite(one.ci99) else {})


class Report:
    """What has ended of a sweep so far. drawn: with figure and page."""

    def __init__(self, folder, title, reduced, settings, quantities=(), drawn=True):
        self.folder, self.quantities, self.drawn = folder, list(quantities), drawn
        self.content = {"format": "drumlin-sweep-1", "title": title, "reduced": reduced}
        self.rows = [{"name": f"{number:03}", "changes": dict(changes), "state": "waiting"} for number, changes in enumerate(settings)]
        self.numbers = [{} for _ in settings]
        self.begin = time.monotonic()
        self.renew("running")
        self.due = self.begin + FIRST_S

    def ended(self, number, outcome):
        """Takes what became of a run, its numbers as study.Scalars, and renews the report if it is time."""
        if outcome.error is None:
            self.numbers[number] = outcome.value
        self.rows[number] |= {"state": "failed", "error": str(outcome.error) or type(outcome.error).__name__} if outcome.error else {"state": "finished"}
        if self.drawn and time.monotonic() > self.due:
            self.renew("running")

    def renew(self, state):
        """Writes all of it; what could not be drawn, an empty text if nothing."""
        begin = time.monotonic()
        content = self.content | {"state": state, "seconds": begin - self.begin, "quantities": self._shown(), "runs": self._runs(), "groups": self._groups(),
                                  "provenance": _drumlin.provenance()}
        file = self.folder / "sweep.json"
        whole_file.write_text(file, json.dumps(content, indent=1, ensure_ascii=False, default=str) + "\n")
        failed = self._draw(file, state) if self.drawn else ""
        self.due = time.monotonic() + (time.monotonic() - begin) / SHARE
        return failed

    def _draw(self, file, state):
        try:
            if self._names() and state != "interrupted":  # who interrupts does not wait for a figure
                draw("figures/sweep_figures.py", file, self.folder)
            draw("pages/write_page.py", "sweep.html", file, self.folder)
        except DrumlinError as error:
            return str(error)
        return ""

    def _runs(self):
        return [row | {"numbers": {name: _entry(one) for name, one in numbers.items()}} for row, numbers in zip(self.rows, self.numbers)]

    def _groups(self):
        """Runs that differ in their seed alone, and the means of their numbers (docs/theory/statistics.md)."""
        groups = {}
        for row, numbers in zip(self.rows, self.numbers):
            own = {key: value for key, value in row["changes"].items() if key != "seed"}
            groups.setdefault(json.dumps(own, default=str), (own, []))[1].append(numbers)
        members = [of for _, of in groups.values()]
        pools = {name: pooled_speeds([[numbers[name] for numbers in of if name in numbers] for of in members]) for name in self._names()}
        return [{"changes": own, "runs": len(of), "numbers": {name: _entry(pools[name][k]) for name in pools}}
                for k, (own, of) in enumerate(groups.values())]

    def _names(self):
        return list(dict.fromkeys(name for numbers in self.numbers for name in numbers))

    def _shown(self):
        known = [name for name in self._names() if any(name in numbers and math.isfinite(numbers[name].value) for numbers in self.numbers)]
        if self.quantities:
            return [name for name in self.quantities if name in known]
        drum = [name for name in DRUM if name in known]
        return drum if len(drum) > 1 else known[:MOST]
