#include "coupling/comparison/registration.hpp"

#include <cmath>

namespace drumlin::coupling {

namespace {

void move_header(RunHeader& header, double offset) {
  for (const HeaderNumber height : {&RunHeader::axis_depth, &RunHeader::wall_z})
    if (auto& value = header.*height; value && std::isfinite(*value)) *value += offset;
}

}  // namespace

double registration_offset(const RunHeader& first, const RunHeader& second, Registration by) {
  if (by == Registration::surface) return 0;
  return number_or_nan(first, &RunHeader::axis_depth) - number_or_nan(second, &RunHeader::axis_depth);
}

ProfileSet moved(ProfileSet profiles, double offset) {
  if (offset == 0) return profiles;
  for (double& z : profiles.z) z += offset;
  move_header(profiles.header, offset);
  return profiles;
}

FieldMap moved(FieldMap map, double offset) {
  if (offset == 0) return map;
  map.grid.z_first += offset;
  move_header(map.header, offset);
  return map;
}

}  // namespace drumlin::coupling
