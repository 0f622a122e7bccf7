"""A particle scene, with all its defaults, as a flow scene of a region: its walls, what moves and opens from when on, and the material at rest at the
time that the flow begins. What has no counterpart in a continuum is refused by its key."""

import dataclasses
import math

import numpy as np

from ..study.runs import refused
from . import fill

# From here on grains of one scene segregate, which no continuum here knows.
SIZE_RATIO = 2.0
# Friction of a wall along which nothing slides: material of mu below 0.67, beyond all laws of dense flow here, bears mu/sqrt(1 - mu^2) at most.
HOLDS = 0.9
MOTIONS = {"force": "is moved by a force", "pressure": "is moved by a pressure", "strain_rate": "is moved at a rate of strain", "oscillation": "shakes",
           "rocking": "rocks", "belt": "runs along itself"}


@dataclasses.dataclass
class Grains:
    """What a run knows of its grains when the flow begins; mm. area: of the discs; surface: (x, z) or None; center: of mass; reach: ((x0, x1), (z0, z1))
    from then on."""

    area: float
    center: tuple
    surface: tuple | None = None
    reach: tuple | None = None


class Reader:
    """Collects what is refused; each message names the key of the scene."""

    def __init__(self, scene, file):
        self.scene, self.file, self.problems = scene, str(file), []

    def refuse(self, key, what, allowed="absent"):
        self.problems.append((self.file, key, what, allowed))

    def stop(self):
        if self.problems:
            raise refused(self.problems)


def refuse_without_counterpart(read):
    scene = read.scene
    for i, outlet in enumerate(scene.get("outlets", [])):
        if "returns_to" in outlet:
            read.refuse(f"outlets.{i}.returns_to", "returns grains, and a continuum has none to return")
    if scene.get("sources"):
        read.refuse("sources", "pours grains: the continuum has no inflow")
    for name, why in {"cohesion": "holds grains together: no law of the continuum's region does", "drag": "is a force of a fluid",
                      "rotating_frame": "turns the observer"}.items():
        if name in scene["effects"]:
            read.refuse(f"effects.{name}", why)
    if "periodic_z" in scene:
        read.refuse("periodic_z", "is a cell without walls and weight, homogeneous: its law is all that a continuum says of it")
    grains = scene["grains"]
    if len(grains.get("materials", [])) > 1:
        read.refuse("grains.materials", "are several: the continuum is of one material", "one")
    if grains.get("groups"):
        read.refuse("grains.groups", "are grains of several kinds: the continuum is of one")


def diameters(read, sizes=None):
    """(smallest, largest) in mm, those that a run or a list has in place of the scene's."""
    source = read.scene["grains"].get("generated")
    smallest, largest = sizes or (source and (source["diameter_min_mm"], source["diameter_max_mm"])) or (None, None)
    if smallest is None:
        read.refuse("grains", "are listed: their sizes are known from a run alone", "generated, or a run of the scene")
    elif largest >= SIZE_RATIO * smallest:
        read.refuse("grains", f"have diameters from {smallest:g} to {largest:g} mm: they segregate, a continuum of one size does not",
                    f"largest below {SIZE_RATIO:g} times the smallest")
    return smallest, largest


def area_of_generated(read, sizes):
    grains = read.scene["grains"]["generated"]
    small, large = sizes
    shares = grains.get("sizes")
    if shares is None:
        square = (small**2 + small * large + large**2) / 3  # of diameters that are uniform
    elif shares["kind"] == "two" and shares.get("by", "number") == "number":
        square = shares["small_share"] * small**2 + (1 - shares["small_share"]) * large**2
    else:
        read.refuse("grains.generated.sizes", "has an area that is known from a run alone", "uniform, two, or a run of the scene")
        return math.nan
    return grains["count"] * math.pi / 4 * square


def stage_ends(scene, ends=None):
    """End of each stage, s; `ends`: as a run that ended some early has met them."""
    if ends:
        return ends
    found, now = [], 0.0
    for stage in scene["stages"]:
        speeds = [abs(motion["speed_rpm"]) for motion in stage.get("motions", []) if motion["kind"] == "rotation"]
        now += stage["duration_s"] if "duration_s" in stage else stage["turns"] * 60 / speeds[0]
        found.append(now)
    return found


def release(read):
    """The stage whose start is time 0: the first that opens or moves a wall or changes gravity; the grains have come to rest in those before."""
    stages = read.scene["stages"]
    first = next((k for k, stage in enumerate(stages) if stage.get("motions") or stage.get("opens") or "gravity" in stage), None)
    if first is None:
        read.refuse("stages", "move and open no wall and leave gravity as it is: nothing makes the grains flow", "a stage that does")
    elif first == 0:
        read.refuse("stages.0", "moves before the grains have come to rest: a flow begins with material at rest", "a stage without motions before it")
    return first or 0


def gravity_at(read, first):
    gravity = dict(read.scene["effects"].get("gravity") or {})
    if not gravity:
        read.refuse("effects.gravity", "is missing: without weight there is no free surface at rest", "present")
        gravity = {"acceleration_m_s2": 9.81, "direction_deg": -90.0}
    for k, stage in enumerate(read.scene["stages"]):
        if "gravity" not in stage:
            continue
        if k > first or stage["gravity"].get("ramp"):
            read.refuse(f"stages.{k}.gravity", "changes while the material flows, which the continuum does not know", "at the beginning of the flow, at once")
        gravity |= {key: value for key, value in stage["gravity"].items() if key != "ramp"}
    return gravity


def shapes_of(read, i, wall):
    """[(from, to)] of a straight wall or a polyline; the chords of an arc."""
    points = None
    if wall["shape"] == "segment":
        points = [wall["from_mm"], wall["to_mm"]]
    elif wall["shape"] == "polyline":
        points = list(zip(wall["x_mm"], wall["z_mm"]))
        points += points[:1] if wall.get("closed") else []
    elif wall["shape"] == "arc":
        angles = np.radians(np.linspace(wall["from_deg"], wall["to_deg"], 2 + int((wall["to_deg"] - wall["from_deg"]) / 5)))
        points = np.array(wall["center_mm"]) + wall["radius_mm"] * np.column_stack([np.cos(angles), np.sin(angles)])
    elif wall["shape"] == "disc":
        read.refuse(f"walls.{i}.shape", "is a body inside of the material, which a region has not", "segment, polyline, arc, container")
    return [] if points is None else [(np.array(a, float), np.array(b, float)) for a, b in zip(points, points[1:])]


def condition_of(scene, wall):
    """Rough with glued discs and where material slides on itself before it slides on the wall, smooth without friction, else the coefficient of grain
    against wall; discs that roll along a wall mobilise less."""
    if "rough" in wall:
        return {"condition": "rough"}
    friction = scene["effects"].get("friction", {"grain_wall": 0.0})
    value, grain = friction["grain_wall"], [material["name"] for material in scene["grains"].get("materials", [])]
    for pair in friction.get("pairs", []):
        if sorted(pair["between"]) == sorted([*grain, wall.get("material", "")]):
            value = pair["value"]
    if value == 0:
        return {"condition": "smooth"}
    return {"condition": "friction", "friction": value} if value < HOLDS else {"condition": "rough"}


def moves_of(read, first, starts, fastest):
    """{wall: keys of the flow scene} of walls that move or go. A wall that leaves faster than material follows, `fastest`, is gone at once."""
    scene, found = read.scene, {}
    for k in range(first, len(scene["stages"])):
        stage, begins = scene["stages"][k], {"begins_s": starts[k] - starts[first]}
        asked = {name: {"ends_s": begins["begins_s"]} for name in stage.get("opens", [])}
        for m, motion in enumerate(stage.get("motions", [])):
            name, key = motion["wall"], f"stages.{k}.motions.{m}"
            if motion["kind"] in MOTIONS:
                read.refuse(f"{key}.kind", f"is {motion['kind']}: the wall {name} {MOTIONS[motion['kind']]}", "translation, rotation")
            elif name in asked:
                read.refuse(key, f"moves the wall {name}, which moves or opens already", "one motion of a wall")
            elif motion["kind"] == "rotation":
                asked[name] = {"rotation_rpm": motion["speed_rpm"], "center_mm": motion["center_mm"]}
            elif math.hypot(*motion["velocity_mm_s"]) > fastest:
                asked[name] = {"ends_s": begins["begins_s"]}
            else:
                asked[name] = {"velocity_mm_s": motion["velocity_mm_s"]}
        for name in {*found, *asked}:
            before, now = found.get(name, {}), asked.get(name, {})
            if "ends_s" in before or before.get("motion") == now:
                continue
            if before and "ends_s" not in now:
                read.refuse(f"stages.{k}.motions", f"change the motion of the wall {name}: a wall of the continuum has one", "as in the stage before")
            found[name] = before | now if "ends_s" in now else {"motion": now} | now | begins
    return {name: {key: value for key, value in keys.items() if key != "motion"} for name, keys in found.items()}


def circle_of(read, i, wall, moves):
    radius = wall["radius_mm"] - 0.5 * wall.get("rough", {}).get("diameter_mm", 0.0)
    keys = {"center_mm": wall["center_mm"], "radius_mm": radius} | moves
    if "velocity_mm_s" in moves or "ends_s" in moves:
        read.refuse(f"walls.{i}", "is a circle that moves or goes", "a circle that rests or turns about its centre")
    elif moves.get("center_mm", wall["center_mm"]) != wall["center_mm"]:
        read.refuse(f"walls.{i}", "turns about another point than its centre", "a circle that turns about its centre")
    return keys


def toward_material(wall, line, seed):
    """A line with glued discs, moved by half a disc towards the material."""
    begin, end = line
    if "rough" not in wall:
        return line
    along = (end - begin) / np.hypot(*(end - begin))
    normal = np.array([-along[1], along[0]])
    shift = 0.5 * wall["rough"]["diameter_mm"] * (normal if normal @ (np.array(seed) - begin) > 0 else -normal)
    return begin + shift, end + shift


def walls_of(read, seed, moves):
    """Walls as the flow scene has them, and what holds the material at time 0."""
    found, before, circle = [], [], None
    for i, wall in enumerate(read.scene.get("walls", [])):
        own, head = moves.get(wall["name"], {}), {"name": wall["name"]}
        if "acts_on" in wall:
            read.refuse(f"walls.{i}.acts_on", "lets some grains pass")
        if wall["shape"] == "container":
            keys = circle_of(read, i, wall, own)
            circle = (*keys["center_mm"], keys["radius_mm"])
            found.append(head | {"shape": "circle"} | keys | condition_of(read.scene, wall))
        for line in shapes_of(read, i, wall):
            if "rotation_rpm" in own:
                read.refuse(f"walls.{i}", "turns and is no circle", "a container that turns about its centre")
            before.append((line, wall, head | {"shape": "segment"} | own | condition_of(read.scene, wall)))
    lines = [fill.Line(*toward_material(wall, line, seed), keys.get("ends_s") != 0) for line, wall, keys in before]
    ends = [(i, name, point) for i, (line, *_) in enumerate(before) for name, point in zip(("begin", "end"), line)]
    fill.joined(lines, {(i, a): (j, b) for i, a, p in ends for j, b, q in ends if i < j and np.allclose(p, q)})
    found += [keys | {"from_mm": [float(x) for x in line.begin], "to_mm": [float(x) for x in line.end]}
              for line, (*_, keys) in zip(lines, before) if line.stays]
    return found, fill.Walls(lines, seed, circle)


def seed_of(read, grains):
    if grains:
        return grains.center
    region = read.scene["grains"]["generated"]["region"]
    if region["shape"] == "circle":
        return tuple(region["center_mm"])
    return tuple(0.5 * (low + high) for low, high in zip(region["min_mm"], region["max_mm"]))


def flow_scene(scene, nu, file="scene", grains=None, sizes=None, ends=None, frames_s=()):
    """(flow scene, origin): the keys of a flow scene of a region, and the time of the particle scene at which it begins, s. nu: of the law. grains, sizes,
    ends: of a run of the scene; without these the material stands under a level surface, with the area of the grains. InputError with every key that has
    no counterpart."""
    read = Reader(scene, file)
    refuse_without_counterpart(read)
    first, known = release(read), diameters(read, sizes)
    gravity = gravity_at(read, first)
    times = [0.0, *stage_ends(scene, ends)]
    read.stop()
    area = (grains.area if grains else area_of_generated(read, known)) / nu
    seed, g = seed_of(read, grains), 1e3 * gravity["acceleration_m_s2"]
    moves = moves_of(read, first, times, math.sqrt(g * math.sqrt(area)))
    walls, holding = walls_of(read, seed, moves)
    read.stop()
    d = 0.5 * sum(known)
    bottom, top = fill.surface_fill(holding, *grains.surface, 2 * d) if grains and grains.surface else fill.level_fill(holding, area)
    openings = fill.holes(holding, bottom)
    bottom = over_openings(bottom, openings)
    if scene.get("outlets") and not openings:
        read.refuse("outlets.0", "takes grains away where no hole between walls lets the material through", "below a hole")
    read.stop()
    if openings:  # all leaves through them
        lowest = bottom[:, 1].min()
        walls = [wall for wall in walls if "radius_mm" in wall or 0.5 * (wall["from_mm"][1] + wall["to_mm"][1]) > lowest - 1e-6]
    return _tables(scene, known, gravity, walls, openings, fill.closed_outline(bottom, top), (times[-1] - times[first], frames_s),
                   grains.reach if grains else None), times[first]


def over_openings(bottom, openings):
    for begin, end in openings:
        outside = (bottom[:, 0] < begin[0] - 1e-6) | (bottom[:, 0] > end[0] + 1e-6)
        bottom = np.array(sorted([*map(tuple, bottom[outside]), tuple(begin), tuple(end)]))
    return bottom


def grid_reach(walls, openings, outline, reach, d):
    """((x0, x1), (z0, z1)) of the frames: what a run reaches, or four heights to either side, within walls, and no farther below than openings."""
    (left, low), (right, high) = outline.min(axis=0), outline.max(axis=0)
    far = 4 * (high - low)
    reach = reach or ((left - far, right + far), (low, high))
    ends = np.array([[left, low], [right, high], *(wall[key] for wall in walls if "from_mm" in wall for key in ("from_mm", "to_mm"))])
    return ((max(reach[0][0], ends[:, 0].min()) - d, min(reach[0][1], ends[:, 0].max()) + d),
            (max(reach[1][0], low if openings else -math.inf) - d, reach[1][1] + d))


def _tables(scene, sizes, gravity, walls, openings, outline, time, reach):
    d, (end, frames) = 0.5 * sum(sizes), time
    unit = math.sqrt(1e-3 * d / gravity["acceleration_m_s2"])
    reach = grid_reach(walls, openings, np.array(outline), reach, d)
    x_mm, z_mm = ([d * math.floor(low / d), d * math.ceil(high / d)] for low, high in reach)
    frames = {"frames_s": list(map(float, frames))} if len(frames) else {"frames_every_s": end / 20}
    return {"format": "drumlin-flow-scene-1", "title": scene["title"], "reduced": scene.get("reduced", False), "region": {"fill_mm": outline},
            "grains": {"diameter_min_mm": sizes[0], "diameter_max_mm": sizes[1], "density_kg_m3": scene["grains"]["density_kg_m3"]},
            "gravity": {key: float(gravity[key]) for key in ("acceleration_m_s2", "direction_deg")}, "walls": walls,
            "openings": [{"name": f"opening-{k + 1}" if k else "opening", "from_mm": [float(x) for x in a], "to_mm": [float(x) for x in b]}
                         for k, (a, b) in enumerate(openings)],
            "time": {"end_s": float(frames["frames_s"][-1] if "frames_s" in frames else end), "step_s": 0.2 * unit} | frames,
            "output": {"x_mm": x_mm, "z_mm": z_mm}}
