#pragma once
// Two runs of one drum side by side: errors, scalars, and what was asked of them.
#include <optional>
#include <string>
#include <vector>

#include "coupling/comparison/profile_errors.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin {

/// Everything that one simulator left of a run.
struct ComparedSide {
  ProfileSet profiles;
  ScalarSet scalars;
};

/// Throws InputError, all reasons at once, unless both sides show the same drum in the same units: rotation
/// and drum_radius (dimensionless) and diameter_m of the profiles' headers agree to 1e-3, and both are
/// reduced or neither.
void require_same_drum(const ProfileSet& particles, const ProfileSet& continuum);

/// A result on both sides; NaN where a side does not have it.
struct ScalarPair {
  std::string name;
  double particles = 0;
  std::optional<double> ci99;  ///< of the particles
  double continuum = 0;
};

struct ZoneErrors {
  Zone zone;
  FieldErrors errors;
};
struct FieldComparison {
  FieldOverlay overlay;
  std::vector<ZoneErrors> zones;
};

/// What is asked of the continuum, and what it reached.
struct Target {
  enum class Outcome { met, missed, not_measured };
  std::string quantity;  ///< "sigma_zz", "theta_deg", ...
  std::string zone;      ///< empty for a scalar
  std::string measure;  ///< how the difference is taken: "rel_l2", "rms in decades", "difference in deg", ...
  double limit = 0;
  double value = 0;  ///< NaN when not measured
  Outcome outcome = Outcome::not_measured;
  std::string remark;  ///< why it was not measured, or which layers are missing
};

struct Comparison {
  std::vector<FieldComparison> fields;
  std::vector<ScalarPair> scalars;
  std::vector<Target> targets;
};

/// Requires the same drum (require_same_drum). Scalars that the continuum did not report but whose definition
/// needs its profile alone (shear_rate, I_th, ...) are read off its profile. The targets are those of
/// docs/formats/comparison.md.
Comparison compare(const ComparedSide& particles, const ComparedSide& continuum,
                   const ZoneOptions& options = {});

/// 0.4 shear_rate H^2 / Q: the share of the flow rate that a linear flowing layer at nu = 0.8 carries. A
/// check that a set of Q, H and shear rate can belong to one profile.
double linear_layer_share(double shear_rate, double H, double Q);

}  // namespace drumlin
