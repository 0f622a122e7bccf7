"""Sweeps and price lists over a flow of the continuum: meshes, eps and tolerances compared by the scalars and the profile of v_x, effects by what they
change. Each flow is solved by drumlin-flow, of which nothing but its numbers is kept."""

import math
import os
import shutil
import statistics
import subprocess
from typing import NamedTuple

import result_files
import whole_file
from drumlin import _drumlin
from drumlin.errors import InputError, IoError, NotConvergedError
from sweeping import Points, advice, axes_of, ended, json_of, mark_fronts, number_or_none, numbers_of, plain, say, without_repeats

FIELDS = {"mesh": "levels", "eps": "eps", "tolerance": "tolerance"}  # of Settings, by axis
AXES = list(FIELDS)
# Each at the strength that a scene which does not name it gets; k is a part of the law.
EFFECTS = {"inertia": "effects.inertia={}", "wall_slip": "effects.wall_slip={friction=0.95}", "rotating_frame": "effects.rotating_frame={}", "k": None,
           "nonlocal": "effects.nonlocal={length=1}", "moving_surface": "effects.moving_surface={}"}


class Settings(NamedTuple):
    """What decides how accurately a flow is solved."""
    levels: int  # number of meshes; the coarsest is that of the scene
    eps: float  # regularisation of the shear rate, sqrt(g/d)
    tolerance: float  # of Newton's method

    @property
    def name(self):
        return f"levels-{self.levels}-eps-{self.eps:g}-tolerance-{self.tolerance:g}"


class Flow(NamedTuple):
    """A flow to be solved, and how."""
    name: str
    scene: str
    law: str
    changes: list  # as for --set, beside no sensitivities and no figures
    ranks: int = 1
    start: str | None = None  # folder of a neighbour to start from
    against: tuple = ()  # measured runs that it is compared with


def changes_of(settings, standard, surface_cell):
    """The settings as changes of the scene's keys. `surface_cell` is the cell of the scene at its surface (d): it halves with each further mesh."""
    return [f"mesh.levels={settings.levels}", f"mesh.surface_cell={plain(surface_cell * 2.0 ** (standard.levels - settings.levels))}",
            f"regularisation.shear_rate={plain(settings.eps)}", f"solver.tolerance={plain(settings.tolerance)}"]


def curves_of(standard, axes):
    """{axis: points from the coarsest to the finest}, each through the scene with the other settings its own."""
    values_of = {"mesh": list(range(1, standard.levels + 2)), "eps": [standard.eps * factor for factor in (1000, 100, 10, 1)] + [standard.eps / 10],
                 "tolerance": [1e-2, 1e-4, 1e-6, standard.tolerance]}
    curves = {}
    for axis, words in axes.items():
        values = numbers_of(axis, words, values_of[axis])
        if axis == "mesh":
            if any(value != math.floor(value) or value > 8 for value in values):
                raise InputError("--sweep mesh: its values are numbers of meshes (allowed: integer >= 1 and <= 8)")
            values = map(int, values)
        points = [standard, *(standard._replace(**{FIELDS[axis]: value}) for value in values)]
        curves[axis] = sorted(without_repeats(points), key=lambda point: (point.levels, -point.eps, -point.tolerance))
    return curves


def reference_of(standard, curves):
    """Finer than every point in mesh and eps where they are varied; no tighter: rounding is near, and the last step of Newton's method leaves far less
    than it was asked for."""
    last = {axis: points[-1] for axis, points in curves.items()}
    return Settings(last["mesh"].levels + 1 if "mesh" in last else standard.levels, last["eps"].eps / 10 if "eps" in last else standard.eps,
                    last["tolerance"].tolerance if "tolerance" in last else standard.tolerance)


def scalar_differences(here, there):
    """Relative, without what is 0 or not known."""
    return {name: abs(here[name] / value - 1) for name, value in there.items() if value and here.get(name) is not None}


def profile_difference(here, there):
    """Rms of the difference over rms of `there`, where both have material; None where their layers differ in number."""
    pairs = [(a, b) for a, b in zip(here, there) if a is not None and b is not None]
    size = sum(b * b for _, b in pairs)
    return math.sqrt(sum((a - b) ** 2 for a, b in pairs) / size) if len(here) == len(there) and size > 0 else None


def differences(flow, reference):
    """Of a solved point from another one: each scalar, then v_x."""
    return scalar_differences(flow["scalars"], reference["scalars"]) | {"v_x": profile_difference(flow["profile"]["v_x"], reference["profile"]["v_x"])}


def closed_form_errors(flow):
    closed = flow["closed_form"]
    return scalar_differences(flow["scalars"], closed["scalars"]) | {name: closed[name] for name in ("v_x", "v_x_mesh")}


def variants_of(words):
    """{name: effects} of words such as "inertia+k" and "none"; without any word each effect alone."""
    variants = {word: [] if word == "none" else word.split("+") for word in words or EFFECTS}
    for word, effects in variants.items():
        for place, name in enumerate(effects):
            if name not in EFFECTS:
                raise InputError(f"--variants: '{name}' is no effect of a flow (allowed: none; {', '.join(EFFECTS)}, joined by +)")
            if name in effects[:place]:
                raise InputError(f"--variants: {name} is named twice in '{word}'")
    return variants


def spread(values):
    return {"least": min(values), "median": statistics.median(values)}


def asks_for_work(options):
    """Whether the options ask for more than one solve of each flow."""
    return options["repeats"] > 1 or bool(options["neighbour"]) or options["ranks"] != [1]


def results_in(folder):
    """The numbers of a solved flow, as its point has them."""
    flow = json_of(folder / "flow.json")
    point = {key: flow[key] for key in ("geometry", "unknowns", "iterations", "seconds", "cpu_seconds", "start", "settings", "phases")}
    table = result_files.read_table(folder / "iterations.csv")[2]
    # One assembly before the first iteration of a phase, one after each; on meshes that have a flow.
    finest = flow["settings"]["levels"] + flow["added_meshes"] - 1
    unknowns = {finest - place: mesh["unknowns"] for place, mesh in enumerate(reversed(flow["meshes"]))}
    point["assembled_unknowns"] = float(sum(unknowns.get(mesh, 0) * (2 if iteration == 1 else 1) for mesh, iteration in zip(table["mesh"], table["iteration"])))
    point["scalars"] = {name: value for name, value in flow["meshes"][-1].items() if name not in ("cells", "unknowns")}
    point["peak_memory_mb"] = max(rank["peak_memory_mb"] for rank in flow["rank_costs"])
    if flow["closed_form"]:
        closed = flow["closed_form"]
        point["closed_form"] = {"v_x": closed["closed_form_error"], "v_x_mesh": closed["mesh_error"], "scalars": closed["scalars"]}
    profiles = result_files.read_table(folder / "profiles.csv")[2]
    point["profile"] = {"z": profiles["z"].tolist(), "v_x": [number_or_none(value) for value in profiles["v_x"].tolist()]}
    return point


def entry_of(flow, repetitions):
    """The numbers of an entry under "work", of the repetitions of one solve."""
    entry = {"ranks": flow.ranks, "start": "neighbour" if flow.start else "cold"}
    failed = [one["failure"] for one in repetitions if "failure" in one]
    if failed:
        return entry | {"failure": failed[0]}
    first = repetitions[0]
    entry |= {key: first[key] for key in ("unknowns", "iterations", "assembled_unknowns")}
    entry["load_before"] = [one["load_before"] for one in repetitions]
    entry |= {key: spread([one[key] for one in repetitions]) for key in ("seconds", "cpu_seconds")}
    entry["phases"] = {name: {"times": phase["times"], "seconds": spread([one["phases"][name]["seconds"] for one in repetitions])}
                       for name, phase in first["phases"].items()}
    return entry | {"peak_memory_mb": max(one["peak_memory_mb"] for one in repetitions)}


class Flows:
    """Solves flows as points of a folder; subclasses plan them."""

    def __init__(self, kind, options):
        self.options = options
        self.facts = facts = _drumlin.flow_facts(options["scene"], options["set"], options["rheology"])
        shared = {"kind": kind, "scene": facts["scene"], "rheology": facts["law"]}
        shared |= {key: options[name] for key, name in (("neighbour", "neighbour"), ("time_limit_s", "time-limit"), ("against", "against")) if options[name]}
        self.points = Points(options, shared, [options["scene"], options["rheology"]])

    def solved(self, flow):
        """Cost, scalars and profile of v_x; "failure" in place of results where no flow was found within the time."""
        def do():
            folder = self.emptied(flow.name)
            point = {"changes": flow.changes, "load_before": os.getloadavg()[0]} | self.solve(folder, flow)
            if flow.against and "failure" not in point:
                point["against"] = self.compared(folder, flow.against)
            self.emptied(flow.name)
            return point

        return self.points.point(flow.name, do)

    def emptied(self, name):
        """A folder for a flow, without what a call has left there that was cut off."""
        folder = self.points.folder / name
        if folder.exists():
            shutil.rmtree(folder)
        return folder

    def solve(self, folder, flow):
        limit = self.options["time-limit"]
        words = [flow.scene, "--rheology", flow.law, "-o", str(folder)] + (["--from", flow.start] if flow.start else [])
        words += [word for change in ["solver.sensitivity=false", "output.figures=false", *flow.changes] for word in ("--set", change)]
        code, _ = ended(["drumlin-flow", *words], flow.ranks, limit, subprocess.DEVNULL)
        if code == 2:
            raise InputError(f"{flow.name}: drumlin-flow refused the scene or the law")
        if code not in (0, 3, None):
            raise IoError(f"{flow.name}: drumlin-flow ended with exit code {code}")
        if code is None:
            failure = f"the flow was not found within {limit:g} s"
        elif not (folder / "flow.json").exists():
            failure = "the flow did not converge"
        elif code == 3 and flow.against:
            failure = json_of(folder / "flow.json")["missed"][0]
        else:  # how far a mesh or an eps is off is what a sweep measures; nobody compares such a flow with runs
            return results_in(folder)
        return {"failure": failure, "cpu_seconds": None}

    def compared(self, folder, runs):
        """Errors of the flow against measured runs, by `drumlin compare --study`: targets, verdict, scalars of both."""
        study = folder / "study"
        code, said = ended(["drumlin", "compare", "-o", str(study), "--study", *runs, str(folder)], output=subprocess.PIPE)
        if code == 2:
            raise InputError("--against: the flow and the runs cannot be compared:\n" + said)
        if code:
            raise IoError(f"drumlin compare --study ended with exit code {code}:\n{said}")
        speeds = json_of(study / "study.json")["speeds"]
        if len(speeds) != 1:
            raise InputError("--against: the runs are not all of the flow's speed of rotation")
        return {key: speeds[0][key] for key in ("scalars", "targets", "verdict")}

    def with_work(self, row, flow, once):
        """The row with what the flow costs cold and from its neighbour, on each number of ranks, each repeated, as the options ask. `once`: solved
        cold on one rank."""
        if not asks_for_work(self.options):
            return row
        work = []
        for ranks in self.options["ranks"] if "failure" not in once else []:
            for cold in (True, False) if self.options["neighbour"] else (True,):
                one = flow._replace(name=flow.name + (f"-ranks-{ranks}" if ranks > 1 else ""), ranks=ranks, against=())
                if not cold:
                    one = one._replace(name=one.name + "-from-neighbour", start=self.neighbour_of(flow))
                names = [one.name] + [f"{one.name}-again-{again}" for again in range(2, self.options["repeats"] + 1)]
                work.append(entry_of(one, [self.solved(one._replace(name=name)) for name in names]))
                self.say_work(work[-1])
        return row | {"work": work}

    def neighbour_of(self, flow):
        """The neighbour's folder, which other flows can start from; solved now if it is not there."""
        neighbour = flow._replace(name=flow.name + "-neighbour", changes=flow.changes + self.options["neighbour"], against=())
        folder = self.points.folder / neighbour.name
        if not _drumlin.holds_results(str(folder), "flow.json"):
            found = self.solve(self.emptied(neighbour.name), neighbour)
            if "failure" in found:
                raise NotConvergedError(f"--neighbour: {found['failure']}")
        return str(folder)

    def say_work(self, entry):
        name = f"{entry['ranks']} rank{'s' if entry['ranks'] > 1 else ''}, {'cold' if entry['start'] == 'cold' else 'from a neighbour'}"
        say(f"    {name}: " + (entry["failure"] if "failure" in entry else (
            f"{entry['iterations']} iterations, {entry['seconds']['least']:.1f} s least, {entry['seconds']['median']:.1f} s median, "
            f"{entry['cpu_seconds']['least']:.1f} s of processors, {entry['peak_memory_mb']:.0f} MB")))

    def head(self, settings):
        return {"title": settings["title"], "reduced": self.facts["reduced"], "scene_file": os.path.basename(self.options["scene"]), "law": settings["law"]}


class Sweep(Flows):
    """One curve through the scene for each axis."""

    def __init__(self, options):
        if not options["output"]:
            raise InputError("cost: a sweep needs --output COST for its points")
        if options["against"] or options["variants"]:
            raise InputError("cost: --against and --variants go with --effects")
        self.axes = axes_of(options["sweep"], AXES)
        super().__init__("continuum", options)
        self.standard, self.surface_cell = None, 0

    def execute(self):
        say(f"{self.options['scene']}: the scene as it is")
        as_it_is = self.solved(self.flow("as-it-is", []))
        if "failure" in as_it_is:
            raise NotConvergedError(f"{self.options['scene']}: {as_it_is['failure']}")
        settings = as_it_is["settings"]
        self.standard = Settings(settings["levels"], settings["regularisation_shear_rate"], settings["tolerance"])
        self.surface_cell = settings["surface_cell"]
        curves = curves_of(self.standard, self.axes)
        solved, rows = {}, {}
        for here in without_repeats([point for curve in curves.values() for point in curve]):
            default = here == self.standard
            flow = self.flow("as-it-is", []) if default else self.flow_with(here)
            found = solved[here] = self.solved(flow)
            row = {"name": here.name, "default": default, "axes": [axis for axis, curve in curves.items() if here in curve]} | here._asdict()
            row |= {key: found[key] for key in ("unknowns", "iterations", "seconds", "cpu_seconds", "load_before", "scalars", "closed_form", "failure")
                    if key in found}
            seconds = "-" if found["cpu_seconds"] is None else f"{found['cpu_seconds']:.2f}"
            say(f"{seconds:>9} s  {row['name']}" + (f": {found['failure']}" if "failure" in found else ""))
            rows[here] = self.with_work(row, flow, found)
        reference = None if "closed_form" in as_it_is else self.reference(curves)
        points = list(rows.values())
        for here, row in rows.items():
            row |= self.errors(here, solved, curves, reference)
        quantities = without_repeats([name for row in points for name in row["errors"]])
        mark_fronts(points, quantities)
        self.say_table(points, quantities)
        print(advice(points, quantities, lambda point: "--set " + " --set ".join(
            changes_of(Settings(*(point[key] for key in Settings._fields)), self.standard, self.surface_cell))), end="")
        content = {"format": "drumlin-cost-1", "kind": "continuum"} | self.head(settings) | {
            "reference": "closed form" if reference is None else {
                key: reference[key] for key in ("levels", "eps", "tolerance", "unknowns", "cpu_seconds", "scalars")},
            "quantities": quantities, "points": points, "scene": self.facts["scene"]}
        self.points.finish(content, "work_precision")
        say(f"{self.options['output']}/cost.json")

    def flow(self, name, changes):
        return Flow(name, self.options["scene"], self.options["rheology"], self.options["set"] + changes)

    def flow_with(self, settings):
        return self.flow(settings.name, changes_of(settings, self.standard, self.surface_cell))

    def reference(self, curves):
        finest = reference_of(self.standard, curves)
        say(f"{'':>11}  reference {finest.name}")
        found = self.solved(self.flow_with(finest))
        if "failure" in found:
            raise NotConvergedError(f"the reference ({finest.name}) was not found: sweep over coarser values")
        return found | finest._asdict()

    @staticmethod
    def errors(settings, solved, curves, reference):
        """Against the reference or the closed form, and by axis against the finest point of that curve: what this setting does with the others fixed."""
        flow = solved[settings]
        if "failure" in flow:
            return {"errors": {}, "errors_alone": {}}
        alone = {axis: differences(flow, solved[curve[-1]]) for axis, curve in curves.items()
                 if settings in curve[:-1] and "failure" not in solved[curve[-1]]}
        return {"errors": closed_form_errors(flow) if reference is None else differences(flow, reference), "errors_alone": alone}

    def say_table(self, points, quantities):
        def cell(point, name):
            error = point["errors"].get(name)
            return f" {'-' if error is None else f'{error:.2g}' + ('*' if name in point['pareto'] else ' '):>12}"

        say(f"{'processor':>10}" + "".join(f" {name:>12}" for name in quantities) + "  (relative errors; * on the front)")
        for point in points:
            if "failure" not in point:
                say(f"{point['cpu_seconds']:8.2f} s" + "".join(cell(point, name) for name in quantities) +
                         f"  {point['name']}{' (the scene)' if point['default'] else ''}")


class Prices(Flows):
    """The flow without any effect, with each alone or some together, and as it is; on request against measured runs."""

    def execute(self, variants):
        options, facts, folder = self.options, self.facts, self.points.folder
        scene, plain_law = str(folder / "plain-scene.toml"), str(folder / "plain-law.toml")
        whole_file.write_text(scene, facts["plain_scene"])
        whole_file.write_text(plain_law, facts["plain_law"])
        say(f"{options['scene']}: processor seconds, iterations, scalars (what the effect changes)")
        against = tuple(options["against"])
        flows = {"none": Flow("none", scene, plain_law, [], against=against)}
        for name, effects in variants.items():
            if effects:  # the one without any stands first
                changes = [facts["named"].get(effect, EFFECTS[effect]) for effect in effects]
                flows[name] = Flow(name, scene, options["rheology"] if "k" in effects else plain_law, [change for change in changes if change],
                                   against=against)
        if facts["named"] or facts["law_has_k"]:
            flows["as it is"] = Flow("as-it-is", options["scene"], options["rheology"], options["set"], against=against)
        # What differs between the two is noise of the machine.
        flows["none, again"] = flows["none"]._replace(name="none-again")
        rows, base = [], None
        for name, flow in flows.items():
            if "k" in variants.get(name, []) and not facts["law_has_k"]:
                rows.append({"effect": name, "refused": "the law has no table [k]"})
                self.say_row(rows[-1])
                continue
            point = self.solved(flow)
            base = base or point
            if "failure" in base:
                raise NotConvergedError(f"without any effect: {base['failure']}")
            row = self.row(name, point, base)
            self.say_row(row)
            rows.append(self.with_work(row, flow, point))
        names = {"against": [os.path.basename(run) for run in options["against"]]} if options["against"] else {}
        self.points.finish({"format": "drumlin-flow-effect-prices-1"} | self.head(base["settings"]) | names | {"effects": rows}, "price_figures")

    @staticmethod
    def row(name, point, base):
        keys = ("changes", "load_before", "unknowns", "iterations", "seconds", "cpu_seconds", "scalars", "failure", "against")
        row = {"effect": name} | {key: point[key] for key in keys if key in point}
        if "failure" in point:
            return row
        change = {scalar: point["scalars"][scalar] - value for scalar, value in base["scalars"].items()
                  if value is not None and point["scalars"].get(scalar) is not None}
        return row | {"change": change, "v_x_change": profile_difference(point["profile"]["v_x"], base["profile"]["v_x"])}

    def say_row(self, row):
        name, failure = f"{row['effect']:<16}", row.get("refused", row.get("failure"))
        if failure:
            say(f"{name} {failure}")
            return
        text = f"{name} {row['cpu_seconds']:8.1f} s {row['iterations']:6}"
        text += "".join(f"  {scalar} {row['scalars'][scalar]:.4g} ({change:+.2g})" for scalar, change in row["change"].items())
        if row["v_x_change"] is not None:
            text += f"  v_x {100 * row['v_x_change']:.2g} %"
        if "against" in row:  # a star where a target is missed
            against = row["against"]
            text += "\n    " + "".join(f"  {target['quantity']}{' ' + target['zone'] if 'zone' in target else ''} {target['value']:.3f}"
                                       f"{'*' if target['outcome'] == 'missed' else ''}" for target in against["targets"] if target["value"] is not None)
            text += f"  ({against['verdict']['met']} met, {against['verdict']['missed']} missed)"
        say(text)


def sweep(options):
    Sweep(options).execute()


def price_effects(options):
    """As Prices."""
    if not options["output"]:
        raise InputError("cost: the effects of a flow need --output COST for its points")
    variants = variants_of(options["variants"])
    Prices("continuum effects", options).execute(variants)
