"""What the scripts of figures share as programs: the JSON file of a command, and drawing one figure after the other."""

import functools
import json
import pathlib
import sys
import traceback

import matplotlib.pyplot as plt

import result_files
import style
import whole_file


def content_of(path):
    return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))


def measured_folder():
    """(folder, content of measured.json), from the one word of a script that draws a measured run: RUN/measured, which takes the figures."""
    folder = pathlib.Path(sys.argv[1])
    return folder, content_of(folder / "measured.json")


def save_each(drawings, folder, reduced):
    """draw_each of {name: function that gives a figure, or None where there is nothing to draw}: NAME.png in the folder."""
    def save(name, draw):
        figure = draw()
        if figure is not None:
            style.save(figure, folder / f"{name}.png", reduced)

    draw_each({name: functools.partial(save, name, draw) for name, draw in drawings.items()})


def draw_each(drawings):
    """Calls each function of {name of a figure: function}. A figure that fails does not keep the others from being drawn; the
    program then ends with the names of all that failed, and why. A file that does not fit or cannot be written ends it at once."""
    failed = []
    for name, draw in drawings.items():
        try:
            draw()
        except (whole_file.CannotWrite, result_files.DoesNotFit):
            raise
        except (Exception, SystemExit) as error:  # pylint: disable=broad-except
            place = traceback.extract_tb(error.__traceback__)[-1]
            failed.append(f"{name}: {type(error).__name__}: {error} ({pathlib.Path(place.filename).name}, line {place.lineno})")
            plt.close("all")
    if failed:
        sys.exit("\n".join(failed))
