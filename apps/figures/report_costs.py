"""What accuracy and effects cost, for the report of `drumlin compare`: one picture per record of data/cost.

usage: report_costs.py FOLDER_OF_RECORDS OUTPUT

Writes OUTPUT/cost_accuracy_NAME.png or OUTPUT/cost_effects_NAME.png for every NAME.json of a format that is drawn; other files are records of something
else and are passed over.
"""

import functools
import pathlib
import sys

import price_figures
import script
import style
import work_precision

KINDS = {"drumlin-cost-1": ("accuracy", work_precision.draw)} | {name: ("effects", draw) for name, draw in price_figures.FIGURES.items()}


def save(record, draw, picture):
    style.save(draw(record), picture, record.get("reduced", False))


def main():
    records, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    style.use_style()
    drawings = {}
    for file in sorted(records.glob("*.json")):
        record = script.content_of(file)
        if record.get("format") in KINDS:
            kind, draw = KINDS[record["format"]]
            drawings[file.name] = functools.partial(save, record, draw, output / f"cost_{kind}_{file.stem}.png")
    script.draw_each(drawings)


if __name__ == "__main__":
    main()
