"""Figures of `drumlin plot`: one snapshot, the log, where the time went, and an animation, a series of stills or
a player if it is asked for."""

import json
import pathlib
import sys

import grain_maps
import player
import run_curves
import script
import style
import whole_file


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: plot_figures.py DRAWING.json")
    folder = pathlib.Path(sys.argv[1]).parent
    drawing = script.content_of(sys.argv[1])
    style.use_style()
    figures = {}
    if drawing["snapshot"] is not None:
        figures.update(grain_maps.draw_snapshot(drawing, folder))
    figures.update(run_curves.draw(drawing, folder))
    if drawing["frames"] and not drawing["animation"]:
        figures.update(grain_maps.draw_stills(drawing, folder))
    if drawing["frames"] and drawing["animation"]:
        figures.update(grain_maps.draw_animation(drawing, folder))
    if drawing["player"]:
        figures.update(player.draw(drawing, folder))
    snapshot = drawing["snapshot"] and drawing["snapshot"]["number"]
    whole_file.write_text(folder / "drawn.json", json.dumps(
        {"format": "drumlin-plots-1", "snapshot": snapshot, "reduced": drawing["reduced"], "status": drawing["status"], "figures": figures}))


if __name__ == "__main__":
    main()
