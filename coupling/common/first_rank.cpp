#include "coupling/common/first_rank.hpp"

#include <exception>

namespace drumlin {

namespace {

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

void do_on_first_rank(bool is_first, const std::function<void()>& action,
                      const std::function<int(int)>& from_first) {
  std::exception_ptr thrown;
  ExitCode code = ExitCode::done;
  if (is_first) {
    try {
      action();
    } catch (...) {
      thrown = std::current_exception();
      code = code_of_error();
    }
  }
  code = static_cast<ExitCode>(from_first(static_cast<int>(code)));
  if (thrown) std::rethrow_exception(thrown);
  if (code != ExitCode::done) throw FailedOnFirstRank{code};
}

}  // namespace drumlin
