#include "coupling/accuracy/sweep_axes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "coupling/common/errors.hpp"
#include "coupling/documents/csv.hpp"

namespace drumlin::coupling {
namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& allowed) {
  throw InputError({InputProblem{.file = {}, .key = key, .what = what, .allowed = allowed}});
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> parts_between(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::vector<SweepAxis> sweep_axes(const std::vector<std::string>& words,
                                  const std::vector<std::string>& allowed) {
  std::vector<SweepAxis> axes;
  for (const std::string& word : words) {
    const auto parts = parts_between(word, '=');
    if (parts.size() > 2 || !holds(allowed, parts[0]))
      refuse("--sweep", fmt::format("'{}' is nothing that this scene can be swept over", parts[0]),
             fmt::format("{}", fmt::join(allowed, ", ")));
    if (find_axis(axes, parts[0]) != nullptr)
      throw InputError(fmt::format("--sweep: {} is named twice", parts[0]));
    axes.push_back({parts[0], parts.size() == 2 ? parts_between(parts[1], ':') : std::vector<std::string>{}});
  }
  if (axes.empty())
    for (const std::string& name : allowed) axes.push_back({name, {}});
  return axes;
}

const SweepAxis* find_axis(const std::vector<SweepAxis>& axes, const std::string& name) {
  for (const SweepAxis& axis : axes)
    if (axis.name == name) return &axis;
  return nullptr;
}

std::vector<double> numbers_of(const SweepAxis& axis, const std::vector<double>& standard) {
  if (axis.values.empty()) return standard;
  std::vector<double> numbers;
  for (const std::string& text : axis.values) {
    const auto number = finite_number(text);
    if (!number || *number <= 0)
      refuse("--sweep " + axis.name, fmt::format("'{}' is no value", text), "number > 0");
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<std::string> names_of(const SweepAxis& axis, const std::vector<std::string>& standard,
                                  const std::vector<std::string>& known) {
  if (axis.values.empty()) return standard;
  for (const std::string& name : axis.values)
    if (!holds(known, name))
      refuse("--sweep " + axis.name, fmt::format("'{}' is no {}", name, axis.name),
             fmt::format("{}", fmt::join(known, ", ")));
  return axis.values;
}

}  // namespace drumlin::coupling
