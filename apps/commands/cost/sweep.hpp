#pragma once
// The points of a sweep as files, so that what is done is never done again.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/support/output_folder.hpp"
#include "coupling/accuracy/work_point.hpp"

namespace drumlin::apps {

/// The folder of a sweep or a price list, claimed for `drumlin cost`.
GrowingOutput cost_output(const std::filesystem::path& folder, ExistingOutput existing,
                          std::vector<std::filesystem::path> inputs);

/// OUT/points/NAME.json, each written and listed when its point is done.
class PointStore {
 public:
  /// Makes OUT/points. OUT/sweep.json says what all points share; throws InputError if it stands there and
  /// says something else.
  PointStore(GrowingOutput& output, const nlohmann::ordered_json& shared);
  std::optional<nlohmann::ordered_json> finished(const std::string& name) const;
  void keep(const std::string& name, nlohmann::ordered_json point) const;
  /// For what a point leaves beside its numbers.
  std::filesystem::path beside(const std::string& name) const;
  /// All is there.
  void finish() const { output_.finish(); }

 private:
  GrowingOutput& output_;
  std::filesystem::path points_;
};

/// An object of the numbers, null for NaN.
nlohmann::ordered_json json_of(const coupling::NamedNumbers& numbers);

/// Marks in every point, under "pareto", the quantities on whose front it stands (`fronts`): least error for
/// its "cpu_seconds".
void mark_fronts(nlohmann::ordered_json& points, const std::vector<std::string>& quantities);

}  // namespace drumlin::apps
