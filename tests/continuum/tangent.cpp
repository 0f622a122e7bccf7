// The assembled tangent against differences of the assembled residual, with every effect that has terms in
// it.
#include <gtest/gtest.h>

#include "remembering.hpp"
#include "tangent_error.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_remembering;
using Add = void (*)(FlowProblem&);

void add_k(FlowProblem& problem) {
  problem.turned = NonCoaxialStress{.k = StressRatioLaw({0.05, 20}, {0.7, 1.3})};
}
void add_cohesion(FlowProblem& problem) { problem.law = CohesiveLaw{0.7, 0.3, 1.1}; }
void add_nonlocal(FlowProblem& problem) { problem.nonlocal = NonlocalFluidity{.length = 1.5}; }
void add_memory(FlowProblem& problem) { problem.memory.emplace(law); }
void add_amount(FlowProblem& problem) {
  add_memory(problem);
  problem.memory->law.amount = swelling;
  problem.memory->law.amount->creep->ratio = 1;  // where the material turns faster than it shears
}
void add_threshold(FlowProblem& problem) { problem.threshold_fluidity = ThresholdFluidity{0.8, 0.3}; }
void add_turning_rough_wall(FlowProblem& problem) {
  problem.frame = RotatingFrame{0.3, 0.5};
  const auto velocity = [](Vec2 x) { return Vec2{0.2 * x.z, -0.2 * x.x}; };
  problem.boundary[Side::bottom] = FrictionWall{.velocity = velocity, .friction = 0.5, .slip_speed = 0.3};
}

TEST(AssembledTangent, IsTheDerivativeOfTheResidual) {
  struct Row {
    const char* name;
    std::vector<Add> effects;
    bool inertia = false;
  };
  for (const Row& row :
       {Row{"none", {}}, Row{"inertia", {}, true}, Row{"k", {add_k}}, Row{"cohesion", {add_cohesion}},
        Row{"nonlocal", {add_nonlocal}}, Row{"nonlocal with k", {add_k, add_nonlocal}},
        Row{"memory", {add_memory}}, Row{"nonlocal memory", {add_memory, add_nonlocal}},
        Row{"amount", {add_amount}}, Row{"nonlocal amount", {add_amount, add_nonlocal}},
        Row{"threshold", {add_threshold}, true}, Row{"threshold with memory", {add_threshold, add_memory}},
        Row{"a wall with friction seen from a turning frame", {add_turning_rough_wall}, true}}) {
    FlowProblem problem = testing_tangent::small_segment();
    for (const Add add : row.effects) add(problem);
    EXPECT_LT(testing_tangent::tangent_error(problem, row.inertia, 1e-6), 1e-7) << row.name;
  }
}

}  // namespace
}  // namespace drumlin
