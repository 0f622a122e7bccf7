#pragma once
// The points of a sweep as files, so that what is done is never done again.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "coupling/accuracy/work_point.hpp"

namespace drumlin::apps {

/// OUT/points/NAME.json, each written when its point is done.
class PointStore {
 public:
  /// Makes OUT/points. OUT/sweep.json says what all points share; throws InputError if it stands there and
  /// says something else.
  PointStore(std::filesystem::path output, const nlohmann::ordered_json& shared);
  std::optional<nlohmann::ordered_json> finished(const std::string& name) const;
  void keep(const std::string& name, nlohmann::ordered_json point) const;
  /// For what a point leaves beside its numbers.
  std::filesystem::path beside(const std::string& name) const;

 private:
  std::filesystem::path points_;
};

/// An object of the numbers, null for NaN.
nlohmann::ordered_json json_of(const coupling::NamedNumbers& numbers);

/// Marks in every point, under "pareto", the quantities on whose front it stands (`fronts`): least error for
/// its "cpu_seconds".
void mark_fronts(nlohmann::ordered_json& points, const std::vector<std::string>& quantities);

}  // namespace drumlin::apps
