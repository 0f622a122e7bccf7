#include "particles/import/frame_table.hpp"

#include "coupling/common/errors.hpp"

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
    throw InputError({{file, first_line, 0, name, "no such column", "docs/formats/import.md"}});
  std::vector<double> scaled = found->second.values;
  if (found->second.in_si)
    for (double& value : scaled) value /= unit_of(found->second.quantity, scales);
  return scaled;
}

double FrameTable::time_in(const Scales& scales) const { return time_in_si ? *time / scales.time_s : *time; }

void FrameTable::refuse(std::size_t row, const std::string& key, const std::string& what,
                        const std::string& allowed) const {
  throw InputError({{file, row < line.size() ? line[row] : first_line, 0, key, what, allowed}});
}

}  // namespace drumlin::particles
