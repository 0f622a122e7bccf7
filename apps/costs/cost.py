"""`drumlin cost`: plans, has the work measured, compares and draws.

usage: cost.py OPTIONS
  OPTIONS  JSON: the options of the command by their long names (apps/commands/cost.cpp)
"""

import json
import sys

import flows
import particles
from drumlin import _drumlin
from drumlin.errors import InputError


def main(words):
    options = json.loads(words)
    flow = _drumlin.is_flow_scene(options["scene"])
    if flow and not options["rheology"]:
        raise InputError(f"{options['scene']}: a flow scene needs --rheology RHEOLOGY.toml")
    if flow and (options["from"] or options["statistics"]):
        raise InputError("cost: --from and --statistics are for scenes of particles")
    if not flow and (flows.asks_for_work(options) or options["time-limit"] or options["variants"] or options["against"]):
        raise InputError("cost: --ranks, --neighbour, --repeats, --time-limit, --variants and --against are for flows")
    kind = flows if flow else particles
    (kind.price_effects if options["effects"] else kind.sweep)(options)


if __name__ == "__main__":
    main(*sys.argv[1:])
