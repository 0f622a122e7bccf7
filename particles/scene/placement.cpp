#include "particles/scene/placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/deposited_placement.hpp"
#include "particles/scene/grain_list.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/obstacles.hpp"
#include "particles/scene/random.hpp"
#include "particles/scene/sequential_placement.hpp"
#include "particles/scene/sizes.hpp"

namespace drumlin::particles {
namespace {

constexpr double spacing_over_largest = 1.03;

struct Site {
  double x = 0, z = 0;
};

/// Lattice sites, in mm, whose discs of the largest diameter lie inside the region and in no obstacle; from
/// below, left to right.
std::vector<Site> lattice_sites(const GeneratedGrains& grains, const Obstacles& obstacles) {
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
      if ((!circle ||
           std::hypot(x - circle->center_mm[0], z - circle->center_mm[1]) + room <= circle->radius_mm) &&
          obstacles.clear({x, z}, room))
        sites.push_back({x, z});
  }
  return sites;
}

/// A material for each generated grain, by their shares.
std::vector<std::uint8_t> drawn_materials(const Scene& scene, std::uint64_t seed, std::size_t count) {
  const auto names = material_names(scene);
  const auto& materials = scene.grains.materials;
  double sum = 0;
  for (const auto& material : materials) sum += material.share;
  RandomStream choice(seed, "grains/material");
  std::vector<std::uint8_t> drawn(count, static_cast<std::uint8_t>(material_number(names, {})));
  for (std::size_t g = 0; g < count && !materials.empty(); ++g) {
    double place = choice.uniform() * sum;
    std::size_t m = 0;
    while (m + 1 < materials.size() && place >= materials[m].share) place -= materials[m++].share;
    drawn[g] = static_cast<std::uint8_t>(m);  // the grains' materials stand first among the names
  }
  return drawn;
}

Bodies generated(const GeneratedGrains& grains, const Obstacles& obstacles, std::uint64_t seed, double unit) {
  const auto sites = lattice_sites(grains, obstacles);
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

/// Grains of a distribution of sizes, or in a packing nearly at rest.
Bodies one_by_one(const GeneratedGrains& grains, const Obstacles& obstacles, std::uint64_t seed,
                  double unit) {
  RandomStream sizes(seed, "grains/diameter");
  const std::vector<double> diameters = diameters_mm(grains, sizes);
  const auto centers = grains.deposited() ? deposited_centers_mm(diameters, grains.region, seed)
                                          : sequential_centers_mm(diameters, grains.region, obstacles, seed);
  Bodies bodies;
  for (std::size_t g = 0; g < centers.size(); ++g)
    add_body(bodies, centers[g][0] * unit, centers[g][1] * unit, diameters[g] / 2 * unit);
  return bodies;
}

/// The material of each listed grain; every one must be known.
std::vector<std::uint8_t> listed_materials(const Scene& scene, const ListedGrains& list,
                                           const std::vector<ListedGrain>& grains) {
  const auto names = material_names(scene);
  const auto& materials = scene.grains.materials;
  std::vector<std::uint8_t> numbers;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const bool known = std::any_of(materials.begin(), materials.end(),
                                   [&](const GrainMaterial& m) { return m.name == grains[g].material; });
    if (!known && !materials.empty())
      throw InputError({InputProblem{list.file.string(), 0, 0, "material",
                                     "grain " + std::to_string(g + 1) + " is of '" + grains[g].material + "'",
                                     "one of grains.materials"}});
    numbers.push_back(static_cast<std::uint8_t>(known ? material_number(names, grains[g].material)
                                                      : material_number(names, {})));
  }
  return numbers;
}

/// Where grains come from, whichever group they are.
struct GroupPlan {
  const GeneratedGrains* made = nullptr;
  const ListedGrains* list = nullptr;
  std::uint64_t seed = 0;
  std::optional<std::string> material;  ///< of all of them
  double density = 1;                   ///< over that of the scene
};

void set_density(double density, std::size_t b, Bodies& bodies) {
  if (density != 1) bodies.inverse_mass[b] /= density;
}

/// Spins beside: bodies hold them only where the scene has them.
void append_listed(const Scene& scene, const GroupPlan& group, const Scales& scales, Bodies& bodies,
                   std::vector<double>& spins) {
  const double unit = 1e-3 / scales.length_m, speed = 1e-3 / scales.velocity_m_s();
  const auto grains = listed(*group.list);
  if (materials_matter(scene)) {
    const auto numbers =
        group.material
            ? std::vector(grains.size(),
                          static_cast<std::uint8_t>(material_number(material_names(scene), group.material)))
            : listed_materials(scene, *group.list, grains);
    bodies.material.insert(bodies.material.end(), numbers.begin(), numbers.end());
  }
  for (const auto& grain : grains) {
    add_body(bodies, grain.x_mm * unit, grain.z_mm * unit, grain.diameter_mm / 2 * unit);
    bodies.v_x.back() = grain.v_x_mm_s * speed;
    bodies.v_z.back() = grain.v_z_mm_s * speed;
    spins.push_back(grain.spin_rad_s * scales.time_s);
    set_density(grain.density_kg_m3 > 0 ? grain.density_kg_m3 / scales.density_kg_m3 : group.density,
                bodies.count() - 1, bodies);
  }
}

void append(const Scene& scene, const GroupPlan& group, const Scales& scales, Bodies& bodies,
            std::vector<double>& spins) {
  if (group.list) return append_listed(scene, group, scales, bodies, spins);
  const double unit = 1e-3 / scales.length_m;
  const bool on_lattice = !group.made->sizes && !group.made->deposited();
  const Obstacles obstacles(*group.made, scene);
  Bodies made = on_lattice ? generated(*group.made, obstacles, group.seed, unit)
                           : one_by_one(*group.made, obstacles, group.seed, unit);
  if (materials_matter(scene)) {
    const auto numbers =
        group.material
            ? std::vector(made.count(),
                          static_cast<std::uint8_t>(material_number(material_names(scene), group.material)))
            : drawn_materials(scene, group.seed, made.count());
    bodies.material.insert(bodies.material.end(), numbers.begin(), numbers.end());
  }
  for (std::size_t b = 0; b < made.count(); ++b) {
    add_body(bodies, made.x[b], made.z[b], made.radius[b]);
    set_density(group.density, bodies.count() - 1, bodies);
  }
  spins.resize(bodies.count(), 0.0);
}

template <class Source>
GroupPlan plan_of(const Source& source, std::uint64_t seed) {
  GroupPlan plan;
  plan.made = std::get_if<GeneratedGrains>(&source), plan.list = std::get_if<ListedGrains>(&source);
  plan.seed = seed;
  return plan;
}

/// Grains of different groups must not overlap. `ends`: of each group, the first one being the main source.
void refuse_overlapping_groups(const Grains& grains, const std::vector<std::size_t>& ends,
                               const Bodies& bodies) {
  const auto group_of = [&](std::size_t b) {
    return std::upper_bound(ends.begin(), ends.end(), b) - ends.begin();
  };
  const auto name = [&](std::ptrdiff_t group) {
    return group == 0 ? std::string("the grains of the scene's own source")
                      : "group \"" + grains.groups[group - 1].name + "\"";
  };
  std::vector<std::size_t> order(bodies.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double largest = *std::max_element(bodies.radius.begin(), bodies.radius.end());
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return bodies.x[a] < bodies.x[b]; });
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t l = k + 1; l < order.size(); ++l) {
      const std::size_t a = order[k], b = order[l];
      const double dx = bodies.x[b] - bodies.x[a], dz = bodies.z[b] - bodies.z[a];
      if (dx > bodies.radius[a] + largest) break;
      const double reach = bodies.radius[a] + bodies.radius[b];
      if (std::hypot(dx, dz) >= reach * (1 - 1e-9) || group_of(a) == group_of(b)) continue;
      const auto later = std::max(group_of(a), group_of(b)), earlier = std::min(group_of(a), group_of(b));
      throw InputError({InputProblem{"", 0, 0, "grains.groups." + std::to_string(later - 1) + ".name",
                                     name(later) + " overlaps " + name(earlier) + " at the start",
                                     "groups apart from one another"}});
    }
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
  if (scene.periodic_z && scene.periodic_z->z_max_mm - scene.periodic_z->z_min_mm <= 3 * largest)
    throw InputError({InputProblem{"", 0, 0, "periodic_z.z_max_mm",
                                   "the cell is too low for discs of " + std::to_string(largest) + " mm",
                                   "higher than 3 of the largest discs"}});
}

}  // namespace

double mean_diameter_m(const Grains& grains) {
  if (const auto* made = std::get_if<GeneratedGrains>(&grains.source))
    return (made->sizes ? mean_power_mm(*made, 1) : (made->diameter_min_mm + made->diameter_max_mm) / 2) *
           1e-3;
  const auto* source = std::get_if<ListedGrains>(&grains.source);
  if (!source)
    throw InputError(
        {InputProblem{"", 0, 0, "grains.from_run", "names grains that are in another folder",
                      "`drumlin run` and `scene check`; the run folder then holds them as a list"}});
  const auto list = listed(*source);
  double sum = 0;
  for (const auto& grain : list) sum += grain.diameter_mm;
  return sum / static_cast<double>(list.size()) * 1e-3;
}

Bodies place_grains(const Scene& scene, const Scales& scales) {
  Bodies bodies;
  std::vector<double> spins;
  append(scene, plan_of(scene.grains.source, scene.seed), scales, bodies, spins);
  std::vector<std::size_t> ends{bodies.count()};
  for (const GrainGroup& group : scene.grains.groups) {
    GroupPlan plan = plan_of(group.source, RandomStream(scene.seed, "groups/" + group.name).bits());
    plan.material = group.material;
    plan.density = group.density_kg_m3.value_or(scales.density_kg_m3) / scales.density_kg_m3;
    append(scene, plan, scales, bodies, spins);
    ends.push_back(bodies.count());
  }
  if (!scene.grains.groups.empty()) refuse_overlapping_groups(scene.grains, ends, bodies);
  if (scene.effects.spin) bodies.spin = spins;
  check_period(scene, bodies, 1e-3 / scales.length_m);
  return bodies;
}

std::vector<Point_mm> listed_places_mm(const Grains& grains) {
  std::vector<Point_mm> places;
  const auto add = [&places](const auto& source) {
    if (const auto* list = std::get_if<ListedGrains>(&source))
      for (const ListedGrain& grain : listed(*list)) places.push_back({grain.x_mm, grain.z_mm});
  };
  add(grains.source);
  for (const GrainGroup& group : grains.groups) add(group.source);
  return places;
}

int capacity(const GeneratedGrains& grains, const Scene& scene) {
  return static_cast<int>(lattice_sites(grains, Obstacles(grains, scene)).size());
}

}  // namespace drumlin::particles
