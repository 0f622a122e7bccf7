"""The player: one HTML file in which a run plays, with everything in it (docs/cookbook/looking-at-a-run.md)."""

import base64
import pathlib

import matplotlib.cm
import matplotlib.colors
import numpy as np

import grain_colours
import grain_maps
import overlaps
import player_pack
import whole_file

TEMPLATES = pathlib.Path(__file__).resolve().parent.parent / "pages"
COLOURS = 64  # of a scale


class Field:
    """What the colour of a grain may show: its words and unit, and from which numbers of the file it is made."""

    def __init__(self, words, unit, si_unit, si, source):
        self.words, self.unit, self.si_unit, self.si, self.source = words, unit, si_unit, si, source


def have_spin(frames):
    """An empty frame does not say; all of them together do, unless there never was a grain."""
    return all(grains.spin is not None for grains in frames) and any(len(grains.spin) for grains in frames)


def known_fields(frames, scales):
    """By name, those that the frames hold. `si` is what one unit is in the SI unit beside it."""
    length, time = scales["length_m"], scales["time_s"]
    in_drum = any(grains.drum_spin != 0 for grains in frames)
    fields = {"speed": Field("speed in the frame of the drum" if in_drum else "speed", "√(gd)", "m/s", length / time, "speed")}
    if have_spin(frames):
        fields["spin"] = Field("spin, positive clockwise", "√(g/d)", "rad/s", 1 / time, "spin")
    fields["size"] = Field("diameter", "d", "mm", 1e3 * length, "radius")
    if any(len(grains.force) for grains in frames):
        fields["pressure"] = Field("pressure of the contacts", "ρ₀gd", "Pa", scales["density_kg_m3"] * length**2 / time**2, "contacts")
        fields["coordination"] = Field("loaded contacts", "", "", 1, "contacts")
    if frames[0].material is not None:
        fields["material"] = Field("material", "", "", 1, "material")
    fields["id"] = Field("number of the grain", "", "", 1, "id")
    return fields


def described(name, field, frames, drawing):
    """Field and scale as the page wants them: the scale is that of the pictures of `drumlin plot --color`."""
    colour = grain_colours.Colour(name, frames, drawing)
    steps = isinstance(colour.norm, matplotlib.colors.BoundaryNorm)
    low, high = (-0.5, len(colour.ticks) - 0.5) if steps else (float(colour.norm.vmin), float(colour.norm.vmax))
    cmap = matplotlib.cm.get_cmap(colour.cmap)
    count = len(colour.ticks) if steps else COLOURS
    return {"name": name, "words": field.words, "unit": field.unit, "si_unit": field.si_unit, "si": field.si, "source": field.source,
            "low": low, "high": high, "scale": "steps" if steps else "log" if isinstance(colour.norm, matplotlib.colors.LogNorm) else "linear",
            "names": colour.names, "colours": [matplotlib.colors.to_hex(cmap(k / max(count - 1, 1)) if not steps else cmap(k)) for k in range(count)]}


def content_of(drawing, frames):
    """(everything that the page says in words and numbers, the zlib stream)"""
    head, stream, grounds = player_pack.packed(frames, have_spin(frames))
    view = grain_maps.View(frames, drawing["window"])
    scales = drawing["run"]["scales"]
    fields = [described(name, field, frames, drawing) for name, field in known_fields(frames, scales).items()]
    content = {"format": "drumlin-player-2", "title": drawing["title"], "reduced": drawing["reduced"], "status": drawing["status"],
               "revision": drawing["run"].get("revision", ""), "scales": scales, "period": drawing["period"],
               "view": [float(v) for v in (view.low[0], view.high[0], view.low[1], view.high[1])],
               "field": drawing["color"] or "speed", "fields": fields, "signal": overlaps.SIGNAL,
               "number": [grains.frame["number"] for grains in frames], "time_s": [grains.frame["time_s"] for grains in frames],
               "overlaps": [[[round(float(depth), 5), int(places[i]), int(places[j]) if j >= 0 else -1] for i, j, depth in zip(*grains.overlaps)]
                            for grains, places in zip(frames, grounds.places)]} | head
    if frames[0].material is not None:
        material = np.zeros(len(grounds.ids), dtype=int)
        for grains, places in zip(frames, grounds.places):
            material[places] = grains.material
        content["material"] = material.tolist()
    return content, stream


def grains_of(drawing):
    """The frames, without what the player does not need of them."""
    for frame in drawing["player"]["frames"]:
        if drawing["player"]["materials"]:
            frame["materials"] = drawing["player"]["materials"]
        yield grain_maps.Grains(frame, drawing["period"])


def draw(drawing, folder):
    """Writes player.html. Returns {file: what it shows}."""
    import jinja2  # only here: the other figures need none
    frames = list(grains_of(drawing))
    content, stream = content_of(drawing | {"materials": drawing["player"]["material_names"]}, frames)
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)
    text = environment.get_template("player.html").render(content=content, data=base64.b64encode(stream).decode("ascii"))
    whole_file.write_text(folder / "player.html", text)
    size, most = (folder / "player.html").stat().st_size, max((len(grains.x) for grains in frames), default=0)
    grains = f"{most} grains" if content["count"] == most else f"at most {most} grains, {content['count']} in turn,"
    return {"player.html": f"{len(frames)} snapshots of {grains} to play in a browser, {size / 1e6:.2f} MB"}
