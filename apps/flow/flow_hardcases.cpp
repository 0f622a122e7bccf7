#include "apps/flow/flow_hardcases.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/json/hard_case_json.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "tests/hardcases/registry.hpp"

namespace drumlin::apps {

int flow_hardcases(const std::vector<std::string>& words) {
  const auto& all = flow_hard_cases();
  const auto say = [](const nlohmann::ordered_json& line) {
    print_out(fmt::format("{}\n", line.dump()));
    flush_out();
  };
  if (!words.empty() && words.front() == "--list") {
    for (const HardCase& hard : all) say({{"name", hard.name}, {"fast", hard.fast}});
    return static_cast<int>(ExitCode::done);
  }
  for (const std::string& name : words) {
    const auto hard = std::find_if(all.begin(), all.end(), [&](const HardCase& h) { return h.name == name; });
    if (hard == all.end()) throw InputError(fmt::format("hardcases: {}: no case of this name", name));
    say(to_json(*hard, run_hard_case(*hard)));
  }
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
