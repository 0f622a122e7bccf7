#include "apps/command_line/command_line.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <sstream>

#include "coupling/core/basics/errors.hpp"
#include "tests/support/says.hpp"

namespace drumlin::apps {
namespace {

/// The request of a command line whose words have no blanks in them.
Request parsed(const std::string& line) {
  std::istringstream stream("drumlin " + line);
  const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  return parse_command_line(static_cast<int>(pointers.size()), pointers.data(), {"nlgs", "nncg"});
}

TEST(CommandLine, FillsTheOptionsOfACommand) {
  const auto run =
      std::get<RunOptions>(parsed("run -o out --set x=1 --set y=[1,2] a.toml --threads 4 --resume"));
  EXPECT_EQ(run.scene, "a.toml");
  EXPECT_EQ(run.output, "out");
  EXPECT_EQ(run.overrides, (std::vector<std::string>{"x=1", "y=[1,2]"}));
  EXPECT_EQ(run.threads, 4);
  EXPECT_EQ(run.existing, ExistingOutput::resume);
  EXPECT_EQ(std::get<RunOptions>(parsed("run a.toml -o out")).threads, processors_at_hand());
  const auto cost = std::get<CostOptions>(parsed("cost s.toml --sweep mesh=1:2,eps --ranks 1,2"));
  EXPECT_EQ(cost.sweep, (std::vector<std::string>{"mesh=1:2", "eps"}));
  EXPECT_EQ(cost.ranks, (std::vector<int>{1, 2}));
  EXPECT_EQ(std::get<MeasureOptions>(parsed("measure r --position -5")).position, -5);
  // Those that no test of the whole program gives.
  EXPECT_EQ(std::get<CostOptions>(parsed("cost --effects s.toml --against r1 r2")).against.size(), 2u);
  EXPECT_EQ(std::get<CalibrateOptions>(parsed("calibrate r1 -o law.toml --I-min 1e-3")).I_min, 1e-3);
  const auto solve = std::get<SolveContactsOptions>(parsed("solve-contacts p.h5 --watch 10 --max-seconds 5"));
  EXPECT_EQ(solve.watch, 10);
  EXPECT_EQ(solve.max_seconds, 5);
}

TEST(CommandLine, RefusesExistingOutputUnlessTold) {
  EXPECT_EQ(std::get<RunOptions>(parsed("run a -o o")).existing, ExistingOutput::refuse);
  EXPECT_EQ(std::get<CompareOptions>(parsed("compare a b -o o --overwrite")).existing,
            ExistingOutput::overwrite);
}

TEST(CommandLine, PrintsACompletionWithoutACommand) {
  const auto script = std::get<TextToShow>(parsed("--completion bash")).text;
  expect_has(script, "complete -o default -F _drumlin drumlin");
  expect_has(script, "--player");
}

TEST(CommandLine, RefusesWrongUsage) {
  for (const char* line : {"",
                           "walk",
                           "run",
                           "run a.toml",
                           "run a.toml -o o --resume --overwrite",
                           "run a.toml -o o --threads 0",
                           "run a.toml -o o --threads two",
                           "run a.toml -o o --unknown",
                           "run a.toml b.toml -o o",
                           "new avalanche -o mine.toml",
                           "new silo",
                           "measure r --slice-width 0",
                           "measure r --slice-width inf",
                           "measure r --slice-width nan",
                           "calibrate -o law.toml",
                           "flow f.toml -o o",
                           "scene",
                           "scene check",
                           "solve-contacts p.h5 --solver none",
                           "solve-contacts p.h5 --tolerance -1",
                           "solve-contacts p.h5 --watch 0",
                           "cost s.toml --repeats 0",
                           "cost s.toml --ranks 1,0",
                           "cost s.toml --ranks two",
                           "cost s.toml --time-limit 0",
                           "cost s.toml --horizon -1",
                           "--completion tcsh"})
    EXPECT_THROW(parsed(line), InputError) << "drumlin " << line;
}

TEST(CommandLine, ShowsHelpWithDefaultUnitAndRange) {
  const auto help = std::get<TextToShow>(parsed("measure --help")).text;
  expect_has(help, "--slice-width");
  expect_has(help, "=20");
  expect_has(help, "[d, ");
  for (const char* command :
       {"run", "calibrate", "flow", "compare", "solve-contacts", "scene", "plot", "export", "history"})
    expect_has(std::get<TextToShow>(parsed(std::string(command) + " --help")).text, "Usage");
  expect_has(std::get<TextToShow>(parsed("--help")).text, "solve-contacts");
}

}  // namespace
}  // namespace drumlin::apps
