#pragma once
// From the evidence to a law, and what is known of it.
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/calibrate/evidence.hpp"
#include "coupling/calibration/fabric_relaxation.hpp"
#include "coupling/calibration/judgement.hpp"

namespace drumlin::apps {

/// Interval of I where the equations of the law are ill-posed in simple shear.
struct IllPosed {
  double from = 0, to = 0;
};

struct Calibration {
  Source source = Source::maps;
  bool with_k = false;  ///< k is a part of the law
  std::vector<RunEvidence> runs, held_out;
  std::vector<CalibratedLaw> forms;  ///< every form that the points allow, one of them chosen
  std::size_t chosen = 0;
  std::optional<CalibratedLaw> turn;          ///< (k - 1)/(k + 1) over I, a table; of profiles k itself
  std::vector<LawScore> scores;               ///< per run of the fit
  std::vector<LawScore> predictions;          ///< per run held out
  std::optional<OneLaw> one_law;              ///< with two speeds at least
  std::vector<FabricRelaxation> relaxations;  ///< per run
  std::vector<IllPosed> ill_posed;            ///< within 1e-6 ... 1
  RheologyFit rheology;

  const CalibratedLaw& law() const { return forms[chosen]; }
};

/// Throws InputError on runs that cannot be used together, too few points, or a law that does not grow.
Calibration calibration_of(const CalibrateOptions& options);

/// Friction over I as the law takes it, of one run.
std::vector<FrictionPoint> friction_of(const RunEvidence& run, const Calibration& calibration);

}  // namespace drumlin::apps
