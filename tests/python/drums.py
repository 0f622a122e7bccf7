"""Measured runs of the paper's drum, and flows that show the same, made from known laws; as objects and as folders."""

import csv
import json
import math

import numpy as np
from drumlin import study

SPEEDS = (2, 4, 5, 6, 10, 15)
TIME_S = 0.018340976999845687
COLUMNS = ("z", "v_x", "v_z", "shear_rate", "nu", "sigma_zz", "sigma_zz_kinetic", "I", "mu", "k", "sigma_xx", "sigma_xz", "dv")


def drum_run(rpm, noise=None, mu_per_rpm=0.0):
    """H = 3 sqrt(Q), tan(theta) = 0.31 + 1.9e-3 Q, mu = 0.35 + 0.013 ln I (+ mu_per_rpm rpm); every number has an interval of 3 %, and `noise`, a random
    generator, moves the scalars by their standard errors."""
    Q = 3.65 * rpm
    theta, H, rate, decay = math.degrees(math.atan(0.31 + 1.9e-3 * Q)), 3 * math.sqrt(Q), 0.15, 3
    scalars = {"Q": Q, "theta_deg": theta, "theta_com_deg": theta, "H": H, "shear_rate": rate, "lambda": decay, "I_th": 0.018, "mu_a": 0.35, "mu_b": 0.013,
               "nu_bulk": 0.82}
    scalars = {name: study.Scalar(value * (1 + (0.03 / 2.576 * noise.normal() if noise else 0)), 0.03 * value) for name, value in scalars.items()}
    z = np.arange(-63.5, 0)
    local = np.where(z > -H, rate, rate * np.exp((z + H) / decay))
    sigma, inertial = -0.77 * z, local / np.sqrt(-0.77 * z)
    mu = 0.35 + 0.013 * np.log(inertial) + mu_per_rpm * rpm
    values = (z, np.where(z > -H, rate * (z + H + decay), local * decay), 0 * z, local, np.where(z > -H, 0.80, 0.82), sigma, 0.001 * sigma, inertial, mu,
              1 + 0 * z, sigma, mu * sigma, 2.65 * local)
    columns = dict(zip(COLUMNS, values)) | {name + "_ci99": 0.03 * abs(value) for name, value in list(zip(COLUMNS, values))[1:]}
    header = {"reduced": "false", "theta_deg": str(theta), "axis_depth": "4", "slice_width": "20", "rotation": str(rpm * math.pi / 30 * TIME_S),
              "drum_radius": "68.1818", "diameter_m": "0.0033", "wall_z": "-64", "position": "0", "side": "particles"}
    identity = {"reduced": "false", "drum_radius": "68.1818", "grains.generated.count": 7183}
    return study.Run(f"rpm-{rpm:g}", f"rpm-{rpm:g}", rpm, study.Profile(header, columns), scalars, identity, {}, line=(-0.7 * H, -0.5))


def six_speeds(**laws):
    return [drum_run(rpm, **laws) for rpm in SPEEDS]


def flow(rpm, fitted_on=("rpm-6",)):
    """The flow that shows what drum_run() shows, without intervals."""
    run = drum_run(rpm)
    run.name = run.folder = f"flow-{rpm:g}"
    run.profile.header["side"] = "continuum"
    run.profile.columns = {name: run.profile.columns[name] for name in COLUMNS}
    run.scalars = {name: study.Scalar(run.scalars[name].value) for name in ("theta_deg", "Q")}
    run.identity = {"law": "mu = 0.35 + 0.013 ln I", "effects": "nothing"}
    run.cpu_seconds, run.start, run.fitted_on = 5.0, "cold", list(fitted_on)
    return run


def _write_profile(path, run, lower=0):
    """z counted from a surface that lies `lower` d nearer to the drum's axis."""
    header = run.profile.header | {"axis_depth": str(4 - lower)}
    columns = run.profile.columns | {"z": run.profile.z - lower}
    names = [name for column in COLUMNS for name in (column, column + "_ci99") if name in columns]
    with open(path, "w", newline="", encoding="utf-8") as stream:
        stream.write("# drumlin-profiles-1\n" + "".join(f"# {key} = {value}\n" for key, value in sorted(header.items())))
        csv.writer(stream, lineterminator="\n").writerows([names, *zip(*(columns[name].tolist() for name in names))])


def _settings(run):
    return {"rotation": run.profile.number("rotation"), "scales": {"length_m": 0.0033, "time_s": TIME_S, "density_kg_m3": 2700}}


def write_run(folder, run, name=None, scene=None, **settings):
    """A run folder as `drumlin run` and `drumlin measure` leave it, without its snapshots; returns it."""
    path = folder / (name or run.name)
    (path / "measured").mkdir(parents=True, exist_ok=True)
    (path / "run.json").write_text(json.dumps({"format": "drumlin-run-1", "status": "finished", "cpu_seconds": 200.0}), encoding="utf-8")
    content = {"format": "drumlin-measured-1", "reduced": run.profile.header["reduced"] == "true"} | {
        key: {"value": value, "ci99": ci99} for key, (value, ci99) in run.scalars.items()}
    content |= {"fits": {"decay_log_rate": 0.5, "fit_bottom": run.line[0], "fit_top": run.line[1]}, "settings": {"linear_share": 0.3, "decay_window_below_H": [2, 8]} | settings | _settings(run), "steadiness": {"steady": not run.warnings, "reasons": run.warnings}}
    (path / "measured" / "measured.json").write_text(json.dumps(content), encoding="utf-8")
    if scene is not None:
        (path / "scene.toml").write_text(scene, encoding="utf-8")
    _write_profile(path / "measured" / "profiles.csv", run)
    return path


def write_flow(folder, run, effects="", lower=0, geometry="drum"):
    """A flow folder as `drumlin flow` leaves it, without maps and figures; returns it."""
    path = folder / run.name
    path.mkdir(parents=True, exist_ok=True)
    law = {"law": "log", "a": 0.35, "b": 0.013, "fitted_on": run.fitted_on}
    content = {"format": "drumlin-flow-run-2", "reduced": False, "geometry": geometry, "cpu_seconds": run.cpu_seconds, "start": run.start,
               "settings": {"law": law} | _settings(run)} | {key: value.value for key, value in run.scalars.items()}
    (path / "flow.json").write_text(json.dumps(content), encoding="utf-8")
    (path / "flow_scene.toml").write_text("[effects]\n" + effects, encoding="utf-8")
    _write_profile(path / "profiles.csv", run, lower)
    return path
