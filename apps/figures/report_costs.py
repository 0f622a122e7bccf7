"""What accuracy and effects cost, for the report of `drumlin compare`: one picture per record of data/cost.

usage: report_costs.py FOLDER_OF_RECORDS OUTPUT

Writes OUTPUT/cost_accuracy_NAME.png or OUTPUT/cost_effects_NAME.png for every NAME.json whose format has a script that draws it; other
files are records of something else and are passed over.
"""

import functools
import pathlib
import runpy
import shutil
import sys
import tempfile

import script

HERE = pathlib.Path(__file__).resolve().parent
PICTURE, FOLDER = "PICTURE", "FOLDER"
# format: kind of record, script, its words after the record
DRAWN = {
    "drumlin-cost-1": ("accuracy", "work_precision.py", [FOLDER]),
    "drumlin-effect-prices-1": ("effects", "effect_price_figures.py", [PICTURE]),
    "drumlin-flow-effect-prices-1": ("effects", "flow_price_figures.py", [PICTURE]),
    "drumlin-effect-errors-1": ("effects", "flow_effect_figures.py", [PICTURE]),
}


def draw(record, picture, name, words):
    """Runs the script as it is called by hand; one that draws into a folder leaves its first picture under its own name."""
    with tempfile.TemporaryDirectory() as folder:
        sys.argv = [str(HERE / name), str(record)] + [{PICTURE: str(picture), FOLDER: folder}.get(word, word) for word in words]
        runpy.run_path(sys.argv[0], run_name="__main__")
        drawn = pathlib.Path(folder) / (pathlib.Path(name).stem + ".png")
        if drawn.exists():
            shutil.move(drawn, picture)


def main():
    records, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    drawings = {}
    for record in sorted(records.glob("*.json")):
        known = DRAWN.get(script.content_of(record).get("format"))
        if known is not None:
            kind, name, words = known
            drawings[record.name] = functools.partial(draw, record, output / f"cost_{kind}_{record.stem}.png", name, words)
    script.draw_each(drawings)


if __name__ == "__main__":
    main()
