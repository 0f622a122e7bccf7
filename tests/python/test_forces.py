"""Distribution and anisotropy of contact forces, on networks whose answer is known."""

import math
import sys

import numpy as np
import pytest
from conftest import SOURCES

sys.path.append(str(SOURCES / "apps/figures"))
import force_statistics as forces  # pylint: disable=wrong-import-position

pytestmark = pytest.mark.filterwarnings("ignore::RuntimeWarning")  # what is not known is a division by 0

PLACE = {"in_mirror": False, "origin": [0, 0], "x_axis": [1, 0], "x": [-10, 10], "z_min": -20, "thickness": 1, "layers": 20, "closed": False,
         "surface_z": 0, "wall_z": -20, "H": None, "friction": [None, None], "interval_factor": 3.25}


def contacts(phi, f_n=1.0, f_t=0.0, z=-5.0, wall=False):
    whole = np.broadcast_arrays(phi, f_n, f_t, z, 1.0, wall)
    return {name: np.ravel(values).copy() for name, values in zip(("phi", "f_n", "f_t", "z", "branch", "wall"), whole)}


def joined(*parts):
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def drawn(random, count, a=(0, 0, 0), at=(0, 0, 0), strength=1.0, z=-5.0):
    """Contacts from the second harmonics of a network; normal forces are exponential about their mean."""
    phi = np.pi * random.random(20 * count)
    phi = phi[random.random(phi.size) * (1 + a[0]) < 1 + a[0] * np.cos(2 * (phi - at[0]))][:count]
    mean = strength * (1 + a[1] * np.cos(2 * (phi - at[1])))
    return contacts(phi, mean * random.exponential(size=count), strength * a[2] * np.sin(2 * (phi - at[2])), z)


def zones_of(batches, **changes):
    return {name: zone for name, (_, zone) in forces.statistics(batches, PLACE | changes)[1].items()}


def test_a_known_network_gives_its_harmonics_back():
    random = np.random.default_rng(3)
    found = zones_of([drawn(random, 4000, (0.3, 0.4, 0.1), (2.4, 2.2, 2.3), 5) for _ in range(20)])["bulk"].scalars
    assert found["contacts"] == (80000, None)
    for name, value in {"a_c": 0.3, "a_n": 0.4, "a_t": 0.1, "phi_c_deg": math.degrees(2.4), "phi_n_deg": math.degrees(2.2),
                        "phi_t_deg": math.degrees(2.3), "f_n": 5 * (1 + 0.06 * math.cos(0.4))}.items():
        assert found[name][0] == pytest.approx(value, abs=1.2 * found[name][1]), name
        assert found[name][1] < 0.1 * value, name  # it is a measurement, not a shrug
    # Branches of one length and nothing but second harmonics: the identity holds but for sampling.
    assert found["stress_ratio_harmonics"][0] == pytest.approx(found["stress_ratio"][0], abs=0.003)
    assert found["fabric_xx"][0] + found["fabric_zz"][0] == pytest.approx(1, abs=1e-12)


def test_an_isotropic_network_has_no_anisotropy_within_its_interval():
    random, inside = np.random.default_rng(5), 0
    for _ in range(60):
        found = zones_of([drawn(random, 300) for _ in range(20)])["bulk"].scalars
        inside += sum(found[name][0] <= found[name][1] for name in ("a_c", "a_n"))
    assert inside >= 114  # 1.2 misses expected at 99 %


def scalars(batch):
    """Of one set of contacts, without intervals."""
    return {name: float(value[0]) for name, value in forces.direction_scalars(forces.leave_one_out([forces.direction_sums(batch, 1)])).items()}


def test_the_tangential_force_leans_towards_its_direction():
    # Greatest pressure along 45 degrees: the force on a contact at 60 degrees is turned back towards it, clockwise.
    phi = (np.arange(3600) + 0.5) * np.pi / 3600
    found = scalars(contacts(phi, f_t=0.2 * np.sin(2 * (phi - np.pi / 4))))
    for name, value in {"a_t": 0.2, "phi_t_deg": 45, "stress_ratio": 0.1, "phi_stress_deg": 45, "a_c": 0}.items():
        assert found[name] == pytest.approx(value, abs=1e-4), name


def test_harmonics_carry_the_stress_of_a_fabric_with_a_fourth_one():
    # E = 1 + 0.3 cos 2(phi - 1) + 0.25 cos 4(phi - 0.5) + 0.2 cos 6 phi by numbers of contacts, forces with second harmonics in three directions.
    phi = (np.arange(3600) + 0.5) * np.pi / 3600
    density = 1 + 0.3 * np.cos(2 * (phi - 1)) + 0.25 * np.cos(4 * (phi - 0.5)) + 0.2 * np.cos(6 * phi)
    phi = np.repeat(phi, np.round(500 * density).astype(int))
    found = scalars(contacts(phi, 1 + 0.35 * np.cos(2 * (phi - 1.1)), 0.1 * np.sin(2 * (phi - 0.8))))
    assert found["a_c4"] == pytest.approx(0.25, abs=1e-4) and found["a_c6"] == pytest.approx(0.2, abs=1e-4)
    # Within a bin of 10 degrees the mean leans to where contacts are many.
    assert found["stress_ratio_harmonics"] == pytest.approx(found["stress_ratio"], rel=0.01)


def test_a_direction_without_contacts_has_no_mean_force():
    found = scalars(contacts(np.ones(1)))
    assert math.isnan(found["a_n"]) and found["a_c"] == pytest.approx(2, abs=1e-6)  # all contacts along one line


def test_an_exponential_tail_is_recovered_with_its_coverage():
    random, inside = np.random.default_rng(11), 0
    for _ in range(200):
        sums = forces.leave_one_out([forces.distribution_sums(contacts(0, 1 + random.exponential(1 / 1.4, 100)), 1, None) for _ in range(20)])
        value, half = forces.with_intervals(forces.distribution_scalars(sums, None), PLACE["interval_factor"])["tail_exponent"]
        inside += abs(value - 1.4) <= half
        assert value == pytest.approx(1.4, abs=5 * 0.031)  # the standard error of maximum likelihood is beta/sqrt(n)
    assert inside >= 193  # two misses expected


@pytest.mark.parametrize("power", [-0.5, 0.0, 0.7])
def test_the_power_of_weak_forces_is_recovered(power):
    share, low, high = np.random.default_rng(13).random(100000), 0.02 ** (power + 1), 0.5 ** (power + 1)
    assert forces.power_of((np.log(low + (high - low) * share) / (power + 1)).mean(), 0.02, 0.5) == pytest.approx(power, abs=0.02)


def test_each_force_is_counted_in_the_bin_that_holds_it():
    assert len(forces.FORCE_EDGES) == 124 and forces.FORCE_EDGES[-1] == pytest.approx(10)
    assert not forces.histogram(np.array([0, 1e-5, 10.1]), forces.FORCE_EDGES).any()
    for force in (1.01e-4, 0.003, 0.0999, 0.1001, 0.5, 1.23, 9.99):
        [place] = np.flatnonzero(forces.histogram(np.array([force]), forces.FORCE_EDGES))
        assert forces.FORCE_EDGES[place] <= force < forces.FORCE_EDGES[place + 1]


def test_sliding_contacts_are_those_at_the_friction_cone():
    batch = contacts(np.zeros(4), f_t=[0.4, -0.4, 0.2, 0])
    found = forces.distribution_scalars(forces.leave_one_out([forces.distribution_sums(batch, 1, 0.4)]), 0.4)
    assert found["sliding_share"] == 0.5 and found["mobilisation"] == pytest.approx(0.625, abs=1e-6)


def test_forces_are_set_against_the_mean_at_their_depth():
    # Two depths, ten times the force below: over the local mean one exponential, over the zone's a mixture.
    random = np.random.default_rng(17)
    found = zones_of([joined(drawn(random, 1000, z=-4.5), drawn(random, 1000, strength=10, z=-14.5)) for _ in range(20)])["bulk"].scalars
    assert found["tail_exponent"][0] == pytest.approx(1, abs=found["tail_exponent"][1])
    assert found["f_n"][0] == pytest.approx(5.5, abs=0.1)
    # Over 5.5 the deep ones have the mean 1.82, and next to nothing else is above 1.
    assert found["tail_exponent_zone_mean"][0] == pytest.approx(0.55, abs=0.02)
    assert "sliding_share" not in found  # the friction is not known


def test_zones_follow_the_surface_the_interface_and_the_wall():
    random = np.random.default_rng(19)
    batch = joined(*(drawn(random, 100, z=z) for z in (-0.5, -3.5, -8.5, -9.5, -14.5, -18.5)), contacts(np.ones(40), 2, 0.5, -19.9, True))
    place = PLACE | {"surface_z": -1, "wall_z": -19, "H": 7}  # in the frame flowing is -8 ... -2, static -17 ... -10, bulk -17 ... -2
    zones = zones_of([batch], **place)
    assert {name: zone.scalars["contacts"][0] for name, zone in zones.items()} == {"flowing": 100, "static": 100, "bulk": 400, "wall": 40}
    assert zones["wall"].scalars["f_n"][0] == 2 and zones["wall"].scalars["f_t_over_f_n"][0] == 0.25
    layers = forces.statistics([batch], place)[0]
    assert layers["z"][0][0] == -17.5 and layers["contacts"][0][0] == 100
    assert list(zones_of([batch], **place | {"H": None})) == ["bulk", "wall"]


def test_densities_integrate_to_the_share_in_their_bins():
    rows = zones_of([drawn(np.random.default_rng(23), 5000, (0.2, 0.3, 0.1), (1, 1, 1))])["bulk"].rows

    def whole(quantity):
        return np.array([((end - begin) * value, count) for name, begin, end, value, _, count in rows if name == quantity]).sum(0)

    share, count = whole("f_n")
    assert share == pytest.approx(count / 5000, abs=1e-12) and count > 4990  # all but those below 1e-4 and above 10
    assert whole("contacts_of_direction")[0] * math.pi / 180 == pytest.approx(0.5, abs=1e-12)  # half of the circle


def column(angle):
    """Six columns of 20 discs on a floor, in a gravity that is tilted by 0.3, turned anticlockwise: a snapshot as result_files reads it."""
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    level = np.tile(np.arange(20), 6)
    x, z = (np.array([np.repeat(np.arange(6), 20) + 0.5, level + 0.5]).T @ turn).T
    grain, weight = np.arange(120), (20 - level) * math.pi / 4
    return {"x": x, "z": z, "radius": np.full(120, 0.5), "i": grain, "j": np.where(level == 0, -1, grain - 1), "normal": np.tile([0.0, 1.0], (120, 1)) @ turn,
            "force_n": weight * math.cos(0.3), "force_t": -weight * math.sin(0.3)}


@pytest.mark.parametrize("angle", [0.0, 0.8, 2.5])
def test_a_column_on_a_slope_has_its_forces_and_directions_in_any_frame(angle):
    found = forces.contacts_of(column(angle), PLACE | {"x": [0, 10], "z_min": -0.5, "x_axis": [math.cos(angle), math.sin(angle)]})
    assert found["wall"].sum() == 6 and found["z"].size == 120
    assert found["phi"] == pytest.approx(np.full(120, np.pi / 2), abs=1e-5) and found["branch"] == pytest.approx(np.where(found["wall"], 0.5, 1))
    assert found["f_n"] == pytest.approx((20 - np.round(found["z"])) * math.pi / 4 * math.cos(0.3), abs=1e-4)
    assert found["f_t"] / found["f_n"] == pytest.approx(np.full(120, -math.tan(0.3)), abs=1e-5)


def test_the_slice_takes_the_contacts_whose_point_it_holds_and_a_mirror_turns_them_round():
    found = forces.contacts_of(column(0), PLACE | {"x": [1, 3], "z_min": 0})  # two of six columns
    assert (~found["wall"]).sum() == 38 and found["wall"].sum() == 2
    seen = forces.contacts_of(column(0.4), PLACE | {"x": [None, None]})
    mirrored = forces.contacts_of(column(0.4), PLACE | {"x": [None, None], "in_mirror": True})
    assert seen["phi"] + mirrored["phi"] == pytest.approx(np.full(seen["phi"].size, np.pi), abs=1e-5)
    assert np.array_equal(mirrored["f_t"], -seen["f_t"]) and np.array_equal(mirrored["f_n"], seen["f_n"])
