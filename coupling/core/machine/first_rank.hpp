#pragma once
// What one of several ranks has to do for all of them: files and messages.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

/// What ranks throw where another one failed and has spoken: they end with its exit code, and say nothing.
struct FailedOnFirstRank {
  ExitCode code = ExitCode::done;
};

/// Does `action` on all ranks, which may not all see the same files. Where it throws on some, that is thrown
/// on the first of them if it is rank 0; another one hands "rank 1: what happened" to `say`, since only rank
/// 0 speaks otherwise. All other ranks throw FailedOnFirstRank with its code. `least` gives all ranks the
/// least of the numbers that they hand to it.
void do_on_all_ranks(int rank, const std::function<void()>& action,
                     const std::function<std::int64_t(std::int64_t)>& least,
                     const std::function<void(const std::string&)>& say);

/// Throws where a rank was given something else than rank 0, whose text is the first: InputError there, which
/// names the rank and `what`, FailedOnFirstRank on the others. Such ranks would wait for each other for ever.
void require_same_on_ranks(int rank, const std::vector<std::string>& texts, const std::string& what);

}  // namespace drumlin
