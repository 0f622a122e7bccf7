"""The flow scene of grains that are periodic in x: steady layers between two walls without gravity (plane_shear), on one wall down a slope (incline), between
two upright ones (chute). The height is the area of the discs over nu and the period, as the fill of a drum crosses to its continuum: a wall of glued discs,
which grains enter, then counts for what it holds. Pressure and speed of a wall are those that the last stage asks for."""

from . import scene as scenes


def driven_wall(read, period_mm):
    """(speed in mm/s, pressure in Pa) of the wall that the last stage presses; nothing where it presses none."""
    speeds = {motion["velocity_mm_s"][0] for stage in read.scene["stages"] for motion in stage.get("motions", []) if "velocity_mm_s" in motion}
    if len(speeds - {0.0}) > 1:
        read.refuse("stages", "change the speed of a wall: a flow in layers is steady", "one speed")
    for motion in read.scene["stages"][-1].get("motions", []):
        speed = motion.get("velocity_mm_s", [0.0, 0.0])[0]
        if motion["kind"] == "pressure":
            return speed, motion["pressure_n_m2"]
        if motion["kind"] == "force":
            return speed, motion["force_n_m"] / (1e-3 * period_mm)
    return None


def geometry(read, height_mm, period_mm):
    pressed, gravity = driven_wall(read, period_mm), read.scene["effects"].get("gravity")
    last = f"stages.{len(read.scene['stages']) - 1}.motions"
    if gravity is None:
        if pressed is None or not pressed[0] > 0:
            read.refuse(last, "press no wall that is dragged towards +x: without weight nothing else shears a layer", "a force or a pressure, with velocity_mm_s")
            return {}
        return {"plane_shear": {"gap_mm": height_mm, "wall_speed_mm_s": pressed[0], "pressure_pa": pressed[1]}}
    slope = 90.0 + gravity["direction_deg"]
    if abs(slope - 90) < 1e-9 and pressed:
        return {"chute": {"half_width_mm": 0.5 * height_mm, "pressure_pa": pressed[1]}}
    if not 0 < slope < 89:
        read.refuse("effects.gravity.direction_deg", f"is {gravity['direction_deg']:g}: no layer that flows down a slope towards +x", "above -90 and below -1")
    moving = [motion for stage in read.scene["stages"] for motion in stage.get("motions", [])]
    if moving:
        read.refuse("stages", f"move the wall {moving[0]['wall']}: a layer on a slope has a base at rest", "no motions")
    return {"incline": {"height_mm": height_mm, "slope_deg": slope}}


def flow_scene(scene, nu, file="scene", grains=None, sizes=None):
    """The keys of a flow scene in layers; InputError with every key that has no counterpart. grains, sizes: of a run of the scene (scene.py)."""
    read = scenes.Reader(scene, file)
    scenes.refuse_without_counterpart(read)
    known = scenes.diameters(read, sizes)
    read.stop()
    area = grains.area if grains else scenes.area_of_generated(read, known)
    period = scene["periodic_x"]["x_max_mm"] - scene["periodic_x"]["x_min_mm"]
    shape = geometry(read, area / (nu * period), period)
    read.stop()
    # No strength at a free surface, and none between plates, beyond a hundredth of a grain's weight.
    return {"format": "drumlin-flow-scene-1", "title": scene["title"], "reduced": scene.get("reduced", False)} | shape | {
        "grains": {"diameter_min_mm": known[0], "diameter_max_mm": known[1], "density_kg_m3": scene["grains"]["density_kg_m3"]},
        "mesh": {"surface_cell": 0.5}, "regularisation": {"pressure": 0.01}}
