// drumlin hardcases: cases with known outcomes, what was expected and what came.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>

#include "apps/json/hard_case_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/program_files.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/machine/child_process.hpp"
#include "tests/hardcases/registry.hpp"

namespace drumlin::apps {

namespace {

constexpr const char* file_name = "hardcases.json";

using Json = nlohmann::ordered_json;

/// What the table calls a case. The continuum's run in drumlin-flow, which links deal.II.
struct Listed {
  std::string name;
  bool fast = false;
  const HardCase* particles = nullptr;  ///< null: one of the continuum
};

void ask_flow(const std::vector<std::string>& words, const std::function<void(const Json&)>& row) {
  ProcessRequest request{.program = program_beside("drumlin-flow"), .words = {"--hardcases"}};
  request.words.insert(request.words.end(), words.begin(), words.end());
  request.output = ProcessOutput::standard;
  request.line = [&](const std::string& line) { row(Json::parse(line)); };
  const ProcessEnd end = run_process(request);
  if (!end.succeeded())
    throw IoError(fmt::format("{} --hardcases ended with {}", request.program.string(), end.shell_code()));
}

/// All cases, in the order of the table.
std::vector<Listed> listed_cases() {
  std::vector<Listed> all;
  static const auto data = data_folder_if_any();
  static const auto of_scenes = data ? scene_cases(*data / "scenes") : std::vector<HardCase>();
  for (const auto* cases : {&particle_hard_cases(), &of_scenes})
    for (const HardCase& hard : *cases) all.push_back({hard.name, hard.fast, &hard});
  ask_flow({"--list"}, [&](const Json& row) {
    all.push_back({row.at("name").get<std::string>(), row.at("fast").get<bool>(), nullptr});
  });
  return all;
}

/// In the order of the table, whatever the order of the names.
std::vector<Listed> chosen(const std::vector<Listed>& all, const HardcasesOptions& options) {
  std::vector<Listed> cases;
  for (const Listed& hard : all) {
    const bool named = options.names.empty() || std::find(options.names.begin(), options.names.end(),
                                                          hard.name) != options.names.end();
    if (named && (hard.fast || !options.fast)) cases.push_back(hard);
  }
  return cases;
}

void refuse_unknown(const std::vector<Listed>& all, const std::vector<std::string>& names) {
  std::string allowed;
  for (const Listed& hard : all) allowed += (allowed.empty() ? "" : ", ") + hard.name;
  for (const std::string& name : names)
    if (std::none_of(all.begin(), all.end(), [&name](const Listed& hard) { return hard.name == name; }))
      throw InputError(fmt::format("hardcases: {}: no case of this name (allowed: {})", name, allowed));
}

constexpr std::array relation_signs{"", "<= ", ">= "};  // as in Relation

const char* verdict(bool good) { return good ? "ok" : "FAILED"; }

constexpr const char* row = "{:<22} {:<52} {:>14} {:>14} {:>10} {:>8}  {}\n";

void print_result(const HardCase& hard, const HardResult& result) {
  for (std::size_t k = 0; k < result.checks.size(); ++k) {
    const HardCheck& check = result.checks[k];
    const bool first = k == 0;
    print_out(fmt::format(
        row, first ? hard.name : "", check.what,
        fmt::format("{}{:.6g}", relation_signs[static_cast<std::size_t>(check.relation)], check.expected),
        fmt::format("{:.6g}", check.got),
        check.relation == Relation::equals ? fmt::format("{:.1e}", check.tolerance) : "",
        first ? fmt::format("{:.2f}", result.seconds) : "", verdict(check.holds())));
  }
  flush_out();
}

}  // namespace

int hardcases(const HardcasesOptions& options) {
  const auto all = listed_cases();
  refuse_unknown(all, options.names);
  const auto cases = chosen(all, options);
  if (cases.empty()) throw InputError("hardcases: none of the cases named is a fast one");
  std::optional<StagedOutput> output;
  if (options.output)
    output.emplace(OutputRequest{.folder = *options.output,
                                 .existing = options.existing,
                                 .command = "hardcases",
                                 .inputs = {},
                                 .goes_on = false});
  print_out(fmt::format(row, "case", "what (d, sqrt(d/g), rho0 g d)", "expected", "got", "tolerance",
                        "seconds", "verdict"));
  Json results = Json::array();
  std::size_t passed = 0;
  double seconds = 0;
  const auto take = [&](const HardCase& hard, const HardResult& result) {
    print_result(hard, result);
    results.push_back(to_json(hard, result));
    passed += result.passed();
    seconds += result.seconds;
  };
  std::vector<std::string> of_flow;
  for (const Listed& hard : cases) {
    if (hard.particles)
      take(*hard.particles, run_hard_case(*hard.particles));
    else
      of_flow.push_back(hard.name);
  }
  if (!of_flow.empty())
    ask_flow(of_flow, [&](const Json& json) {
      const HardRow row_of_flow = hard_row(json);
      take(row_of_flow.hard, row_of_flow.result);
    });
  print_out(fmt::format("{} of {} cases passed, {:.1f} s\n", passed, cases.size(), seconds));
  if (output) {
    write_json(output->folder() / file_name, {{"format", "drumlin-hardcases-1"},
                                              {"provenance", apps::to_json(provenance())},
                                              {"seconds", seconds},
                                              {"cases", results}});
    output->publish();
  }
  return static_cast<int>(passed == cases.size() ? ExitCode::done : ExitCode::not_converged);
}

}  // namespace drumlin::apps
