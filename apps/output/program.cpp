#include "apps/output/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "apps/command_line/options.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/unfinished_file.hpp"

namespace drumlin::apps {
namespace {

/// Hands code and message of the error that is being handled to `report`.
template <class Report>
void report_error(const Report& report) {
  try {
    throw;
  } catch (const Interrupted& stopped) {
    report(static_cast<ExitCode>(stopped.exit_code), "");
  } catch (const InputError& error) {
    report(ExitCode::wrong_input, error.what());  // one line per problem
  } catch (const NotConvergedError& error) {
    report(ExitCode::not_converged, error.what());
  } catch (const IoError& error) {
    report(ExitCode::input_output, error.what());
  } catch (const std::bad_alloc&) {
    report(ExitCode::input_output, "not enough memory");
  } catch (const std::length_error& error) {
    report(ExitCode::input_output, fmt::format("not enough memory ({})", error.what()).c_str());
  } catch (const std::filesystem::filesystem_error& error) {
    // No file can have such a name, whatever it was asked for.
    const bool wrong_name = error.code() == std::errc::filename_too_long ||
                            error.code() == std::errc::too_many_symbolic_link_levels;
    report(wrong_name ? ExitCode::wrong_input : ExitCode::input_output,
           fmt::format("{}: {}", error.path1().string(), error.code().message()).c_str());
  } catch (const std::system_error& error) {  // files, and threads that cannot be started
    report(ExitCode::input_output, error.what());
  } catch (const nlohmann::json::exception& error) {
    report(ExitCode::wrong_input,
           fmt::format("a JSON file holds what it should not: {}", error.what()).c_str());
  } catch (const std::runtime_error& error) {  // TBB's, of threads that cannot be started
    const bool of_threads = std::strstr(error.what(), "pthread_create") != nullptr;
    report(of_threads ? ExitCode::input_output : ExitCode::fault,
           fmt::format("{}{}", of_threads ? "" : "a fault of this program: ", error.what()).c_str());
  } catch (const std::exception& error) {
    report(ExitCode::fault, fmt::format("a fault of this program: {}", error.what()).c_str());
  } catch (...) {
    report(ExitCode::fault, "a fault of this program");
  }
}

[[noreturn]] void end_with_message() noexcept {
  remove_unfinished_files();
  if (std::current_exception())
    report_error([](ExitCode code, const char* message) {
      print_error(message);
      print_error("\n");
      ::_exit(static_cast<int>(code));
    });
  // What leaves a function that must not throw, a destructor above all, is not always handed on by g++.
  if (std::uncaught_exceptions() > 0) {
    print_error("an error where none can be handled, most likely a lack of memory\n");
    ::_exit(static_cast<int>(ExitCode::input_output));
  }
  ::_exit(static_cast<int>(ExitCode::fault));
}

int code_with_output(int code, bool speaks) {
  const int lost = lost_output();
  if (lost == 0) return code;
  if (lost == EPIPE) {
    if (code != static_cast<int>(ExitCode::done)) return code;
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  if (speaks)
    print_error(
        fmt::format("standard output: cannot be written, a part of it is lost: {}\n", std::strerror(lost)));
  return static_cast<int>(ExitCode::input_output);
}

}  // namespace

int processors_at_hand() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, most_threads);
}

int run_program(const std::function<int()>& work, const std::function<bool()>& speaks) {
  open_standard_streams();
  end_at_signals();
  end_with_parent();
  std::set_terminate(end_with_message);
  int code = 0;
  try {
    code = work();
  } catch (...) {
    flush_out();
    report_error([&](ExitCode of_error, const char* message) {
      code = static_cast<int>(of_error);
      if (!speaks() || *message == '\0') return;
      print_error(message);
      print_error("\n");
    });
  }
  return code_with_output(code, speaks());
}

}  // namespace drumlin::apps
