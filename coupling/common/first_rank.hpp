#pragma once
// What one of several ranks has to do for all of them: files and messages.
#include <functional>

#include "coupling/common/errors.hpp"

namespace drumlin {

/// What the other ranks throw where the first one failed: they end with its exit code, and say nothing.
struct FailedOnFirstRank {
  ExitCode code = ExitCode::done;
};

/// Does `action` on the first rank, while the others wait for it. What it throws there is thrown there, and
/// FailedOnFirstRank on the others. `from_first` gives all ranks the number that the first one hands to it.
void do_on_first_rank(bool is_first, const std::function<void()>& action,
                      const std::function<int(int)>& from_first);

}  // namespace drumlin
