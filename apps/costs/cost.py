"""Plans `drumlin cost`, which starts it, and has that program do the work: a line of JSON each way (apps/commands/cost/cost.cpp)."""

import json
import signal
import sys

import flows
import particles
from sweeping import Failure, InputError


def ask(what, **words):
    print(json.dumps({"what": what} | words, allow_nan=False), flush=True)
    return json.loads(sys.stdin.buffer.readline())


def refuse_options_of_the_other_kind(options, flow):
    if flow and (options["from"] or options["statistics"]):
        raise InputError("cost: --from and --statistics are for scenes of particles")
    if not flow and (flows.asks_for_work(options) or options["time-limit"] or options["variants"] or options["against"]):
        raise InputError("cost: --ranks, --neighbour, --repeats, --time-limit, --variants and --against are for flows")


def main():
    for number in (signal.SIGINT, signal.SIGHUP):  # the program takes notice of them, and ends this one
        signal.signal(number, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    known = ask("facts")
    options, facts = known["options"], known["facts"]
    flow = facts["kind"] == "continuum"
    try:
        refuse_options_of_the_other_kind(options, flow)
        if options["effects"]:
            (flows.price_effects if flow else particles.price_effects)(ask, options, facts)
        else:
            (flows.Sweep if flow else particles.Sweep)(ask, options, facts).execute()
    except Failure as failure:
        ask("fail", code=failure.code, text=str(failure))


if __name__ == "__main__":
    main()
