#pragma once
// A particle run on MPI ranks: from a scene to the files of `drumlin run`.
#include "apps/support/commands.hpp"
#include "particles/distributed/ranks.hpp"

namespace drumlin::apps {

/// All ranks call it together; the first writes and speaks. Throws InputError for scenes and options that
/// ranks do not know.
int run_on_ranks(const RunOptions& options, const particles::Ranks& ranks);

}  // namespace drumlin::apps
