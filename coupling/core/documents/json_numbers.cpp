#include "coupling/core/documents/json_numbers.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace drumlin {

using Json = nlohmann::ordered_json;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json number_or_null(const std::optional<double>& value) { return value ? number_or_null(*value) : Json(); }

std::optional<double> number_or_nan(const Json& value) {
  if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
  if (value.is_number()) return value.get<double>();
  return std::nullopt;
}

}  // namespace drumlin
