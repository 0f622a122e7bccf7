#include "particles/import/frame_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"

namespace drumlin::particles {

double unit_of(Quantity quantity, const Scales& scales) {
  switch (quantity) {
    case Quantity::number:
      return 1;
    case Quantity::time:
      return scales.time_s;
    case Quantity::length:
      return scales.length_m;
    case Quantity::velocity:
      return scales.velocity_m_s();
    case Quantity::rate:
      return 1 / scales.time_s;
    case Quantity::force:
      return scales.stress_Pa() * scales.length_m;
  }
  return 1;
}

std::vector<double> FrameTable::values(const std::string& name, const Scales& scales) const {
  const auto found = columns.find(name);
  if (found == columns.end())
    throw InputError({{file, first_line, 0, word(name),
                       "no such column among " + std::string(trimmed(all_names)), "docs/formats/import.md"}});
  const auto& [values, quantity, in_si] = found->second;
  std::vector<double> scaled = values;
  if (in_si)
    for (double& value : scaled) value /= unit_of(quantity, scales);
  if (quantity == Quantity::number) return scaled;
  for (std::size_t row = 0; row < scaled.size(); ++row)
    if (!(std::abs(scaled[row]) <= largest_imported))
      refuse(row, word(name), fmt::format("is {:.3g} of the unit made of d, sqrt(d/g) and rho0", scaled[row]),
             fmt::format("up to {:g} of it", largest_imported));
  return scaled;
}

bool FrameTable::repeats(const FrameTable& other) const {
  return time == other.time && columns.size() == other.columns.size() &&
         std::all_of(columns.begin(), columns.end(), [&](const auto& column) {
           const auto same = other.columns.find(column.first);
           return same != other.columns.end() && same->second.values == column.second.values;
         });
}

double FrameTable::time_in(const Scales& scales) const { return time_in_si ? *time / scales.time_s : *time; }

void FrameTable::refuse(std::size_t row, const std::string& key, const std::string& what,
                        const std::string& allowed) const {
  throw InputError({{file, row < line.size() ? line[row] : first_line, 0, key, what, allowed}});
}

}  // namespace drumlin::particles
