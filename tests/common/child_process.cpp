// Started programs: what they print, how they end, what reaches them.
#include "coupling/core/machine/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <thread>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

ProcessRequest shell(const std::string& script, ProcessOutput output, std::vector<std::string>& lines) {
  ProcessRequest request{.program = "/bin/sh", .words = {"-c", script}};
  request.output = output;
  request.line = [&](const std::string& line) { lines.push_back(line); };
  return request;
}

TEST(ChildProcess, HandsOverItsLinesAndItsExitCode) {
  std::vector<std::string> lines;
  const ProcessEnd end =
      run_process(shell("echo one; printf 'two words'; exit 3", ProcessOutput::standard, lines));
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two words"}));
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_EQ(end.signal, 0);
  EXPECT_FALSE(end.succeeded());
}

TEST(ChildProcess, SaysWhichSignalEndedIt) {
  std::vector<std::string> lines;
  const ProcessEnd end = run_process(shell("kill -9 $$", ProcessOutput::standard, lines));
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_EQ(end.shell_code(), 128 + SIGKILL);
}

TEST(ChildProcess, HandsOverBothStreamsInTheirOrder) {
  std::vector<std::string> lines;
  EXPECT_TRUE(
      run_process(shell("echo a; echo b >&2; echo c", ProcessOutput::with_errors, lines)).succeeded());
  EXPECT_EQ(lines, (std::vector<std::string>{"a", "b", "c"}));
}

TEST(ChildProcess, GetsVariablesInPlaceOfOurs) {
  std::vector<std::string> lines;
  ::setenv("DRUMLIN_TEST_VARIABLE", "ours", 1);
  ProcessRequest request = shell("echo $DRUMLIN_TEST_VARIABLE $HOME", ProcessOutput::standard, lines);
  request.environment = {"DRUMLIN_TEST_VARIABLE=given"};
  EXPECT_TRUE(run_process(request).succeeded());
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].starts_with("given")) << lines[0];
}

volatile std::sig_atomic_t seen = 0;
extern "C" void see(int signal) { seen = signal; }

TEST(ChildProcess, GetsTheSignalsThatOurHandlerGets) {
  std::signal(SIGTERM, see);
  std::vector<std::string> lines;
  // It ends this process's wait by the signal that it sends to its parent.
  ProcessRequest request = shell("trap 'exit 7' TERM; kill -TERM $PPID; while :; do sleep 0.01; done",
                                 ProcessOutput::standard, lines);
  request.caught = [] { return int{seen}; };
  EXPECT_EQ(run_process(request).exit_code, 7);
  EXPECT_EQ(seen, SIGTERM);
  std::signal(SIGTERM, SIG_DFL);
}

/// Whether nobody holds the other end of a pipe any more; waits until it is so.
bool all_have_gone(int read_end) {
  char byte = 0;
  return ::read(read_end, &byte, 1) == 0;
}

TEST(ChildProcess, EndsWithItsParent) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);  // the child inherits the write end, and holds it while it lives
  const pid_t parent = ::fork();
  if (parent == 0) {
    ::close(ends[0]);
    ProcessRequest request{.program = "/bin/sh", .words = {"-c", "kill -9 $PPID; while :; do sleep 1; done"}};
    run_process(request);
    ::_exit(0);
  }
  ::close(ends[1]);
  EXPECT_TRUE(all_have_gone(ends[0]));
  ::close(ends[0]);
  int status = 0;
  EXPECT_EQ(::waitpid(parent, &status, 0), parent);
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
}

TEST(ChildProcess, GetsAHangUpAndNoHandlerOfOurs) {
  seen = 0;
  std::signal(SIGHUP, see);
  std::vector<std::string> lines;
  ProcessRequest request = shell("kill -HUP $PPID; exec sleep 30", ProcessOutput::standard, lines);
  request.caught = [] { return int{seen}; };
  EXPECT_EQ(run_process(request).signal, SIGHUP);
  EXPECT_EQ(seen, SIGHUP);
  std::signal(SIGHUP, SIG_DFL);
}

TEST(ChildProcess, IsEndedByAGoneReaderAlthoughWeAreNot) {
  std::signal(SIGPIPE, SIG_IGN);
  std::vector<std::string> lines;
  EXPECT_EQ(run_process(shell("kill -PIPE $$; sleep 30", ProcessOutput::standard, lines)).signal, SIGPIPE);
  std::signal(SIGPIPE, SIG_DFL);
}

TEST(ChildProcess, IsMissed) {
  EXPECT_THROW(run_process({.program = "/nowhere/to/be/found"}), IoError);
}

}  // namespace
}  // namespace drumlin
