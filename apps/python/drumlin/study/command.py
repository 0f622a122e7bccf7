"""What `drumlin measure --study`, `drumlin compare --study` and `drumlin score` start once they have checked all folders: writes study.json (score.json)
and its tables and prints what the command says.

usage: command.py STUDY PAPER GIVEN
  STUDY  folder of the results
  PAPER  the folder data/paper
  GIVEN  JSON: both_sides, runs and flows (folders), pairs, limits (a file, or null), provenance, scored (of a score: the name)
"""

import json
import pathlib
import sys

from drumlin import study
from drumlin.figures import whole_file


def of_particles(runs, paper):
    content = study.plain(study.study_of(runs, paper))
    return {"format": "drumlin-study-1"}, content, {"paper_table.md": study.paper_table(content)}, study.study_text(content)


def of_both_sides(runs, flows, given, paper):
    limits = study.read_limits(given["limits"]) if given["limits"] else None
    pairs = {(pair["first"], pair["second"], pair["by"]): pair for pair in given["pairs"]}
    content = study.plain(study.compared_speeds(runs, flows, pairs, paper))
    lines = content["verdict_lines"] = study.verdict_lines(content["speeds"])
    tables = {"table.md": study.speed_table(content)}
    if limits:
        content["limits"] = study.plain(study.judged_limits(limits, runs, flows, pairs))
        tables["limits.md"] = study.limits_table(content["limits"])
    title = "Particles and continuum over the speed of rotation" + (" (reduced)" if flows[0].reduced else "")
    said = "".join(f"{line}\n" for line in [f"warning: {warning}" for warning in content["warnings"]] + lines) + tables.get("limits.md", "")
    return ({"format": "drumlin-comparison-study-1", "title": title}, {"law": flows[0].law, "effects": flows[0].identity["effects"]} | content,
            tables, said)


def of_score(runs, flows, given):
    pairs = {(pair["first"], pair["second"], pair["by"]): pair for pair in given["pairs"]}
    content = study.plain(study.score(study.read_limits(given["limits"]), runs, flows[0], pairs))
    table = study.score_table(given["scored"], content)
    return {"format": "drumlin-score-1", "scored": given["scored"]}, content, {"score.md": table}, table


def main(output, paper, file):
    sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    given = json.loads(pathlib.Path(file).read_text(encoding="utf-8"))
    runs, flows = [study.read_run(folder) for folder in given["runs"]], [study.read_flow(folder) for folder in given["flows"]]
    if "scored" in given:
        head, content, tables, said = of_score(runs, flows, given)
    else:
        head, content, tables, said = of_both_sides(runs, flows, given, paper) if given["both_sides"] else of_particles(runs, paper)
    content = head | {"reduced": (flows or runs)[0].reduced} | content | {"provenance": given["provenance"]}
    record = "score.json" if "scored" in given else "study.json"
    for name, text in (tables | {record: json.dumps(content, indent=2, ensure_ascii=False) + "\n"}).items():
        # A name of others may be no UTF-8: it stands there with the sign for an unknown letter.
        whole_file.write_text(pathlib.Path(output) / name, text.encode("utf-8", "surrogateescape").decode("utf-8", "replace"))
    print(said, end="")


if __name__ == "__main__":
    main(*sys.argv[1:])
