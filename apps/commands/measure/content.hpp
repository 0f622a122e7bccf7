#pragma once
// What stands in the files of RUN/measured beside the numbers themselves.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/calibration/log_friction.hpp"
#include "particles/measurement/measurement.hpp"

namespace drumlin::apps {

/// How far a scalar moves under other windows than its own.
struct ScalarSensitivity {
  struct Change {
    std::string change;
    double value = 0;
  };
  std::vector<Change> changes;  ///< those that move it
  double lowest = 0, highest = 0;
  std::string strongest;  ///< the change that moves it most
};
/// Empty `changes` when nothing moves it or no variants were computed.
ScalarSensitivity sensitivity_of(const Scalar& scalar, const std::vector<ScalarVariant>& variants);

/// The header of profiles.csv; of a slice of its own with its place and its axis_depth.
std::map<std::string, std::string> header_of(const Measurement& measured, const MeasurementOptions& options,
                                             bool reduced);

nlohmann::ordered_json settings_of(const Measurement& measured, const MeasurementOptions& options,
                                   const LayerSelection& selection);
/// What the figures draw over the profiles.
nlohmann::ordered_json fits_of(const ProfileScalars& fits);
nlohmann::ordered_json steadiness_of(const Steadiness& steadiness);
/// {"value", "ci99", "sensitivity": {"lowest", "highest", "changes": {"words": value}}}, the last only when
/// known.
nlohmann::ordered_json scalar_with_sensitivity(const Scalar& scalar, const ScalarSensitivity& sensitivity);

/// mu_a and mu_b at the centre with what other windows make of them: see measurement.md.
ScalarSet friction_scalars(const Measurement& measured, const LayerSelection& selection);
/// Adds mu_a and mu_b to each variant, and variants of the fit's own windows.
void add_friction_variants(const Measurement& measured, const LayerSelection& selection,
                           std::vector<ScalarVariant>& variants);

}  // namespace drumlin::apps
