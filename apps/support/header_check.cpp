#include "apps/support/header_check.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Problems = std::vector<InputProblem>;

/// Reports a header entry that is no finite number.
void require_finite(const fs::path& file, const ProfileSet& profiles, const std::string& key,
                    Problems& problems) {
  const auto found = profiles.header.find(key);
  const auto number = header_number(profiles, key);
  if (number && std::isfinite(*number)) return;
  problems.push_back(
      {file.string(), 0, 0, key,
       found == profiles.header.end() ? std::string("is missing") : found->second + " is no number",
       "a finite number"});
}

}  // namespace

bool near(double a, double b) { return std::abs(a - b) <= 1e-3 * std::abs(b); }

std::optional<double> header_number(const ProfileSet& profiles, const std::string& key) {
  const auto found = profiles.header.find(key);
  if (found == profiles.header.end()) return std::nullopt;
  const std::string& text = found->second;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

void check_frame(const fs::path& file, const ProfileSet& profiles, const std::string& side,
                 Problems& problems) {
  const auto found = profiles.header.find("side");
  if (found == profiles.header.end() || found->second != side)
    problems.push_back({file.string(), 0, 0, "side",
                        found == profiles.header.end() ? std::string("is missing") : "is " + found->second,
                        side});
  for (const char* key : {"theta_deg", "rotation", "drum_radius", "diameter_m", "position"})
    require_finite(file, profiles, key, problems);
  // Without a drum there is no axis, and the bottom need not be a wall.
  if (header_number(profiles, "drum_radius").value_or(0) > 0)
    for (const char* key : {"axis_depth", "wall_z"}) require_finite(file, profiles, key, problems);
}

void require_number_near(const fs::path& file, const ProfileSet& profiles, const std::string& key,
                         double expected, const std::string& where, Problems& problems) {
  const double value = header_number(profiles, key).value_or(std::nan(""));
  if (near(value, expected)) return;
  problems.push_back({file.string(), 0, 0, key, fmt::format("{}, but {} in {}", value, expected, where),
                      "the same units and the same frame in all files of a run"});
}

void check_layers(const fs::path& file, const ProfileSet& profiles, Problems& problems) {
  const double wall = header_number(profiles, "wall_z").value_or(std::nan(""));
  const double thickness = header_number(profiles, "layer_thickness").value_or(1);
  std::vector<const ProfileColumn*> needed;
  for (const char* name : {"v_x", "sigma_xx", "sigma_zz", "sigma_xz"}) {
    needed.push_back(profiles.find(name));
    if (needed.back() == nullptr)
      problems.push_back({file.string(), 0, 0, name, "is no column of these profiles", "a measured profile"});
  }
  if (needed.front() == nullptr) return;
  int inside = 0;
  double below = wall;
  for (std::size_t i = 0; i < profiles.z.size(); ++i) {
    const double z = profiles.z[i];
    if (z <= 0 && z - below > 2 * thickness)
      problems.push_back({file.string(), 0, 0, "z",
                          fmt::format("no layer between {:.4g} and {:.4g}, inside the packing", below, z),
                          "layers without gaps between the wall and the surface"});
    below = z;
    // One layer to spare at either end: the wall is round, the surface rough.
    if (z > -thickness || z < wall + thickness) continue;
    if (std::isnan(wall) && std::isnan(needed.front()->value[i])) continue;
    ++inside;
    for (const ProfileColumn* column : needed)
      if (column != nullptr && !std::isfinite(column->value[i]))
        problems.push_back({file.string(), 0, 0, column->name,
                            fmt::format("the layer at z = {:.4g}, inside the packing, is empty", z),
                            "a number in every layer between the wall and the surface"});
  }
  if (inside < 3)
    problems.push_back({file.string(), 0, 0, "z", fmt::format("holds {} layers inside the packing", inside),
                        "three or more"});
}

}  // namespace drumlin::apps
