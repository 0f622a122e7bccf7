// Calibration and flow evaluate one law.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "continuum/rheology/stress_law.hpp"
#include "continuum/rheology/turned_law.hpp"
#include "coupling/calibration/calibration.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "shear_layer.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::one_evaluation_test {
using namespace continuum;
using namespace coupling;
namespace {

using testing::TemporaryFolder;

constexpr int places = 1000;

// Far beyond both ends of any table, and below mu = 0.
double place(int i) { return 1e-12 * std::pow(1e14, (i + 0.5) / places); }

struct Example {
  FrictionForm form;
  Coefficients law;
};

const std::vector<double> knots{3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1};

std::vector<Example> frictions() {
  return {{{.formula = LogLaw{}}, {0.36, 0.014}},
          {{.formula = LogLinearLaw{}}, {0.34, 0.012, 0.4}},
          {{.formula = JopLaw{}}, {0.383, 0.26, 0.279}},
          {{.kind = FormKind::table, .knots = knots}, {0.16, 0.006, 0.026, 0.05, 0.02, 0.01, 0.025, 0.052}}};
}

std::vector<Example> ratios() {
  const Coefficients k{0.72, 0.03, 0.05, 0.12, 0.1, 0.05, -0.02, -0.03};
  return {{{.kind = FormKind::stress_ratio, .knots = knots}, k},
          {{.kind = FormKind::turn, .knots = knots}, k}};
}

TEST(OneLaw, OfTheCalibrationIsThatOfTheFlow) {
  const TemporaryFolder folder;
  for (const Example& example : frictions()) {
    RheologyFit fit;
    fit.mu = measured_friction(example.form, example.law, {}, 1e-4, 1e-1);
    fit.nu = 0.8;
    write_rheology(folder / "law.toml", fit);
    const StressLaw flow = stress_law(read_rheology(folder / "law.toml"));
    const FormCurve calibration(example.form, example.law);
    for (int i = 0; i < places; ++i) {
      const double I = place(i);
      const Strength F = strength(flow, 0.5 * I, 1);
      EXPECT_EQ(F.value, calibration.at(I).value) << name_of(example.form) << " at " << I;
      EXPECT_DOUBLE_EQ(F.d_rate * 0.5 * I, calibration.at(I).slope) << I;
    }
  }
}

TEST(OneLaw, OfEveryFormOfAFileIsThatOfTheFlow) {
  const std::vector<FrictionLaw> forms{
      LogLaw{.a = 0.35, .b = 0.013}, LogLinearLaw{.a = 0.34, .b = 0.012, .c = 0.4}, ConstantLaw{0.3},
      JopLaw{0.383, 0.643, 0.279}, FrictionTable{{1e-4, 1e-3, 1e-1}, {0.2, 0.21, 0.33}}};
  for (const FrictionLaw& mu : forms) {
    RheologyFit fit;
    fit.mu = mu;
    const StressLaw flow = stress_law(fit);
    const FrictionLaw law = mu;
    for (int i = 0; i < places; ++i)
      EXPECT_EQ(strength(flow, 0.5 * place(i), 1).value, friction_at(law, place(i)).mu) << described(mu);
  }
}

TEST(OneLaw, OfTheCalibrationHasTheKOfTheFlow) {
  const Example example = ratios().back();
  const StressRatioLaw k = stress_ratio_law(measured_stress_ratio(example.form, example.law));
  const FormCurve turn(example.form, example.law);
  const LogLaw mu{0.36, 0.014};
  for (int i = 0; i < places; ++i) {
    const double rate_number = place(i);
    const TurnedStrength flow = turned_strength(mu, LocalRatio{&k, 1}, 0.5 * rate_number, 1);
    EXPECT_NEAR(flow.across.value, turn.at(rate_number).value, 1e-15) << rate_number;
  }
}

TEST(OneLaw, ThresholdsAreOfTheLawsThatStandStill) {
  EXPECT_EQ(threshold(ConstantLaw{0.3}), 0.3);
  EXPECT_EQ(threshold(JopLaw{0.383, 0.643, 0.279}), 0.383);
  EXPECT_FALSE(threshold(LogLaw{0.35, 0.013}));
  EXPECT_FALSE(threshold(LogLinearLaw{0.34, 0.012, 0.4}));
  EXPECT_FALSE(threshold(TabulatedLaw({1e-3, 1e-1}, {0.2, 0.3})));
}

double difference(const std::function<double(double)>& f, double x, double h) {
  return (f(x + h) - f(x - h)) / (2 * h);
}

TEST(FormCurve, SlopeAndInfluenceAreItsDerivatives) {
  std::vector<Example> all = frictions();
  for (const Example& example : ratios()) all.push_back(example);
  for (const Example& example : all)
    for (int i = 0; i < 60; ++i) {
      const double I = 1e-6 * std::pow(1e6, (i + 0.5) / 60);
      const FormCurve curve(example.form, example.law);
      const double slope =
          difference([&](double ln_I) { return curve.at(std::exp(ln_I)).value; }, std::log(I), 1e-6);
      // Differences know 1e-16/1e-6, and the curve's bend to 1e-12.
      EXPECT_NEAR(curve.at(I).slope, slope, 1e-8) << name_of(example.form) << " at " << I;
      std::vector<double> influence(example.law.size());
      curve.influence(I, influence);
      for (std::size_t j = 0; j < example.law.size(); ++j) {
        const auto moved = [&](double to) {
          Coefficients law = example.law;
          law[j] = to;
          return friction(example.form, law, I);
        };
        EXPECT_NEAR(influence[j], difference(moved, example.law[j], 1e-7), 1e-7)
            << name_of(example.form) << " at " << I << ", coefficient " << j;
      }
    }
}

// A turn that is negative in slow flow and positive in fast flow, as tensors of a drum show.
double known_turn(double rate_number) { return 0.04 * std::tanh(std::log(rate_number / 1e-3)) - 0.01; }

Calibration calibrated_on(double angle, double noise) {
  RunEvidence run{.name = "layer", .nu = {"nu_bulk", 0.8, {}}};
  add_blocks(run, testing::layer(angle, noise, noise, 1, known_turn), {});
  return calibration_of({run}, {}, {.form = "log", .k = true, .draws = 3});
}

// Angle from the axes of D to those of the flow's stress, by the definition that measures maps.
double angle_of_flow(const RheologyFit& fit, const PlaneTensor& D, double p) {
  const StressRatioLaw k = stress_ratio_law(*fit.k);
  const LogLaw& mu = std::get<LogLaw>(fit.mu);
  const auto s =
      turned_response(LogLaw{mu.a, mu.b}, LocalRatio{&k, 1}, Regularisation{1e-14, 1e-12}, D, p, D);
  return axis_angle_deg(PlaneMatrix{p - s.stress.xx, -s.stress.xz, -s.stress.xz, p - s.stress.zz},
                        PlaneMatrix{D.xx, 2 * D.xz, 0, D.zz});
}

TEST(SignOfK, IsThatOfTheTensorsFromTheMapToTheStressOfTheFlow) {
  for (const double angle : {0.0, 0.4}) {
    const RheologyFit fit = calibrated_on(angle, 0).rheology;
    ASSERT_TRUE(fit.k);
    for (const double I : {4e-4, 7e-4, 5e-3, 2e-2}) {
      const double N = known_turn(I), p = 7, D = 0.5 * I * std::sqrt(p);
      const double M = friction(testing::logarithm, testing::truth, I);
      const double measured = turn_angle_deg(N, M);
      const PlaneTensor strain{D * std::sin(2 * angle), -D * std::sin(2 * angle), D * std::cos(2 * angle)};
      const double flow = angle_of_flow(fit, strain, p);
      EXPECT_GT(measured * flow, 0) << I;
      // Knots every half decade follow a bend over one decade to a tenth of the 2.6 degrees below it.
      EXPECT_NEAR(flow, measured, 0.25) << I;
    }
  }
}

TEST(SignOfK, SurvivesNoise) {
  const RheologyFit fit = calibrated_on(0.2, 0.05).rheology;
  const StressRatioLaw k = stress_ratio_law(*fit.k);
  EXPECT_NEAR(k.at_ln(std::log(5e-4)).value, (1 + known_turn(5e-4)) / (1 - known_turn(5e-4)), 0.03);
}

}  // namespace
}  // namespace drumlin::one_evaluation_test
