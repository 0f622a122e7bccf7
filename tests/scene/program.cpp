// The program as a user meets it: exit codes, what goes to which stream, what it refuses to overwrite.
#include <gtest/gtest.h>

#include <sstream>

#include "coupling/core/machine/child_process.hpp"
#include "tests/files/folder.hpp"
#include "tests/scene/example.hpp"

namespace drumlin {
using namespace particles;
namespace {

struct Outcome {
  int code = -1;
  std::string out, err;
};

class Program : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  std::filesystem::path scene = folder.with("scene.toml", testing::example_scene);

  static std::string content(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  Outcome drumlin(const std::string& words) const {
    const auto err = folder / "err.txt";
    Outcome outcome;
    ProcessRequest shell{.program = "/bin/sh"};
    shell.words = {"-c", std::string(DRUMLIN_PROGRAM) + " " + words + " 2>" + err.string()};
    shell.output = ProcessOutput::standard;
    shell.line = [&](const std::string& line) { outcome.out += line + "\n"; };
    outcome.code = run_process(shell).shell_code();
    outcome.err = content(err);
    return outcome;
  }
  std::string run_to(const std::string& name) const {
    return "run " + scene.string() + " -o " + (folder / name).string();
  }
};

TEST_F(Program, ShowsASceneThatShowsTheSame) {
  const std::string shown =
      drumlin("scene show " + scene.string() + " --set solver.max_sweeps=7 --set solver.check_every=7").out;
  expect_has(shown, "max_sweeps = 7");
  EXPECT_EQ(drumlin("scene show " + folder.with("shown.toml", shown).string()).out, shown);
}

TEST_F(Program, PrintsEveryProblemOnALineOfItsOwn) {
  const Outcome outcome = drumlin("scene check " + scene.string() +
                                  " --set solver.tolerance=0 --set effects.spinn={} --set titel=x");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
}

TEST_F(Program, LeavesTheProblemsThatItCouldNotSolveToSolveContacts) {
  const std::string hopeless =
      " --set solver.tolerance=1e-12 --set solver.max_sweeps=1 --set solver.check_every=1"
      " --set solver.capture_unconverged=2";
  ASSERT_EQ(drumlin(run_to("r") + hopeless).code, 3);  // it goes to its end
  std::vector<std::filesystem::path> problems;
  for (const auto& file : std::filesystem::directory_iterator(folder.path() / "r" / "problems"))
    problems.push_back(file.path());
  ASSERT_EQ(problems.size(), 2u);  // of all the steps that missed it
  EXPECT_EQ(drumlin("solve-contacts " + problems[0].string() + " --tolerance 1e-6").code, 0);
  const Outcome looked =
      drumlin("solve-contacts " + problems[0].string() + " --json --backward-error --watch 3");
  EXPECT_EQ(looked.code, 0);
  for (const char* part : {"\"backward_error\"", "\"friction\": 0.05", "\"sweeps\": 3"})
    expect_has(looked.out, part);
  expect_lacks(looked.out, "null");  // the file says the time step

  // The step that ends a run leaves its problem too, and is named.
  const Outcome fatal = drumlin(run_to("s") + hopeless + " --set solver.stop_when_unconverged=true");
  EXPECT_EQ(fatal.code, 3);
  const auto problem = *std::filesystem::directory_iterator(folder.path() / "s" / "problems");
  const auto step = std::stoi(problem.path().stem().string().substr(5));
  expect_has(fatal.err, "step " + std::to_string(step) + ":");
}

TEST_F(Program, EndsWithThreeWhereAGrainLeaves) {
  // A row of discs shot at the wall, one sweep: the first step puts the foremost disc outside.
  std::string shot = "x_mm,z_mm,diameter_mm,v_x_mm_s\n";
  for (int k = 0; k < 5; ++k) shot += std::to_string(8 - 3 * k) + ",0,3,80000\n";
  std::ofstream(folder.path() / "shot.csv") << shot;
  const Outcome left = drumlin(run_to("left") +
                               " --set 'grains={density_kg_m3=2700, listed={file=\"shot.csv\"}}'"
                               " --set solver.max_sweeps=1 --set solver.check_every=1 --set "
                               "solver.projection_sweeps=0");
  EXPECT_EQ(left.code, 3);
  expect_has(left.err, "step 1: grain 0 left its container");
  expect_has(content(folder.path() / "left" / "run.json"), "\"grain lost\"");
}

TEST_F(Program, RefusesGrainsThatStandInOneAnotherOrInAWall) {
  const auto listed = [&](const std::string& name, const std::string& rows) {
    std::ofstream(folder.path() / name) << "x_mm,z_mm,diameter_mm\n" << rows;
    return " --set 'grains={density_kg_m3=2700, listed={file=\"" + name + "\"}}'";
  };
  const std::string check = "scene check " + scene.string();
  const Outcome coincident = drumlin(check + listed("coincident.csv", "0,0,3\n0,0,3\n"));
  EXPECT_EQ(coincident.code, 2);
  expect_has(coincident.err, "grain 1 overlaps grain 2 by 1 of a diameter");
  const Outcome outside = drumlin(check + listed("outside.csv", "0,0,3\n900,0,3\n"));
  EXPECT_EQ(outside.code, 2);
  expect_has(outside.err, "grain 2 overlaps wall");
  // A little is pushed apart, and told.
  const Outcome little = drumlin(check + listed("little.csv", "0,0,3\n2.9,0,3\n"));
  EXPECT_EQ(little.code, 0);
  expect_has(little.out, "warning: 1 pairs overlap at the start, by up to 0.033");
}

TEST_F(Program, EndsWithAWarningWhereManyStepsMissTheirTolerance) {
  const Outcome missed = drumlin(
      run_to("r") + " --set solver.tolerance=1e-12 --set solver.max_sweeps=1 --set solver.check_every=1");
  EXPECT_EQ(missed.code, 3);  // most of them
  expect_has(missed.out, "missed a tolerance: forces and positions of these steps do not hold");
  expect_has(content(folder.path() / "r" / "run.json"), "do not hold");
  expect_lacks(drumlin(run_to("s")).out, "warning");
}

TEST_F(Program, EndsWithSeventyFourWhereItCannotWrite) {
  EXPECT_EQ(drumlin("run " + scene.string() + " -o /dev/null/r").code, 74);
}

}  // namespace
}  // namespace drumlin
