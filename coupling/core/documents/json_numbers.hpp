#pragma once
// Numbers in JSON: what was not computed is null there, and NaN or absent here.
#include <nlohmann/json_fwd.hpp>
#include <optional>

namespace drumlin {

/// The number, or null where it is not finite.
nlohmann::ordered_json number_or_null(double value);
/// The number, or null where there is none or it is not finite.
nlohmann::ordered_json number_or_null(const std::optional<double>& value);

/// The number that a value is, NaN for null; nothing for any other value.
std::optional<double> number_or_nan(const nlohmann::ordered_json& value);

}  // namespace drumlin
