#include "coupling/comparison/registration.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace drumlin {

namespace {

using Header = std::map<std::string, std::string>;

/// Shortest text that reads back to the same number.
std::string text_of(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

void move_header(Header& header, double offset) {
  for (const char* key : {"axis_depth", "wall_z"})
    if (const double value = header_number(header, key); std::isfinite(value))
      header[key] = text_of(value + offset);
}

}  // namespace

double header_number(const Header& header, const std::string& key) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const auto found = header.find(key);
  if (found == header.end()) return none;
  const std::string& text = found->second;
  double value = none;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : none;
}

double registration_offset(const Header& first, const Header& second, Registration by) {
  if (by == Registration::surface) return 0;
  return header_number(first, "axis_depth") - header_number(second, "axis_depth");
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

}  // namespace drumlin
