#pragma once
// How the results depend on the speed of rotation, by way of the flow rate Q.
#include <optional>
#include <string>
#include <vector>

#include "coupling/calibration/log_friction.hpp"
#include "coupling/study/law_fit.hpp"
#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {

struct SpeedLaw {
  struct Coefficient {
    std::string name;
    double value = 0;
    double ci99 = 0;
  };
  std::string name;  ///< as in data/paper/laws.toml where the paper has it
  std::string formula;
  std::vector<Coefficient> coefficients;
  double reduced_chi2 = 0;
  double rms = 0;  ///< about the law, of its left side (of its logarithm for powers)
  std::size_t points = 0;
};

/// One point per speed, from its pooled scalars: H(Q) with and without a free power, tan(theta) against Q,
/// the shear rate against Rajchenbach's scaling with and without an offset (Phi from the friction law at Q =
/// 0), each for the slope of the surface and for that of the centre of mass (names ending in _com), and the
/// shear rate as a power of Q. A law whose quantities were not measured holds NaN.
std::vector<SpeedLaw> speed_laws(const std::vector<SpeedGroup>& groups);

/// Mean of a quantity over the speeds, each speed alike (half width: the larger of what their intervals give
/// and Student's t of their spread), and how much of it the quantity gains from the least to the greatest Q
/// along the straight line through it.
struct SpeedTrend {
  std::string quantity;
  Scalar mean;              ///< named after the quantity
  Scalar trend;             ///< slope (Q_max - Q_min) / mean
  double reduced_chi2 = 0;  ///< about the mean
};
SpeedTrend speed_trend(const std::string& quantity, const std::vector<SpeedGroup>& groups);

/// mu = a + b ln I in one speed and in all of them.
struct FrictionCollapse {
  struct OneSpeed {
    double rotation_rpm = 0;
    FrictionFit fit;
    double rms_about_common = 0;  ///< of its layers, about the law of all speeds
  };
  FrictionFit common;
  std::vector<OneSpeed> speeds;
  double rms_own = 0;     ///< of all layers, each about the law of its speed
  double mean_error = 0;  ///< mean standard error of mu over the layers
};
/// Layers as in `drumlin calibrate`. Speeds with fewer than three are left out; nothing when all are.
std::optional<FrictionCollapse> friction_collapse(const std::vector<StudyRun>& runs,
                                                  const std::vector<SpeedGroup>& groups,
                                                  const LayerSelection& selection = {});

}  // namespace drumlin::coupling
