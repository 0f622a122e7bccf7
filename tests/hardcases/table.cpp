// hard_cases [--fast] [NAME...], flow_hard_cases likewise: runs the cases with known outcomes of a simulator
// and prints what was expected and what came (docs/hard-cases.md). Exit code 3 if one fails, 2 for an unknown
// name.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "tests/hardcases/registry.hpp"
#ifdef DRUMLIN_CONTINUUM_CASES
#include "continuum/fem/runtime.hpp"
#endif

namespace {

using namespace drumlin;

constexpr const char* row = "{:<22} {:<52} {:>14} {:>14} {:>10} {:>8}  {}\n";
constexpr std::array relation_signs{"", "<= ", ">= "};  // as in Relation

void print_result(const HardCase& hard, const HardResult& result) {
  bool first = true;
  for (const HardCheck& check : result.checks) {
    const char* sign = relation_signs[static_cast<std::size_t>(check.relation)];
    fmt::print(row, first ? hard.name : "", check.what, fmt::format("{}{:.6g}", sign, check.expected),
               fmt::format("{:.6g}", check.got),
               check.relation == Relation::equals ? fmt::format("{:.1e}", check.tolerance) : "",
               first ? fmt::format("{:.2f}", result.seconds) : "", check.holds() ? "ok" : "FAILED");
    first = false;
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names(argv + 1, argv + argc);
  const bool fast = std::erase(names, "--fast") > 0;
#ifdef DRUMLIN_CONTINUUM_CASES
  const continuum::FemRuntime runtime(argc, argv);
  std::vector<HardCase> all = flow_hard_cases();
#else
  std::vector<HardCase> all = joined({particle_hard_cases(), scene_cases(DRUMLIN_SCENES)});
#endif
  std::string known;
  for (const HardCase& hard : all) known += (known.empty() ? "" : ", ") + hard.name;
  for (const std::string& name : names)
    if (std::none_of(all.begin(), all.end(), [&](const HardCase& hard) { return hard.name == name; })) {
      fmt::print(stderr, "{}: no case of this name (allowed: {})\n", name, known);
      return 2;
    }
  std::erase_if(all, [&](const HardCase& hard) {
    const bool named = names.empty() || std::find(names.begin(), names.end(), hard.name) != names.end();
    return !named || (fast && !hard.fast);
  });
  fmt::print(row, "case", "what (d, sqrt(d/g), rho0 g d)", "expected", "got", "tolerance", "seconds",
             "verdict");
  std::size_t passed = 0;
  double seconds = 0;
  for (const HardCase& hard : all) {
    const HardResult result = run_hard_case(hard);
    print_result(hard, result);
    passed += result.passed();
    seconds += result.seconds;
  }
  fmt::print("{} of {} cases passed, {:.1f} s\n", passed, all.size(), seconds);
  return passed == all.size() ? 0 : 3;
}
