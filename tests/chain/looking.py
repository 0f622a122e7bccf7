"""What `drumlin plot` and `drumlin export` leave of small runs of every kind: figures that are not blank, files that ParaView's rules hold for.

usage: looking.py DRUMLIN FOLDER_OF_THIS_TEST [--short]
--short: leaves out figures of other walls and of chosen moments.
"""

import json
import math
import sys
import xml.etree.ElementTree

import h5py
import matplotlib.image
import numpy

from command import given, read_json, require
from player_file import Player
from vtu_file import arrays_of

GRAINS = """
[grains]
density_kg_m3 = 2700
[grains.generated]
count = {count}
diameter_min_mm = 3
diameter_max_mm = 4
region = {{ shape = "rectangle", min_mm = [2, 3], max_mm = [28, 40] }}
"""

# A disc that falls, in the air in snapshot 1: no friction, no spin, one wall. Its title is what a figure must not take for mathematics.
ONE_DISC = 'format = "drumlin-scene-1"\ntitle = "$x_1$ \\\\alpha_{5 % of <b>one</b> disc & $"\n' + GRAINS.format(count=1).replace("[2, 3]", "[2, 30]") + """
[[walls]]
name = "floor"
shape = "segment"
from_mm = [-1000, 0]
to_mm = [1000, 0]
[effects.gravity]
[[stages]]
name = "fall"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
"""

# Contacts across the seam, glued discs that move, forces that pull.
PERIODIC = 'format = "drumlin-scene-1"\ntitle = "Shaken floor"\nreduced = true\n' + GRAINS.format(count=50) + """
[periodic_x]
x_min_mm = 0
x_max_mm = 30
[[walls]]
name = "floor"
shape = "segment"
from_mm = [0, 0]
to_mm = [30, 0]
rough = { diameter_mm = 3, spacing_mm = 4 }
[effects.gravity]
[effects.friction]
grain_grain = 0.4
grain_wall = 0.4
[effects.cohesion]
grain_grain = 2
grain_wall = 2
[effects.spin]
[[stages]]
name = "shaken"
duration_s = 0.2
time_step_s = 1e-3
snapshots = 5
motions = [{ wall = "floor", kind = "oscillation", amplitude_mm = [0, 2], frequency_hz = 5 }]
"""

# A floor that slides 80 mm along a period of 30 mm.
SLIDING = PERIODIC.replace("Shaken floor", "Sliding floor").replace(
    'kind = "oscillation", amplitude_mm = [0, 2], frequency_hz = 5', 'kind = "translation", velocity_mm_s = [400, 0]')

# The same grains between walls.
BED = PERIODIC.replace("[periodic_x]\nx_min_mm = 0\nx_max_mm = 30\n", "").replace("[effects.gravity]", """
[[walls]]
name = "left"
shape = "segment"
from_mm = [0, 100]
to_mm = [0, -10]
[[walls]]
name = "right"
shape = "segment"
from_mm = [30, -10]
to_mm = [30, 100]
[effects.gravity]""")

# A bowl that glides to the right by 10 mm, a little more than half a circle.
BOWL = BED[:BED.index("[[walls]]")].replace("Shaken floor", "Bowl") + """
[[walls]]
name = "bowl"
shape = "arc"
center_mm = [15, 20]
radius_mm = 30
from_deg = 175
to_deg = 365
[effects.gravity]
[[stages]]
name = "glides"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
motions = [{ wall = "bowl", kind = "translation", velocity_mm_s = [100, 0] }]
"""

# Grains that leave through a bottom that opens: the last snapshots hold none.
EMPTIED = 'format = "drumlin-scene-1"\ntitle = "Emptied"\n' + GRAINS.format(count=20) + """
[[walls]]
name = "gate"
shape = "segment"
from_mm = [-10, 0]
to_mm = [40, 0]
[[outlets]]
name = "below"
region = { shape = "rectangle", min_mm = [-90, -60], max_mm = [120, -20] }
[effects.gravity]
[effects.friction]
grain_grain = 0.4
grain_wall = 0.4
[effects.spin]
[[stages]]
name = "fall"
duration_s = 0.3
time_step_s = 1e-3
snapshots = 6
opens = ["gate"]
"""

# Nothing to look at but the log.
NO_SNAPSHOTS = ONE_DISC.replace("snapshots = 2", "snapshots = 0")


def made_run(drumlin, folder, name, text):
    scene = folder / f"{name}.toml"
    scene.write_text(text, encoding="utf-8")
    drumlin("run", scene, "-o", folder / name)
    return folder / name


def require_figure(file):
    """More than one colour beside white on at least a hundredth of the picture."""
    pixels = matplotlib.image.imread(file)[:, :, :3]
    marked = pixels.min(axis=2) < 0.95
    require(min(pixels.shape[:2]) > 150, f"{file}: too small, {pixels.shape}")
    require(marked.mean() > 0.005, f"{file}: all but blank")
    require(len({tuple(colour) for colour in (pixels[marked][::7] * 8).astype(int)}) > 3, f"{file}: of one colour")


def require_plots(folder, expected):
    drawn = read_json(folder / "plots.json")
    require(sorted(drawn["figures"]) == sorted(expected), f"{folder}: {drawn['figures']} instead of {expected}")
    require(sorted(path.name for path in folder.iterdir()) == sorted([*expected, "manifest.txt", "plots.json"]),
            f"{folder}: other files than it names")
    for name in expected:
        if name.endswith(".png"):
            require_figure(folder / name)
    return drawn


def frames_of_gif(file):
    data = file.read_bytes()
    require(data[:6] == b"GIF89a" and data[-1:] == b"\x3b", f"{file}: no whole GIF")
    return data.count(b"\x21\xf9\x04")  # one graphic control extension per frame


def plots(drumlin, one_disc, periodic, none, folder):
    drumlin("plot", periodic, "--animation", "--snapshot", "3")
    drawn = require_plots(periodic / "plots",
                          ["speed.png", "spin.png", "forces.png", "log.png", "time.png", "animation.gif"])
    require(drawn["reduced"] is True and drawn["snapshot"] == 3, f"{drawn}: not what was asked for")
    frames = frames_of_gif(periodic / "plots" / "animation.gif")
    require(frames == 5, f"{frames} frames of 5 snapshots")
    text, _ = drumlin("plot", periodic, "--animation", "--snapshot", "3", "--resume")
    require("done already" in text, f"drawn again: {text}")
    _, said = drumlin("plot", periodic, "--snapshot", "3", "--resume", code=2)
    require("other inputs or options" in said, f"another picture: {said}")

    # A run without spin has no picture of it; one that goes on is drawn as far as it went, its last line cut.
    report = json.loads((one_disc / "run.json").read_text(encoding="utf-8"))
    (one_disc / "run.json").write_text(json.dumps(report | {"status": "running"}), encoding="utf-8")
    log = one_disc / "log.csv"
    log.write_bytes(log.read_bytes()[:-7])
    _, error = drumlin("plot", one_disc, "-o", folder / "elsewhere", code=2)
    require("log.csv" in error and "drumlin accept" in error, f"changed files were drawn: {error}")
    drumlin("accept", one_disc, "--reason", "cut to look like one that goes on")
    text, _ = drumlin("plot", one_disc, "-o", folder / "elsewhere")
    require("unfinished" in text, f"nothing said of an unfinished run: {text}")
    edits = read_json(folder / "elsewhere" / "plots.json")["accepted_edits"]
    require(len(edits) == 1 and "cut to look like one that goes on" in edits[0], f"not said what was edited: {edits}")
    require_plots(folder / "elsewhere", ["speed.png", "forces.png", "log.png", "time.png"])

    drumlin("plot", none)
    require_plots(none / "plots", ["log.png", "time.png"])


def chosen_plots(drumlin, periodic, folder):
    """One colour in the place of the standard ones, a series of stills, a window; and what is asked for wrongly."""
    common = ["forces.png", "log.png", "time.png"]
    for colour in ("size", "pressure", "coordination", "id"):
        drumlin("plot", periodic, "--color", colour, "-o", folder / colour)
        require_plots(folder / colour, [f"{colour}.png", *common])
    drumlin("plot", periodic, "--color", "spin", "--every", "2", "--window", "0,4,-1,3", "-o", folder / "stills")
    names = [f"stills/{n:06}.png" for n in (1, 3, 5)]
    require(sorted(read_json(folder / "stills" / "plots.json")["figures"]) == sorted(["spin.png", *common, *names]), "other stills")
    sizes = {matplotlib.image.imread(folder / "stills" / name).shape for name in names}
    require(len(sizes) == 1, f"stills of several sizes: {sizes}")
    drumlin("plot", periodic, "--animation", "--every", "2", "-o", folder / "every")
    require(frames_of_gif(folder / "every" / "animation.gif") == 3, "not every second snapshot of five")
    for words, answer in ([["--window", "1,0,0,1"], "X0 < X1"], [["--color", "material"], "no materials"], [["--color", "mass"], "mass"]):
        _, said = drumlin("plot", periodic, *words, "-o", folder / "refused", code=2)
        require(answer in said, said)


def sliding_wall(drumlin, folder):
    """The glued discs of a floor that left the period nearly three times are seen over all its width."""
    run = made_run(drumlin, folder, "sliding", SLIDING)
    drumlin("plot", run)
    pixels = matplotlib.image.imread(run / "plots" / "speed.png")[:, :, :3]
    grey = (numpy.abs(pixels - 0.6) < 0.01).all(axis=2)
    columns = numpy.flatnonzero(grey.sum(axis=0) > 3)
    marked = numpy.flatnonzero((pixels.min(axis=2) < 0.95).any(axis=0))
    require(len(columns) > 0.4 * (marked.max() - marked.min()), f"a wall over {len(columns)} columns of pixels")


def arcs(drumlin, folder):
    """An arc is drawn where it is then, its grains in it; its points in .vtu files lie on its circle."""
    run = made_run(drumlin, folder, "bowl", BOWL)
    drumlin("plot", run, "--player")
    require_figure(run / "plots" / "speed.png")
    drumlin("export", run, "--vtu")
    for number, x in ((1, 0.020), (2, 0.025)):
        walls, grains = (arrays_of(run / "vtu" / kind / f"{number:06}.vtu") for kind in ("walls", "grains"))
        points = walls["Points"][:, :2]
        away = numpy.hypot(*(points - (x, 0.020)).T)
        require(set(walls["types"]) == {3} and len(set(walls["wall"])) == 2 and numpy.allclose(away, 0.030, atol=1e-7), f"{len(walls['offsets'])} pieces, {away}")
        require(numpy.isclose(points[:, 1].min(), -0.010, atol=1e-5) and (points[:, 1] < 0.0227).all(), "another piece of the circle")
        inside = numpy.hypot(*(grains["Points"][:, :2] - (x, 0.020)).T) + grains["radius_m"]
        require(len(inside) == 50 and (inside < 0.0302).all(), f"grains outside: {inside.max()}")


def emptied(drumlin, folder):
    """Snapshots without grains are pictures of the walls, or of nothing, and frames of animation and player like others."""
    run = made_run(drumlin, folder, "emptied", EMPTIED)
    counts = []
    for file in sorted((run / "snapshots").iterdir()):
        with h5py.File(file) as snapshot:
            counts.append(len(snapshot["grains/x"]))
    require(counts[0] == 20 and counts[-1] == 0, f"{counts} grains")
    drumlin("plot", run, "--animation", "--player")
    names = ["speed.png", "forces.png", "log.png", "time.png", "animation.gif", "player.html"]
    require(sorted(read_json(run / "plots/plots.json")["figures"]) == sorted(names), "other figures of a run that ends empty")
    require(frames_of_gif(run / "plots/animation.gif") == 6, "frames without grains are left out")
    found = [len(frame["grains"]) for frame in Player(run / "plots/player.html").frames]
    require(found == counts, f"the player shows {found} grains of {counts}")
    for colour in ("spin", "size", "pressure", "coordination", "id"):
        drumlin("plot", run, "--color", colour, "--snapshot", "6", "-o", folder / f"emptied-{colour}")
    drumlin("report", run)
    require((run / "report/index.html").exists(), "no report of a run that ends empty")


def words_of_figures(figures):
    """Labels tell places apart; a wall without a place is not drawn."""
    sys.path.insert(0, str(figures))
    import grain_maps  # noqa: E402
    import overlaps  # noqa: E402
    import style  # noqa: E402
    require(style.place_labels([-3.2, 1.21, 1.24]) == ["-3.20", "+1.21", "+1.24"], style.place_labels([-3.2, 1.21, 1.24]))
    require(style.place_labels([-13.6, 0.0, 13.6]) == ["-14", "+0", "+14"], style.place_labels([-13.6, 0.0, 13.6]))
    require([style.at_places(n) for n in (1, 2, 5, 12)] == ["at one place", "at two places", "at five places", "at 12 places"], "places")
    placed = {"shape": "segment", "x": [0.0, 1.0], "z": [0.0, 0.0], "angle": 0.0}
    for wall in (placed | {"x": [None, 1.0]}, placed | {"z": [0.0, math.inf]}, {"shape": "disc", "x": 0.0, "z": None, "radius": 1.0}):
        require(grain_maps.has_place(placed) and not grain_maps.has_place(wall), f"{wall}")
    # Overlaps of 0.002 d, or 0.0005 d, of a large and a small disc; across a seam; in a sheared cell; with the container.
    big, cell = 1.5, ((0.0, 0.0), (10.0, 8.0))
    for x, z, other, expected in (((1, 2.998), (3, 3), {}, [0.002]), ((1, 2.9995), (3, 3), {}, []),
                                  ((0.5, 8.502), (3, 3), {"period": (0, 10)}, [0.002]), ((0.5, 8.502), (3, 3), {}, []),
                                  ((1, 4), (8, 1.998), {"period": (0, 10), "cell": cell, "offset": 7.0}, [0.002]),
                                  ((1, 4), (8, 1.998), {"period": (0, 10), "cell": cell, "offset": 0.0}, []),
                                  ((-3.502, 4), (0, 0), {"container": (0, 0, 5)}, [0.002]), ((), (), {}, [])):
        i, j, depth = overlaps.deep_overlaps(numpy.array(x), numpy.array(z), numpy.array([big, 0.5])[:len(x)], **other)
        require(len(depth) == len(expected) and numpy.allclose(depth, expected, atol=1e-9), f"{x}, {z}, {other}: {i}, {j}, {depth}")
    require(overlaps.words_of(numpy.array([0.002, 0.0061])) == "2 overlaps beyond 0.001 d, the deepest 0.0061 d", "words of overlaps")


def stretches(drumlin, folder):
    """The errors of a run that no record knows; the files of the run stay those of the run without."""
    scene = folder / "periodic.toml"
    drumlin("run", scene, "-o", folder / "told", "--accuracy-seconds", "0.02")
    told = read_json(folder / "told" / "run.json")["accuracy"]["stretches"]
    require(told["seconds"] == 0.02 and {"kinetic_energy", "pressure", "displacement"} <= set(told["quantities"]), f"{told}")
    for name, one in told["quantities"].items():
        for setting, factor in (("step", 2), ("solver", 2.3660254037844386)):
            found = one[setting]
            require(math.isclose(found["error_at_most"], factor * (abs(found["change"]) + found["ci99"]), rel_tol=1e-12), f"{name}: {found}")
    for name in ["log.csv", *(f"snapshots/{n:06}.h5" for n in range(1, 6))]:
        require((folder / "told" / name).read_bytes() == (folder / "periodic" / name).read_bytes(), f"{name} differs")


def read_by_vtk(file):
    """Points and arrays of a .vtu by VTK's own reader; None where VTK is not installed."""
    try:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
    except ImportError:
        return None
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(file))
    reader.Update()
    grid = reader.GetOutput()
    found = {"Points": vtk_to_numpy(grid.GetPoints().GetData())}
    for data in (grid.GetPointData(), grid.GetCellData()):
        found |= {data.GetArrayName(k): vtk_to_numpy(data.GetArray(k)) for k in range(data.GetNumberOfArrays())}
    return found


def exports(drumlin, one_disc, periodic, folder):
    drumlin("export", periodic, "--vtu", "--snapshots", "2-3,5,5")
    output = periodic / "vtu"
    for kind in ("grains", "contacts", "walls"):
        sets = xml.etree.ElementTree.parse(output / f"{kind}.pvd").getroot().findall("Collection/DataSet")
        names = [entry.get("file") for entry in sets]
        require(names == [f"{kind}/{n:06}.vtu" for n in (2, 3, 5)], f"{kind}.pvd: {names}")
        times = [float(entry.get("timestep")) for entry in sets]
        require(all(math.isclose(t, n * 0.04, rel_tol=1e-6) for t, n in zip(times, (2, 3, 5))), f"{kind}.pvd: {times} s")
        require(len(list((output / kind).iterdir())) == 3, f"{kind}: other files than three")

    with h5py.File(periodic / "snapshots" / "000005.h5") as snapshot:
        d, second, rho = (snapshot["scales/" + name][()] for name in ("length_m", "time_s", "density_kg_m3"))
        grains = {name: values[:] for name, values in snapshot["grains"].items()}
        contacts = {name: values[:] for name, values in snapshot["contacts"].items()}
        step = snapshot["time_step"][()]

    def near(a, b, scale):  # numbers of single precision
        return numpy.allclose(a, b, rtol=1e-6, atol=1e-6 * scale)

    shown = arrays_of(output / "grains" / "000005.vtu")
    x, y = shown["Points"][:, 0], shown["Points"][:, 1]
    require(near(y, grains["z"] * d, d) and near(shown["radius_m"], grains["radius"] * d, d), "places or radii differ")
    turns = (grains["x"] * d - x) / 0.03  # the domain is 30 mm long
    require(numpy.allclose(turns, turns.round(), atol=1e-4) and x.min() > -1e-6 and x.max() < 0.03 + 1e-6, "not within the period")
    require(near(shown["velocity_m_s"][:, 1], grains["v_z"] * d / second, d / second), "velocities differ")
    require(near(shown["spin_clockwise_rad_s"], grains["spin"] / second, 1 / second), "spins differ")

    lines = arrays_of(output / "contacts" / "000005.vtu")
    unit = rho * d**3 / second
    require(near(lines["normal_impulse_N_s_m"], contacts["impulse_n"] * unit, unit), "impulses differ")
    require(near(lines["normal_force_N_m"] * step * second, contacts["impulse_n"] * unit, unit), "forces differ")
    require((lines["grain_or_wall_j"] == contacts["j"]).all(), "partners differ")
    ends = lines["Points"].reshape(-1, 2, 3)
    between = contacts["j"] >= 0
    length = numpy.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    radii = grains["radius"][contacts["i"]] + numpy.where(between, grains["radius"][contacts["j"]], 0)
    require(between.any() and (~between).any() and near(length, radii * d, d), "lines do not join centres")

    for kind, own in (("grains", shown), ("contacts", lines)):
        theirs = read_by_vtk(output / kind / "000005.vtu")
        for name in theirs or ():
            require(numpy.array_equal(theirs[name], own[name]), f"{kind}: VTK reads other {name}")

    # The floor with its 7 or 8 glued discs at the height of its motion, 2 mm (sin(10 pi t)) at t = 0.2 s: 0.
    walls = arrays_of(output / "walls" / "000005.vtu")
    require(list(dict.fromkeys(walls["wall"])) == [-1 - k for k in range(9)], f"{walls['wall']}")
    require(near(walls["Points"][:2, 1], 0, 1e-3), "the floor is elsewhere")
    quarter = arrays_of(output / "walls" / "000003.vtu")["Points"][0, 1]  # t = 0.12 s
    require(math.isclose(quarter, 2e-3 * math.sin(10 * math.pi * 0.12), rel_tol=1e-5), f"floor at {quarter} m")

    # No spin, no friction: no array of it; a disc in the air has no contact, and the file says so.
    drumlin("export", periodic, "--to", "vtkhdf")
    drumlin("export", periodic, "--to", "lammps", "-o", folder / "dumps", "--snapshots", "last")
    require((periodic / "vtkhdf" / "run.vtkhdf").stat().st_size > 0 and (folder / "dumps" / "contacts.dump").read_text().startswith("ITEM: UNITS"), "no files")
    drumlin("export", periodic, "--to", "vtkhdf", "--vtu", code=2)
    drumlin("export", periodic, "--to", "vtk", code=2)
    drumlin("export", one_disc, "--vtu", "-o", folder / "export", "--snapshots", "1")
    require("spin_clockwise_rad_s" not in arrays_of(folder / "export" / "grains" / "000001.vtu"), "a spin that is not there")
    none = arrays_of(folder / "export" / "contacts" / "000001.vtu")
    require({"Points", "connectivity", "normal_force_N_m"} <= set(none) and not any(map(len, none.values())), f"contacts of a disc in the air: {none}")
    drumlin("export", one_disc, "--vtu", "-o", folder / "export", "--resume", code=2)  # of all snapshots
    text, _ = drumlin("export", one_disc, "--vtu", "-o", folder / "export", "--snapshots", "1", "--resume")
    require("done already" in text, f"exported again: {text}")


def histories(drumlin, one_disc, periodic, folder):
    """The floor carries the grains; a box as wide as the period gets a stress, a single disc in the air none."""
    drumlin("history", periodic, "--box", "0,8.571,0,8")
    head, rows = table_of(periodic / "history" / "walls.csv")
    require(head[0] == "# drumlin-history-walls-1", head[0])
    require([row["snapshot"] for row in rows] == list("12345") and float(rows[-1]["force_z"]) < 0, f"walls: {rows}")
    _, rows = table_of(periodic / "history" / "region.csv")
    require(len(rows) == 5 and float(rows[-1]["sigma_zz"]) > 0 and rows[0]["d_v_x_dz"] == "", f"region: {rows}")
    drumlin("history", one_disc, "-o", folder / "history")
    require(not (folder / "history" / "region.csv").exists(), "a region that nobody asked for")
    head, rows = table_of(periodic / "history" / "surface.csv")
    require(head[0] == "# drumlin-history-surface-1" and len(rows) == 5 and rows[-1]["repose_deg"] == "", f"surface: {head[0]}, {rows}")
    text, _ = drumlin("history", one_disc, "-o", folder / "history", "--resume")
    require("done already" in text, f"made again: {text}")
    for words in (["--sectors", "5"], ["--box", "0,1,0,1"]):  # another question is not answered by what is there
        _, said = drumlin("history", one_disc, "-o", folder / "history", "--resume", *words, code=2)
        require("--overwrite" in said, said)


def table_of(file):
    """(lines that start with #, rows by column)"""
    lines = file.read_text().splitlines()
    head = [line for line in lines if line.startswith("#")]
    names, *rows = [line.split(",") for line in lines[len(head):]]
    return head, [dict(zip(names, row)) for row in rows]


def own_frames(drumlin, periodic, folder):
    """Every grain of every snapshot is counted once in rings, over the height and over the width."""
    bed = made_run(drumlin, folder, "bed", BED)
    for words, answer in ([["--radial", "axis"], "no circular wall"], [["--radial", "1"], "X,Z"], [["--radial", "1,x"], "X,Z"],
                          [["--height", "3,1"], "second one greater"], [["--width", "3"], "second one greater"]):
        _, said = drumlin("measure", bed, "--parts", "none", *words, code=2)
        require(answer in said and not (bed / "measured").exists(), f"{words}: {said}")
    _, said = drumlin("measure", periodic, "--parts", "none", "--height", "0,5", code=2)
    require("periodic" in said and not (periodic / "measured").exists(), said)
    drumlin("measure", bed, "--parts", "none")
    require("frames" not in read_json(bed / "measured/measured.json") and not list(bed.glob("measured/radial*")), "what nobody asked for")
    no_spin = made_run(drumlin, folder, "no-spin", BED.replace("[effects.spin]\n", ""))
    drumlin("measure", no_spin, "--parts", "none", "--width", "5,6", "--height", "500,600")  # one band nearly empty, one without a grain
    require_figure(no_spin / "measured/width.png")
    require((no_spin / "measured/height.png").exists(), "a band without grains has no figure")
    drumlin("measure", bed, "--parts", "none", "--radial", "4,3", "--height=-1,10", "--width=-1,60", "--overwrite")
    measured = read_json(bed / "measured/measured.json")
    grains = 50 * measured["settings"]["snapshots"]
    require([frame["file"] for frame in measured["frames"]] == ["radial.csv", "height.csv", "width.csv"], measured["frames"])
    # A frame without a figure, or a figure that says it could not be drawn, would have ended the call with 74.
    for name in ("radial", "height", "width"):
        require_figure(bed / f"measured/{name}.png")
    require(not (bed / "measured/figures.pending").exists(), "figures are missing")
    for name, first, there, foreign in (("radial", "r", "sigma_rt", "sigma_xz"), ("height", "z", "sigma_zz", "shear_rate"), ("width", "x", "d_v_z_dx", "k")):
        head, rows = table_of(bed / "measured" / f"{name}.csv")
        require(head[:2] == ["# drumlin-frame-1", f"# frame = {name}"] and "# reduced = true" in head, head)
        require(list(rows[0])[0] == first and there in rows[0] and foreign not in rows[0] and f"{there}_ci99" in rows[0], list(rows[0]))
        require(sum(float(row["count"]) for row in rows) == grains, f"{name}: {[row['count'] for row in rows]} of {grains}")


def refusals(drumlin, one_disc, periodic, none, folder):
    damaged = folder / "damaged"
    damaged.mkdir()
    for name in ("run.json", "scene.toml", "log.csv"):
        (damaged / name).write_bytes((one_disc / name).read_bytes())
    (damaged / "snapshots").mkdir()
    (damaged / "snapshots" / "000001.h5").write_bytes((one_disc / "snapshots" / "000001.h5").read_bytes()[:-9])
    for words in (["plot", one_disc, "--snapshot", "3"], ["plot", one_disc, "--snapshot", "first"],
                  ["plot", none, "--snapshot", "1"], ["plot", none, "--animation"], ["plot", damaged],
                  ["export", none, "--vtu"], ["export", damaged, "--vtu"],
                  ["export", one_disc], ["export", one_disc, "--vtu", "--snapshots", "2-3"],
                  ["export", one_disc, "--vtu", "--snapshots", "2-"], ["export", one_disc, "--vtu", "--snapshots", ""],
                  ["export", one_disc, "--vtu", "-o", one_disc, "--overwrite"],
                  ["history", none], ["history", damaged], ["history", one_disc, "--box", "0,1,2"],
                  ["history", one_disc, "--box", "1,0,0,1"], ["history", periodic, "--box", "0,9,0,8"],
                  ["plot", one_disc, "-o", one_disc], ["plot", one_disc, "-o", one_disc, "--overwrite"]):
        _, said = drumlin(*words, code=2)
        require(said.strip(), f"{words} was refused without a word")
    left = [path for run in (one_disc, none, damaged) for path in (run / "plots", run / "vtu", run / "history") if path.exists()]
    require(not left, f"a refusal left {left}")


def main():
    with given() as (drumlin, tests, folder):
        one_disc, periodic, none = (made_run(drumlin, folder, *run) for run in
                                    (("one", ONE_DISC), ("periodic", PERIODIC), ("none", NO_SNAPSHOTS)))
        refusals(drumlin, one_disc, periodic, none, folder)
        exports(drumlin, one_disc, periodic, folder)
        histories(drumlin, one_disc, periodic, folder)
        own_frames(drumlin, periodic, folder)
        plots(drumlin, one_disc, periodic, none, folder)
        if "--short" not in sys.argv:
            chosen_plots(drumlin, periodic, folder)
            sliding_wall(drumlin, folder)
            arcs(drumlin, folder)
        stretches(drumlin, folder)
        emptied(drumlin, folder)
        words_of_figures(tests.parents[1] / "apps/figures")
    print("figures drawn, not blank; exported numbers are those of the snapshots; what cannot be done refused")


if __name__ == "__main__":
    main()
