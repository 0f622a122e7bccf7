#include "coupling/core/results/run_checks.hpp"

#include <fmt/format.h>

#include <cmath>

namespace drumlin {

namespace {

namespace fs = std::filesystem;
using Problems = std::vector<InputProblem>;

/// Reports a header entry that is no finite number.
void require_finite(const fs::path& file, const RunHeader& header, HeaderNumber number, Problems& problems) {
  if (std::isfinite(number_or_nan(header, number))) return;
  const bool missing = !(header.*number);
  problems.push_back(
      {file.string(), 0, 0, key_of(number), missing ? "is missing" : "nan is no number", "a finite number"});
}

}  // namespace

bool nearly_equal(double a, double b) { return std::abs(a - b) <= 1e-3 * std::abs(b); }

void check_frame(const fs::path& file, const RunHeader& header, RunSide side, Problems& problems) {
  if (header.side != side)
    problems.push_back({file.string(), 0, 0, "side",
                        header.side ? std::string("is ") + name_of(*header.side) : "is missing",
                        name_of(side)});
  for (const HeaderNumber number : {&RunHeader::theta_deg, &RunHeader::rotation, &RunHeader::drum_radius,
                                    &RunHeader::diameter_m, &RunHeader::position})
    require_finite(file, header, number, problems);
  // Without a drum there is no axis, and the bottom need not be a wall.
  if (header.drum_radius.value_or(0) > 0)
    for (const HeaderNumber number : {&RunHeader::axis_depth, &RunHeader::wall_z})
      require_finite(file, header, number, problems);
}

void require_number_near(const fs::path& file, const RunHeader& header, HeaderNumber number, double expected,
                         const std::string& where, Problems& problems) {
  const double value = number_or_nan(header, number);
  if (nearly_equal(value, expected)) return;
  problems.push_back({file.string(), 0, 0, key_of(number),
                      fmt::format("{}, but {} in {}", value, expected, where),
                      "the same units and the same frame in all files of a run"});
}

void check_layers(const fs::path& file, const ProfileSet& profiles, Problems& problems) {
  const double wall = number_or_nan(profiles.header, &RunHeader::wall_z);
  const double thickness = profiles.header.layer_thickness.value_or(1);
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

}  // namespace drumlin
