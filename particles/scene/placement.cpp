#include "particles/scene/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coupling/common/errors.hpp"
#include "coupling/common/input_file.hpp"
#include "coupling/documents/csv.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/random.hpp"
#include "particles/scene/sequential_placement.hpp"
#include "particles/scene/sizes.hpp"

namespace drumlin::particles {
namespace {

constexpr double spacing_over_largest = 1.03;

struct Site {
  double x = 0, z = 0;
};

/// Lattice sites, in mm, whose discs of the largest diameter lie inside the region; from below, left to
/// right.
std::vector<Site> lattice_sites(const GeneratedGrains& grains) {
  const double spacing = spacing_over_largest * grains.diameter_max_mm,
               row_height = spacing * std::sqrt(3.0) / 2;
  // Room for a disc of the largest diameter and its shaking: half a lattice spacing.
  const double room = spacing / 2;
  double x_low, x_high, z_low, z_high;
  const auto* circle = std::get_if<CircleRegion>(&grains.region);
  if (circle) {
    x_low = circle->center_mm[0] - circle->radius_mm, x_high = circle->center_mm[0] + circle->radius_mm;
    z_low = circle->center_mm[1] - circle->radius_mm, z_high = circle->center_mm[1] + circle->radius_mm;
  } else {
    const auto& box = std::get<RectangleRegion>(grains.region);
    x_low = box.min_mm[0], x_high = box.max_mm[0], z_low = box.min_mm[1], z_high = box.max_mm[1];
  }
  std::vector<Site> sites;
  for (int row = 0;; ++row) {
    const double z = z_low + room + row * row_height;
    if (z + room > z_high + 1e-12) break;
    for (double x = x_low + room + (row % 2 ? spacing / 2 : 0); x + room <= x_high + 1e-12; x += spacing)
      if (!circle ||
          std::hypot(x - circle->center_mm[0], z - circle->center_mm[1]) + room <= circle->radius_mm)
        sites.push_back({x, z});
  }
  return sites;
}

/// A material for each generated grain, by their shares.
std::vector<std::uint8_t> drawn_materials(const Scene& scene, std::size_t count) {
  const auto names = material_names(scene);
  const auto& materials = scene.grains.materials;
  double sum = 0;
  for (const auto& material : materials) sum += material.share;
  RandomStream choice(scene.seed, "grains/material");
  std::vector<std::uint8_t> drawn(count, static_cast<std::uint8_t>(material_number(names, {})));
  for (std::size_t g = 0; g < count && !materials.empty(); ++g) {
    double place = choice.uniform() * sum;
    std::size_t m = 0;
    while (m + 1 < materials.size() && place >= materials[m].share) place -= materials[m++].share;
    drawn[g] = static_cast<std::uint8_t>(m);  // the grains' materials stand first among the names
  }
  return drawn;
}

Bodies generated(const GeneratedGrains& grains, std::uint64_t seed, double unit) {
  const auto sites = lattice_sites(grains);
  if (static_cast<int>(sites.size()) < grains.count)
    throw InputError({InputProblem{"", 0, 0, "grains.generated.count",
                                   std::to_string(grains.count) + " grains do not fit into the region",
                                   "at most " + std::to_string(sites.size())}});
  RandomStream sizes(seed, "grains/diameter"), shaking(seed, "grains/position");
  const double room = (spacing_over_largest - 1) * grains.diameter_max_mm / 2;
  Bodies bodies;
  for (int g = 0; g < grains.count; ++g) {
    const double diameter = sizes.uniform(grains.diameter_min_mm, grains.diameter_max_mm);
    const double angle = shaking.uniform(0, 2 * std::numbers::pi), distance = shaking.uniform(0, room);
    add_body(bodies, (sites[g].x + distance * std::cos(angle)) * unit,
             (sites[g].z + distance * std::sin(angle)) * unit, diameter / 2 * unit);
  }
  return bodies;
}

/// Grains of a distribution of sizes.
Bodies sequential(const GeneratedGrains& grains, std::uint64_t seed, double unit) {
  RandomStream sizes(seed, "grains/diameter");
  std::vector<double> diameters;
  for (int g = 0; g < grains.count; ++g) diameters.push_back(drawn_diameter_mm(grains, sizes));
  const auto centers = sequential_centers_mm(diameters, grains.region, seed);
  Bodies bodies;
  for (std::size_t g = 0; g < centers.size(); ++g)
    add_body(bodies, centers[g][0] * unit, centers[g][1] * unit, diameters[g] / 2 * unit);
  return bodies;
}

/// Columns of a list of grains, those that must be there first; the last one is a name.
const std::array<std::string, 7> columns = {"x_mm",     "z_mm",       "diameter_mm", "v_x_mm_s",
                                            "v_z_mm_s", "spin_rad_s", "material"};
constexpr std::size_t needed_columns = 3, material_column = 6;

struct ListedGrain {
  double x_mm = 0, z_mm = 0, diameter_mm = 0, v_x_mm_s = 0, v_z_mm_s = 0, spin_rad_s = 0;
  std::string material;
};

/// The number that stands in a column.
double& number_in(ListedGrain& grain, std::size_t column) {
  double* const numbers[] = {&grain.x_mm,     &grain.z_mm,     &grain.diameter_mm,
                             &grain.v_x_mm_s, &grain.v_z_mm_s, &grain.spin_rad_s};
  return *numbers[column];
}

/// Largest magnitude of a listed number, in the unit of its column.
double largest_allowed(const std::string& column) { return column == "diameter_mm" ? 1e5 : 1e7; }

/// Reads the CSV list; every fault of the file is reported at once.
std::vector<ListedGrain> listed(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::istringstream in(input_text(file));
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
          problems.push_back({name, number, 0, column, "unknown column",
                              "x_mm, z_mm, diameter_mm, v_x_mm_s, v_z_mm_s, spin_rad_s, material"});
      }
      for (const auto& column : names)
        if (std::count(names.begin(), names.end(), column) > 1)
          problems.push_back({name, number, 0, column, "stands more than once", ""});
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
      else if (names[f] == "diameter_mm" && value <= 0)
        problems.push_back({name, number, 0, names[f], std::string(fields[f]), "> 0"});
      if (places[f] < material_column) number_in(grain, places[f]) = value;
    }
    grains.push_back(std::move(grain));
  }
  if (grains.empty() && problems.empty())
    problems.push_back({name, 0, 0, "grains.listed.file", "lists no grains", ""});
  if (!problems.empty()) throw InputError(problems);
  return grains;
}

/// The material of each listed grain; every one must be known.
std::vector<std::uint8_t> listed_materials(const Scene& scene, const std::vector<ListedGrain>& grains) {
  const auto names = material_names(scene);
  const auto& materials = scene.grains.materials;
  std::vector<std::uint8_t> numbers;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const bool known = std::any_of(materials.begin(), materials.end(),
                                   [&](const GrainMaterial& m) { return m.name == grains[g].material; });
    if (!known && !materials.empty())
      throw InputError(
          {InputProblem{std::get<ListedGrains>(scene.grains.source).file.string(), 0, 0, "material",
                        "grain " + std::to_string(g + 1) + " is of '" + grains[g].material + "'",
                        "one of grains.materials"}});
    numbers.push_back(static_cast<std::uint8_t>(known ? material_number(names, grains[g].material)
                                                      : material_number(names, {})));
  }
  return numbers;
}

/// In a period shorter than three of the largest discs, of grains or walls, a grain would meet a neighbour on
/// both sides.
void check_period(const Scene& scene, const Bodies& bodies, double unit) {
  if (!scene.periodic_x) return;
  double largest = 2 * *std::max_element(bodies.radius.begin(), bodies.radius.end()) / unit;
  for (const Wall& wall : scene.walls) {
    if (const auto* disc = std::get_if<DiscShape>(&wall.shape))
      largest = std::max(largest, disc->diameter_mm);
    if (wall.rough) largest = std::max(largest, wall.rough->diameter_mm);
  }
  if (scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm <= 3 * largest)
    throw InputError({InputProblem{"", 0, 0, "periodic_x.x_max_mm",
                                   "the period is too short for discs of " + std::to_string(largest) + " mm",
                                   "longer than 3 of the largest discs"}});
}

}  // namespace

double mean_diameter_m(const Grains& grains) {
  if (const auto* made = std::get_if<GeneratedGrains>(&grains.source))
    return (made->sizes ? mean_power_mm(*made, 1) : (made->diameter_min_mm + made->diameter_max_mm) / 2) *
           1e-3;
  const auto list = listed(std::get<ListedGrains>(grains.source).file);
  double sum = 0;
  for (const auto& grain : list) sum += grain.diameter_mm;
  return sum / static_cast<double>(list.size()) * 1e-3;
}

Bodies place_grains(const Scene& scene, const Scales& scales) {
  const double unit = 1e-3 / scales.length_m, speed = 1e-3 / scales.velocity_m_s();
  Bodies bodies;
  std::vector<double> spins;
  if (const auto* made = std::get_if<GeneratedGrains>(&scene.grains.source)) {
    bodies = made->sizes ? sequential(*made, scene.seed, unit) : generated(*made, scene.seed, unit);
    spins.assign(bodies.count(), 0.0);
    if (materials_matter(scene)) bodies.material = drawn_materials(scene, bodies.count());
  } else {
    const auto grains = listed(std::get<ListedGrains>(scene.grains.source).file);
    if (materials_matter(scene)) bodies.material = listed_materials(scene, grains);
    for (const auto& grain : grains) {
      add_body(bodies, grain.x_mm * unit, grain.z_mm * unit, grain.diameter_mm / 2 * unit);
      bodies.v_x.back() = grain.v_x_mm_s * speed;
      bodies.v_z.back() = grain.v_z_mm_s * speed;
      spins.push_back(grain.spin_rad_s * scales.time_s);
    }
  }
  if (scene.effects.spin) bodies.spin = spins;
  check_period(scene, bodies, unit);
  return bodies;
}

int capacity(const GeneratedGrains& grains) { return static_cast<int>(lattice_sites(grains).size()); }

}  // namespace drumlin::particles
