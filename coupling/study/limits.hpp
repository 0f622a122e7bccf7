#pragma once
// Limits that a continuum has to keep, as a file states them before the flows are solved
// (docs/formats/comparison-study.md).
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::coupling {

/// One number that is judged at every speed.
struct Limit {
  std::string quantity;  ///< a field, a scalar, "traction_ratio", "seconds_cold", "seconds_neighbour"
  std::string where;     ///< "centre", "map", "wall", "scalar", "cost"
  std::string zone;      ///< of a field: "flowing", "static", "all"; else empty
  std::string measure;   ///< "relative", "rms", "difference", "inside_interval", "value"
  double must = 0;       ///< of "inside_interval": share of the speeds
  double aim = 0;
  /// At one speed; `must` and `aim` are then those of the mean over the speeds. Absent: they hold at each.
  std::optional<double> must_worst;
};

struct Limits {
  double floor_factor = 1.5;  ///< a limit below so many noise floors is judged against that
  std::vector<Limit> limits;
};

/// Throws InputError, all faults at once (file, line, key, allowed).
Limits read_limits(const std::filesystem::path& file);

}  // namespace drumlin::coupling
