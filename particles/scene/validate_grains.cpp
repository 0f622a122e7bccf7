#include "particles/scene/validate_grains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <system_error>

#include "particles/scene/deposited_placement.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/obstacles.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/region.hpp"
#include "particles/scene/scene_walls.hpp"
#include "particles/scene/sequential_placement.hpp"
#include "particles/scene/sizes.hpp"

namespace drumlin::particles {
namespace {

using Faults = std::vector<SceneFault>;

constexpr double most_sites = 1e7;  // of the lattice on which grains are placed: 160 MB
constexpr double widest = 1e5;      // region of deposited grains, in diameters: they roll that far

/// Whether a rectangle has its corners the right way round; a circle always has.
bool check_corners(const Region& region, const std::string& key, Faults& faults) {
  const auto* box = std::get_if<RectangleRegion>(&region);
  for (int axis : {0, 1})
    if (box && !(box->min_mm[axis] < box->max_mm[axis])) {
      faults.push_back({key + ".max_mm",
                        fmt::format("is {} along {}", box->max_mm[axis], axis ? "z" : "x"),
                        fmt::format("> min_mm = {}", box->min_mm[axis]),
                        {key}});
      return false;
    }
  return true;
}

/// The table of a sieve analysis: openings ascend, shares never fall, and both end where diameters do.
bool check_sieves(const SieveSizes& sieves, double smallest, double largest, const std::string& key,
                  Faults& faults) {
  const auto& openings = sieves.openings_mm;
  const auto& shares = sieves.passing_share;
  const auto fault = [&](const char* name, const std::string& what, const std::string& allowed) {
    faults.push_back({key + name, what, allowed, {key + "openings_mm", key + "passing_share"}});
    return false;
  };
  if (openings.size() != shares.size())
    return fault("passing_share",
                 fmt::format("has {} shares, openings_mm {}", shares.size(), openings.size()), "as many");
  for (std::size_t k = 0; k < openings.size(); ++k) {
    if (openings[k] < smallest || openings[k] > largest || (k > 0 && !(openings[k] > openings[k - 1])))
      return fault(
          "openings_mm", fmt::format("holds {}", openings[k]),
          fmt::format("ascending, from diameter_min_mm = {} to diameter_max_mm = {}", smallest, largest));
    if (k > 0 && shares[k] < shares[k - 1])
      return fault("passing_share", fmt::format("falls from {} to {}", shares[k - 1], shares[k]),
                   "never less");
    if (openings[k] == smallest && shares[k] > 0)
      return fault("passing_share", fmt::format("is {} at the smallest diameter", shares[k]), "0 there");
    if (openings[k] == largest && shares[k] < 1)
      return fault("passing_share", fmt::format("is {} at the largest diameter", shares[k]), "1 there");
  }
  return true;
}

/// The same for grains that are placed at random or deposited.
void check_share(const GeneratedGrains& grains, const std::string& key, Faults& faults) {
  if (!check_sizes(grains.sizes, grains.diameter_min_mm, grains.diameter_max_mm, key + "sizes.", faults))
    return;
  const auto [left, right] = extent_mm(grains.region, 0);
  if (const double width = (right - left) / grains.diameter_max_mm;
      grains.deposited() && !(width <= widest)) {
    faults.push_back({key + "region",
                      fmt::format("is {:.3g} of the largest diameters wide", width),
                      fmt::format("at most {:g} for deposited grains", widest),
                      {key + "region", key + "diameter_max_mm", key + "placement"}});
    return;
  }
  const double area = std::numbers::pi / 4 * mean_power_mm(grains, 2);
  const double share = grains.deposited() ? deposited_share : sequential_share;
  const double most = share * area_mm2(grains.region) / area;
  if (grains.count > most)
    faults.push_back({key + "count",
                      fmt::format("is {}, of {:.4g} mm2 each in the mean", grains.count, area),
                      fmt::format("at most {:.0f}, {} of the region", most, share),
                      {key}});
}

/// Whether the region has room for the grains, and a lattice that fits into memory.
void check_room(const Scene& scene, const GeneratedGrains& grains, const std::string& key, Faults& faults) {
  if (grains.diameter_min_mm > grains.diameter_max_mm) {
    faults.push_back({key + "diameter_max_mm",
                      fmt::format("is {}", grains.diameter_max_mm),
                      fmt::format("number in mm, >= diameter_min_mm = {}", grains.diameter_min_mm),
                      {key + "diameter_min_mm", key + "diameter_max_mm"}});
    return;
  }
  const std::vector<std::string> about = {key + "count", key + "diameter_max_mm", key + "region"};
  if (grains.sizes || grains.deposited()) {
    check_share(grains, key, faults);
    return;
  }
  const auto [left, right] = extent_mm(grains.region, 0);
  const auto [bottom, top] = extent_mm(grains.region, 1);
  const double sites =
      ((right - left) / grains.diameter_max_mm + 1) * ((top - bottom) / grains.diameter_max_mm + 1);
  if (!(sites <= most_sites)) {
    faults.push_back({key + "region", fmt::format("has room for {:.0f} grains", sites),
                      fmt::format("at most {:.0f}", most_sites), about});
    return;
  }
  if (const int most = capacity(grains, scene); grains.count > most)
    faults.push_back({key + "count", fmt::format("is {}", grains.count),
                      fmt::format("at most {} fit into the region", most), about});
}

bool crossed_by_glued(const Region& region, const Wall& wall) {
  const auto centers = glued_centers_mm(wall);
  return std::any_of(centers.begin(), centers.end(), [&](const Point_mm& center) {
    return crosses(region, DiscShape{center, wall.rough->diameter_mm}, relative_rounding);
  });
}

/// Grains know the walls that they are placed around, where they are not deposited.
void check_around(const Scene& scene, const GeneratedGrains& grains, const std::string& key, Faults& faults) {
  if (!grains.around) return;
  if (grains.deposited())
    faults.push_back(
        {key + "around",
         "names walls, where deposited grains know only one another and the border of the region",
         "placement = \"apart\"",
         {key + "around", key + "placement"}});
  for (const std::string& name : *grains.around)
    if (std::none_of(scene.walls.begin(), scene.walls.end(), [&](const Wall& w) { return w.name == name; }))
      faults.push_back({key + "around",
                        fmt::format("names no wall: \"{}\"", name),
                        "names of walls",
                        {key + "around", "walls"}});
}

/// Grains are placed anywhere in the region: it must lie inside the containers, and clear of all other walls
/// that grains are not placed around.
void check_region_clear(const Scene& scene, const GeneratedGrains& grains, const std::string& key,
                        Faults& faults) {
  for (std::size_t w = 0; w < scene.walls.size(); ++w) {
    const auto& wall = scene.walls[w];
    const std::vector<std::string> about = {key, wall_key(w)};
    if (const auto* container = std::get_if<ContainerShape>(&wall.shape)) {
      const double reach = farthest_mm(grains.region, container->center_mm);
      const double room = container->radius_mm - (wall.rough ? wall.rough->diameter_mm / 2 : 0);
      if (reach > room * (1 + relative_rounding))
        faults.push_back({key,
                          fmt::format("reaches {} mm from the centre of container \"{}\"", reach, wall.name),
                          fmt::format("inside its radius of {} mm", room), about});
    } else if (!placed_around(grains, wall) && (crosses(grains.region, wall.shape, relative_rounding) ||
                                                crossed_by_glued(grains.region, wall))) {
      faults.push_back({key, fmt::format("is crossed by wall \"{}\" ({})", wall.name, wall_key(w)),
                        "clear of all walls but containers and those of around", about});
    }
  }
}

/// `key`: of the table of the generated grains, with a dot.
void check_generated(const Scene& scene, const GeneratedGrains& grains, const std::string& key,
                     Faults& faults) {
  if (!check_corners(grains.region, key + "region", faults)) return;
  check_around(scene, grains, key, faults);
  check_room(scene, grains, key, faults);
  check_region_clear(scene, grains, key + "region", faults);
}

void check_list(const ListedGrains& list, const std::string& key, Faults& faults) {
  std::error_code unknown;
  const auto status = std::filesystem::status(list.file, unknown);
  if (std::filesystem::is_regular_file(status)) return;
  std::string what = std::filesystem::is_directory(status) ? "is a folder"
                     : std::filesystem::exists(status)     ? "is no regular file"
                     : status.type() == std::filesystem::file_type::not_found
                         ? "does not exist"
                         : "cannot be found: " + unknown.message();
  faults.push_back({key, list.file.string() + " " + what, "a CSV file", {key}});
}

void check_group(const Scene& scene, std::size_t g, std::set<std::string>& names, Faults& faults) {
  const GrainGroup& group = scene.grains.groups[g];
  const std::string key = fmt::format("grains.groups.{}.", g);
  if (!names.insert(group.name).second)
    faults.push_back(
        {key + "name", fmt::format("\"{}\" appears twice", group.name), "a name of its own", {key + "name"}});
  const auto& materials = scene.grains.materials;
  const auto known = [&](const GrainMaterial& m) { return group.material && m.name == *group.material; };
  if (group.material && std::none_of(materials.begin(), materials.end(), known))
    faults.push_back({key + "material",
                      fmt::format("names no material: \"{}\"", *group.material),
                      "one of grains.materials",
                      {key + "material", "grains.materials"}});
  if (const auto* made = std::get_if<GeneratedGrains>(&group.source))
    check_generated(scene, *made, key + "generated.", faults);
  else
    check_list(std::get<ListedGrains>(group.source), key + "listed.file", faults);
}

}  // namespace

bool check_sizes(const std::optional<Sizes>& sizes, double smallest_mm, double largest_mm,
                 const std::string& key, Faults& faults) {
  if (const auto* sieves = sizes ? std::get_if<SieveSizes>(&*sizes) : nullptr)
    return check_sieves(*sieves, smallest_mm, largest_mm, key, faults);
  const auto* cut = sizes ? std::get_if<LognormalSizes>(&*sizes) : nullptr;
  if (!cut || (cut->median_mm >= smallest_mm && cut->median_mm <= largest_mm)) return true;
  faults.push_back({key + "median_mm",
                    fmt::format("is {}", cut->median_mm),
                    "between diameter_min_mm and diameter_max_mm",
                    {key}});
  return false;
}

void check_grains(const Scene& scene, Faults& faults) {
  if (const auto* made = std::get_if<GeneratedGrains>(&scene.grains.source))
    check_generated(scene, *made, "grains.generated.", faults);
  if (const auto* list = std::get_if<ListedGrains>(&scene.grains.source))
    check_list(*list, "grains.listed.file", faults);
  std::set<std::string> names;
  for (std::size_t g = 0; g < scene.grains.groups.size(); ++g) check_group(scene, g, names, faults);
}

}  // namespace drumlin::particles
