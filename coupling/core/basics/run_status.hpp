#pragma once
// What has become of a run: "status" of run.json.
#include "coupling/core/basics/enum_names.hpp"

namespace drumlin {

enum class RunStatus { running, interrupted, finished, not_converged, grain_lost, crushed };
constexpr auto names_of(RunStatus) {
  return std::array{"running", "interrupted", "finished", "not converged", "grain lost", "crushed"};
}

}  // namespace drumlin
