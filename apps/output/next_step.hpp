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

/// Whose run it is: an imported one has no scene that could go on or make a pair.
enum class Origin { drumlin, other_program };

/// "next: ...\n" after `command`, with the folder or file that it left; `seconds`: simulated ones that were
/// sampled.
std::string next_step(std::string_view command, Flowing flowing, Verdict verdict, const std::string& output,
                      double seconds = 0, Origin origin = Origin::drumlin);

}  // namespace drumlin::apps
