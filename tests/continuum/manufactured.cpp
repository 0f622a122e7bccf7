// Orders of convergence on a flow made up for the purpose.
#include <array>

#include "boxes.hpp"
#include "manufactured_flow.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;
using namespace testing_manufactured;

/// Errors on three meshes.
std::array<Errors, 3> errors_on_three_meshes(const Manufactured& made) {
  FlowSolverOptions options;
  options.levels = 3;
  options.tolerance = 1e-11;
  options.coarse_tolerance = options.tolerance;  // the errors of all meshes are compared
  options.picard_tolerance = 1e-6;               // below the errors of the finest mesh
  std::array<Errors, 3> found;
  FlowObserver observer;
  observer.level_finished = [&](int level, const FlowField& field) { found[level] = errors(field); };
  (void)converged(problem_of(made), options, observer);
  return found;
}

void expect_orders_of_Q2_Q1(const std::array<Errors, 3>& found) {
  // Halving the cells divides errors of order q by 2^q; a tenth of an order is left for the coarse meshes.
  for (int level = 1; level < 3; ++level) {
    EXPECT_GT(std::log2(found[level - 1].velocity / found[level].velocity), 2.9) << level;
    EXPECT_GT(std::log2(found[level - 1].gradient / found[level].gradient), 1.9) << level;
    EXPECT_GT(std::log2(found[level - 1].pressure / found[level].pressure), 1.9) << level;
  }
}

TEST(ManufacturedFlow, OfTheFrictionLawConvergesWithTheOrdersOfQ2Q1) {
  expect_orders_of_Q2_Q1(errors_on_three_meshes(of_friction_law()));
}

TEST(ManufacturedFlow, WithKConvergesWithTheOrdersOfQ2Q1) {
  expect_orders_of_Q2_Q1(errors_on_three_meshes(of_given_turn()));
}

TEST(ManufacturedFlow, FindsTheTurnOfItsStress) {
  const auto found = errors_on_three_meshes(of_found_turn());
  // The turn is linear between the vertices, where it comes from derivatives of D: an error of second order
  // in the stress, so that the velocity, of third order without it, loses up to one.
  for (int level = 1; level < 3; ++level) {
    EXPECT_GT(std::log2(found[level - 1].velocity / found[level].velocity), 2.0) << level;
    EXPECT_GT(std::log2(found[level - 1].gradient / found[level].gradient), 1.8) << level;
    EXPECT_GT(std::log2(found[level - 1].pressure / found[level].pressure), 1.8) << level;
  }
}

}  // namespace
}  // namespace drumlin
