"""What `drumlin law` starts: prints the law's file as JSON, with what it says of it. A refusal is printed and ends with exit code 2.

usage: command.py OPTIONS
  OPTIONS  JSON: friction, restitution, spread, rolling_resistance, extrapolate
"""

import json
import sys

from drumlin.library.table import law


def main(options):
    found = law(**json.loads(options))
    middle = len(found.I) // 2
    print(json.dumps({"text": found.text, "I": found.I[middle], "mu": float(found.mu(found.I[middle])), "low": found.low[middle], "high": found.high[middle],
                      "nu": found.nu, "extrapolates": found.extrapolates}))


if __name__ == "__main__":
    main(*sys.argv[1:])
