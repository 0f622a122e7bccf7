// The public problem set: every solver improves on nothing, the reference solves it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "particles/lab/contact_problem_file.hpp"
#include "tests/particles/solving.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

namespace fs = std::filesystem;

std::vector<std::string> problem_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(data_folder() / "problems"))
    if (entry.path().extension() == ".h5") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ProblemSet : public ::testing::TestWithParam<std::string> {
 protected:
  const fs::path file = data_folder() / "problems" / (GetParam() + ".h5");
  const BlockProblem problem = read_contact_problem(file);
};

TEST_P(ProblemSet, EverySolverEndsInTheConesBetterThanItBegan) {
  const std::vector<double> nothing(problem.q.size(), 0.0);
  const double before = residual_at(problem, nothing).rms;
  for (const std::string& solver : any_solver_names()) {
    const auto solution = solved_by(solver, problem, 1e-3, 500);
    const std::vector<double>& r = solution.impulses;
    EXPECT_LT(solution.report.residual.rms, before) << solver;
    for (int a = 0; a < problem.contacts(); ++a)
      EXPECT_LE(std::abs(r[2 * a + 1]), problem.mu[a] * r[2 * a] * (1 + 1e-12))
          << solver << ", contact " << a;
  }
}

TEST_P(ProblemSet, TheReferenceReachesOneInTenMillion) {
  // Best known residuals are below 1e-9 (data/problems/README.md); this many sweeps and factorisations take
  // seconds.
  EXPECT_EQ(solved_by("reference", problem, 1e-7, 8000).report.status, Status::converged);
}

INSTANTIATE_TEST_SUITE_P(Public, ProblemSet, ::testing::ValuesIn(problem_names()), [](const auto& test) {
  std::string name = test.param;  // letters and underscores only
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace drumlin
