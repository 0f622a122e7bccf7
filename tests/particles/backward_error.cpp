// The backward error of impulses, and contacts that change their state.
#include "particles/lab/backward_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "particles/contact/residual.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "particles/lab/disc_problem.hpp"
#include "particles/lab/state_changes.hpp"
#include "tests/particles/solving.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

constexpr std::array changes_of_friction{0.0, 1e-3, 1e-2, 2.6e-2, 5e-2, 1.0};

/// Contacts that do not feel one another, W_nn = 1, W_tt = 3, mu = 1/2.
BlockProblem apart(const std::vector<double>& q) {
  BlockProblem problem;
  problem.q = q;
  problem.W.row_start.push_back(0);
  for (int a = 0; a < static_cast<int>(q.size()) / 2; ++a) {
    problem.mu.push_back(0.5);
    problem.W.column.push_back(a);
    problem.W.block.push_back(Eigen::Vector2d(1, 3).asDiagonal());
    problem.W.diagonal.push_back(problem.W.block.back());
    problem.W.row_start.push_back(a + 1);
  }
  return problem;
}

BlockProblem flowing() {
  return read_contact_problem(data_folder() / "problems" / "drum-300-mu-0.4-flow.h5");
}

std::vector<double> solved(const BlockProblem& problem, const char* solver, double tolerance) {
  return solved_by(solver, disc_problem(problem).value(), tolerance, 60000).impulses;
}

BackwardError at(const BlockProblem& problem, const std::vector<double>& r, double friction) {
  return backward_errors(problem, r, std::array{friction}).at(0);
}

TEST(BackwardError, TakesAwayWhatALawForbidsContactByContact) {
  const BlockProblem problem = apart({1, 1, 1, 1, 1, 1});
  struct Case {
    std::array<double, 2> r, u, dq;
    double friction;
    ContactState state;
  };
  const double inf = std::numeric_limits<double>::infinity();
  const ContactState open = ContactState::open, sticks = ContactState::sticking,
                     slides = ContactState::sliding;
  for (const Case& c : {
           Case{{0, 0}, {2, 3}, {0, 0}, 0, open}, Case{{0, 0}, {-2, 3}, {2, 0}, 0, open},  // would overlap
           Case{{1, 0.2}, {-2, 3}, {2, -3}, 0, sticks},                                    // within its cone
           Case{{1, 0.5}, {-2, -3}, {2, 0}, 0, slides},                                    // against r_t
           Case{{1, 0.5}, {0, 3}, {0, -3}, 0, sticks},                                     // with r_t
           Case{{1, 0.49}, {0, -3}, {0, 3}, 0.01, sticks},                                 // too far within
           Case{{1, 0.49}, {0, -3}, {0, 0}, 0.03, slides},
           Case{{1, 0.51}, {0, -3}, {inf, 0}, 0.01, open},  // beyond any cone that may be
           Case{{1, 0.51}, {0, -3}, {0, 0}, 0.03, slides}, Case{{-1, 0}, {0, 0}, {inf, 0}, 1, open},
           Case{{0, 0.1}, {0, 0}, {inf, 0}, 1, open},
           Case{{1, 0}, {0, -3}, {0, 0}, 1, slides},  // without friction
       }) {
    std::vector<ContactState> states;
    std::vector<double> r(6, 0.0), u(6, 0.0);
    std::copy(c.r.begin(), c.r.end(), r.begin() + 2), std::copy(c.u.begin(), c.u.end(), u.begin() + 2);
    const auto dq = velocity_changes(problem, r, u, c.friction, states);
    EXPECT_EQ(dq[2], c.dq[0]) << c.r[1] << ' ' << c.friction;
    EXPECT_EQ(dq[3], c.dq[1]) << c.r[1] << ' ' << c.friction;
    if (std::isfinite(c.dq[0])) {
      EXPECT_EQ(states[1], c.state) << c.r[1] << ' ' << c.friction;
    }
  }
}

TEST(BackwardError, FindsTheFrictionThatAProblemWasSolvedFor) {
  BlockProblem problem = flowing();
  const std::vector<double> mu = problem.mu;
  for (double& friction : problem.mu) friction *= 0.39 / 0.4;
  const std::vector<double> r = solved(problem, "reference", 1e-9);
  problem.mu = mu;
  EXPECT_LE(at(problem, r, 0.026).dq, 1e-8);  // 0.4 (1 - 0.026) < 0.39
  EXPECT_GE(at(problem, r, 0.024).dq, 1e-4);
}

TEST(BackwardError, OfAPerturbedProblemIsAtMostThePerturbation) {
  BlockProblem problem = flowing();
  const std::vector<double> r = solved(problem, "reference", 1e-9);
  std::mt19937 bits(5);
  double squares = 0;
  for (double& q : problem.q) {
    const double change = 1e-4 * (static_cast<double>(bits()) / 4294967296.0 - 0.5);
    q += change;
    squares += change * change;
  }
  const double perturbation = std::sqrt(2 * squares / squared_norm(problem.q));  // two entries per contact
  for (const double x : changes_of_friction) EXPECT_LE(at(problem, r, x).dq, perturbation + 1e-8);
}

TEST(BackwardError, ShrinksWithTheFrictionThatMayDiffer) {
  const BlockProblem problem = flowing();
  const auto errors = backward_errors(problem, solved(problem, "accelerated", 3e-3), changes_of_friction);
  for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_LE(errors[k].dq, errors[k - 1].dq);
}

TEST(BackwardError, IsOfTheSizeOfTheResidual) {
  // (1 + mu + |W diag(rho)|) residual at most: |W diag(rho)| <= 6 discs around one, twice.
  const BlockProblem problem = flowing();
  for (const char* solver : {"accelerated", "nlgs", "nncg", "cpg"})  // in single and in double precision
    for (const double tolerance : {1e-2, 1e-3}) {
      const std::vector<double> r = solved(problem, solver, tolerance);
      const double residual = residual_at(problem, r).rms;
      EXPECT_LE(at(problem, r, 0).dq, 14 * residual) << solver;
      EXPECT_GE(at(problem, r, 0).dq, 0.1 * residual) << solver;
    }
}

TEST(BackwardError, TheChangedProblemIsSolvedExactly) {
  BlockProblem problem = flowing();
  const std::vector<double> r = solved(problem, "accelerated-double", 1e-2);
  std::vector<double> u;
  BlockDelassus::State none;
  problem.W.velocities(r, problem.q, none, u);
  std::vector<ContactState> states;
  const double friction = 0.01;
  const auto dq = velocity_changes(problem, r, u, friction, states);
  for (int a = 0; a < problem.contacts(); ++a)
    if (states[a] == ContactState::sliding) problem.mu[a] = std::abs(r[2 * a + 1]) / r[2 * a];
  const auto before = residual_at(problem, r).rms;
  for (std::size_t k = 0; k < dq.size(); ++k) problem.q[k] += dq[k];
  EXPECT_GE(before, 1e-3);
  EXPECT_LE(residual_at(problem, r).rms, 1e-12);
}

TEST(BackwardError, OfNoContactsIsZero) { EXPECT_EQ(at(BlockProblem{}, {}, 0).dq, 0); }

TEST(StateChanges, AreNoneOfASolutionAndSomeOnTheWayToIt) {
  const BlockProblem problem = flowing();
  const auto exact = solved(problem, "reference", 1e-9);
  const auto still = state_changes(problem, exact, 100);
  EXPECT_EQ(still.total, 0);
  EXPECT_EQ(still.changed, 0);
  EXPECT_EQ(still.states, contact_states_of(problem, std::span<const double>(exact)));
  const auto moving = state_changes(problem, std::vector<double>(exact.size(), 0.0), 100);
  EXPECT_GT(moving.total, moving.changed);
  EXPECT_GT(moving.changed, 0);
  EXPECT_LE(moving.most_of_it, moving.changed);
}

TEST(StateChanges, ReadTheStatesOffTheImpulses) {
  const BlockProblem problem = apart({1, 7, -1, 0.75, -1, 2});
  const std::vector<double> r{0, 0, 1, -0.25, 1, -0.5};
  EXPECT_EQ(contact_states_of(problem, std::span<const double>(r)),
            (std::vector{ContactState::open, ContactState::sticking, ContactState::sliding}));
}

}  // namespace
}  // namespace drumlin
