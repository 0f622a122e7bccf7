#pragma once
// From the evidence of runs to one law, and what is known of it.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupling/calibration/law_score.hpp"
#include "coupling/calibration/one_law.hpp"
#include "coupling/calibration/run_evidence.hpp"
#include "coupling/core/law/ill_posed.hpp"

namespace drumlin::coupling {

struct CalibrationOptions {
  EvidenceSource source = EvidenceSource::maps;
  std::optional<std::string> form =
      {};             ///< of mu, its name; absent: a table where there are points enough, else log
  bool k = false;     ///< k(I) is a part of the law
  bool turn = false;  ///< the turn of the stress is fitted although it is no part of the law
  int draws = 200;
  std::function<void()> before_each_draw = {};  ///< of mu; may throw to end a long fit
};

struct Calibration {
  CalibrationOptions options;
  std::vector<RunEvidence> runs;
  std::vector<RunEvidence> held_out;
  std::vector<CalibratedLaw> forms;  ///< every form that the points allow, one of them chosen
  std::size_t chosen = 0;
  std::optional<CalibratedLaw> turn;     ///< FormKind::turn of maps, FormKind::stress_ratio of profiles
  std::vector<LawScore> scores;          ///< per run of the fit
  std::vector<LawScore> predictions;     ///< per run held out
  std::optional<OneLaw> one_law;         ///< with two speeds at least
  std::vector<InertialRange> ill_posed;  ///< within 1e-6 ... 1, in simple shear
  RheologyFit rheology;

  const CalibratedLaw& law() const { return forms[chosen]; }
};

/// Throws InputError on too few points, or a law that does not grow. `runs`: one at least.
Calibration calibration_of(std::vector<RunEvidence> runs, std::vector<RunEvidence> held_out,
                           const CalibrationOptions& options);

/// Friction over I as the law takes it, of one run.
std::vector<FrictionPoint> friction_of(const RunEvidence& run, const Calibration& calibration);

/// Angle from the axes of the strain rate to those of the stress in simple shear, in degrees, by the fitted
/// turn and friction, over the inertial number that the law takes. Of maps with a turn alone.
struct SampledAngle {
  std::vector<double> I, degrees;
};
SampledAngle sampled_axis_angle(const Calibration& calibration, int intervals = 60);

}  // namespace drumlin::coupling
