// Bodies and blocks are two forms of one problem.
#include "particles/lab/block_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "particles/contact/residual.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double operator()() { return 2 * static_cast<double>(bits_()) / 4294967296.0 - 1; }
  int below(int count) { return static_cast<int>(bits_() % static_cast<unsigned>(count)); }

 private:
  std::mt19937 bits_;
};

/// Bodies of random masses (one of them a hundred times heavier), pairs that meet twice, walls.
template <class Problem>
Problem random_problem(unsigned seed, std::vector<double>& r) {
  Random random(seed);
  const int bodies = 12, contacts = 30;
  Problem problem;
  problem.time_step = 0.01;
  for (int b = 0; b < bodies; ++b) problem.W.inverse_mass.push_back(b == 3 ? 0.01 : 1.5 + random());
  problem.W.inverse_mass.push_back(0);
  for (int a = 0; a < contacts; ++a) {
    const int i = random.below(bodies);
    const int j = a % 4 == 0 ? bodies : (i + 1 + random.below(bodies - 1)) % bodies;
    const double angle = 3.141592653589793 * random();
    problem.W.add(i, j, std::cos(angle), std::sin(angle));
    if (Problem::dim == 2) problem.mu.push_back(0.5 + 0.4 * random());
    for (int c = 0; c < Problem::dim; ++c) {
      problem.q.push_back(random());
      r.push_back(c == 0 ? std::max(0.0, random()) : 0.2 * random());
    }
  }
  return problem;
}

template <class Problem>
class BlockForm : public ::testing::Test {};
using BodyProblems = ::testing::Types<FrictionlessProblem, CoulombProblem, CoulombSpinProblem>;
TYPED_TEST_SUITE(BlockForm, BodyProblems);

TYPED_TEST(BlockForm, HasTheSameVelocitiesAndTheSameResidual) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::vector<double> r;
    const auto problem = random_problem<TypeParam>(seed, r);
    const BlockProblem blocks = block_problem(problem);
    const auto r_blocks = block_layout<TypeParam>(r);
    typename TypeParam::Delassus::State scratch;
    std::vector<double> u, u_blocks, unused;
    problem.W.velocities(r, problem.q, scratch, u);
    blocks.W.velocities(r_blocks, blocks.q, unused, u_blocks);
    for (int a = 0; a < problem.contacts(); ++a)
      for (int c = 0; c < TypeParam::dim; ++c)
        EXPECT_NEAR(u[TypeParam::dim * a + c], u_blocks[2 * a + c], 1e-13) << a;
    const ContactResidual one = residual_at(problem, r);
    const ContactResidual other = residual_at(blocks, r_blocks);
    // A frictionless contact carries a second, empty entry of q.
    const double entries = TypeParam::dim == 1 ? std::sqrt(2.0) : 1;
    EXPECT_NEAR(other.rms, entries * one.rms, 1e-13);
    EXPECT_NEAR(other.max, entries * one.max, 1e-12);
    EXPECT_NEAR(other.penetration, one.penetration, 1e-14);
  }
}

TEST(BlockProblem, OfAStepIsNoneWhereAFileCannotHoldIt) {
  std::vector<double> r;
  auto problem = random_problem<CoulombProblem>(2, r);
  EXPECT_EQ(block_problem(DiscProblem(&problem)).value().W.block, block_problem(problem).W.block);
  problem.W.cell = CellBody{};
  EXPECT_FALSE(block_problem(DiscProblem(&problem)));
  const RollingProblem rolling;
  EXPECT_FALSE(block_problem(DiscProblem(&rolling)));
}

TEST(BlockProblem, ContactsThatShareOnlyAWallAreNotCoupled) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1, 1, 0};
  problem.W.add(0, 2, 0, 1);
  problem.W.add(1, 2, 0, 1);
  problem.q = {-1, 0, -1, 0};
  problem.mu = {0.4, 0.4};
  const BlockProblem blocks = block_problem(problem);
  EXPECT_EQ(blocks.W.row_start, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(blocks.W.diagonal[0](0, 0), 1);
  EXPECT_EQ(blocks.W.diagonal[0](1, 1), 3);  // W_tt = 3 W_nn with spin
}

}  // namespace
}  // namespace drumlin
