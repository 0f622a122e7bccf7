// A drum of 30 grains' width: what must hold of every drum.
#include "tests/hardcases/continuum/small_drum.hpp"

#include <filesystem>

#include "boxes.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"

namespace drumlin::small_drum_test {
using namespace continuum;
namespace {

using namespace testing_boxes;

const DrumGeometry drum = drumlin::small_drum();

TEST(SmallDrum, BalancesMassForcesTorqueAndPower) {
  for (const StressLaw& law : {StressLaw(paper_law), StressLaw(CohesiveLaw{0.1, 0.25, 0.3})}) {
    const FlowField field = converged(small_drum_problem(law), one_mesh());
    const FlowIntegrals sums = field.integrals({0, drum.axis_offset});
    EXPECT_NEAR(sums.area, segment_area(drum.radius, drum.axis_offset), 1e-3 * sums.area);  // quadratic arcs
    // Q from the velocity against mass balance: what the stiff surface lets through.
    EXPECT_NEAR(discharge(field, drum) / drum.expected_Q(), 1, 1e-3);
    // The slope is that at which the surface has no moment, so that the wall's torque carries the weight's.
    EXPECT_NEAR(sums.surface_moment, 0, 1e-8);
    EXPECT_NEAR(sums.given_side_torque / sums.weight_torque, -1, 1e-4);
    EXPECT_NEAR(sums.surface_force, 0, 0.02);
    EXPECT_NEAR(sums.dissipation / (sums.given_side_power + sums.weight_power), 1, 1e-3);
    EXPECT_GT(field.theta(), 15 * degree);
    EXPECT_LT(field.theta(), 25 * degree);
  }
}

TEST(SmallDrum, FluxIsThatOfMassBalanceAtAnyFill) {
  for (const double fill : {0.3, 0.7}) {  // half full: above
    DrumGeometry filled = drum;
    filled.axis_offset = chord_offset(drum.radius, fill * std::numbers::pi * drum.radius * drum.radius);
    const FlowField field = converged(small_drum_problem(filled), one_mesh());
    EXPECT_NEAR(discharge(field, filled) / filled.expected_Q(), 1, 1e-3) << fill;
    EXPECT_NEAR(drum_checks(field, filled).value("torque_relative_error"), 0, 1e-4) << fill;
  }
}

TEST(SmallDrum, AsMuchFlowsInAsOutThroughAnyCut) {
  std::vector<double> imbalance;
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) {
    imbalance.push_back(flux_imbalance(field, drum));
  };
  FlowSolverOptions options;
  options.levels = 2;
  (void)converged(small_drum_problem(), options, observer);
  // The worst cuts end in the corners, where the flow turns within 3 d: cells of 2 d
  // leave 2.5e-3 there, and Q2-Q1 holds div u = 0 in the mean of its pressures alone, to
  // second order.
  ASSERT_EQ(imbalance.size(), 2u);
  EXPECT_LT(imbalance[1], 1e-3);
  EXPECT_LT(imbalance[1], imbalance[0] / 3);
  // It sees a leak: a soft surface lets a share of the flow through.
  FlowProblem soft = small_drum_problem();
  soft.boundary[Side::top] = NormalSpring{10};
  EXPECT_GT(flux_imbalance(converged(soft, one_mesh()), drum), 2e-2);
}

TEST(SmallDrum, SurfaceCarriesTheMomentThatAPrescribedSlopeLeaves) {
  DrumGeometry flat = drum;
  flat.slope = 18 * degree;
  const FlowField field = converged(small_drum_problem(flat), one_mesh());
  EXPECT_EQ(field.theta(), *flat.slope);
  const ScalarSet checks = drum_checks(field, flat);
  // Flatter than the slope that is found: the weight's torque is smaller than the wall's.
  EXPECT_LT(checks.value("surface_moment"), -1);
  EXPECT_NEAR(checks.value("torque_relative_error"), 0, 1e-4);
  EXPECT_NEAR(checks.value("Q_relative_error"), 0, 1e-3);
}

TEST(SmallDrum, SlopeDoesNotDependOnItsFirstGuess) {
  FlowProblem steep = small_drum_problem();
  steep.slope = SlopeFromMoment{0.6};
  EXPECT_NEAR(converged(small_drum_problem(), one_mesh()).theta(), converged(steep, one_mesh()).theta(),
              1e-6);
}

TEST(SmallDrum, LeavesProfilesAndAVtu) {
  const FlowField field = converged(small_drum_problem(), one_mesh());
  const ProfileSet profiles = drum_profiles(field, drum);
  ASSERT_EQ(profiles.z.size(), 14u);  // the depth, in layers of 1 d
  EXPECT_EQ(profiles.z.back(), -0.5);
  const auto& v_x = profiles.column("v_x").value;
  EXPECT_GT(v_x.back(), 0);
  EXPECT_NEAR(v_x.front(), 0, 0.02 * v_x.back());  // at the wall, in the frame of the drum
  const auto& sigma_zz = profiles.column("sigma_zz").value;
  EXPECT_NEAR((sigma_zz[4] - sigma_zz[8]) / 4, drum.nu * std::cos(field.theta()),
              0.05);  // nearly hydrostatic
  EXPECT_GT(profiles.column("sigma_xz").value[10], 0);

  const auto folder = std::filesystem::temp_directory_path();
  const auto vtu = folder / "drumlin_small_drum.vtu";
  field.write_vtu(vtu, {0.0033, 0.0183, 2700});
  if (!field.on_first_rank()) return;
  if (std::filesystem::exists(vtu)) {  // several ranks leave pieces of other names
    EXPECT_GT(std::filesystem::file_size(vtu), 1000u);
  }
  std::filesystem::remove(vtu);
}

TEST(SmallDrum, MapsHoldWhatTheParticlesMapsHoldUnderTheSameNames) {
  const FlowField field = converged(small_drum_problem(), one_mesh());
  FieldMap map = flow_map(field, drum_map_area(field, drum), 1);
  map.scales = {0.0033, 0.0183, 2700};
  // 31 columns across, from the lowest point within the wall up to the chord.
  ASSERT_EQ(map.grid.columns, 31u);
  ASSERT_EQ(map.grid.rows, 15u);
  const auto at = [&](const char* name, double x, double z) {
    const auto column = static_cast<std::size_t>(std::lround(x - map.grid.x_first));
    const auto row = static_cast<std::size_t>(std::lround(z - map.grid.z_first));
    return map.field(name).value[row * map.grid.columns + column];
  };
  EXPECT_TRUE(std::isnan(at("v_x", 14, -12)));  // outside of the wall
  const Vec2 place{2, -3};
  const PointState s = state_at(field, place);
  const Vec2 rigid = rigid_rotation(drum.rotation, drum.axis_offset, place);
  EXPECT_EQ(at("nu", 2, -3), drum.nu);
  EXPECT_NEAR(at("v_x", 2, -3), s.velocity.x - rigid.x, 1e-12);
  EXPECT_NEAR(at("d_v_x_dz", 2, -3), s.dvx_dz - drum.rotation, 1e-12);
  EXPECT_NEAR(at("strain_rate", 2, -3), 2 * s.rate, 1e-12);  // sees no rotation
  // The elements hold div u = 0 in the mean alone: what is left of it at a point is in the stress.
  EXPECT_NEAR(at("p", 2, -3), s.pressure, 2e-3 * s.pressure);
  EXPECT_NEAR(at("mu", 2, -3), s.shear_stress / s.pressure, 2e-3);
  EXPECT_NEAR(at("axis_angle_deg", 2, -3), 0, 1e-9);  // without k the stress lies along D
  // mu and I are those of the stress and the motion; what the law was given has p_min in it.
  EXPECT_LT(at("I_law", 2, -3), at("I", 2, -3));
  EXPECT_LT(at("mu_law", 2, -3), at("mu", 2, -3));
  EXPECT_NEAR(at("mu_law", 2, -3), LogLaw({0.35, 0.013}).friction(at("I_law", 2, -3)).mu, 1e-4);
}

TEST(SmallDrum, IsFoundAgainToTheLastBit) {
  const double first = converged(small_drum_problem(), one_mesh()).theta();
  const double second = converged(small_drum_problem(), one_mesh()).theta();
  if (FemRuntime::ranks() == 1)
    EXPECT_EQ(first, second);
  else  // sums over ranks come in the order of their messages
    EXPECT_NEAR(first, second, 1e-9);
}

}  // namespace
}  // namespace drumlin::small_drum_test
