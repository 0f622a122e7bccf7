// Particles and continuum over the speed of rotation, on runs and flows made from known laws.
#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "coupling/study/speed_comparison.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/flow_runs.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using testing::drum_run;
using testing::DrumLaws;
using testing::flow_run;
using testing::message_of;

const std::filesystem::path paper = drumlin::test::data_folder() / "paper";

const SpeedScalar& scalar(const ComparedSpeed& speed, const std::string& name) {
  for (const SpeedScalar& candidate : speed.scalars)
    if (candidate.particles.name == name) return candidate;
  throw InputError("no " + name);
}

const Target& target(const ComparedSpeed& speed, const std::string& name, const std::string& zone = "") {
  for (const Target& candidate : speed.targets)
    if (candidate.quantity == name && candidate.zone == zone) return candidate;
  throw InputError("no " + name);
}

TEST(SpeedComparison, AFlowThatShowsWhatTheParticlesShowHasNoError) {
  const SpeedComparison found =
      compared_speeds({drum_run(5), drum_run(6)}, {flow_run(6), flow_run(5)}, paper);
  ASSERT_EQ(found.speeds.size(), 2u);
  EXPECT_EQ(found.speeds[0].role, SpeedRole::predicted);
  EXPECT_EQ(found.speeds[1].role, SpeedRole::calibrated) << "the law was fitted on the run at 6 rpm";
  for (const ComparedSpeed& speed : found.speeds)
    for (const char* field : {"sigma_zz", "sigma_xx"}) {
      EXPECT_EQ(target(speed, field, "all").value, 0) << field;
      EXPECT_EQ(target(speed, field, "all").outcome, Target::Outcome::met);
    }
  EXPECT_TRUE(found.warnings.empty());
}

TEST(SpeedComparison, BothSidesAreReadAtTheSamePlaceOfTheDrum) {
  // The same material, whose surface the continuum draws 1.3 d higher: nothing may differ.
  const SpeedComparison same = compared_speeds({drum_run(6)}, {flow_run(6)}, paper);
  const SpeedComparison higher = compared_speeds({drum_run(6)}, {flow_run(6, {}, 1.3)}, paper);
  EXPECT_NEAR(target(higher.speeds[0], "v_x", "flowing").value, 0, 1e-9);
  EXPECT_NEAR(target(higher.speeds[0], "sigma_zz", "all").value, 0, 1e-9);
  EXPECT_NEAR(scalar(higher.speeds[0], "H").continuum, scalar(same.speeds[0], "H").continuum, 1e-9);
  EXPECT_NEAR(scalar(higher.speeds[0], "lambda").continuum, 3, 1e-6);
}

TEST(SpeedComparison, SeedsOfASpeedAreAveragedAndTheErrorIsAgainstTheirMean) {
  StudyRun first = drum_run(6), second = drum_run(6);
  first.name = "a";
  second.name = "b";
  for (Scalar& one : first.scalars.scalars)
    if (one.name == "theta_deg") one.value += 0.4;
  const SpeedComparison found = compared_speeds({first, second}, {flow_run(6)}, paper);
  ASSERT_EQ(found.speeds.size(), 1u);
  EXPECT_EQ(found.speeds[0].particles, (std::vector<std::string>{"a", "b"}));
  EXPECT_NEAR(target(found.speeds[0], "theta_deg").value, 0.2, 1e-9);
  EXPECT_NEAR(scalar(found.speeds[0], "H").paper.value, 14.6, 0);
}

TEST(SpeedComparison, ALawOfAnotherDepthMissesHAndSaysBySoMuch) {
  DrumLaws deep;
  deep.depth = 3.8;
  const double same = scalar(compared_speeds({drum_run(6)}, {flow_run(6)}, paper).speeds[0], "H").continuum;
  const SpeedComparison found = compared_speeds({drum_run(6)}, {flow_run(6, deep)}, paper);
  // The line through v_x ends in the tail below the layer, by the same amount for both.
  EXPECT_NEAR(scalar(found.speeds[0], "H").continuum - same, 0.8 * std::sqrt(21.9), 0.3);
  EXPECT_EQ(target(found.speeds[0], "H").outcome, Target::Outcome::missed);
}

TEST(SpeedComparison, ASpeedThatOneSideLacksStaysAndIsWarnedOf) {
  const SpeedComparison found =
      compared_speeds({drum_run(4), drum_run(6)}, {flow_run(6), flow_run(10)}, paper);
  ASSERT_EQ(found.speeds.size(), 3u);
  EXPECT_EQ(found.speeds[0].role, SpeedRole::particles_only);
  EXPECT_EQ(found.speeds[2].role, SpeedRole::continuum_only);
  EXPECT_TRUE(found.speeds[0].targets.empty());
  ASSERT_EQ(found.warnings.size(), 2u);
  EXPECT_NE(found.warnings[0].find("no flow at 4.0 rpm"), std::string::npos);
  EXPECT_NE(found.warnings[1].find("no particle run at 10.0 rpm"), std::string::npos);
}

TEST(SpeedComparison, ALawOfElsewhereCalibratesNoSpeed) {
  StudyFlow flow = flow_run(6);
  flow.fitted_on = {"somewhere"};
  const SpeedComparison found = compared_speeds({drum_run(6)}, {flow}, paper);
  EXPECT_EQ(found.speeds[0].role, SpeedRole::unknown);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_NE(found.warnings[0].find("not known"), std::string::npos);
}

TEST(SpeedComparison, RefusesTwoLawsTwoFlowsOfASpeedAnotherDrumAndMixedUnits) {
  const auto refusal = [](std::vector<StudyFlow> flows) {
    return message_of<InputError>([&] { compared_speeds({drum_run(6)}, flows, paper); });
  };
  StudyFlow other = flow_run(5);
  other.identity["law"] = "mu = 0.4";
  EXPECT_NE(refusal({flow_run(6), other}).find("law"), std::string::npos);
  other = flow_run(5);
  other.identity["effects"] = "inertia";
  EXPECT_NE(refusal({flow_run(6), other}).find("effects"), std::string::npos);
  EXPECT_NE(refusal({flow_run(6), flow_run(6)}).find("one flow per speed"), std::string::npos);
  other = flow_run(6);
  other.side.profiles.header.reduced = true;
  EXPECT_NE(refusal({other}).find("reduced"), std::string::npos);
  other = flow_run(6);
  other.side.profiles.header.diameter_m = 0.004;
  EXPECT_NE(refusal({other}).find("diameter_m"), std::string::npos);
  EXPECT_NE(refusal({}).find("continuum flow"), std::string::npos);
  EXPECT_THROW(compared_speeds({}, {flow_run(6)}, paper), InputError);
}

}  // namespace
}  // namespace drumlin
