// The program as a user meets it: exit codes, what goes to which stream, what it refuses to overwrite.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <sstream>

#include "tests/exchange_files/folder.hpp"
#include "tests/scene/example.hpp"

namespace drumlin {
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
    const auto out = folder / "out.txt", err = folder / "err.txt";
    const std::string line =
        std::string(DRUMLIN_PROGRAM) + " " + words + " >" + out.string() + " 2>" + err.string();
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
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

TEST_F(Program, EndsWithSeventyFourWhereItCannotWrite) {
  EXPECT_EQ(drumlin("run " + scene.string() + " -o /dev/null/r").code, 74);
}

}  // namespace
}  // namespace drumlin
