#pragma once
// What a user does next: one table, by the command that has ended, by what flows and by how it went.
#include <string>
#include <string_view>

namespace drumlin::apps {

/// What flows: in a drum, in layers along a period, in an open packing, which is a region of the continuum.
enum class Flowing { drum, layers, open };

/// How it went.
enum class Verdict {
  done,          ///< steady, where that is judged
  one_rate,      ///< steady, but its layers know mu(I) at hardly more than one I
  unsteady,      ///< it changes, or was seen for too short a time
  rests,         ///< nothing flows
  no_snapshots,  ///< nothing was kept that can be measured
};

/// "next: ...\n" after `command` ("new flow", "measure imported": that kind of its results), with the folder
/// or file that it left; `seconds`: simulated ones that were sampled.
std::string next_step(std::string_view command, Flowing flowing, Verdict verdict, const std::string& output,
                      double seconds = 0);

}  // namespace drumlin::apps
