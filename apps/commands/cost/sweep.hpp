#pragma once
// A sweep over settings whose points are files, so that what is done is never done again.
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace drumlin::apps {

/// One setting that is varied, and over which values; none: over standard ones.
struct SweepAxis {
  std::string name;
  std::vector<std::string> values;
};

/// Reads "tolerance" or "tolerance=1e-2:1e-3"; without any word all of `allowed`. Throws InputError for a
/// name that is not allowed, or given twice.
std::vector<SweepAxis> sweep_axes(const std::vector<std::string>& words,
                                  const std::vector<std::string>& allowed);
const SweepAxis* find_axis(const std::vector<SweepAxis>& axes, const std::string& name);
/// The values as numbers above 0, `standard` where there are none. Throws InputError.
std::vector<double> numbers_of(const SweepAxis& axis, const std::vector<double>& standard);

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

/// Processor time of this process.
double process_seconds();
/// Of the last minute; how busy the machine is with other things.
double load_average();

/// Marks in every point, under "pareto", the quantities on whose front it stands: least error for its
/// "cpu_seconds". Points without a number for a quantity are left out of its front.
void mark_fronts(nlohmann::ordered_json& points, const std::vector<std::string>& quantities);

/// Thrown through a sweep when a signal came; carries the exit code.
struct Interrupted {
  int exit_code;
};
void stop_if_interrupted();

}  // namespace drumlin::apps
