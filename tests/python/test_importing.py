"""Snapshots of other programs: units, axes, order, contacts, and what is refused with its place. The descriptions are read by tests/import."""

import math

import numpy as np
import pytest
from drumlin.errors import InputError
from drumlin.importing.run import Import

TABLES = {"grains": ["grains.csv"], "columns": [], "heading": [], "contacts": []}
# d = 9.81 m: the unit of time is 1 s.
DUMPS = {"grains": ["dump.a"], "plane": "xy", "step_s": 0.5, "wall_types": [], "contacts": [], "contact_ids": [], "contact_forces": [],
         "wall_ids": [], "force_on": "first"}
WITH_CONTACTS = {"contacts": ["contacts"], "contact_ids": ["a", "b"], "contact_forces": ["fx", "fy"], "depth_m": 1.0}
NAMES = "time_s,id,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n"
COLUMNS = "id x y radius vx vy"
DRUM = {"center_m": [0.0, 0.0], "speed_rpm": 0.0, "turns_before": 0.0}


class Folder:
    """Files, imported with changes of a description."""

    def __init__(self, path):
        self.path = path

    def write(self, **texts):
        for name, text in texts.items():
            (self.path / {"csv": "grains.csv", "dump": "dump.a"}.get(name, name)).write_bytes(text if isinstance(text, bytes) else text.encode())
        return self

    def imported(self, kind, source=None, grains=None, **tables):
        """(report, snapshots)"""
        source = (TABLES if kind == "csv" else DUMPS) | (source or {})
        description = {kind: {key: value for key, value in source.items() if value is not None},
                       "grains": {"density_kg_m3": 2000.0, "may_change": False, "velocities": "given"}
                       | ({} if kind == "csv" else {"mean_diameter_m": 9.81}) | (grains or {}),
                       "gravity": {"acceleration_m_s2": 9.81, "direction_deg": -90.0}} | tables
        found = Import(description, {of: [str(self.path / name) for name in source[of]] for of in ("grains", "contacts")})
        snapshots = list(found)
        return found.report, snapshots

    def refusal(self, *words, **tables):
        with pytest.raises(InputError) as refused:
            self.imported(*words, **tables)
        return str(refused.value)


@pytest.fixture
def folder(tmp_path):
    return Folder(tmp_path)


def frame(step, columns, rows, kind="ATOMS"):
    return (f"ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF {kind}\n{len(rows)}\nITEM: BOX BOUNDS pp ff pp\n-10 10\n0 40\n-1 1\nITEM: {kind} {columns}\n"
            + "".join(row + "\n" for row in rows))


def tilted(columns, row):
    return ("ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 3 1\n0 2 0\n0 1 0\n"
            f"ITEM: ATOMS {columns}\n{row}\n")


def test_tables_are_brought_from_si_into_the_units_of_the_grains(folder):
    folder.write(csv="time_s,id,x_m,z_m,v_x_m_s,v_z_m_s,radius_m,spin_anticlockwise_rad_s\n0.5,9,0.03,0.01,0.2,0,0.004,-3\n"
                     "0.5,4,0.01,0.02,0,-0.1,0.006,5\n1,4,0.01,0.02,0,0,0.006,0\n1,9,0.03,0.01,0,0,0.004,0\n")
    report, (s, _) = folder.imported("csv")
    d, t = 0.01, math.sqrt(0.01 / 9.81)  # mean of 8 and 12 mm
    assert [report.scales.length_m, report.scales.time_s] == pytest.approx([d, t], abs=1e-15)
    for name, expected in {"time": 0.5 / t, "grains/x": [1, 3], "grains/z": [2, 1], "grains/v_z": [-0.1 * t / d, 0], "grains/radius": [0.6, 0.4],
                           "grains/spin": [-5 * t, 3 * t], "gravity_z": -1, "gravity_x": 0, "step": 1}.items():  # grain 4 first; clockwise
        assert s[name] == pytest.approx(expected, abs=1e-12), name
    assert not {"grains/displacement_x", "contacts/i"} & s.keys()


def test_dimensionless_columns_are_taken_as_they_are(folder):
    folder.write(csv="time,x,z,v_x,v_z,radius\n2,1,2,0.5,0,0.5\n")
    report, (s,) = folder.imported("csv", grains={"mean_diameter_m": 0.003})
    assert (s["grains/x"][0], s["time"], report.scales.length_m, report.with_spin) == (1, 2, 0.003, False)
    assert "mean_diameter_m" in folder.refusal("csv")


def test_drum_turns_with_the_time(folder):
    folder.write(csv=NAMES + "2,0,0,0,0,0,0.005\n3,0,0,0,0,0,0.005\n")
    drum = {"center_m": [0.01, 0.0], "radius_m": 0.1, "speed_rpm": 6.0, "turns_before": 0.0}
    _, snapshots = folder.imported("csv", drum=drum)
    assert [s["wall/angle"] for s in snapshots] == pytest.approx([0, 0.2 * math.pi], abs=1e-12)
    assert [snapshots[0]["container/" + key] for key in ("x", "radius")] == pytest.approx([1, 10])
    _, later = folder.imported("csv", drum=drum | {"turns_before": 1.5})
    assert later[1]["wall/angle"] == pytest.approx(3.2 * math.pi, abs=1e-12)
    folder.write(csv=NAMES + "2,0,0.2,0,0,0,0.005\n")
    assert "grains.csv:2: x_m, z_m: the grain lies outside of the drum" in folder.refusal("csv", drum=drum)


def test_files_without_times_are_an_interval_apart(folder):
    row = "x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0,0,0,0,0.5\n"
    folder.write(a=row, b=row, c=row)
    report, snapshots = folder.imported("csv", {"grains": ["a", "b", "c"], "interval_s": 2.0})
    assert [s["time"] * report.scales.time_s for s in snapshots] == pytest.approx([0, 2, 4])


def test_contacts_have_their_forces_in_normal_and_tangent(folder):
    source, drum = {"contacts": ["contacts"]}, DRUM | {"radius_m": 2.0}
    folder.write(csv=NAMES + "1,1,0,0,0,0,0.5\n1,2,0.6,0.8,0,0,0.5\n2,1,0,0,0,0,0.5\n2,2,0.6,0.8,0,0,0.5\n",
                 contacts="time_s,i,j,f_x_N_m,f_z_N_m\n2,2,1,6,8\n2,1,-3,0,0\n")
    _, (first, second) = folder.imported("csv", source, drum=drum)
    assert len(first["contacts/i"]) == 0  # none at that time
    newton = second["time_step"] / (2000 * 9.81)  # rho g d2
    for name, expected in {"i": [1], "j": [0], "normal_x": [0.6], "normal_z": [0.8], "impulse_n": [10 * newton], "impulse_t": [0]}.items():
        assert second["contacts/" + name] == pytest.approx(expected, abs=1e-7), name  # along the centres, towards i; what carries nothing is left out
    for rows, message in {"f_x_N_m,f_z_N_m\n2,2,1,-6,-8": "contacts: contacts: the contacts of this snapshot pull",
                          "f_x_N_m,f_z_N_m\n2,2,-1,1,1": "contacts:2: normal_x: the normal of a contact with a wall is not given",
                          "f_x_N_m,f_z_N_m\n2,2,5,1,1": "contacts:2: i, j: there is no grain 5", "f_x_N_m,f_z_N_m\n2,2,2,1,1": "touches itself",
                          "f_x_N_m,f_z_N_m\n2,2.5,1,1,1": "contacts:2: i: 2.5 is no whole number",
                          "f_x_N_m,f_z_N_m\n1.5,2,1,6,8": "no snapshot of grains at this time",
                          "normal_x,normal_z,f_n_N_m,f_t_N_m\n2,2,1,0.6,0.9,1,1": "contacts:2: normal_x: the normal has the length 1.08"}.items():
        folder.write(contacts=f"time_s,i,j,{rows}\n")
        assert message.replace("contacts: c", "contacts:2: c") in folder.refusal("csv", source)


def test_a_drum_pushes_towards_its_axis(folder):
    folder.write(csv=NAMES + "1,1,-0.3,0.1,0,0,0.05\n", contacts="time_s,i,j,f_n_N_m,f_t_N_m\n1,1,-1,5,2\n")
    _, (s,) = folder.imported("csv", {"contacts": ["contacts"]}, drum=DRUM | {"radius_m": 0.35, "center_m": [0.0, 0.1]})
    assert (s["contacts/normal_x"][0], s["contacts/j"][0]) == (1, -1)
    assert s["contacts/impulse_t"][0] / s["contacts/impulse_n"][0] == pytest.approx(0.4)


GOOD = NAMES + "# a comment\n1,1,0,0,0,0,0.5\n"


@pytest.mark.parametrize("text, message", [
    (GOOD + "1,2,0,0,0,0\n", "grains.csv:4: holds 6 fields (allowed: 7"),
    (GOOD + "1,2,0,0,abc,0,1\n", 'grains.csv:4: v_x_m_s: "abc" is no number'),
    (GOOD + "1,2,0,0,inf,0,1\n", 'grains.csv:4: v_x_m_s: "inf" is no number'),
    (GOOD + "1,1,0,0,0,0,0.5\n", "grains.csv:4: id: 1 appears twice"),
    (GOOD + "1,2.5,0,0,0,0,0.5\n", "grains.csv:4: id: 2.5 is no id"),
    (GOOD + "1,2,0,0,0,0,-0.1\n", "grains.csv:4: radius_m: is not above 0"),
    (GOOD + "0.5,1,0,0,0,0,0.5\n", "grains.csv:4: time_s: 0.5 s does not go on from 1 s (allowed: times that ascend)"),
    (GOOD + "2,2,0,0,0,0,0.5\n", "grains.csv:4: id: grain 1 is gone"),
    (GOOD + "2,1,0,0,0,0,0.5\n2,2,1,0,0,0,0.5\n", "grain 2 was not there before"),
    ("x_m,z_m,v_x_m_s,v_z_m_s\n0,0,0,0\n", "radius_m: no such column among x_m, z_m, v_x_m_s, v_z_m_s"),
    ("x_m;z_m;radius_m\n0,5;0;1\n", 'grains.csv:1: the name "x_m;z_m;radius_m" holds a semicolon or a tab (allowed: commas'),
    ("time_s,x_m,x,z_m\n", "grains.csv:1: x: appears twice"),
    ("x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0,0,0,0,1\n", "the time is not known"),
    (GOOD + "1,2,1,0,1e308,0,0.5\n", "grains.csv:4: v_x_m_s: is 3.19e+307 of the unit"),
    ("time_s,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n1e200,0,0,0,0,0.5\n", "time_s: is 3.13e+200 sqrt(d/g)"),
    (GOOD + "1,2,0,0,0,0,0.5\n", "grains.csv:4: x_m, z_m: grains 1 and 2 are in one place"),
    ("time_s,x_m,z_m,radius_m\n0,0,0,1\n", "v_x_m_s: no such column (allowed: one, or grains.velocities"),
    (b"\x1f\x8b\x08", "grains.csv: the compressed file is cut off"), (b"\x28\xb5\x2f\xfd", "grains.csv: is compressed (zstd)"), (b"\xff\xfea\0", "grains.csv: is text in UTF-16"),
    ("# nothing\n", "holds no line of column names"), (NAMES, "hold no snapshot"), ("", "holds no line of column names")])
def test_tables_are_refused_with_file_and_line(folder, text, message):
    assert message in folder.write(csv=text).refusal("csv")


def test_grains_may_come_and_go_where_the_description_says_so(folder):
    folder.write(csv=GOOD + "2,2,0,0,0,0,0.5\n")
    assert len(folder.imported("csv", grains={"may_change": True})[1]) == 2


def test_fields_in_quotes_blank_lines_and_comments_are_what_they_are(folder):
    folder.write(csv='"time_s",id,name,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\r\n\r\n1,1,"a, b",0.5,0,0,0,0.5\r\n  # one\r\n \r\n1,2,c,"3",0,+0,0,0.5\r\n')
    report, (s,) = folder.imported("csv")
    assert (list(s["grains/x"]), report.unused_columns) == ([0.5, 3], ["name"])


# Two snapshots of MercuryDPM: number and time above each, then x y z, v, radius, angles, omega, species.
MERCURY = {"heading": ["count", "time_s"], "columns": ["x_m", "y", "z_m", "v_x_m_s", "v_y", "v_z_m_s", "radius_m", "a", "b", "c", "omega_x",
                                                       "spin_clockwise_rad_s"]}


def test_plain_columns_have_a_heading_above_each_snapshot(folder):
    first, second = (f"2 {time} 0 0 0 1 1 1 \n0.1 0 0.2 3 0 4 0.005 0 0 0 nan 7 0 1\n0.3 0 0.2 0 0 0 0.005 0 0 0 0 0 0 1\n" for time in (0.5, 0.75))
    _, snapshots = folder.write(csv=first + second).imported("csv", MERCURY)
    d, t = 0.01, math.sqrt(0.01 / 9.81)
    assert [s["time"] for s in snapshots] == pytest.approx([0.5 / t, 0.75 / t])
    assert [snapshots[0]["grains/" + name][0] for name in ("x", "z", "v_z", "spin")] == pytest.approx([10, 20, 4 * t / d, 7 * t])
    # Cut off anywhere, by a line or within one: the first is there, and what happened is said.
    for kept in range(1, len(second) - 1):
        report, snapshots = folder.write(csv=first + second[:kept]).imported("csv", MERCURY)
        assert len(snapshots) == 1 and len(report.left_out) == 1 and "is cut off" in report.left_out[0], kept
    assert "grains.csv:2: holds 4 fields (allowed: 12" in folder.write(csv=first[:30]).refusal("csv", MERCURY)


def test_a_last_snapshot_that_ends_within_a_line_is_left_out(folder):
    whole = NAMES + "1,1,0,0,0,0,0.5\n1,2,1,0,0,0,0.5\n2,1,0,0,0,0,0.5\n"
    report, snapshots = folder.write(csv=whole + "2,2,1,0,").imported("csv")
    assert len(snapshots) == 1 and len(report.left_out) == 1 and "grains.csv:5: is cut off" in report.left_out[0]
    # A line with its end is whole, and wrong.
    assert "grains.csv:5: holds 5 fields" in folder.write(csv=whole + "2,2,1,0,\n").refusal("csv")


def test_velocities_are_taken_from_displacements(folder):
    folder.write(csv="time_s,id,x_m,z_m,radius_m\n1,1,0.9,0,0.05\n1,2,0.5,0,0.05\n3,1,0.1,0.2,0.05\n3,2,0.5,0,0.05\n")
    report, (s,) = folder.imported("csv", grains={"velocities": "displacements"}, periodic_x={"length_m": 1.0})
    d, t = 0.1, math.sqrt(0.1 / 9.81)
    for name, expected in {"step": 1, "time": 3 / t, "velocity_window": 2 / t, "grains/displacement_x": [2, 0],  # across the seam: 0.2 m
                           "grains/v_x": [0.1 * t / d, 0], "grains/v_z": [0.1 * t / d, 0]}.items():
        assert s[name] == pytest.approx(expected, abs=1e-12), name
    assert "no snapshot before" in report.left_out[0] and report.first_time_s == pytest.approx(3)


def test_the_second_axis_of_a_dump_is_up_and_its_spin_anticlockwise(folder):
    folder.write(dump=frame(4, "id type x y z vx vy vz radius omegaz", ["2 1 9.81 19.62 0 3 4 0 4.9 0.7", "1 1 0 0 0 0 0 0 4.9 0"])
                 + frame(8, COLUMNS, ["1 0 0 5 0 0", "2 0 9 5 0 0"]))
    report, (s, last) = folder.imported("lammps")
    assert [s["time"], *(s["grains/" + name][1] for name in ("x", "z", "v_z", "spin"))] == pytest.approx([2, 1, 2, 4 / 9.81, -0.7])
    assert "grains/spin" not in last and report.unused_columns == ["type"]
    # Upright, y points away from the onlooker.
    folder.write(dump=frame(4, "id x y z vx vz radius omegay", ["1 0 0 9.81 0 1 4 0.7"]))
    _, (s,) = folder.imported("lammps", {"plane": "xz"})
    assert (s["grains/z"][0], s["grains/spin"][0]) == pytest.approx((1, 0.7))


def test_scaled_coordinates_are_put_into_their_box(folder):
    folder.write(dump=frame(0, "id xs ys diameter vx vy", ["1 0.75 0.5 9.81 0 0"]))
    _, (s,) = folder.imported("lammps", {"length_unit_m": 2.0})
    assert [s["grains/" + name][0] * 9.81 for name in ("x", "z", "radius")] == pytest.approx([10, 40, 9.81])  # 5 units of 2 m
    folder.write(dump=tilted("id xs ys diameter vx vy", "1 0.5 0.5 9.81 0 0"))  # x 0 to 2, y 0 to 2, tilted by 1
    _, (s,) = folder.imported("lammps")
    assert [s["grains/" + name][0] * 9.81 for name in ("x", "z")] == pytest.approx([1.5, 1])


def test_atoms_of_a_wall_are_no_grains_and_their_contacts_are_the_walls(folder):
    # From the wall's side (force on the wall: down), among grains, and wall on wall.
    folder.write(dump=frame(0, "id type x y radius vx vy", ["7 2 0 0 5 0 0", "3 1 0 9.81 5 0 0", "4 1 9.81 9.81 5 0 0"]),
                 contacts=frame(0, "a b fx fy", ["7 3 2 -8", "3 4 -6 0", "7 7 1 1"], "ENTRIES"))
    _, (s,) = folder.imported("lammps", WITH_CONTACTS | {"wall_types": [2.0], "depth_m": 2.0})
    unit = s["time_step"] / (2000 * 9.81**3)  # N per metre: rho d3 / s2
    for name, expected in {"i": [0, 0], "j": [-1, 1], "normal_x": [0, -1], "normal_z": [1, 0], "impulse_n": [4 * unit, 3 * unit],  # 8 N over 2 m
                           "impulse_t": [-unit, 0]}.items():  # force on the grain: -2 N along x
        assert s["contacts/" + name] == pytest.approx(expected, abs=1e-15), name
    assert len(s["grains/x"]) == 2


def test_contacts_reach_across_the_seam(folder):
    folder.write(dump=frame(0, COLUMNS, ["1 -9.5 5 1 0 0", "2 9.5 5 1 0 0"]), contacts=frame(0, "a b fx fy", ["1 2 3 0"], "ENTRIES"))
    _, (s,) = folder.imported("lammps", WITH_CONTACTS, periodic_x={"length_m": 20.0})
    assert s["contacts/normal_x"][0] == 1 and s["contacts/impulse_n"][0] > 0


def test_a_box_that_is_periodic_along_x_has_the_period_of_the_description_in_each_frame(folder):
    own, wider = frame(1, COLUMNS, ["1 0 0 5 0 0"]), frame(2, COLUMNS, ["1 0 0 5 0 0"]).replace("-10 10", "-10 11")
    periodic = {"periodic_x": {"length_m": 20.0}}
    report, (s,) = folder.write(dump=own).imported("lammps", **periodic)
    assert s["period_x"] * 9.81 == pytest.approx(20) and report.unused_period_m is None
    assert folder.imported("lammps")[0].unused_period_m == pytest.approx(20)
    assert folder.imported("lammps", drum=DRUM | {"radius_m": 40.0})[0].unused_period_m is None
    assert ("dump.a:1: BOX BOUNDS: are periodic over 20 m along x (allowed: 30 m, periodic_x.length_m"
            in folder.refusal("lammps", periodic_x={"length_m": 30.0}))
    assert "dump.a:11: BOX BOUNDS: are periodic over 21 m along x (allowed: 20 m" in folder.write(dump=own + wider).refusal("lammps", **periodic)
    folder.write(dump=wider.replace("pp ff", "ff pp"))
    assert len(folder.imported("lammps", **periodic)[1]) == 1, "walls along x may lie anywhere"


def test_a_pour_begins_with_its_first_grain(folder):
    folder.write(dump=frame(0, COLUMNS, []) + frame(1, COLUMNS, ["1 0 0 5 0 0"]),
                 contacts=frame(0, "a b fx fy", [], "ENTRIES") + frame(1, "a b fx fy", [], "ENTRIES"))
    report, snapshots = folder.imported("lammps", WITH_CONTACTS)
    assert len(snapshots) == 1 and [left.rsplit("/", 1)[1] for left in report.left_out] == ["dump.a:1: has no grains yet"]


@pytest.mark.parametrize("text, message", [
    (frame(1, COLUMNS, ["1 0 0 1 0 0", "2 0 0 1 0"]), "dump.a:11: holds 5 fields (allowed: 6"),
    (frame(1, COLUMNS, ["1 0 0 1 nan 0"]), 'dump.a:10: vx: "nan" is no number'),
    (frame(1, COLUMNS, ["1 0 0 0 0 0"]), "dump.a:10: radius: is not above 0"),
    (frame(1, "id x y radius diameter vx vy", ["1 0 0 1 2 0 0", "2 5 0 1 1 0 0"]),
     "dump.a:11: radius, diameter: say that the radius is 1 m and 0.5 m"),
    (frame(1, COLUMNS, ["1 0 0 1 0 0", "1 2 0 1 0 0"]), "dump.a:11: id: 1 appears twice"),
    (frame(1, "id x y vx vy", ["1 0 0 0 0"]), "radius or diameter: no such column"),
    (frame(1, "id x y radius vx", ["1 0 0 1 0"]), "vy: no such column"),
    (frame(1, "id x y diameter vx vy", ["1 0 0 0 0 0"]), "dump.a:10: diameter: is not above 0"),
    (frame(1, COLUMNS, ["1 0 0 1 0 0", "2 0 0 1 1 0"]), "dump.a:11: x, y: grains 1 and 2 are in one place"),
    (tilted("id xs y radius vx vy", "1 0 0 1 0 0"), "dump.a:10: xs: is scaled by a tilted box (allowed: ys beside it)"),
    (frame(2, COLUMNS, ["1 0 0 1 0 0"]) + frame(1, COLUMNS, ["1 0 0 1 0 0"]), "times that ascend"),
    (frame(1, "id x y z radius vx vy", ["1 0 0 0 0.1 0 0", "2 0 0 5 0.1 0 0"]), "lie in space"),
    (frame(1, COLUMNS, ["1 0 0 1 0 0"])[:60], "ends within a frame"),
    ("ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id xs ys radius vx vy\n1 0.5 0.5 1 0 0\n",
     "dump.a:5: xs: is scaled by a box that this frame does not give"),
    ("ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2.7\n", "dump.a:4: NUMBER OF ...: is 2.7 (allowed: a whole number"),
    ("ITEM: TIMESTEP\n1.5\n", "dump.a:2: TIMESTEP: is 1.5 (allowed: a whole number"),
    ("ITEM: TIMESTEP\n1\nITEM: TIMESTEP\n2\n", "dump.a:3: TIMESTEP: appears a second time"),
    ("ITEM: TIMESTEP\n1\nITEM: BOX BOUNDS pp ff pp\n10 -10\n", "dump.a:4: BOX BOUNDS: are not in their order"),
    ("ITEM: TIMESTEP\n" + "1" * (2 << 20), "dump.a:2: is longer than 1 MiB"),
    ("ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x\n", "ITEM: ATOMS: comes before ITEM: TIMESTEP"),
    ("hello\n", 'dump.a:1: "hello" is not expected here'), ("", "hold no snapshot")])
def test_dumps_are_refused_with_file_and_line(folder, text, message):
    assert message in folder.write(dump=text).refusal("lammps")


# A disc of 2 mm at 20 mm, 0.1 m/s, at 0.025 s.
@pytest.mark.parametrize("units, row, time", [("si", "1 0.02 0 0.001 0.1 0", 0.025), ("cgs", "1 2 0 0.1 10 0", 0.025),
                                              ("micro", "1 2e4 0 1e3 0.1 0", 2.5e4), ("nano", "1 2e7 0 1e6 0.1 0", 2.5e7)])
def test_units_and_times_are_those_that_the_dump_names(folder, units, row, time):
    folder.write(dump=f"ITEM: UNITS\n{units}\nITEM: TIME\n{time}\n" + frame(1000, COLUMNS, [row])
                 + f"ITEM: TIME\n{1.2 * time}\n" + frame(2000, COLUMNS, [row]))
    report, snapshots = folder.imported("lammps", {"step_s": 1.0}, {"mean_diameter_m": None})
    assert [report.scales.length_m, report.first_time_s, report.last_time_s] == pytest.approx([0.002, 0.025, 0.03], rel=1e-12)
    assert snapshots[1]["grains/x"][0] == pytest.approx(10)
    assert snapshots[1]["grains/v_x"][0] * report.scales.unit_of("velocity") == pytest.approx(0.1)


@pytest.mark.parametrize("units, source, message", [
    ("cgs", {"length_unit_m": 1.0}, 'UNITS: is "cgs", a unit of 0.01; lammps.length_unit_m is 1'),
    ("real", {}, 'dump.a:2: UNITS: is "real" (allowed: si, cgs, micro, nano, lj)'),
    ("lj", {"length_unit_m": 0.01}, "lammps.time_unit_s in the description")])
def test_units_that_contradict_the_description_are_refused(folder, units, source, message):
    folder.write(dump=f"ITEM: UNITS\n{units}\nITEM: TIME\n1\n" + frame(1000, COLUMNS, ["1 2 0 0.1 10 0"]))
    assert message in folder.refusal("lammps", source)


def test_units_without_dimensions_are_those_of_the_description(folder):
    folder.write(dump="ITEM: UNITS\nlj\nITEM: TIME\n1.2\n" + frame(1000, COLUMNS, ["1 2 0 0.1 10 0"]))
    assert folder.imported("lammps", {"length_unit_m": 0.01, "time_unit_s": 0.5})[0].last_time_s == pytest.approx(0.6)
    folder.write(dump=frame(1, COLUMNS, ["1 0 0 1 0 0"]))
    assert "TIMESTEP: counts steps whose length is not known" in folder.refusal("lammps", {"step_s": None})


def test_only_what_is_needed_is_read(folder):
    folder.write(dump=frame(4, "id type x xu y x radius diameter vx vy mol", ["1 sand 9.81 7 0 8 4.9 9.8 0 0 water"]))
    report, (s,) = folder.imported("lammps")
    assert (s["grains/x"][0], s["grains/radius"][0] * 9.81) == pytest.approx((1, 4.9))  # the first that gives x
    assert report.unused_columns == ["mol", "type", "x", "xu"]
    assert 'dump.a:10: type: "sand" is no number' in folder.refusal("lammps", {"wall_types": [2.0]})
    folder.write(dump=tilted(COLUMNS, "1 2.5 1.5 4.9 0 0"))
    assert folder.imported("lammps")[1][0]["grains/x"][0] * 9.81 == pytest.approx(2.5)


def test_what_is_written_twice_or_cut_off_is_left_out(folder):
    def at(step, *rows):
        return frame(step, COLUMNS, rows or ["1 0 0 5 0 0", "2 9 0 5 0 1"])

    def contacts(step):
        return frame(step, "a b fx fy", ["1 2 -3 0"], "ENTRIES")

    # A run that was started again writes the frame at which it starts once more, in any order.
    folder.write(dump=at(1) + at(2) + at(2, "2 9 0 5 0 1", "1 0 0 5 0 0") + at(3), contacts=contacts(1) + contacts(2) * 2 + contacts(3))
    report, snapshots = folder.imported("lammps", WITH_CONTACTS)
    assert (len(snapshots), report.contacts, len(report.left_out)) == (3, 3, 1) and "dump.a:23: is the snapshot before once more" in report.left_out[0]
    folder.write(dump=at(1) + at(2) + at(2, "1 0 0 5 0 0", "2 8 0 5 0 1"))
    assert "dump.a:23: TIMESTEP: 1 s does not go on from 1 s" in folder.refusal("lammps")
    # Cut off after any letter; the others are there, and what happened is said.
    for kept in range(1, len(at(3))):
        report, snapshots = folder.write(dump=at(1) + at(2) + at(3)[:kept]).imported("lammps")
        assert len(snapshots) == 2 and len(report.left_out) == 1 and "dump.a:23: is cut off" in report.left_out[0], kept
    # Grains whose contacts are cut off have no stress, and are left out too; contacts of such grains likewise.
    folder.write(dump=at(1) + at(2) + at(3), contacts=contacts(1) + contacts(2) + contacts(3)[:70])
    assert len(folder.imported("lammps", WITH_CONTACTS)[1]) == 2
    folder.write(dump=at(1) + at(2) + at(3)[:70], contacts=contacts(1) + contacts(2) + contacts(3))
    assert len(folder.imported("lammps", WITH_CONTACTS)[0].left_out) == 1
    # Anywhere else it is a fault.
    folder.write(b=at(4))
    assert "dump.a" in folder.refusal("lammps", {"grains": ["dump.a", "b"]})


def test_lines_lie_across_pieces_of_a_file_which_may_lack_its_last_end(folder):
    count = 40000
    text = "\ufeff" + frame(1, COLUMNS, [f"{k + 1} {20 * k} 0 9.81 0 0" for k in range(count)])
    _, (s,) = folder.write(dump=text[:-1]).imported("lammps")
    assert s["grains/x"] == pytest.approx(20 * np.arange(count) / 9.81, abs=1e-9)
    rows = text.splitlines()
    rows[count // 2] += "\n \n"
    assert len(folder.write(dump="\n".join(rows)).imported("lammps")[1][0]["grains/x"]) == count
    rows[count] += " 1"
    assert f"dump.a:{count + 3}: holds 7 fields" in folder.write(dump="\n".join(rows)).refusal("lammps")
