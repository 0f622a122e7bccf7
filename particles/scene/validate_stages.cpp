#include "particles/scene/validate_stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "particles/scene/scene_walls.hpp"

namespace drumlin::particles {
namespace {

using Faults = std::vector<SceneFault>;

std::set<std::string> wall_names(const Scene& scene) {
  std::set<std::string> names;
  for (const Wall& wall : scene.walls) names.insert(wall.name);
  return names;
}

std::string listed(const std::set<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none, the scene has no walls" : text;
}

/// Whether a wall of that name is there in the stage; else a fault.
void require_wall(const Scene& scene, const std::string& name, const std::set<std::string>& open,
                  const std::string& key, Faults& faults) {
  if (!wall_names(scene).contains(name))
    faults.push_back(
        {key, fmt::format("names no wall: \"{}\"", name), listed(wall_names(scene)), {key, "walls"}});
  else if (open.contains(name))
    faults.push_back(
        {key, fmt::format("names \"{}\", which has been opened", name), "walls that are still there", {key}});
}

/// Walls that stages name are there: opened ones are named once, and nothing is asked of them afterwards.
void check_opened(const Scene& scene, Faults& faults) {
  std::set<std::string> open;
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    const Stage& stage = scene.stages[s];
    const std::string key = fmt::format("stages.{}", s);
    for (const std::string& name : stage.opens.value_or(std::vector<std::string>{})) {
      require_wall(scene, name, open, key + ".opens", faults);
      open.insert(name);
    }
    for (std::size_t m = 0; m < stage.motions.size(); ++m)
      require_wall(scene, stage.motions[m].wall, open, fmt::format("{}.motions.{}.wall", key, m), faults);
    if (stage.until && stage.until->moved)
      require_wall(scene, stage.until->moved->wall, open, key + ".until.moved.wall", faults);
    if (stage.until && !stage.until->moved && !stage.until->at_rest && !stage.until->out)
      faults.push_back(
          {key + ".until", "names nothing to wait for", "at_rest, moved or out", {key + ".until"}});
  }
}

/// What a stage changes must be there: effects decide which unknowns exist.
void check_coefficients(const Scene& scene, std::size_t s, Faults& faults) {
  const Stage& stage = scene.stages[s];
  const Effects& effects = scene.effects;
  const auto check = [&](const std::string& name, bool is_set, bool there) {
    const std::string key = fmt::format("stages.{}.{}", s, name);
    if (is_set && !there)
      faults.push_back({key,
                        "changes an effect that the scene does not name",
                        "together with effects." + name + ", or not at all",
                        {key, "effects"}});
  };
  check("gravity", stage.gravity.has_value(), effects.gravity.has_value());
  each_effect(
      [&]<class E>(const auto& values, const std::optional<E>& effect) {
        if constexpr (HasPairs<E>) check(E::name, values.has_value(), effect.has_value());
      },
      stage.effects, effects);
  if (stage.gravity && scene.output.energy_ledger) {
    const std::string key = fmt::format("stages.{}.gravity", s);
    faults.push_back({key,
                      "changes gravity, whose potential energy the ledger counts from one value",
                      "without output.energy_ledger",
                      {key, "output.energy_ledger"}});
  }
}

void check_pressure(const Scene& scene, const WallMotion& wall_motion, const PressureControl& pressure,
                    const std::string& key, Faults& faults) {
  if (pressure.between) {
    const auto names = wall_names(scene);
    const bool two = pressure.between->size() == 2 && (*pressure.between)[0] != (*pressure.between)[1];
    if (!two || !names.contains((*pressure.between)[0]) || !names.contains((*pressure.between)[1]))
      faults.push_back({key + ".between", "does not name two walls of the scene", listed(names), {key}});
    return;
  }
  for (const Wall& wall : scene.walls)
    if (wall.name == wall_motion.wall && (std::holds_alternative<SegmentShape>(wall.shape) ||
                                          std::holds_alternative<PolylineShape>(wall.shape)))
      return;
  faults.push_back({key + ".wall",
                    "has no length that a pressure could act on",
                    "a wall with a segment or a polyline, or with between",
                    {key, "walls"}});
}

void check_directions(const Scene& scene, std::size_t s, Faults& faults) {
  for (std::size_t m = 0; m < scene.stages[s].motions.size(); ++m) {
    const WallMotion& wall_motion = scene.stages[s].motions[m];
    const std::string key = fmt::format("stages.{}.motions.{}", s, m);
    if (const auto* pressure = std::get_if<PressureControl>(&wall_motion.motion))
      check_pressure(scene, wall_motion, *pressure, key, faults);
    if (const auto* strain = std::get_if<StrainRate>(&wall_motion.motion))
      if (!(std::hypot(strain->direction[0], strain->direction[1]) > 0))
        faults.push_back({key + ".direction", "has no length", "any other vector", {key}});
  }
}

void check_polyline(const PolylineShape& line, bool rough, const std::string& key, Faults& faults) {
  const std::vector<std::string> about = {key};
  if (line.x_mm.size() != line.z_mm.size() || line.x_mm.size() < 2)
    faults.push_back({key + ".z_mm",
                      fmt::format("has {} points, x_mm {}", line.z_mm.size(), line.x_mm.size()),
                      "as many, at least 2", about});
  const auto segments = segments_of(line);
  if (std::any_of(segments.begin(), segments.end(),
                  [](const SegmentShape& s) { return s.from_mm == s.to_mm; }))
    faults.push_back(
        {key + ".x_mm", "holds a point twice in a row", "points that differ from the one before", about});
  if (rough)
    faults.push_back({key + ".rough", "is glued to a polyline", "on containers, segments and discs", about});
}

void check_arc(const ArcShape& arc, bool rough, const std::string& key, Faults& faults) {
  const std::vector<std::string> about = {key};
  if (!(arc.from_deg < arc.to_deg && arc.to_deg - arc.from_deg < 360))
    faults.push_back({key + ".to_deg", fmt::format("is {}, from_deg {}", arc.to_deg, arc.from_deg),
                      "above from_deg, by less than 360", about});
  if (rough)
    faults.push_back({key + ".rough", "is glued to an arc", "on containers, segments and discs", about});
}

}  // namespace

double strongest_gravity(const Scene& scene, std::size_t stage) {
  if (!scene.effects.gravity) return 0;
  double strongest = scene.effects.gravity->acceleration_m_s2, before = strongest;
  for (std::size_t s = 0; s <= stage; ++s) {
    const auto& change = scene.stages[s].gravity;
    const double now = change ? change->acceleration_m_s2.value_or(before) : before;
    strongest = change && change->ramp ? std::max(before, now) : now;
    before = now;
  }
  return strongest;
}

void check_stage_changes(const Scene& scene, Faults& faults) {
  check_opened(scene, faults);
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    check_coefficients(scene, s, faults);
    check_directions(scene, s, faults);
  }
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (const auto* line = std::get_if<PolylineShape>(&scene.walls[w].shape))
      check_polyline(*line, scene.walls[w].rough.has_value(), fmt::format("walls.{}", w), faults);
  for (std::size_t w = 0; w < scene.walls.size(); ++w)
    if (const auto* arc = std::get_if<ArcShape>(&scene.walls[w].shape))
      check_arc(*arc, scene.walls[w].rough.has_value(), fmt::format("walls.{}", w), faults);
  if (scene.output.walls_every_s && scene.effects.rotating_frame)
    faults.push_back({"output.walls_every_s",
                      "requires loads in a rotating frame",
                      "a scene without effects.rotating_frame",
                      {"output.walls_every_s", "effects.rotating_frame"}});
}

}  // namespace drumlin::particles
