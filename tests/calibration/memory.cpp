// The memory of the axes: its closed forms, and its recovery from maps that obey it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/calibration/memory_calibration.hpp"
#include "coupling/core/basics/errors.hpp"
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

/// Evidence of a drum, as `drumlin calibrate --memory` reads it.
RunEvidence evidence_of(FieldMap map, std::string name) {
  RunEvidence run{.name = std::move(name), .rotation_rpm = 6};
  add_blocks(run, std::move(map), {});
  add_amount_blocks(run, {});
  return run;
}

PathsOfRun paths_of(const RememberingDrum& drum) {
  const FieldMap map = remembering_drum(drum);
  PathsOfRun run{"drum", stress_paths(PathFields(map, {.smoothing = 0.3})), {}};
  for (const StressPath& path : run.paths) run.amounts.push_back(known_amount(std::exp(path.ln_I)));
  return run;
}

constexpr AxisMemory guess{.c = 10, .m = 0.5, .chi = 0.2, .I_low = 1e-2, .I_high = 1e-1};

TEST(MemoryFit, KnownCoefficientsComeBackFromPathsWithoutNoise) {
  const PathsOfRun run = paths_of({});
  const MemoryFit fit = fit_memory({&run, 1}, guess, {true, true, true});
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.law.c, known_memory.c, 0.05);
  EXPECT_NEAR(fit.law.m, known_memory.m, 0.01);
  EXPECT_NEAR(fit.law.chi, known_memory.chi, 0.01);
  EXPECT_LT(fit.rms, 2e-3);  // the stress between nodes is bilinear
}

TEST(MemoryFit, NoisyPathsGiveTheCoefficientsWithinTheirIntervals) {
  int inside = 0, asked = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const PathsOfRun run = paths_of({.noise = 0.02, .seed = seed});
    const MemoryFit fit = fit_memory({&run, 1}, guess, {true, true, true});
    const double found[] = {fit.law.c, fit.law.m, fit.law.chi};
    const double truth[] = {known_memory.c, known_memory.m, known_memory.chi};
    for (std::size_t j = 0; j < 3; ++j, ++asked)
      inside += std::abs(found[j] - truth[j]) <= fit.ci99_sectors[j];
  }
  EXPECT_GE(inside, asked - 2) << asked;
}

TEST(MemoryCalibration, FindsTheLawOfNoisyMapsAndSaysWhatItCannotTell) {
  std::vector<RunEvidence> runs, held_out;
  for (unsigned seed = 1; seed <= 2; ++seed)
    runs.push_back(evidence_of(remembering_drum({.noise = 0.02, .seed = seed}), "drum"));
  const MemoryCalibration found = memory_calibration(runs, {}, amount_law(runs, 16));
  ASSERT_TRUE(found.bed_line);
  EXPECT_NEAR(found.bed_line->law[0], 0.31, 0.015);
  EXPECT_NEAR(found.bed_line->law[1], 0.011, 0.0015);
  EXPECT_LT(found.amount.I_min, 2e-5);  // the points of mu(I) begin at 3e-5
  EXPECT_NEAR(found.free.law.c, known_memory.c, found.free.ci99_sectors[memory_c]);
  EXPECT_NEAR(found.free.law.m, known_memory.m, found.free.ci99_sectors[memory_m]);
  EXPECT_NEAR(found.free.law.chi, known_memory.chi, found.free.ci99_sectors[memory_chi]);
  EXPECT_TRUE(found.law.c_rho);
  EXPECT_LE(found.law.m, 1);
  for (const MemoryScore& score : found.scores) {
    EXPECT_GT(score.bed.paths, 50U);
    EXPECT_LT(score.bed.axes_deg, score.bed.axes_deg_without_memory / 2);
  }
  EXPECT_EQ(found.arcs.size(), 3U);
  EXPECT_FALSE(found.untold.empty());

  // What is held out is scored and changes nothing.
  AxisMemory other = known_memory;
  other.chi = -0.6;
  held_out.push_back(evidence_of(remembering_drum({}, other), "other"));
  const MemoryCalibration again = memory_calibration(runs, held_out, amount_law(runs, 16));
  EXPECT_EQ(again.law.c, found.law.c);
  EXPECT_EQ(again.law.chi, found.law.chi);
  EXPECT_EQ(again.amount.fit.law, found.amount.fit.law);
  ASSERT_EQ(again.predictions.size(), 1U);
  EXPECT_GT(again.predictions[0].bed.axes_deg, 2 * again.scores[0].bed.axes_deg);

  const MemoryLaw written = measured_memory(found);
  EXPECT_EQ(written.c, found.law.c);
  EXPECT_EQ(written.mu.I.size(), written.mu.mu.size());
}

TEST(MemoryCalibration, ADrumWithoutABedIsRefused) {
  const RememberingDrum fast{.surface_speed = 20, .decay = 40};
  const std::vector<RunEvidence> runs{evidence_of(remembering_drum(fast), "fast")};
  EXPECT_THROW((void)memory_calibration(runs, {}, amount_law(runs, 16)), InputError);
}

TEST(MemoryCalibration, MapsThatSayTooLittleAreRefused) {
  RunEvidence run = evidence_of(remembering_drum({.radius = 40}), "short");
  run.amount_blocks.resize(20);
  EXPECT_THROW((void)memory_calibration({&run, 1}, {}, amount_law({&run, 1}, 16)), InputError);
  FieldMap layer = remembering_drum({.radius = 40});
  layer.header.drum_radius = 0;
  EXPECT_THROW(PathFields{layer}, InputError);
}

TEST(MemoryCalibration, MotionFromDisplacementsIsTakenWhereTheMapHasIt) {
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
