#include "coupling/core/basics/errors.hpp"

#include <gtest/gtest.h>

#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/basics/scales.hpp"

namespace drumlin {
namespace {

TEST(InputProblem, SaysPlaceKeyFaultAndWhatIsAllowed) {
  const InputProblem problem{"a.toml", 3, 7, "solver.tolerance", "is -1", "number, > 0"};
  EXPECT_EQ(problem.text(), "a.toml:3:7: solver.tolerance: is -1 (allowed: number, > 0)");
}

TEST(InputProblem, LeavesOutWhatItDoesNotKnow) {
  EXPECT_EQ((InputProblem{"a.toml", 3, 0, "", "is odd", ""}.text()), "a.toml:3: is odd");
  EXPECT_EQ((InputProblem{"", 0, 0, "", "is odd", ""}.text()), "is odd");
}

TEST(InputError, CarriesEveryProblemOnALineOfItsOwn) {
  const InputError error(
      std::vector<InputProblem>{{"f", 1, 1, "a", "is odd", ""}, {"f", 2, 1, "b", "is odd", ""}});
  EXPECT_EQ(error.problems().size(), 2u);
  EXPECT_STREQ(error.what(), "f:1:1: a: is odd\nf:2:1: b: is odd");
}

TEST(Scales, OfThePapersGrains) {
  const Scales scales = scales_of(3.3e-3, 9.81, 2700);
  EXPECT_DOUBLE_EQ(scales.length_m, 3.3e-3);
  EXPECT_NEAR(scales.time_s, 0.018341, 1e-6);          // sqrt(0.0033/9.81)
  EXPECT_NEAR(scales.velocity_m_s(), 0.179925, 1e-6);  // sqrt(9.81 * 0.0033)
  EXPECT_NEAR(scales.stress_Pa(), 2700 * 9.81 * 3.3e-3, 1e-9);
}

TEST(Scales, UseStandardGravityWhereThereIsNone) {
  EXPECT_DOUBLE_EQ(scales_of(3.3e-3, 0, 2700).time_s, scales_of(3.3e-3, 9.81, 2700).time_s);
}

TEST(Provenance, NamesRevisionCompilerAndMachine) {
  const Provenance p = provenance();
  EXPECT_FALSE(p.revision.empty());
  EXPECT_FALSE(p.compiler.empty());
  EXPECT_FALSE(p.build_type.empty());
  EXPECT_FALSE(p.machine.empty());
  EXPECT_GT(p.processors, 0);
}

}  // namespace
}  // namespace drumlin
