#include "coupling/core/results/field_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin {
namespace {

constexpr const char* name_letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";

/// Of a number with which nothing can be measured; empty: there is none.
std::string fault_of(const std::string& name, const std::vector<double>& values, std::size_t columns) {
  const auto bad = std::find_if(values.begin(), values.end(),
                                [](double value) { return std::abs(value) > largest_value; });
  if (bad == values.end()) return {};
  const auto node = static_cast<std::size_t>(bad - values.begin());
  return fmt::format("{}: is {} in row {}, column {} (allowed: at most {:g} from 0, NaN: not measured)", name,
                     *bad, node / columns + 1, node % columns + 1, largest_value);
}

}  // namespace

const MapField* FieldMap::find(const std::string& name) const {
  for (const MapField& candidate : fields)
    if (candidate.name == name) return &candidate;
  return nullptr;
}

const MapField& FieldMap::field(const std::string& name) const {
  if (const MapField* found = find(name)) return *found;
  throw InputError("the maps have no field " + name);
}

std::vector<double> surface_heights(const MapGrid& grid, const std::vector<double>& nu, double surface_nu) {
  std::vector<double> heights(grid.columns, no_value);
  for (std::size_t node = 0; node < grid.nodes(); ++node) {
    if (!(nu[node] >= surface_nu)) continue;
    const std::size_t next = node + grid.columns;
    const double above = next < grid.nodes() ? nu[next] : no_value;
    const double share = std::isnan(above) ? 0 : (nu[node] - surface_nu) / (nu[node] - above);
    heights[node % grid.columns] = grid.z_of(node / grid.columns) + share * grid.spacing_z;
  }
  return heights;
}

std::string fault_of(const FieldMap& map) {
  const MapGrid& grid = map.grid;
  if (grid.nodes() == 0) return "the grid has no nodes";
  for (double spacing : {grid.spacing_x, grid.spacing_z})
    if (!(spacing > 0) || !std::isfinite(spacing))
      return fmt::format("the grid has a spacing of {}", spacing);
  if (!std::isfinite(grid.x_first) || !std::isfinite(grid.z_first)) return "the grid begins nowhere";
  std::set<std::string> names;
  for (const MapField& field : map.fields) {
    if (field.name.empty() || field.name.find_first_not_of(name_letters) != std::string::npos)
      return fmt::format("\"{}\" cannot name a field: letters, digits and _ can", field.name);
    if (!names.insert(field.name).second) return fmt::format("{} appears twice", field.name);
    if (field.value.size() != grid.nodes() || (!field.ci99.empty() && field.ci99.size() != grid.nodes()))
      return fmt::format("{} has another length than the {} x {} nodes of the grid", field.name, grid.rows,
                         grid.columns);
    for (const auto& [group, values] : {std::pair{"fields/", &field.value}, {"ci99/", &field.ci99}})
      if (std::string fault = fault_of(group + field.name, *values, grid.columns); !fault.empty())
        return fault;
  }
  return fault_of(map.header);
}

}  // namespace drumlin
