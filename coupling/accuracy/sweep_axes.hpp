#pragma once
// The settings that a sweep varies, read from words such as "tolerance=1e-2:1e-3".
#include <string>
#include <vector>

namespace drumlin::coupling {

/// One setting that is varied, and over which values; none: over standard ones.
struct SweepAxis {
  std::string name;
  std::vector<std::string> values;
};

/// Reads "tolerance" or "tolerance=1e-2:1e-3"; without any word all of `allowed`. Throws InputError for a
/// name that is not allowed, or given twice.
std::vector<SweepAxis> sweep_axes(const std::vector<std::string>& words,
                                  const std::vector<std::string>& allowed);

/// The axis of this name; null if it is not varied.
const SweepAxis* find_axis(const std::vector<SweepAxis>& axes, const std::string& name);

/// The values as numbers above 0, `standard` where there are none. Throws InputError.
std::vector<double> numbers_of(const SweepAxis& axis, const std::vector<double>& standard);

/// The values as names, `standard` where there are none. Throws InputError for one that is not in `known`.
std::vector<std::string> names_of(const SweepAxis& axis, const std::vector<std::string>& standard,
                                  const std::vector<std::string>& known);

/// The parts of a text between the separators; of an empty text one empty part.
std::vector<std::string> parts_between(const std::string& text, char separator);

}  // namespace drumlin::coupling
