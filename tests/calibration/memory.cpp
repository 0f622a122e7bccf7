// What a material carries along its path: closed forms. The fits: tests/python/test_bed.py.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/calibration/law_points.hpp"
#include "coupling/core/law/memory_law.hpp"
#include "remembering_drum.hpp"

namespace drumlin {
using namespace coupling;
using namespace testing;
namespace {

TEST(AxisMemory, SteadySimpleShearHasItsClosedForm) {
  const AxisMemory law{.c = 5, .m = 0.8, .chi = 0.7};
  const double phi = std::atan(1 / law.c);
  const Deviator n(0, 1), A = std::polar(std::cos(phi), law.chi - phi) * n, sum = n + law.m * A;
  const Deviator found = carried_axes(steady_shear(200, 0.02, std::log(1e-5)), law);
  EXPECT_NEAR(std::abs(found - sum / std::abs(sum)), 0, 1e-12);
  // Where chi is atan(1/c) the stress lies along the strain rate: mu(I) and no more.
  const Deviator flow = carried_axes(steady_shear(200, 0.02, std::log(0.5)), law);
  EXPECT_NEAR(std::abs(flow - n), 0, 1e-12);
}

TEST(AxisMemory, TurnsWithTheMaterialWhereNothingShears) {
  const AxisMemory law{.c = 5, .m = 1, .chi = 0};
  StressPath path = steady_shear(400, 0.02, std::log(1e-5));
  const Deviator before = carried_axes(path, law);
  const double turn = 0.3;
  path.steps.push_back({0, turn, path.axis, std::log(1e-9)});
  path.axis *= std::polar(1.0, -2 * turn);
  EXPECT_NEAR(std::abs(carried_axes(path, law) - std::polar(1.0, -2 * turn) * before), 0, 1e-12);
}

TEST(AxisMemory, ForgetsByStrainAlone) {
  // Pure shear, then its axes turned: what is left of the memory after a strain e is exp(-2 c e).
  const AxisMemory law{.c = 5, .m = 1, .chi = 0};
  for (const std::size_t pieces : {1U, 40U}) {
    StressPath path;
    path.steps.assign(1, {5, 0, Deviator(1, 0), std::log(1e-4)});
    const double strain = 0.1;
    for (std::size_t k = 0; k < pieces; ++k)
      path.steps.push_back({strain / static_cast<double>(pieces), 0, Deviator(0, 1), std::log(1e-6)});
    path.axis = Deviator(0, 1);
    const double left = std::exp(-2 * law.c * strain);
    const Deviator sum = Deviator(0, 1) + Deviator(left, 1 - left);
    EXPECT_NEAR(std::abs(carried_axes(path, law) - sum / std::abs(sum)), 0, 1e-12);
  }
}

TEST(AxisMemory, LeadAngleIsThatOfTheLawThatFlowsComputeWith) {
  const AxisMemory law{.c = 6, .m = 1, .chi = 0.6, .I_low = 3e-3, .I_high = 0.05};
  const MemoryLaw written{.c = 6,
                          .m = 1,
                          .chi_deg = 0.6 * 180 / std::numbers::pi,
                          .c_rho = 100,
                          .I_low = 3e-3,
                          .I_high = 0.05,
                          .mu = {}};
  for (double I = 1e-6; I < 1; I *= 1.7)
    EXPECT_NEAR(lead_angle(law, std::log(I)), memory_turn(written, I), 1e-13);
}

TEST(PathFields, MotionFromDisplacementsIsTakenWhereTheMapHasIt) {
  FieldMap map = remembering_drum({});
  // Velocities of the bed that are noise, beside displacements that are right.
  for (const char* name : {"v_x", "v_z", "d_v_x_dx", "d_v_x_dz", "d_v_z_dx", "d_v_z_dz"})
    map.fields.push_back({std::string("displacement_") + name, map.field(name).value, {}});
  for (std::size_t node = 0; node < map.grid.nodes(); ++node)
    for (MapField& field : map.fields)
      if (field.name == "d_v_x_dz" || field.name == "d_v_z_dz")
        field.value[node] += node % 2 == 0 ? 0.01 : -0.01;
  EXPECT_NEAR(PathFields(map).share_from_displacements(), 1, 1e-12);
  const PathFields with(map), without(remembering_drum({}));
  EXPECT_EQ(with.at(3.3, -31.2).rate, without.at(3.3, -31.2).rate);
  const auto clean = law_points(remembering_drum({}), {.I_min = 1e-6});
  const auto moved = law_points(map, {.I_min = 1e-6, .displacements = true});
  ASSERT_EQ(clean.size(), moved.size());
  for (std::size_t i = 0; i < clean.size(); ++i) EXPECT_EQ(clean[i].friction.I, moved[i].friction.I);
}

}  // namespace
}  // namespace drumlin
