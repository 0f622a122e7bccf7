// drumlin measure --study: several measured runs together, laws over speed, the paper's table.
#include "coupling/study/study.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/asked.hpp"
#include "apps/support/commands.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/pending_figures.hpp"
#include "apps/support/standard_streams.hpp"
#include "apps/support/study_json.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/study/study_run_folder.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void print_study(const coupling::Study& study, const Json& content) {
  for (const std::string& warning : study.warnings) print_out(fmt::format("warning: {}\n", warning));
  print_out("\nlaws over the speed of rotation (99 %)\n");
  for (const coupling::SpeedLaw& law : study.laws) {
    print_out(fmt::format("  {:28} {}\n", law.name, law.formula));
    for (const auto& c : law.coefficients)
      print_out(fmt::format("  {:28}   {} = {:.4g} +- {:.2g}\n", "", c.name, c.value, c.ci99));
  }
  for (const coupling::Collapse& collapse : study.collapses)
    print_out(fmt::format("  {:28} spread between speeds / intervals = {:.2f} (limit {:.2f}): {}\n",
                          collapse.column + "(I)", collapse.ratio, collapse.limit,
                          !std::isfinite(collapse.ratio) ? "not told, which takes runs of two speeds"
                          : collapse.collapse            ? "one curve"
                                                         : "not one curve"));
  print_out(fmt::format("\n{}\n", paper_table_markdown(study)));
  if (!study.paper.empty())
    print_out(fmt::format("{} agree, {} open, {} near, {} differ, {} imposed, {} not measured\n",
                          content["verdict"]["agrees"].get<int>(), content["verdict"]["open"].get<int>(),
                          content["verdict"]["near"].get<int>(), content["verdict"]["differs"].get<int>(),
                          content["verdict"]["imposed"].get<int>(),
                          content["verdict"]["not measured"].get<int>()));
}

}  // namespace

int study(const StudyOptions& options) {
  const fs::path finished = options.output / "study.json";
  Json inputs = Json::array();
  for (const fs::path& run : options.runs) inputs.push_back(measured_run_sum(run));
  const std::string asked = asked_sum(inputs);
  if (options.existing == ExistingOutput::resume && is_complete(finished))
    return done_already(options.output, asked);
  std::vector<coupling::StudyRun> runs;
  std::vector<std::string> folders;
  for (const fs::path& run : options.runs) {
    runs.push_back(coupling::read_study_run(run));
    folders.push_back(run.string());
  }
  const coupling::Study result = coupling::study_of(std::move(runs), paper_data_folder());
  StagedOutput output({options.output, options.existing, "study", options.runs, {}, asked});
  const fs::path& folder = output.folder();

  const bool reduced = result.runs.front().identity.at("reduced") == "true";
  Json content{{"format", "drumlin-study-1"}, {"reduced", reduced}};
  std::vector<std::string> edits;
  add_study(content, result);
  content["provenance"] = to_json(provenance());
  for (const coupling::StudyRun& run : result.runs)
    edits.insert(edits.end(), run.accepted.begin(), run.accepted.end());
  add_accepted_edits(content["provenance"], edits);
  const std::string table = paper_table_markdown(result);
  replace_file(folder / "paper_table.md", table);
  note_pending_figures(folder);
  const fs::path file = folder / "study.json";
  write_json(file, content);
  std::vector<std::string> words{"--study",  file.string(),  "--paper", paper_data_folder().string(),
                                 "--output", folder.string()};
  words.insert(words.end(), folders.begin(), folders.end());
  const auto failures =
      draw_pending_figures(folder, {{"study_figures.py", words}}, ResultPage{"study", file});
  output.publish();
  print_study(result, content);
  throw_if_figures_failed(finished, failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
