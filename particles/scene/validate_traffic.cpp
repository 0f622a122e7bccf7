#include "particles/scene/validate_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "particles/scene/materials.hpp"
#include "particles/scene/region.hpp"
#include "particles/scene/validate_grains.hpp"
#include "particles/scene/validate_names.hpp"

namespace drumlin::particles {
namespace {

using Faults = std::vector<SceneFault>;

/// Whether a disc of that diameter fits into the region; 0: whether the region is one.
bool check_region(const Region& region, double diameter_mm, const std::string& key, Faults& faults) {
  for (int axis : {0, 1}) {
    const auto [low, high] = extent_mm(region, axis);
    if (high > low && high - low >= diameter_mm) continue;
    faults.push_back({key,
                      fmt::format("is {} mm long along {}", high - low, axis ? "z" : "x"),
                      diameter_mm > 0 ? fmt::format("at least {} mm, the largest diameter", diameter_mm)
                                      : "max_mm > min_mm",
                      {key}});
    return false;
  }
  return true;
}

double between(double value, double low, double high) { return std::max({low - value, value - high, 0.0}); }

/// Whether two regions have points in common, other than of their borders.
bool overlap(const Region& a, const Region& b) {
  const auto* first = std::get_if<CircleRegion>(&a);
  const auto* second = std::get_if<CircleRegion>(&b);
  if (first && second)
    return std::hypot(first->center_mm[0] - second->center_mm[0],
                      first->center_mm[1] - second->center_mm[1]) < first->radius_mm + second->radius_mm;
  if (second) return overlap(b, a);
  const auto [left, right] = extent_mm(b, 0);
  const auto [bottom, top] = extent_mm(b, 1);
  if (first)
    return std::hypot(between(first->center_mm[0], left, right), between(first->center_mm[1], bottom, top)) <
           first->radius_mm;
  return extent_mm(a, 0).first < right && left < extent_mm(a, 0).second && extent_mm(a, 1).first < top &&
         bottom < extent_mm(a, 1).second;
}

/// Grains must not be put where an outlet takes them away.
void check_clear(const Scene& scene, const Region& region, const std::string& key, Faults& faults) {
  for (std::size_t o = 0; o < scene.outlets.size(); ++o)
    if (overlap(region, scene.outlets[o].region))
      faults.push_back({key,
                        fmt::format("overlaps the region of outlet \"{}\"", scene.outlets[o].name),
                        "a region apart from it",
                        {key, fmt::format("outlets.{}.region", o)}});
}

/// A grain must not meet the same neighbour on both sides.
void check_periods(const Scene& scene, const Source& source, const std::string& key, Faults& faults) {
  const auto check = [&](const std::string& period, double length_mm) {
    if (length_mm > 3 * source.diameter_max_mm) return;
    faults.push_back({key,
                      fmt::format("is {}", source.diameter_max_mm),
                      fmt::format("number in mm, less than a third of the {} mm of {}", length_mm, period),
                      {key, period}});
  };
  if (scene.periodic_x) check("periodic_x", scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm);
  if (scene.periodic_z) check("periodic_z", scene.periodic_z->z_max_mm - scene.periodic_z->z_min_mm);
}

void check_source(const Scene& scene, std::size_t s, Faults& faults) {
  const Source& source = scene.sources[s];
  const std::string key = fmt::format("sources.{}", s);
  if (source.diameter_min_mm > source.diameter_max_mm) {
    faults.push_back({key + ".diameter_max_mm",
                      fmt::format("is {}", source.diameter_max_mm),
                      fmt::format("number in mm, >= diameter_min_mm = {}", source.diameter_min_mm),
                      {key + ".diameter_min_mm", key + ".diameter_max_mm"}});
    return;
  }
  check_sizes(source.sizes, source.diameter_min_mm, source.diameter_max_mm, key + ".sizes.", faults);
  if (check_region(source.region, source.diameter_max_mm, key + ".region", faults))
    check_clear(scene, source.region, key + ".region", faults);
  check_periods(scene, source, key + ".diameter_max_mm", faults);
  const auto& materials = scene.grains.materials;
  const auto known = [&](const GrainMaterial& m) { return source.material && m.name == *source.material; };
  if (source.material ? std::none_of(materials.begin(), materials.end(), known)
                      : !materials.empty() && materials_matter(scene))
    faults.push_back(
        {key + ".material",
         source.material ? fmt::format("names no material: \"{}\"", *source.material) : "is missing",
         "one of grains.materials",
         {key, "grains.materials"}});
}

void check_until(const Scene& scene, Faults& faults) {
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const auto& until = scene.stages[s].until;
    if (!until || !until->out) continue;
    const auto named = [&](const Outlet& outlet) { return outlet.name == until->out->outlet; };
    const std::string key = fmt::format("stages.{}.until.out.outlet", s);
    if (std::none_of(scene.outlets.begin(), scene.outlets.end(), named))
      faults.push_back({key,
                        fmt::format("names no outlet: \"{}\"", until->out->outlet),
                        "the name of one of outlets",
                        {key, "outlets"}});
  }
}

}  // namespace

void check_traffic(const Scene& scene, Faults& faults) {
  check_until(scene, faults);
  if (!changes_grains(scene)) return;
  const std::string first = scene.outlets.empty() ? "sources.0" : "outlets.0";
  const auto refuse = [&](const std::string& key, const std::string& what) {
    faults.push_back({first, "changes the number of grains " + what, "without " + key, {first, key}});
  };
  if (scene.output.energy_ledger)
    refuse("output.energy_ledger", "whose energy the ledger counts from the start");
  if (scene.effects.rotating_frame) refuse("effects.rotating_frame", "in a rotating frame");
  std::set<std::string> names;
  for (std::size_t o = 0; o < scene.outlets.size(); ++o) {
    const Outlet& outlet = scene.outlets[o];
    const std::string key = fmt::format("outlets.{}", o);
    check_name(outlet.name, key + ".name", names, faults);
    check_region(outlet.region, 0, key + ".region", faults);
    if (outlet.returns_to && check_region(*outlet.returns_to, 0, key + ".returns_to", faults))
      check_clear(scene, *outlet.returns_to, key + ".returns_to", faults);
  }
  for (std::size_t s = 0; s < scene.sources.size(); ++s) {
    check_name(scene.sources[s].name, fmt::format("sources.{}.name", s), names, faults);
    check_source(scene, s, faults);
  }
}

}  // namespace drumlin::particles
