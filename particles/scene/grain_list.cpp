#include "particles/scene/grain_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/documents/key_spec.hpp"
#include "coupling/core/files/input_file.hpp"

namespace drumlin::particles {
namespace {

/// Columns of a list of grains, those that must be there first; the last one is a name.
const std::array<std::string, 8> columns = {"x_mm",     "z_mm",       "diameter_mm",   "v_x_mm_s",
                                            "v_z_mm_s", "spin_rad_s", "density_kg_m3", "material"};
constexpr std::size_t needed_columns = 3, material_column = 7;

/// The number that stands in a column.
double& number_in(ListedGrain& grain, std::size_t column) {
  double* const numbers[] = {&grain.x_mm,     &grain.z_mm,       &grain.diameter_mm,  &grain.v_x_mm_s,
                             &grain.v_z_mm_s, &grain.spin_rad_s, &grain.density_kg_m3};
  return *numbers[column];
}

/// Largest magnitude of a listed number, in the unit of its column.
double largest_allowed(const std::string& column) { return column == "diameter_mm" ? 1e5 : 1e7; }
bool positive(const std::string& column) { return column == "diameter_mm" || column == "density_kg_m3"; }

}  // namespace

std::vector<ListedGrain> listed(const ListedGrains& list) {
  const std::string name = list.file.string();
  std::istringstream in(list.text ? *list.text : input_text(list.file));
  std::vector<InputProblem> problems;
  std::vector<std::string> names;
  std::vector<std::size_t> places;  // of the names among the columns
  std::vector<ListedGrain> grains;
  std::vector<std::string_view> fields;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r" || line[0] == '#') continue;
    csv_fields(line, fields);
    if (names.empty()) {
      names.assign(fields.begin(), fields.end());
      for (const auto& column : names) {
        const auto found = std::find(columns.begin(), columns.end(), column);
        places.push_back(found - columns.begin());
        if (found == columns.end())
          problems.push_back(
              {name, number, 0, column, "unknown column",
               "x_mm, z_mm, diameter_mm, v_x_mm_s, v_z_mm_s, spin_rad_s, density_kg_m3, material"});
      }
      for (const auto& column : names)
        if (std::count(names.begin(), names.end(), column) > 1)
          problems.push_back({name, number, 0, column, "appears more than once", ""});
      for (std::size_t needed = 0; needed < needed_columns; ++needed)
        if (std::find(names.begin(), names.end(), columns[needed]) == names.end())
          problems.push_back({name, number, 0, columns[needed], "missing column", ""});
      continue;
    }
    if (fields.size() != names.size()) {
      problems.push_back(
          {name, number, 0, "", std::to_string(fields.size()) + " fields", std::to_string(names.size())});
      continue;
    }
    ListedGrain grain;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (places[f] == material_column) {
        grain.material = fields[f];
        continue;
      }
      const auto number_read = finite_number(fields[f]);
      const double value = number_read.value_or(0);
      if (!number_read)
        problems.push_back(
            {name, number, 0, names[f], "'" + std::string(fields[f]) + "'", "a finite number"});
      else if (std::abs(value) > largest_allowed(names[f]))
        problems.push_back({name, number, 0, names[f], std::string(fields[f]),
                            "up to " + std::to_string(largest_allowed(names[f]))});
      else if (positive(names[f]) && value <= 0)
        problems.push_back({name, number, 0, names[f], std::string(fields[f]), "> 0"});
      if (places[f] < material_column) number_in(grain, places[f]) = value;
    }
    grains.push_back(std::move(grain));
  }
  if (grains.empty() && problems.empty())
    problems.push_back({name, 0, 0, "grains.listed.file", "lists no grains", ""});
  const auto [least, largest] =
      std::minmax_element(grains.begin(), grains.end(),
                          [](const auto& a, const auto& b) { return a.diameter_mm < b.diameter_mm; });
  if (problems.empty() && least->diameter_mm < least_share_of_length * largest->diameter_mm)
    problems.push_back(
        {name, 0, 0, "diameter_mm", fmt::format("is {:g}", least->diameter_mm),
         fmt::format("at least {:g} of the largest, {:g}", least_share_of_length, largest->diameter_mm)});
  if (!problems.empty()) throw InputError(problems);
  return grains;
}

}  // namespace drumlin::particles
