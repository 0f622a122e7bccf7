// drumlin hardcases: cases with known outcomes, what was expected and what came.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/hardcases/hard_case.hpp"

namespace drumlin::apps {

namespace {

constexpr const char* file_name = "hardcases.json";

/// In the order of the table, whatever the order of the names.
std::vector<HardCase> chosen(const HardcasesOptions& options) {
  std::vector<HardCase> cases;
  for (const HardCase& hard : hard_cases()) {
    const bool named = options.names.empty() || std::find(options.names.begin(), options.names.end(),
                                                          hard.name) != options.names.end();
    if (named && (hard.fast || !options.fast)) cases.push_back(hard);
  }
  return cases;
}

void refuse_unknown(const std::vector<std::string>& names) {
  std::string allowed;
  for (const HardCase& hard : hard_cases()) allowed += (allowed.empty() ? "" : ", ") + hard.name;
  for (const std::string& name : names)
    if (std::none_of(hard_cases().begin(), hard_cases().end(),
                     [&name](const HardCase& hard) { return hard.name == name; }))
      throw InputError(fmt::format("hardcases: {}: no case of this name (allowed: {})", name, allowed));
}

const char* relation_sign(Relation relation) {
  switch (relation) {
    case Relation::equals:
      return "";
    case Relation::at_most:
      return "<= ";
    case Relation::at_least:
      return ">= ";
  }
  return "?";
}

const char* verdict(bool good) { return good ? "ok" : "FAILED"; }

constexpr const char* row = "{:<22} {:<52} {:>14} {:>14} {:>10} {:>8}  {}\n";

void print_result(const HardCase& hard, const HardResult& result) {
  for (std::size_t k = 0; k < result.checks.size(); ++k) {
    const HardCheck& check = result.checks[k];
    const bool first = k == 0;
    fmt::print(row, first ? hard.name : "", check.what,
               fmt::format("{}{:.6g}", relation_sign(check.relation), check.expected),
               fmt::format("{:.6g}", check.got),
               check.relation == Relation::equals ? fmt::format("{:.1e}", check.tolerance) : "",
               first ? fmt::format("{:.2f}", result.seconds) : "", verdict(check.holds()));
  }
  std::fflush(stdout);
}

nlohmann::ordered_json to_json(const HardCase& hard, const HardResult& result) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const HardCheck& check : result.checks) {
    const char* const relation = check.relation == Relation::equals    ? "equals"
                                 : check.relation == Relation::at_most ? "at_most"
                                                                       : "at_least";
    checks.push_back({{"what", check.what},
                      {"relation", relation},
                      {"expected", check.expected},
                      {"got", check.got},
                      {"tolerance", check.tolerance},
                      {"reason", check.reason},
                      {"holds", check.holds()}});
  }
  return {{"name", hard.name},         {"outcome", hard.outcome},   {"fast", hard.fast},
          {"seconds", result.seconds}, {"passed", result.passed()}, {"checks", checks}};
}

}  // namespace

int hardcases(const HardcasesOptions& options) {
  refuse_unknown(options.names);
  const auto cases = chosen(options);
  if (cases.empty()) throw InputError("hardcases: none of the cases named is a fast one");
  if (options.output) prepare_output(*options.output, options.existing, {file_name});
  fmt::print(row, "case", "what (d, sqrt(d/g), rho0 g d)", "expected", "got", "tolerance", "seconds",
             "verdict");
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  std::size_t passed = 0;
  double seconds = 0;
  for (const HardCase& hard : cases) {
    const HardResult result = run_hard_case(hard);
    print_result(hard, result);
    results.push_back(to_json(hard, result));
    passed += result.passed();
    seconds += result.seconds;
  }
  fmt::print("{} of {} cases passed, {:.1f} s\n", passed, cases.size(), seconds);
  if (options.output)
    write_json(*options.output / file_name, {{"format", "drumlin-hardcases-1"},
                                             {"provenance", apps::to_json(provenance())},
                                             {"seconds", seconds},
                                             {"cases", results}});
  return static_cast<int>(passed == cases.size() ? ExitCode::done : ExitCode::not_converged);
}

}  // namespace drumlin::apps
