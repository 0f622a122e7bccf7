"""Model of what discs on ranks cost, from its records, drawn as strong and weak scaling to 1e8 discs and 10,000 cores (docs/scaling.md).

usage: scaling_model.py DATA_FOLDER MODEL.json FIGURE.png

DATA_FOLDER holds cost/ranks.json and cost/sweeps-over-size.json. The seconds of one rank and the sweeps of four sizes make the model, those of two ranks
check it. The network is assumed, not measured; so is the serial work of an impact (a first look at a profile).
"""

import json
import math
import pathlib
import sys

import matplotlib.pyplot as plt

import style
import whole_file

NETWORK = {"latency_s": 2e-6, "bytes_per_s": 1e10}  # assumed: a message between nodes
ROUNDS_PER_SWEEP, ROUNDS_PER_STEP = 4, 50  # messages to each neighbour; sums over all ranks besides one per sweep (docs/scaling.md)
SHARE_OF_LARGEST = 1.1  # contacts of the rank that has most over the mean: the shares are made anew beyond (docs/decisions/ranks.md)
# Candidates and grains near impacts pass through one rank: bytes there and back (docs/decisions/ranks.md), and its work (first look). Their share is
# that of 7183 discs at 6 rpm, assumed for all sizes.
BYTES_PER_CANDIDATE, BYTES_PER_GRAIN, SERIAL_S_PER_CONTACT = 56, 48 + 32, 16e-9
NEAR_IMPACTS = 0.1
DISCS = (1e6, 1e8)
DISCS_PER_CORE = 1e4
CORES = [round(10 ** (k / 4)) for k in range(17)]


def best(case, way):
    return min(case["calls"][way], key=lambda call: call["wall_seconds_per_step"])


def line_through(cases, way):
    """Seconds per contact and step = a + b sweeps, from two sizes."""
    (x_0, y_0), (x_1, y_1) = [(call["sweeps_per_step"], call["wall_seconds_per_step"] / call["contacts_mean"])
                              for call in (best(case, way) for case in cases)]
    b = (y_1 - y_0) / (x_1 - x_0)
    return {"s_per_contact": y_0 - b * x_0, "s_per_contact_and_sweep": b}


def power_of_sweeps(cases):
    """sweeps = at_7183 (discs/7183)^power of the flows: least squares of the logarithms."""
    points = [(math.log(case["discs"]), math.log(case["flowing"]["sweeps_last_200_steps"]["mean"])) for case in cases]
    x_mean, y_mean = (sum(values) / len(points) for values in zip(*points))
    power = sum((x - x_mean) * (y - y_mean) for x, y in points) / sum((x - x_mean) ** 2 for x, _ in points)
    return {"power": power, "at_7183": math.exp(y_mean + power * (math.log(7183) - x_mean))}


def fitted(data):
    measured = json.loads((data / "cost/ranks.json").read_text(encoding="utf-8"))["cases"]
    ranks = [case for case in measured if not case.get("lying") and not case.get("flowing")]  # those that fall and settle
    sizes = json.loads((data / "cost/sweeps-over-size.json").read_text(encoding="utf-8"))["cases"]
    flows = {case["discs"]: case["flowing"] for case in sizes}
    # Bytes over a straight cut, by the root of the discs: of the packing that lies.
    cut = best(ranks[0], "2 ranks")["ranks"][0]["halo_bytes_per_sweep"] / math.sqrt(ranks[0]["discs"])
    # What two ranks on one machine wait for includes what they do not share alike: no less than their latency.
    call = best(ranks[0], "2 ranks")
    waits = min(rank["waiting_seconds"] for rank in call["ranks"]) / ((ROUNDS_PER_SWEEP + 1) * call["sweeps_per_step"] + ROUNDS_PER_STEP)
    return ranks, {"one_process": line_through(ranks, "one process"), "one_rank": line_through(ranks, "1 rank"), "sweeps": power_of_sweeps(sizes),
                   "sweeps_of_100000": flows[100000]["sweeps_last_200_steps"]["mean"], "contacts_per_disc": flows[100000]["contacts_mean"] / 100000,
                   "bytes_per_sweep_over_root_of_discs": cut, "wait_per_round_here_s": waits}


def seconds(model, discs, cores, sweeps, impacts, contacts=None, net=NETWORK):
    """Of a step; contacts: of the rank that has most. Four straight cuts bound a rank."""
    share = SHARE_OF_LARGEST if cores > 1 else 1
    most = contacts or share * model["contacts_per_disc"] * discs / cores
    rank = model["one_rank"]
    time = most * (rank["s_per_contact"] + sweeps * rank["s_per_contact_and_sweep"])
    if cores == 1:
        return time
    bytes_sent = 4 * model["bytes_per_sweep_over_root_of_discs"] * math.sqrt(discs / cores)
    sums = 2 * net["latency_s"] * math.ceil(math.log2(cores))
    time += sweeps * (ROUNDS_PER_SWEEP * net["latency_s"] + bytes_sent / net["bytes_per_s"] + sums) + ROUNDS_PER_STEP * sums
    candidates = impacts * model["contacts_per_disc"] * discs
    time += candidates * SERIAL_S_PER_CONTACT + (BYTES_PER_CANDIDATE * candidates + BYTES_PER_GRAIN * impacts * discs) / net["bytes_per_s"]
    return time


def checked(model, ranks):
    """Two ranks of one machine, where a round takes what it takes here and impacts are within the fit."""
    here = {"latency_s": model["wait_per_round_here_s"] / 2, "bytes_per_s": math.inf}
    found = []
    for case in ranks:
        call = best(case, "2 ranks")
        most = max(rank["contacts_mean"] for rank in call["ranks"])
        predicted = seconds(model, case["discs"], 2, call["sweeps_per_step"], 0, most, here)
        measured = call["wall_seconds_per_step"]
        found.append({"discs": case["discs"], "ranks": 2, "measured_s": measured, "predicted_s": predicted, "relative_error": predicted / measured - 1})
    return found


def sweeps_of(model, discs, stay):
    return model["sweeps_of_100000"] if stay else model["sweeps"]["at_7183"] * (discs / 7183) ** model["sweeps"]["power"]


# Whether sweeps stay those of 100,000 discs, and the share of grains that impacts send to one rank. How sweeps grow beyond that size is not measured.
STATES = {"as it is, sweeps that grow on as measured": (False, NEAR_IMPACTS), "as it is, sweeps as of 100,000": (True, NEAR_IMPACTS),
          "no impacts, sweeps as of 100,000": (True, 0)}


def curves(model):
    strong = {f"{discs:.0e}": {name: [seconds(model, discs, cores, sweeps_of(model, discs, stay), impacts) for cores in CORES]
                               for name, (stay, impacts) in STATES.items()} for discs in DISCS}
    weak = {name: [seconds(model, DISCS_PER_CORE * cores, cores, sweeps_of(model, DISCS_PER_CORE * cores, stay), impacts) for cores in CORES]
            for name, (stay, impacts) in STATES.items()}
    return strong, weak


def draw(model, strong, weak, file):
    style.use_style()
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.2))
    styles = dict(zip(STATES, ("-", "--", ":")))
    for color, (discs, states) in zip((style.PARTICLES, style.CONTINUUM), strong.items()):
        for name, values in states.items():
            left.loglog(CORES, values, styles[name], color=color, label=f"{float(discs):,.0f} discs" if values is next(iter(states.values())) else None)
        left.loglog(CORES, [next(iter(states.values()))[0] / cores for cores in CORES], color="0.8", linewidth=1, zorder=0)
    left.set_title("strong scaling")
    for name, values in weak.items():
        right.loglog(CORES, values, styles[name], color=style.PAPER, label=name)
    right.set_title(f"weak scaling, {DISCS_PER_CORE:,.0f} discs a core")
    for axes in (left, right):
        axes.set_xlabel("cores, one rank each")
        axes.set_ylabel("seconds per step")
        axes.legend(loc="best")
    figure.suptitle("Modelled, not measured: a flow to a residual of 1e-2; grey: in proportion to the cores; lines as on the right", fontsize=12)
    style.save(figure, pathlib.Path(file), False)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    ranks, model = fitted(pathlib.Path(sys.argv[1]))
    strong, weak = curves(model)
    content = {"format": "drumlin-scaling-model-1", "command": "apps/figures/isolated.py apps/figures/scaling_model.py data MODEL.json FIGURE.png",
               "from": ["cost/ranks.json", "cost/sweeps-over-size.json"], "network_assumed": NETWORK, "serial_s_per_contact_first_look": SERIAL_S_PER_CONTACT,
               "share_near_impacts_assumed": NEAR_IMPACTS,
               "model": model, "check": checked(model, ranks), "cores": CORES, "strong_s_per_step": strong,
               "weak_s_per_step": weak, "discs_per_core": DISCS_PER_CORE}
    whole_file.write_text(sys.argv[2], json.dumps(content, indent=1) + "\n")
    draw(model, strong, weak, sys.argv[3])


if __name__ == "__main__":
    main()
