#include "apps/command_line/command_line.hpp"

#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "tests/support/says.hpp"

namespace drumlin::apps {
namespace {

Request parsed(std::vector<const char*> words) {
  words.insert(words.begin(), "drumlin");
  return parse_command_line(static_cast<int>(words.size()), words.data(), {"nlgs", "nncg"});
}

TEST(CommandLine, FillsTheOptionsOfRun) {
  const auto run = std::get<RunOptions>(
      parsed({"run", "a.toml", "-o", "out", "--set", "x=1", "--set", "y=[1, 2]", "--resume"}));
  EXPECT_EQ(run.scene, "a.toml");
  EXPECT_EQ(run.output, "out");
  EXPECT_EQ(run.overrides, (std::vector<std::string>{"x=1", "y=[1, 2]"}));
  EXPECT_EQ(run.threads, processors_at_hand());
  EXPECT_EQ(run.existing, ExistingOutput::resume);
}

TEST(CommandLine, TakesOneValuePerSet) {
  const auto run =
      std::get<RunOptions>(parsed({"run", "-o", "out", "--set", "x=1", "a.toml", "--threads", "4"}));
  EXPECT_EQ(run.scene, "a.toml");
  EXPECT_EQ(run.overrides.size(), 1u);
  EXPECT_EQ(run.threads, 4);
}

TEST(CommandLine, RefusesExistingOutputUnlessTold) {
  EXPECT_EQ(std::get<RunOptions>(parsed({"run", "a", "-o", "o"})).existing, ExistingOutput::refuse);
  EXPECT_EQ(std::get<CompareOptions>(parsed({"compare", "a", "b", "-o", "o", "--overwrite"})).existing,
            ExistingOutput::overwrite);
}

TEST(CommandLine, FillsTheOptionsOfNewAndReport) {
  const auto fresh = std::get<NewSceneOptions>(parsed({"new", "silo", "-o", "mine.toml", "--overwrite"}));
  EXPECT_EQ(fresh.kind, "silo");
  EXPECT_EQ(fresh.output, "mine.toml");
  EXPECT_EQ(fresh.existing, ExistingOutput::overwrite);
  EXPECT_THROW(parsed({"new", "avalanche", "-o", "mine.toml"}), InputError);
  EXPECT_THROW(parsed({"new", "silo"}), InputError);
  const auto report = std::get<ReportOptions>(parsed({"report", "RUN"}));
  EXPECT_EQ(report.run, "RUN");
  EXPECT_FALSE(report.output);
  EXPECT_TRUE(std::get<PlotOptions>(parsed({"plot", "RUN", "--player"})).player);
}

TEST(CommandLine, PrintsACompletionWithoutACommand) {
  const auto script = std::get<TextToShow>(parsed({"--completion", "bash"})).text;
  expect_has(script, "complete -o default -F _drumlin drumlin");
  expect_has(script, "--player");
  EXPECT_THROW(parsed({"--completion", "tcsh"}), InputError);
}

TEST(CommandLine, FillsTheOptionsOfEveryOtherCommand) {
  const auto measure =
      std::get<MeasureOptions>(parsed({"measure", "r", "--slice-width", "10", "--position", "-5"}));
  EXPECT_EQ(measure.run, "r");
  EXPECT_EQ(measure.slice_width, 10);
  EXPECT_EQ(measure.position, -5);
  EXPECT_EQ(measure.layer_thickness, 1);
  const auto calibrate =
      std::get<CalibrateOptions>(parsed({"calibrate", "r1", "r2", "-o", "law.toml", "--I-min", "1e-3"}));
  EXPECT_EQ(calibrate.runs.size(), 2u);
  EXPECT_EQ(calibrate.I_min, 1e-3);
  const auto flow = std::get<FlowOptions>(parsed({"flow", "f.toml", "--rheology", "law.toml", "-o", "f"}));
  EXPECT_EQ(flow.rheology, "law.toml");
  EXPECT_EQ(std::get<CompareOptions>(parsed({"compare", "r", "f", "-o", "c"})).flow_run, "f");
  const auto show = std::get<SceneOptions>(parsed({"scene", "show", "s.toml", "--set", "a=1"}));
  EXPECT_EQ(show.action, SceneAction::show);
  EXPECT_EQ(show.overrides.size(), 1u);
  EXPECT_EQ(std::get<SceneOptions>(parsed({"scene", "check", "s.toml"})).scene, "s.toml");
  EXPECT_TRUE(std::get<SceneOptions>(parsed({"scene", "keys", "--markdown"})).markdown);
  const auto solve = std::get<SolveContactsOptions>(
      parsed({"solve-contacts", "p.h5", "--solver", "nlgs", "--tolerance", "1e-6", "--max-seconds", "5",
              "--output", "s.h5", "--json", "--backward-error", "--watch", "10"}));
  EXPECT_EQ(solve.solver, "nlgs");
  EXPECT_EQ(solve.tolerance, 1e-6);
  EXPECT_EQ(solve.output, "s.h5");
  EXPECT_TRUE(solve.json);
  EXPECT_TRUE(solve.backward_error);
  EXPECT_EQ(solve.watch, 10);
  const auto hard = std::get<HardcasesOptions>(parsed({"hardcases", "wedge", "shot", "--fast", "-o", "h"}));
  EXPECT_EQ(hard.names, (std::vector<std::string>{"wedge", "shot"}));
  EXPECT_TRUE(hard.fast);
  EXPECT_EQ(hard.output, "h");
  EXPECT_FALSE(std::get<SolveContactsOptions>(parsed({"solve-contacts", "p.h5"})).output);
}

TEST(CommandLine, FillsTheOptionsOfCost) {
  const auto sweep = std::get<CostOptions>(
      parsed({"cost", "s.toml", "--rheology", "law.toml", "--sweep", "mesh=1:2,eps", "--ranks", "1,2",
              "--neighbour", "drum.rotation_rpm=5", "--repeats", "3", "-o", "c"}));
  EXPECT_EQ(sweep.sweep, (std::vector<std::string>{"mesh=1:2", "eps"}));
  EXPECT_EQ(sweep.ranks, (std::vector<int>{1, 2}));
  EXPECT_EQ(sweep.neighbour, std::vector<std::string>{"drum.rotation_rpm=5"});
  EXPECT_EQ(sweep.repeats, 3);
  const auto effects =
      std::get<CostOptions>(parsed({"cost", "--effects", "s.toml", "--variants", "k,inertia+k", "--against",
                                    "r1", "r2", "--time-limit", "900"}));
  EXPECT_EQ(effects.scene, "s.toml");
  EXPECT_EQ(effects.variants, (std::vector<std::string>{"k", "inertia+k"}));
  EXPECT_EQ(effects.against.size(), 2u);
  EXPECT_EQ(effects.time_limit_s, 900);
  EXPECT_EQ(effects.ranks, std::vector<int>{1});
}

TEST(CommandLine, RefusesWrongUsage) {
  const std::vector<std::vector<const char*>> wrong = {
      {},                 // no command
      {"walk"},           // none of ours
      {"run"},            // no scene
      {"run", "a.toml"},  // no output
      {"run", "a.toml", "-o", "o", "--resume", "--overwrite"},
      {"run", "a.toml", "-o", "o", "--threads", "0"},
      {"run", "a.toml", "-o", "o", "--threads", "two"},
      {"run", "a.toml", "-o", "o", "--unknown"},
      {"run", "a.toml", "b.toml", "-o", "o"},
      {"measure", "r", "--slice-width", "0"},
      {"measure", "r", "--slice-width", "inf"},
      {"measure", "r", "--slice-width", "nan"},
      {"calibrate", "-o", "law.toml"},
      {"flow", "f.toml", "-o", "o"},
      {"scene"},
      {"scene", "check"},
      {"solve-contacts", "p.h5", "--solver", "none"},
      {"solve-contacts", "p.h5", "--tolerance", "-1"},
      {"solve-contacts", "p.h5", "--watch", "0"},
      {"cost", "s.toml", "--repeats", "0"},
      {"cost", "s.toml", "--ranks", "1,0"},
      {"cost", "s.toml", "--ranks", "two"},
      {"cost", "s.toml", "--time-limit", "0"},
      {"cost", "s.toml", "--horizon", "-1"},
  };
  for (const auto& words : wrong) {
    std::string line;
    for (const char* word : words) line += std::string(" ") + word;
    EXPECT_THROW(parsed(words), InputError) << "drumlin" << line;
  }
}

TEST(CommandLine, ShowsHelpWithDefaultUnitAndRange) {
  const auto help = std::get<TextToShow>(parsed({"measure", "--help"})).text;
  expect_has(help, "--slice-width");
  expect_has(help, "=20");
  expect_has(help, "[d, ");
  for (const char* command : {"run", "calibrate", "flow", "compare", "solve-contacts", "scene"})
    expect_has(std::get<TextToShow>(parsed({command, "--help"})).text, "Usage");
  expect_has(std::get<TextToShow>(parsed({"--help"})).text, "solve-contacts");
}

TEST(CommandLine, ShowsItsVersion) {
  EXPECT_EQ(std::get<TextToShow>(parsed({"--version"})).text.rfind("drumlin ", 0), 0u);
}

}  // namespace
}  // namespace drumlin::apps
