#pragma once
// Wall shapes as the figures draw them: JSON for apps/figures/grain_maps.py.
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "particles/bodies/arc.hpp"
#include "particles/io/run_folder.hpp"

namespace drumlin::apps {

/// A list of objects with shape, angle (rad turned since the start, clockwise) and, in d, x, z and radius:
/// those of a segment and of an arc are lists. Shapes that were opened are left out.
inline nlohmann::ordered_json drawn_walls(const std::vector<particles::PlacedShape>& shapes) {
  using Json = nlohmann::ordered_json;
  struct ShapeJson {
    Json operator()(const particles::Container& c) const {
      return {{"shape", "container"}, {"x", c.center.x}, {"z", c.center.z}, {"radius", c.radius}};
    }
    Json operator()(const particles::Segment& s) const {
      return {{"shape", "segment"}, {"x", {s.from.x, s.to.x}}, {"z", {s.from.z, s.to.z}}};
    }
    Json operator()(const particles::Arc& a) const {
      constexpr int pieces = 48;  // of half a circle at most: chords leave it by 1/2000 of its radius
      Json x = Json::array(), z = Json::array();
      for (const particles::Point& p : points_of(a, pieces)) x.push_back(p.x), z.push_back(p.z);
      return {{"shape", "arc"}, {"x", x}, {"z", z}};
    }
    Json operator()(const particles::FixedDisc& d) const {
      return {{"shape", "disc"}, {"x", d.center.x}, {"z", d.center.z}, {"radius", d.radius}};
    }
    Json operator()(const particles::Opened&) const { return nullptr; }
  };
  Json drawn = Json::array();
  for (const particles::PlacedShape& placed : shapes) {
    if (is_open(placed.shape)) continue;
    drawn.push_back(std::visit(ShapeJson{}, placed.shape));
    drawn.back()["angle"] = placed.angle;
  }
  return drawn;
}

/// From and to of the period along x, d; null without one.
inline nlohmann::ordered_json drawn_period(const particles::Scene& scene, const Scales& scales) {
  if (!scene.periodic_x) return nullptr;
  return {scene.periodic_x->x_min_mm * 1e-3 / scales.length_m,
          scene.periodic_x->x_max_mm * 1e-3 / scales.length_m};
}

}  // namespace drumlin::apps
