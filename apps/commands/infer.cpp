// drumlin infer: the grains behind measured numbers, which drumlin/inference/command.py of the Python package
// finds.
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/program.hpp"
#include "apps/output/results.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

struct InferOptions {
  fs::path question, output;
  std::optional<fs::path> designs;
  std::string executor = "local";
  bool price_only = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("question", question, "QUESTION.toml", "What was measured, in which scenes, and what is unknown")
        .required()
        .decides(Decides::content);
    d.output(output, "DIR", "Folder for infer.json, samples.csv and figures");
    d.add("--designs", designs, "DIR",
          "Folder of runs that other questions use, too; absent: designs, beside the output")
        .decides(Decides::nothing);
    d.add("--executor", executor, "WORKERS",
          "Where runs are computed: local, local:N (so many at once), or dask:ADDRESS of a scheduler")
        .decides(Decides::nothing);
    d.add("--price-only", price_only, "Makes the first run of each scene, says what all will cost, and ends")
        .decides(Decides::nothing);
    d.existing(existing, "Goes on where an earlier call was interrupted");
  }
};

int infer(const InferOptions& options) {
  const ResultsRequest request = results_of(options, "infer", options.output, "infer.json");
  if (is_done_already(request)) return static_cast<int>(ExitCode::done);
  nlohmann::ordered_json given = json_of(described(options));
  given["sum"] = request.requested;
  return end_of_command("../inference/command.py", {given.dump()});
}

}  // namespace

Command infer_command() {
  return command("infer", "The grains behind measured numbers, and what these do not determine", infer);
}

}  // namespace drumlin::apps
