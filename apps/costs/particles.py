"""Sweeps and price lists over a scene of particles. Solvers, tolerances and time steps are compared from one state by the velocities that they lead
to and, on request, by what long runs measure."""

import os
import pathlib
import shutil
import sys
from typing import NamedTuple

from drumlin import _drumlin
from drumlin.errors import InputError
from sweeping import Points, advice, axes_of, ended, json_of, mark_fronts, names_of, numbers_of, say, without_repeats, write_cost

AXES = ["solver", "tolerance", "step"]
# "solver" is of the same step with a much tighter tolerance: what the contact solve alone leaves.
QUANTITIES = ["field", "displacement", "velocity", "energy", "solver"]
STANDARD_STEPS = 16  # of the scene, in the stretch
LARGEST_FLOOR = 0.02
SNAPSHOTS_PER_SECOND = 40  # as in the paper: 400 over a turn of 10 s
LEAST_SNAPSHOTS = 40  # two in each of the twenty batches of an interval


class Settings(NamedTuple):
    """What decides how accurately a step of the grains is solved."""
    solver: str
    tolerance: float  # of the residual
    step_s: float

    @property
    def name(self):
        return f"{self.solver}-tolerance-{self.tolerance:g}-step-{self.step_s:g}"


class Plan(NamedTuple):
    points: list
    reference: Settings  # what the points are measured against
    finest: Settings  # the point closest to it: what the reference itself is worth

    def tight(self, step_s):
        """Of the same step, solved as tightly as the reference."""
        return self.reference._replace(step_s=step_s)


def plan_of(standard, axes, solvers):
    """Every tolerance with every step by the scene's solver, and every other solver at the scene's step."""
    tolerance, step = standard.tolerance, standard.step_s
    tolerances, steps = [tolerance], [step]
    if "tolerance" in axes:
        tolerances = numbers_of("tolerance", axes["tolerance"], [10 * tolerance, 3 * tolerance, tolerance, tolerance / 3, tolerance / 10])
    if "step" in axes:
        steps = numbers_of("step", axes["step"], [2 * step, step, step / 2])
    points = [standard] + [Settings(standard.solver, t, h) for h in steps for t in tolerances]
    if "solver" in axes:
        points += [Settings(name, t, step) for name in names_of("solver", axes["solver"], solvers) for t in tolerances if t >= 0.3 * tolerance]
    least, shortest = min(point.tolerance for point in points), min(point.step_s for point in points)
    return Plan(without_repeats(points), Settings("accelerated", least / 3, shortest / 2), Settings(standard.solver, least, shortest))


def last_followed(errors):
    """The last mark at which the finest point still follows the reference, given its errors of the velocity field at each: two sequences of impacts
    make a difference grow with time, whatever its size was. The first if there is none."""
    return max((mark for mark, error in enumerate(errors) if error is not None and error < LARGEST_FLOOR), default=0)


def work_on(options):
    return _drumlin.ParticleWork(options["scene"], options["set"], options["threads"])


class Sweep:
    """All points of a plan and their report."""

    def __init__(self, options):
        self.options, self.work = options, work_on(options)
        self.facts = facts = self.work.facts
        self.standard = Settings(facts["solver"], facts["tolerance"], facts["step_s"])
        self.plan = plan_of(self.standard, axes_of(options["sweep"], AXES), facts["solvers"])
        self.stretch_s = options["horizon"] or STANDARD_STEPS * self.standard.step_s
        if not options["output"]:
            raise InputError("cost: a sweep needs --output COST for its points")
        start = options["from"] or "the beginning of the last stage"
        shared = {"kind": "particles", "scene": facts["scene"], "from": start, "horizon_s": self.stretch_s, "reference": self.plan.reference._asdict()}
        self.points = Points(options, shared, [options["scene"]] + ([options["from"] + "/run.json"] if options["from"] else []))
        self.work.begin(f"{options['output']}/start.h5", options["from"])
        say(f"{options['scene']}: {self.stretch_s:g} s from {start}, {len(self.plan.points)} points")

    def execute(self):
        reference = self.reference(self.plan.reference)
        finest = self.measured(self.plan.finest)
        horizon = self.horizon(finest)
        say(f"{'processor':>10} {'sweeps':>8} {'missed':>8}" + "".join(f" {name:>12}" for name in QUANTITIES) +
                 "  (processor seconds per simulated one; relative errors)")
        points = [self.flat(settings, horizon) for settings in self.plan.points]
        if self.options["statistics"]:
            self.add_statistics(points)
        mark_fronts(points, QUANTITIES)
        print(advice(points, QUANTITIES, lambda point: (
            f"--set solver.name={point['solver']} --set solver.tolerance={point['tolerance']:g} "
            f"--set stages.{self.facts['last_stage']}.time_step_s={point['step_s']:g}")), end="")
        self.report(finest["marks"], reference["marks"][horizon], horizon, points)

    def stretch(self, settings, **words):
        return self.work.stretch(_drumlin.StretchSettings(*settings, self.stretch_s), **words)

    def marks(self, found):
        steps = found[-1]["steps"]
        return [{"simulated_seconds": self.stretch_s * mark["steps"] / steps, "cpu_seconds": mark["cpu_seconds"], "steps": mark["steps"],
                 "sweeps": mark["sweeps"], "contact_sweeps": mark["contact_sweeps"], "missed_share": mark["missed"] / mark["steps"],
                 "overlap_d": mark["overlap_d"]} for mark in found]

    def reference(self, settings):
        """Keeps where the grains are at each mark, too."""
        def do():
            say(f"reference-{settings.name}")
            load = os.getloadavg()[0]
            found = self.stretch(settings, saved=str(self.points.folder / settings.name))
            return settings._asdict() | {"load_before": load, "marks": self.marks(found["marks"])}

        return self.points.point(f"reference-{settings.name}", do)

    def measured(self, settings):
        def do():
            tight = self.plan.tight(settings.step_s)
            self.reference(tight)
            load = os.getloadavg()[0]
            found = self.stretch(settings, against=[str(self.points.folder / one.name) for one in (self.plan.reference, tight)])
            marks = self.marks(found["marks"])
            for mark, (from_reference, from_tight) in zip(marks, (mark["against"] for mark in found["marks"])):
                mark["errors"] = from_reference | {"solver": from_tight["field"], "solver_velocity": from_tight["velocity"]}
            return settings._asdict() | {"load_before": load, "marks": marks, "cpu_seconds": found["cpu_seconds"] / self.stretch_s}

        return self.points.point(settings.name, do)

    def horizon(self, finest):
        """The mark at which all errors are read."""
        for mark in finest["marks"]:
            floor = {name: "nan" if error is None else f"{error:.2g}" for name, error in mark["errors"].items()}
            say(f"floor after {mark['simulated_seconds']:g} s: field {floor['field']}, displacement {floor['displacement']}, "
                     f"velocity {floor['velocity']}, energy {floor['energy']}")
        return last_followed([mark["errors"]["field"] for mark in finest["marks"]])

    def flat(self, settings, horizon):
        """The point as it stands in cost.json."""
        point = self.measured(settings)
        mark = point["marks"][horizon]
        row = {"name": point["name"], "default": settings == self.standard} | settings._asdict()
        row |= {key: point[key] for key in ("load_before", "cpu_seconds")}
        row |= {key: value for key, value in mark.items() if key not in ("simulated_seconds", "cpu_seconds")}
        errors = (row["errors"][name] for name in QUANTITIES)
        say(f"{row['cpu_seconds']:8.2f} s {mark['sweeps'] / mark['steps']:8.1f} {100 * mark['missed_share']:6.1f} %" +
                 "".join(f" {'-' if error is None else f'{error:.2g}':>12}" for error in errors) +
                 f"  {row['name']}{' (the scene)' if row['default'] else ''}")
        return row

    def add_statistics(self, points):
        """Only with the scene's own solver: the others differ by nothing but their work."""
        seconds = self.options["statistics"]
        for settings, point in zip(self.plan.points, points):
            if settings.solver == self.standard.solver:
                name = f"{settings.name}-over-{seconds:g}-s"
                point["statistics"] = self.points.point(name, lambda settings=settings, name=name: {
                    "statistics": self.long_run(settings, self.points.folder / name)})["statistics"]

    def long_run(self, settings, folder):
        """What a run long enough to be measured shows: from the state of the sweep by `drumlin run` and `drumlin measure`, so that an interrupted one
        goes on from its checkpoint. What it leaves is removed."""
        seconds, load = self.options["statistics"], os.getloadavg()[0]
        snapshots = max(LEAST_SNAPSHOTS, int(SNAPSHOTS_PER_SECOND * seconds + 0.5))
        before = self.work.lay_down(_drumlin.StretchSettings(*settings, seconds), snapshots, str(folder))
        # A run most of whose steps missed a tolerance is a point of the sweep like others, which says so.
        self.run(["run", str(folder / "scene.toml"), "-o", str(folder / "run"), "--threads", str(self.options["threads"]), "--resume"], (0, 3))
        self.run(["measure", str(folder / "run"), "--parts", "none", "--resume"], (0,))
        ran, measured = (json_of(folder / "run" / name) for name in ("run.json", "measured/measured.json"))
        own = ran["steps"] - before
        scalars = {name: {"value": value["value"], "ci99": value["ci99"]} for name, value in measured.items()
                   if isinstance(value, dict) and "value" in value and "ci99" in value}
        shutil.rmtree(folder)
        return {"simulated_seconds": seconds, "cpu_seconds": ran["cpu_seconds"], "steps": float(own),
                "sweeps_mean": ran["cost"]["sweeps_mean"] * ran["steps"] / own, "missed_share": ran["unconverged_steps"] / own, "load_before": load,
                "scalars": scalars}

    @staticmethod
    def run(words, good):
        code, _ = ended(["drumlin", *words])
        if code not in good:
            sys.exit(code)  # it has said why

    def report(self, floors, reference, horizon, points):
        options, facts = self.options, self.facts
        statistics = {"statistics_s": options["statistics"]} if options["statistics"] else {}
        content = {"format": "drumlin-cost-1", "kind": "particles", "title": facts["title"], "reduced": facts["reduced"],
                   "scene_file": os.path.basename(options["scene"]), "threads": options["threads"],
                   "horizon_s": floors[horizon]["simulated_seconds"], "floor": floors[horizon]["errors"],
                   "floors": [{key: mark[key] for key in ("simulated_seconds", "errors")} for mark in floors],
                   "reference": self.plan.reference._asdict() | {"cpu_seconds": reference["cpu_seconds"]},
                   "quantities": QUANTITIES} | statistics | {"points": points, "scene": facts["scene"]}
        self.points.finish(content, "work_precision")
        say(f"{options['output']}/cost.json")


def sweep(options):
    Sweep(options).execute()


def price_effects(options):
    """The scene as it is, each of its effects removed, each absent one added, one after the other: what each takes and changes."""
    work = work_on(options)
    facts, variants = work.facts, work.variants()
    output = options["output"] and _drumlin.StagedOutput(options["output"], "cost", options["resume"], options["overwrite"], [options["scene"]])
    say(f"{options['scene']}: the first {options['seconds']:g} s; results are means over the second half\n" + ("reduced\n" if facts["reduced"] else "") +
        "     time     memory unknowns sweeps  missed energy J/kg centre z   slope   overlap  scene\n"
        "                                                             mm     deg         d")
    rows = []
    # Once more at the end: what differs between the two is noise of the machine.
    for number in [*range(len(variants)), 0]:
        row = dict(variants[number])
        refused = row.pop("refused")
        row["name"] = ("as it is, again" if rows else "as it is") if row["change"] == "none" else (
            ("without " if row["change"] == "removed" else "with ") + row["effect"] + (": " + row["with_it"] if row["with_it"] else ""))
        if refused:
            row["refused"] = refused
            say(f"{'not possible':>88}  {row['name']}: {refused}")
        else:
            row |= work.price(number, options["seconds"])
            slope = "-" if row["slope_deg"] is None else f"{row['slope_deg']:.2f}"
            say(f"{row['cpu_seconds']:7.2f} s {row['bytes'] / (1 << 20):7.2f} MB {row['unknowns']:8.0f} {row['sweeps']:6.1f} "
                f"{100 * row['missed_share']:5.1f} % {row['kinetic_energy_J_kg']:10.3g} {row['center_of_mass_mm'][1]:8.2f} {slope:>7} "
                f"{row['overlap_d']:9.2g}  {row['name']}")
        rows.append(row)
    if output:
        command = f"drumlin cost --effects {os.path.basename(options['scene'])} --seconds {options['seconds']:g} --threads {options['threads']}"
        write_cost(pathlib.Path(output.folder), {
            "format": "drumlin-effect-prices-1", "title": facts["title"], "reduced": facts["reduced"], "command": command,
            "simulated_seconds": options["seconds"], "threads": options["threads"], "variants": rows}, "price_figures")
        output.publish()
