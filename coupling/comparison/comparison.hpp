#pragma once
// Comparison of two runs of one drum: errors by field and zone, scalars, and the targets.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "coupling/comparison/field_errors.hpp"
#include "coupling/comparison/parts.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"

namespace drumlin::coupling {

/// Everything that one simulator left of a run.
struct ComparedSide {
  ProfileSet profiles;
  ScalarSet scalars;
  SideFields fields = {};
};

/// Throws InputError, all reasons at once, unless both sides show the same drum in the same units and frame:
/// rotation and drum_radius (dimensionless), diameter_m and position of the profiles' headers agree to 1e-3,
/// there is a drum, and both are reduced or neither.
void require_same_drum(const ProfileSet& particles, const ProfileSet& continuum);

/// A result on both sides; NaN where a side does not have it.
struct ScalarPair {
  std::string name;
  double particles = 0;
  std::optional<double> ci99;  ///< of the particles
  double continuum = 0;
  std::optional<double> continuum_ci99 =
      std::nullopt;  ///< what its calibration leaves open; of particles their interval
  double continuum_own = std::numeric_limits<double>::quiet_NaN();  ///< as that side says it, counted from
                                                                    ///< its own surface; NaN: it says nothing
};

/// What became of a target.
enum class Outcome { met, missed, not_measured };
constexpr auto names_of(Outcome) { return std::array{"met", "missed", "not_measured"}; }
enum class JudgedBy { limit, noise_floor };
constexpr auto names_of(JudgedBy) { return std::array{"limit", "noise floor"}; }

/// What is asked of the continuum, and what it reached.
struct Target {
  std::string quantity;  ///< "sigma_zz", "theta_deg", ...
  std::string zone;      ///< empty for a scalar
  std::string measure;  ///< how the difference is taken: "rel_l2", "rms in decades", "difference in deg", ...
  double limit = 0;
  double value = 0;  ///< NaN when not measured
  Outcome outcome = Outcome::not_measured;
  std::string remark;  ///< why it was not measured, which layers are missing, what the particles leave open
  /// A limit narrower than the particles' own interval asks for more than they know: their noise judges.
  JudgedBy judged_by = JudgedBy::limit;
  bool undefined = false;  ///< the continuum leaves layers of the zone undefined: missed, whatever the value
  double noise_floor = std::numeric_limits<double>::quiet_NaN();  ///< where it judges
};

struct Comparison {
  Registration registration = Registration::axis;
  double offset = 0;                    ///< added to the second side's z, at the centre
  std::vector<FieldComparison> fields;  ///< at the centre
  PartOrReason<std::vector<SliceComparison>> slices;
  PartOrReason<MapComparison> maps;
  std::vector<ScalarPair> scalars;
  std::vector<Target> targets;
};

struct ComparisonOptions {
  Registration registration = Registration::axis;
  ZoneOptions zones;
};

/// The second side at the centre on the first one's axes: moved by the registration; where its profile holds
/// no velocity gradient, with that of its maps (half_vorticity, d_v_x_dx, d_v_z_dz).
ProfileSet registered_centre(const ComparedSide& first, const ComparedSide& second, Registration by);

/// Requires the same drum (require_same_drum). H, lambda, shear_rate and I_th of the second side are read off
/// its registered profile with the definitions of the particles (docs/theory/measurement.md), and so is what
/// it did not report but its profile holds; lambda_same_window is its lambda in the particles' window. The
/// targets are those of docs/formats/comparison.md.
Comparison compare(const ComparedSide& particles, const ComparedSide& continuum,
                   const ComparisonOptions& options = {});

/// 0.4 shear_rate H^2 / Q: the share of the flow rate that a linear flowing layer at nu = 0.8 carries. A
/// check that a set of Q, H and shear rate can belong to one profile.
double linear_layer_share(double shear_rate, double H, double Q);

}  // namespace drumlin::coupling
