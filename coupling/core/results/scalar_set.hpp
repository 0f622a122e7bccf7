#pragma once
// Scalar results with their intervals, as they stand in measured.json and flow.json.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin {

/// A measured or computed number; no interval where it is not a measurement, NaN where it was not computed
/// (null in JSON).
struct Scalar {
  std::string name;
  double value = 0;
  std::optional<double> ci99;  ///< half width of the 99 % interval
};

/// Results of one run of either simulator.
struct ScalarSet {
  std::vector<Scalar> scalars;
  const Scalar* find(const std::string& name) const;
  double value(const std::string& name) const;  ///< throws InputError if it is missing
};

/// Reads every top-level key of a JSON object whose value is a number or {"value": , "ci99": }; other keys
/// are skipped. Throws InputError when the file is missing, no JSON, or its "format" is not `format`.
ScalarSet read_scalars(const std::filesystem::path& json_file, const std::string& format);

}  // namespace drumlin
