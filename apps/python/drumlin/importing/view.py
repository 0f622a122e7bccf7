"""The axes of a file seen as those of the description."""

VECTORS = ("", "v_", "normal_", "f_")


def in_axes_of_description(frame, source):
    """A frame whose columns are along the axes of its file, as the description sees it. Of spheres z is up in both. Of discs the second axis of the plane is
    up; the component of the angular velocity across it points at the onlooker where that is y and anticlockwise is positive, away from him where it is z."""
    if not frame.in_file_axes or source["dimensions"] == 3:
        return frame
    up = source["plane"][1]
    across = "y" if up == "z" else "z"
    names = {"omega_" + across: "spin_clockwise" if up == "z" else "spin_anticlockwise", across: "third"}
    for vector in VECTORS:
        names[vector + up] = vector + "z"
    dropped = {vector + across for vector in VECTORS[1:]} | {"omega_x", "omega_" + up}
    words = {name: name for name in names} | frame.words
    frame.words = {names.get(name, name): word for name, word in words.items() if name not in dropped}
    frame.columns = {names.get(name, name): column for name, column in frame.columns.items() if name not in dropped}
    return frame
