// The program as a user meets it: exit codes, what goes to which stream, what it refuses to overwrite.
#include <gtest/gtest.h>

#include <sstream>

#include "coupling/common/child_process.hpp"
#include "tests/exchange_files/folder.hpp"
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

TEST_F(Program, EndsWithZeroWhereItDidWhatWasAsked) {
  EXPECT_EQ(drumlin("--version").code, 0);
  EXPECT_EQ(drumlin("--help").code, 0);
  const Outcome check = drumlin("scene check " + scene.string());
  EXPECT_EQ(check.code, 0);
  EXPECT_NE(check.out.find("ok"), std::string::npos);
  EXPECT_NE(check.out.find("200 steps, 4 snapshots"), std::string::npos) << check.out;
  EXPECT_NE(drumlin("scene keys").out.find("solver.tolerance"), std::string::npos);
}

TEST_F(Program, ShowsASceneThatShowsTheSame) {
  const std::string shown =
      drumlin("scene show " + scene.string() + " --set solver.max_sweeps=7 --set solver.check_every=7").out;
  EXPECT_NE(shown.find("max_sweeps = 7"), std::string::npos);
  EXPECT_EQ(drumlin("scene show " + folder.with("shown.toml", shown).string()).out, shown);
}

TEST_F(Program, EndsWithTwoOnWrongUsageAndInput) {
  for (const std::string& words :
       {std::string(), std::string("walk"), std::string("run"), "run " + scene.string(),
        "scene check " + (folder / "none.toml").string(), "scene check " + folder.path().string(),
        "scene check " + folder.with("empty.toml", "").string(), "measure " + (folder / "none").string(),
        run_to("r") + " --set solver.tolerance=0"}) {
    const Outcome outcome = drumlin(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_EQ(outcome.out, "") << words;
    EXPECT_NE(outcome.err, "") << words;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "r")) << "nothing is made for a scene that is refused";
}

TEST_F(Program, PrintsEveryProblemOnALineOfItsOwn) {
  const Outcome outcome = drumlin("scene check " + scene.string() +
                                  " --set solver.tolerance=0 --set effects.spinn={} --set titel=x");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 3) << outcome.err;
}

TEST_F(Program, RefusesAnExistingOutputUnlessTold) {
  EXPECT_EQ(drumlin(run_to("r")).code, 0);
  EXPECT_EQ(drumlin(run_to("r")).code, 2);
  EXPECT_EQ(drumlin(run_to("r") + " --resume").code, 0);
  EXPECT_EQ(drumlin(run_to("r") + " --overwrite").code, 0);
}

TEST_F(Program, RunsAgainFromTheSceneThatARunLeaves) {
  ASSERT_EQ(drumlin(run_to("r")).code, 0);
  const auto resolved = folder.path() / "r" / "scene.toml", again = folder / "again";
  ASSERT_EQ(drumlin("run " + resolved.string() + " -o " + again.string()).code, 0);
  EXPECT_EQ(content(again / "scene.toml"), content(resolved));
  EXPECT_EQ(content(again / "log.csv"), content(folder.path() / "r" / "log.csv"));
  EXPECT_EQ(content(again / "snapshots" / "000004.h5"),
            content(folder.path() / "r" / "snapshots" / "000004.h5"));
}

TEST_F(Program, EndsWithThreeWhereTheSolverDoesNotConverge) {
  const Outcome outcome =
      drumlin(run_to("r") +
              " --set solver.tolerance=1e-12 --set solver.max_sweeps=1 --set solver.check_every=1"
              " --set solver.stop_when_unconverged=true");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_NE(outcome.err.find("residual"), std::string::npos) << outcome.err;
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
    EXPECT_NE(looked.out.find(part), std::string::npos) << looked.out;
  EXPECT_EQ(looked.out.find("null"), std::string::npos) << looked.out;  // the file says the time step

  // The step that ends a run leaves its problem too, and is named.
  const Outcome fatal = drumlin(run_to("s") + hopeless + " --set solver.stop_when_unconverged=true");
  EXPECT_EQ(fatal.code, 3);
  const auto problem = *std::filesystem::directory_iterator(folder.path() / "s" / "problems");
  const auto step = std::stoi(problem.path().stem().string().substr(5));
  EXPECT_NE(fatal.err.find("step " + std::to_string(step) + ":"), std::string::npos) << fatal.err;
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
  EXPECT_NE(left.err.find("step 1: grain 0 left its container"), std::string::npos) << left.err;
  EXPECT_NE(content(folder.path() / "left" / "run.json").find("\"grain lost\""), std::string::npos);
}

TEST_F(Program, RefusesGrainsThatStandInOneAnotherOrInAWall) {
  const auto listed = [&](const std::string& name, const std::string& rows) {
    std::ofstream(folder.path() / name) << "x_mm,z_mm,diameter_mm\n" << rows;
    return " --set 'grains={density_kg_m3=2700, listed={file=\"" + name + "\"}}'";
  };
  const std::string check = "scene check " + scene.string();
  const Outcome coincident = drumlin(check + listed("coincident.csv", "0,0,3\n0,0,3\n"));
  EXPECT_EQ(coincident.code, 2);
  EXPECT_NE(coincident.err.find("grain 1 overlaps grain 2 by 1 of a diameter"), std::string::npos)
      << coincident.err;
  const Outcome outside = drumlin(check + listed("outside.csv", "0,0,3\n900,0,3\n"));
  EXPECT_EQ(outside.code, 2);
  EXPECT_NE(outside.err.find("grain 2 overlaps wall"), std::string::npos) << outside.err;
  // A little is pushed apart, and told.
  const Outcome little = drumlin(check + listed("little.csv", "0,0,3\n2.9,0,3\n"));
  EXPECT_EQ(little.code, 0);
  EXPECT_NE(little.out.find("warning: 1 pairs overlap at the start, by up to 0.033"), std::string::npos)
      << little.out;
}

TEST_F(Program, EndsWithAWarningWhereManyStepsMissTheirTolerance) {
  const Outcome missed = drumlin(
      run_to("r") + " --set solver.tolerance=1e-12 --set solver.max_sweeps=1 --set solver.check_every=1");
  EXPECT_EQ(missed.code, 3);  // most of them
  EXPECT_NE(missed.out.find("missed a tolerance: forces and positions of these steps do not hold"),
            std::string::npos);
  EXPECT_NE(content(folder.path() / "r" / "run.json").find("do not hold"), std::string::npos);
  EXPECT_EQ(drumlin(run_to("s")).out.find("warning"), std::string::npos);
}

TEST_F(Program, RefusesAStepInWhichAGrainFallsPastAnother) {
  const Outcome outcome = drumlin("scene check " + scene.string() + " --set stages.0.time_step_s=0.1");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("in which a grain falls by"), std::string::npos) << outcome.err;
}

TEST_F(Program, EndsWithSeventyFourWhereItCannotWrite) {
  EXPECT_EQ(drumlin("run " + scene.string() + " -o /dev/null/r").code, 74);
}

}  // namespace
}  // namespace drumlin
