// The frame of every program: what an error becomes, also one that no caller can catch.
#include "apps/output/program.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>

#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::apps {
namespace {

/// Ends a copy of the test as a program would end whose work this is.
template <class Work>
[[noreturn]] void end_as_program(Work work) {
  std::_Exit(run_program(work));
}

template <class Error>
int failing(const Error& error) {
  throw error;
}

TEST(Program, EndsWithTheCodeOfItsWorkOrOfItsError) {
  const auto ends_with = [](int code, const char* said, const std::function<int()>& work) {
    EXPECT_EXIT(end_as_program(work), ::testing::ExitedWithCode(code), said) << said;
  };
  ends_with(0, "", [] { return 0; });
  ends_with(3, "", [] { return 3; });
  ends_with(2, "wrong", [] { return failing(InputError("wrong")); });
  ends_with(3, "slow", [] { return failing(NotConvergedError("slow")); });
  ends_with(74, "lost", [] { return failing(IoError("lost")); });
  ends_with(74, "not enough memory", [] { return failing(std::bad_alloc()); });
  ends_with(74, "not enough memory", [] { return std::string().reserve(std::string().max_size() + 1), 0; });
  ends_with(74, "9 threads.*unavailable",
            [] { return failing(std::system_error(EAGAIN, std::generic_category(), "9 threads")); });
  ends_with(74, "^pthread_create has failed",
            [] { return failing(std::runtime_error("pthread_create has failed: unavailable")); });
  ends_with(70, "a fault of this program: odd", [] { return failing(std::runtime_error("odd")); });
  ends_with(2, "JSON", [] { return nlohmann::json("text").get<int>(); });
  ends_with(70, "a fault of this program: odd", [] { return failing(std::logic_error("odd")); });
  ends_with(70, "a fault of this program", [] { return failing(7); });
}

TEST(Program, EndsWithTheErrorOfAThreadThatNobodyCanCatch) {
  const auto in_a_thread = [](auto error) {
    return [error] { return std::thread([error] { throw error; }).join(), 0; };
  };
  EXPECT_EXIT(end_as_program(in_a_thread(std::bad_alloc())), ::testing::ExitedWithCode(74),
              "not enough memory");
  EXPECT_EXIT(end_as_program(in_a_thread(IoError("lost"))), ::testing::ExitedWithCode(74), "lost");
}

TEST(Program, EndsBySignalsUnlessItsWorkCatchesThem) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    EXPECT_EXIT(end_as_program([&] { return std::raise(signal), 0; }),
                ::testing::ExitedWithCode(128 + signal), "");
    EXPECT_EXIT(end_as_program([&] {
                  const CaughtInterruptions caught;
                  std::raise(signal);
                  return interruption() == signal ? 5 : 6;
                }),
                ::testing::ExitedWithCode(5), "");
    EXPECT_EXIT(end_as_program([&] {
                  {
                    const CaughtInterruptions outer, inner;
                    std::raise(signal);
                  }
                  stop_if_interrupted();
                  return 6;
                }),
                ::testing::ExitedWithCode(128 + signal), "");
  }
}

TEST(Program, LosesNoOutputSilently) {
  EXPECT_EXIT(end_as_program([] {
                (void)!std::freopen("/dev/full", "w", stdout);
                print_out("result");
                return 0;
              }),
              ::testing::ExitedWithCode(74), "standard output: cannot be written");
}

}  // namespace
}  // namespace drumlin::apps
