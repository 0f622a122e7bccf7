#include "coupling/core/machine/first_rank.hpp"

#include <exception>
#include <limits>
#include <new>

namespace drumlin {

namespace {

std::string text_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return "not enough memory";
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "a fault of this program";
  }
}

/// The exit code that the error which is being handled stands for.
ExitCode code_of_error() {
  try {
    throw;
  } catch (const InputError&) {
    return ExitCode::wrong_input;
  } catch (const NotConvergedError&) {
    return ExitCode::not_converged;
  } catch (...) {
    return ExitCode::input_output;
  }
}

}  // namespace

void do_on_all_ranks(int rank, const std::function<void()>& action,
                     const std::function<std::int64_t(std::int64_t)>& least,
                     const std::function<void(const std::string&)>& say) {
  constexpr std::int64_t codes = 256, nobody = std::numeric_limits<std::int64_t>::max();
  std::exception_ptr thrown;
  std::int64_t own = nobody;
  try {
    action();
  } catch (...) {
    thrown = std::current_exception();
    own = codes * rank + static_cast<int>(code_of_error());
  }
  const std::int64_t first = least(own);
  if (first == nobody) return;
  if (first == own && rank == 0) std::rethrow_exception(thrown);
  if (first == own) say("rank " + std::to_string(rank) + ": " + text_of(thrown));
  throw FailedOnFirstRank{static_cast<ExitCode>(first % codes)};
}

void require_same_on_ranks(int rank, const std::vector<std::string>& texts, const std::string& what) {
  for (std::size_t other = 1; other < texts.size(); ++other) {
    if (texts[other] == texts[0]) continue;
    if (rank != 0) throw FailedOnFirstRank{ExitCode::wrong_input};
    throw InputError("rank " + std::to_string(other) + ": " + what + " not those of rank 0");
  }
}

}  // namespace drumlin
