"""Laws of the bed: what is fitted comes back from paths that obey it, and from the runs of data/bed as their law holds it."""

import json
import tomllib

import drumlin
import numpy as np
import pytest
from drumlin import InputError, _drumlin
from drumlin.bed import amount, command, memory, spreading
from drumlin.bed.paths import Paths

KNOWN = memory.Axes(6, 0.9, 0.6, None, 1e-2, 1e-1)


def known_amount(inertial):
    return 0.31 + 0.011 * np.log(inertial)


class Drum:
    """A drum of radius 50 d whose layer decays over `decay`, as a bed with stresses of one's own: `stress_of(bed)` over p at the ends of its paths."""

    def __init__(self, stress_of=lambda bed: bed.paths["stress"], speed=1.5, decay=5.0, half_chord=52.0, mu=0.0, own_weight=0.0):
        radius, depth = 50.0, 4.0
        self.x, self.z = np.arange(-radius, radius + 1), depth - radius + 0.5 + np.arange(radius)
        x, z = np.meshgrid(self.x, self.z)
        rise, across, p = speed * np.exp(z / decay), 1 - (x / half_chord) ** 2, 0.8 * (2 - z)
        stretch = -2 * x / half_chord**2 * rise
        fields = {"nu": 0.8 * ((z <= 0) & (np.hypot(x, z - depth) <= radius)), "v_x": rise * across, "v_z": -decay * stretch, "sigma_xx": p, "sigma_zz": p,
                  "sigma_xz": mu * p, "sigma_zx": mu * p, "d_v_x_dx": stretch, "d_v_x_dz": rise * across / decay,
                  "d_v_z_dx": 2 * decay / half_chord**2 * rise, "d_v_z_dz": -stretch}
        header = {"drum_radius": radius, "axis_depth": depth, "rotation": 0.012}
        self.bed = _drumlin.bed(self.x, self.z, fields, {}, header, own_weight=own_weight, smoothing=0.3)
        self.paths = self.bed.paths | {"stress": stress_of(self.bed)}

    def __getattr__(self, name):
        return getattr(self.bed, name)


def remembering(law=KNOWN, noise=0.0, seed=1, **further):
    random = np.random.default_rng(seed)

    def stress(bed):
        stress = known_amount(np.exp(bed.paths["ln_I"])) * bed.axes(*law)
        return stress + noise * (random.normal(size=stress.size) + 1j * random.normal(size=stress.size))

    return Drum(stress, **further)


def table_of(drum):
    """|s|/p over I of a drum's own paths."""
    inertial = np.exp(drum.paths["ln_I"])
    return _drumlin.fitted([[inertial, np.abs(drum.paths["stress"]), 0 * inertial, 0 * inertial]], "table", _drumlin.table_knots(inertial))


def test_known_axes_come_back():
    found = memory.fit(Paths([remembering()], known_amount), KNOWN._replace(c=10, m=0.5, chi=0.2), (True, True, True))
    assert found.converged and found.law == pytest.approx(KNOWN, rel=1e-8)


def test_noisy_axes_come_back_within_their_intervals():
    inside = 0
    for seed in range(1, 7):
        found = memory.fit(Paths([remembering(noise=0.02, seed=seed)], known_amount), KNOWN._replace(c=10, m=0.5, chi=0.2), (True, True, True))
        inside += np.sum(np.abs(np.subtract(found.law[:3], KNOWN[:3])) <= found.ci99_sectors)
    assert inside >= 16  # of 18


def test_the_memory_of_noisy_runs_and_what_they_cannot_tell():
    beds = [remembering(noise=0.02, seed=seed) for seed in (1, 2)]
    found = memory.axes_of(beds, known_amount)
    assert np.all(np.abs(np.subtract(found.free.law[:3], KNOWN[:3])) <= found.free.ci99_sectors)
    assert found.law.c_rho and found.law.m <= 1 and np.all(np.isfinite(found.bed_alone.ci99_runs))
    own, other = (memory.score("drum", Paths([bed], known_amount), found.law)["bed"] for bed in (beds[0], remembering(KNOWN._replace(chi=-0.6))))
    assert own["paths"] > 50 and own["axes_deg"] < own["axes_deg_without_memory"] / 2 and other["axes_deg"] > 2 * own["axes_deg"]
    assert len(memory.axes_on_arcs(Paths(beds, known_amount), found.law, 50)) == 3
    assert any("c_rho" in sentence for sentence in memory.untold(found, table_of(beds[0]), beds))


def test_runs_that_say_too_little_are_refused():
    with pytest.raises(InputError, match="too little bed"):
        memory.axes_of([remembering(speed=20, decay=40)], known_amount)
    with pytest.raises(InputError, match="no drum"):
        _drumlin.bed([0, 1], [0, 1], {}, {}, {"drum_radius": 0, "axis_depth": 0, "rotation": 0})
    few = remembering()
    few.blocks = {key: values[:20] for key, values in few.bed.blocks.items()}
    with pytest.raises(InputError, match="in 20 blocks"):
        command.table_of([few], 16)


def adding(law, **further):
    """A drum whose amount is what `law` adds to mu(I)."""
    axes, ends = KNOWN, (1e-6, 1.0)

    def stress(bed):
        paths = Paths([bed], known_amount)
        return known_amount(paths.I) + amount.Memory(paths, axes, ends).added(law) + 0j

    return Drum(stress, **further)


@pytest.mark.parametrize("own_weight", [0.0, 3.0])
def test_known_amounts_come_back_and_predict_another_speed(own_weight):
    law = {"swelling": 0.008, "c_nu": 4, "c_psi": 16, "lag": 0.05, "creep": {"slope": 0.015, "ratio": 0.05}}
    drum, other = (adding(law, speed=speed, own_weight=own_weight) for speed in (1.5, 2.5))
    found = amount.amount_of([("drum", drum)], [("other", other)], KNOWN, table_of(drum), own_weight)
    assert (found.law["c_nu"], found.law["c_psi"], found.law["creep"]["ratio"], found.law["own_weight"]) == (4, 16, 0.05, own_weight)
    assert found.law["swelling"] == pytest.approx(0.008, abs=2e-4) and found.law["lag"] == pytest.approx(0.05, abs=2e-3)
    assert found.law["creep"]["slope"] == pytest.approx(0.015, abs=1e-3)
    assert found.table.at(np.array([1e-4])) == pytest.approx(known_amount(1e-4), abs=1e-3)
    for zone in ("bed", "flow"):
        assert found.predictions[0][zone]["rms"] < 0.2 * found.predictions[0][zone]["rms_alone"]


def test_an_amount_shows_what_it_lacks():
    hardly = adding({"swelling": 0.002, "c_nu": 4, "c_psi": 16, "lag": 0})
    law = amount.amount_of([("drum", hardly)], [], KNOWN, table_of(hardly), 0.0).law
    assert law["swelling"] == pytest.approx(0.002, abs=1e-4) and abs(law["lag"]) < 1e-3 and law.get("creep", {"slope": 0})["slope"] < 1e-3
    shrinking = adding({"swelling": -0.002, "c_nu": 4, "c_psi": 16, "lag": 0})
    with pytest.raises(InputError, match="leave --amount out"):
        amount.amount_of([("drum", shrinking)], [], KNOWN, table_of(shrinking), 0.0)


def obeying_points(noise=0.0, seed=1):
    """A = 0.6, mu_s = 0.25 over ten sectors: points as spreading.points_of gives them."""
    random = np.random.default_rng(seed)
    inertial, curvature = 10 ** (-5 + 4 * random.random(300)), 0.1 * random.random(300)
    mu = np.maximum(known_amount(inertial), 0.25) - 0.6**2 * curvature + noise * random.normal(size=300)
    return np.array([mu, inertial, curvature, np.arange(300) % 10])


def test_known_length_and_threshold_come_back():
    found = spreading.spreading_of(obeying_points(), known_amount)
    assert found.mu_s == pytest.approx(0.25, abs=0.002) and found.amplitude == pytest.approx(0.6, abs=0.02)  # the step of the thresholds
    assert found.is_told and found.record["rms_bed"] < 2e-3 and found.record["rms_local_bed"] > 5 * found.record["rms_bed"]
    inside = 0
    for seed in range(1, 7):
        noisy = spreading.spreading_of(obeying_points(0.01, seed), known_amount)
        inside += np.sum([abs(noisy.amplitude - 0.6) <= noisy.amplitude_ci99, abs(noisy.mu_s - 0.25) <= noisy.mu_s_ci99 + 0.002])
    assert inside >= 11  # of 12


def test_points_that_creep_ask_for_no_threshold_and_flow_alone_is_refused():
    points = obeying_points(seed=3)
    points[0] = known_amount(points[1]) + 0.01 * np.random.default_rng(4).normal(size=300)
    assert "do not require one" in spreading.spreading_of(points, known_amount).untold()[0]
    points[1] = 0.01
    with pytest.raises(InputError, match="0 points with I < 0.001"):
        spreading.spreading_of(points, known_amount)


def test_the_curvature_of_exponential_decay_is_one_over_its_length_squared():
    layers = Drum(half_chord=1e4, mu=0.25)
    mu, _, curvature, _ = spreading.points_of(layers, layers.x, layers.z)
    assert mu.size > 100 and mu == pytest.approx(0.25, abs=1e-9)
    assert curvature == pytest.approx(1 / 25, abs=1e-4)  # smoothing takes one side alone near the edge of what speaks


def test_the_runs_of_the_bed_give_their_law(data, tmp_path):
    """data/rheology/drum-6rpm-amount.toml, whose solver ended up to 1e-4 of ln c, m and chi short of the minimum."""
    runs = [data / "bed" / f"6rpm-5turns-seed{seed}" for seed in (1, 2)]
    drumlin.command("calibrate", *runs, "-o", tmp_path / "law.toml", "--memory", "--amount", "--own-weight", 4, "--nonlocal", "--draws", 16)
    found, kept = (tomllib.loads(file.read_text(encoding="utf-8")) for file in (tmp_path / "law.toml", data / "rheology" / "drum-6rpm-amount.toml"))
    assert found.keys() == kept.keys()  # no length is told

    def numbers(table):
        return np.concatenate([numbers(table[key]) if isinstance(table[key], dict) else np.ravel(table[key]) for key in sorted(table)])

    assert numbers(found["memory"]) == pytest.approx(numbers(kept["memory"]), rel=1e-4)
    assert {"memory", "nonlocal"} < json.loads((tmp_path / "law.json").read_text(encoding="utf-8")).keys()


def test_a_bed_that_is_refused_leaves_no_files(data, tmp_path):
    with pytest.raises(InputError, match="blocks of the maps alone"):
        drumlin.command("calibrate", data / "bed" / "6rpm-5turns-seed1", "-o", tmp_path / "law.toml", "--memory", "--I-min", 0.07, "--law", "log", "--draws", 20)
    assert not list(tmp_path.iterdir())
