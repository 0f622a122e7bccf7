#pragma once
// The content of measured.json.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/calibration/centre_friction.hpp"
#include "particles/measurement/measurement.hpp"

namespace drumlin::apps {

nlohmann::ordered_json settings_of(const particles::Measurement& measured,
                                   const particles::MeasurementOptions& options,
                                   const coupling::LayerSelection& selection);
nlohmann::ordered_json steadiness_of(const particles::Steadiness& steadiness);
/// {"value", "ci99", "sensitivity": {"lowest", "highest", "changes": {"words": value}}}, the last only when
/// known.
nlohmann::ordered_json scalar_with_sensitivity(const Scalar& scalar,
                                               const particles::ScalarSensitivity& sensitivity);

/// Adds mu_a and mu_b to each variant, and variants of the fit's own windows.
void add_friction_variants(const particles::Measurement& measured, const coupling::LayerSelection& selection,
                           std::vector<particles::ScalarVariant>& variants);

}  // namespace drumlin::apps
