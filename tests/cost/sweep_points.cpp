// Which points a sweep has, what errors they are given, and which effects a price list names.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "coupling/accuracy/flow_sweep.hpp"
#include "coupling/accuracy/flow_variants.hpp"
#include "coupling/accuracy/particle_sweep.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin {
using namespace coupling;
namespace {

const FlowSettings scene{2, 1e-5, 1e-8};

TEST(SweepAxes, AreReadAndRefused) {
  const auto axes = sweep_axes({"mesh=1:2", "eps"}, flow_axes());
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_EQ(numbers_of(axes[0], {}), (std::vector<double>{1, 2}));
  EXPECT_EQ(numbers_of(axes[1], {7}), std::vector<double>{7});
  EXPECT_EQ(sweep_axes({}, flow_axes()).size(), 3u);
  for (const char* word : {"step", "mesh=1=2"}) EXPECT_THROW(sweep_axes({word}, flow_axes()), InputError);
  EXPECT_THROW(sweep_axes({"eps", "eps=1"}, flow_axes()), InputError);
  for (const char* value : {"small", "0", "-1", "inf", ""})
    EXPECT_THROW(numbers_of({"eps", {value}}, {}), InputError) << value;
}

TEST(FlowSweep, GoesThroughTheSceneFromCoarseToFine) {
  const auto curves = sweep_curves(scene, sweep_axes({"mesh=3:1", "eps=1e-3"}, flow_axes()));
  EXPECT_EQ(curves[0].points, (std::vector<FlowSettings>{{1, 1e-5, 1e-8}, scene, {3, 1e-5, 1e-8}}));
  EXPECT_EQ(curves[1].points, (std::vector<FlowSettings>{{2, 1e-3, 1e-8}, scene}));
  EXPECT_EQ(reference_settings(scene, curves), (FlowSettings{4, scene.eps / 10, 1e-8}));
  EXPECT_THROW(sweep_curves(scene, {{"mesh", {"1.5"}}}), InputError);
  // The coarsest mesh stays that of the scene: cells at the surface halve with each further one.
  EXPECT_EQ(changes_of({3, 1e-5, 1e-8}, scene, 1)[1], "mesh.surface_cell=0.5");
}

TEST(FlowSweep, HasErrorsAgainstTheReferenceAndAlongEachCurve) {
  const auto numbers = [](double H, std::vector<double> v_x) {
    return FlowNumbers{{{"H", H}, {"Q", 0.0}}, std::move(v_x), std::nullopt};
  };
  const auto curves = sweep_curves(scene, {{"mesh", {"1", "3"}}});
  const std::vector<SweptFlow> points = {{curves[0].points[0], {"mesh"}, numbers(11, {1, 2, NAN})},
                                         {scene, {"mesh"}, std::nullopt},
                                         {curves[0].points[2], {"mesh"}, numbers(10.5, {1, 2, 3})}};
  const auto errors = flow_errors(points, curves, numbers(10, {1, 4, 3}));
  EXPECT_NEAR(number_named(errors[0].errors, "H"), 0.1, 1e-12);
  EXPECT_TRUE(std::isnan(number_named(errors[0].errors, "Q")));  // nothing is relative to 0
  EXPECT_NEAR(number_named(errors[0].errors, "v_x"), 2 / std::sqrt(17), 1e-12);
  EXPECT_TRUE(errors[1].errors.empty());
  ASSERT_EQ(errors[0].alone.size(), 1u);
  EXPECT_NEAR(number_named(errors[0].alone[0].second, "H"), 11 / 10.5 - 1, 1e-12);
  EXPECT_TRUE(errors[2].alone.empty());  // the finest of its curve
  EXPECT_EQ(quantities_of(errors), (std::vector<std::string>{"H", "v_x"}));
}

TEST(FlowSweep, MeasuresAgainstTheClosedFormWhereThereIsOne) {
  const FlowNumbers found{{{"Q", 1.1}}, {1}, ClosedFormErrors{0.02, 0.01, {{"Q", 1.0}}}};
  const auto errors = flow_errors(std::vector<SweptFlow>{{scene, {}, found}}, {}, std::nullopt);
  EXPECT_NEAR(number_named(errors[0].errors, "Q"), 0.1, 1e-12);
  EXPECT_EQ(number_named(errors[0].errors, "v_x"), 0.02);
  EXPECT_EQ(number_named(errors[0].errors, "v_x_mesh"), 0.01);
}

TEST(ParticleSweep, IsMeasuredAgainstAFinerPointThanAny) {
  const ParticleSettings standard{"nlgs", 1e-2, 1e-3};
  const auto axes =
      sweep_axes({"tolerance=1e-1:1e-2:1e-3", "step=1e-3:5e-4", "solver=nncg"}, particle_axes());
  const ParticleSweep sweep = particle_sweep(standard, axes, {"nlgs", "nncg"});
  EXPECT_EQ(sweep.points.front(), standard);
  EXPECT_EQ(sweep.points.size(),
            8u);  // six of the scene's solver, two of the other: 1e-3 is too tight for it
  EXPECT_EQ(sweep.finest, (ParticleSettings{"nlgs", 1e-3, 5e-4}));
  EXPECT_EQ(sweep.reference, (ParticleSettings{"accelerated", 1e-3 / 3, 2.5e-4}));
  EXPECT_THROW(particle_sweep(standard, {{"solver", {"none"}}}, {"nlgs"}), InputError);
}

TEST(ParticleSweep, IsReadWhereTheFinestPointFollowsTheReference) {
  EXPECT_EQ(last_followed(std::vector<double>{0.001, 0.01, 0.5}), 1u);
  EXPECT_EQ(last_followed(std::vector<double>{0.5, 0.5, NAN}), 0u);
}

TEST(Fronts, HoldTheLeastErrorForItsSecondsByQuantity) {
  const std::vector<WorkPoint> points = {
      {1, {{"a", 3}, {"b", 1}}}, {2, {{"a", 1}}}, {3, {{"a", 2}}}, {NAN, {}}};
  EXPECT_EQ(fronts(points, {"a", "b"}), (std::vector<std::vector<std::string>>{{"a", "b"}, {"a"}, {}, {}}));
}

TEST(Spread, HasTheMeanOfTheMiddleTwoAsMedian) {
  EXPECT_EQ(spread({3, 1, 2}).median, 2);
  EXPECT_EQ(spread({4, 1, 2, 3}).median, 2.5);
  EXPECT_EQ(spread({4, 1, 2, 3}).least, 1);
}

TEST(FlowVariants, AreEachEffectAloneOrThoseNamed) {
  EXPECT_EQ(flow_variants({}).size(), flow_effects().size());
  const auto variants = flow_variants({"none", "inertia+k"});
  EXPECT_TRUE(variants[0].effects.empty());
  EXPECT_TRUE(variants[1].needs_k());
  EXPECT_EQ(variants[1].changes({}), std::vector<std::string>{"effects.inertia={}"});  // k is the law's
  // A scene's own keys come before the standard strength.
  EXPECT_EQ(flow_variants({"nonlocal"})[0].changes({{"nonlocal", "effects.nonlocal={length=2}"}}),
            std::vector<std::string>{"effects.nonlocal={length=2}"});
  for (const char* word : {"", "gravity", "inertia+inertia", "inertia+"})
    EXPECT_THROW(flow_variants({word}), InputError) << word;
}

TEST(FlowVariants, ChangeScalarsAndTheProfile) {
  const FlowNumbers without{{{"H", 10}, {"theta_deg", 19}}, {1, 2}, {}}, with{{{"H", 12}}, {1, 2}, {}};
  const EffectChanges changes = effect_changes(with, without);
  EXPECT_EQ(changes.scalars, (NamedNumbers{{"H", 2}}));
  EXPECT_EQ(changes.v_x, 0);
  EXPECT_TRUE(std::isnan(effect_changes({{}, {1}, {}}, without).v_x));
}

}  // namespace
}  // namespace drumlin
