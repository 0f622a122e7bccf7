#include "continuum/model/mesh_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "continuum/model/region_mesh.hpp"

namespace drumlin::continuum {
namespace {

// Along a wall a contact moves as the flux asks where the surface meets it at more than this sine.
constexpr double least_contact_sine = 0.3;
// Sine of the angle below which two parts go on in one line.
constexpr double smallest_corner_sine = 0.05;
constexpr double at_a_wall = 1e-6;   // d
constexpr double hardly_past = 0.1;  // a wall that moves, sizes: as far as corrections of the area go
constexpr double relaxation = 1.6;   // of Gauss-Seidel's method
constexpr int most_sweeps = 200;
constexpr double smooth_enough = 1e-4;  // last change over the largest velocity

// How a corner of the mesh may move: by this velocity, or along this direction beside it, or as its
// neighbours do.
struct Freedom {
  bool inside = true;
  std::optional<Vec2> slides = {};
  Vec2 velocity = {};
};

// The velocity that has both these normal parts.
Vec2 meeting(Vec2 first_tangent, Vec2 first, Vec2 second_tangent, Vec2 second) {
  const double sine = cross(first_tangent, second_tangent);
  if (std::abs(sine) < smallest_corner_sine) return 0.5 * (first + second);
  // first + s t1 = second + r t2
  const double s = cross(second - first, second_tangent) / sine;
  return first + s * first_tangent;
}

class Boundary {
 public:
  Boundary(const Region& region, double time, const RegionMesh& mesh, std::span<const Vec2> corners,
           const CornerMotion& material)
      : region_(region), time_(time), mesh_(mesh), corners_(corners), material_(material) {}

  void mark(std::vector<Freedom>& freedom) const {
    const std::size_t n = mesh_.boundary.size();
    const std::vector<std::size_t> side_before = sides_before(mesh_);
    std::vector<double> flux = material_.free_flux;
    // Contacts first, and of them those that do not move as the flux asks: what they do not take goes to
    // their neighbours.
    for (const bool takes : {false, true})
      for (std::size_t i = 0; i < n; ++i) {
        const auto &before = mesh_.boundary[side_before[i]], &after = mesh_.boundary[i];
        const bool comes_free = before.part < 0, goes_free = after.part < 0;
        if (comes_free == goes_free) continue;
        const unsigned int v = after.from, next = comes_free ? before.from : after.to;
        const int wall = comes_free ? after.part : before.part;
        if (takes_flux(v, wall) != takes) continue;
        freedom[v] = contact(v, wall, flux[v]);
        flux[next] += flux[v] - dot(material_.free_normal[v], freedom[v].velocity);
      }
    for (std::size_t i = 0; i < n; ++i) {
      const auto &before = mesh_.boundary[side_before[i]], &after = mesh_.boundary[i];
      const unsigned int v = after.from;
      if (before.part < 0 && after.part < 0)
        freedom[v] = free(v, flux[v]);
      else if (before.part >= 0 && after.part >= 0)
        freedom[v] = on_parts(v, before.part, after.part);
    }
  }

 private:
  const RegionPart& part(int number) const { return region_.parts[static_cast<std::size_t>(number)]; }
  Vec2 tangent(const RegionPart& wall, Vec2 point) const {
    const PartLine line = line_of(wall, time_);
    return line.tangent(line.nearest(point));
  }
  Freedom free(unsigned int v, double flux) const {
    const Vec2 normal = material_.free_normal[v], u = material_.velocity[v];
    return {false, {}, u + ((flux - dot(u, normal)) / dot(normal, normal)) * normal};
  }
  bool takes_flux(unsigned int v, int number) const {
    const Vec2 normal = material_.free_normal[v];
    return part(number).kind != RegionPart::Kind::opening &&
           std::abs(dot(normal, tangent(part(number), corners_[v]))) > least_contact_sine * length(normal);
  }
  Freedom contact(unsigned int v, int number, double flux) const {
    const RegionPart& wall = part(number);
    const Vec2 t = tangent(wall, corners_[v]), moves = wall_motion(wall, time_);
    if (wall.kind == RegionPart::Kind::opening) return {false, {}, {}};
    const Vec2 normal = material_.free_normal[v];
    if (takes_flux(v, number)) return {false, {}, moves + ((flux - dot(moves, normal)) / dot(normal, t)) * t};
    if (wall.kind == RegionPart::Kind::rough) return {false, {}, moves};
    return {false, {}, moves + dot(material_.velocity[v] - moves, t) * t};
  }
  Freedom on_parts(unsigned int v, int before, int after) const {
    const Vec2 first = wall_motion(part(before), time_), second = wall_motion(part(after), time_);
    const Vec2 t = tangent(part(before), corners_[v]);
    if (before == after) return {false, t, first};
    const bool opens =
        (part(before).kind == RegionPart::Kind::opening) != (part(after).kind == RegionPart::Kind::opening);
    if (opens) return {false, {}, part(before).kind == RegionPart::Kind::opening ? second : first};
    return {false, {}, meeting(t, first, tangent(part(after), corners_[v]), second)};
  }

  const Region& region_;
  double time_;
  const RegionMesh& mesh_;
  std::span<const Vec2> corners_;
  const CornerMotion& material_;
};

// Each corner's neighbours; of one on a wall those beside it along the wall.
std::vector<std::vector<unsigned int>> neighbours(const RegionMesh& mesh) {
  std::vector<std::vector<unsigned int>> all(mesh.vertices.size());
  std::vector<bool> outside(mesh.vertices.size(), false);
  for (const auto& edge : mesh.boundary) {
    outside[edge.from] = true;
    all[edge.from].push_back(edge.to);
    all[edge.to].push_back(edge.from);
  }
  for (const auto& triangle : mesh.triangles)
    for (unsigned int k = 0; k < 3; ++k)
      if (const unsigned int v = triangle[k]; !outside[v]) all[v].push_back(triangle[(k + 1) % 3]);
  return all;
}

}  // namespace

Vec2 wall_motion(const RegionPart& part, double time) { return time >= part.begins ? part.velocity : Vec2{}; }

Vec2 wall_velocity(const RegionPart& part, double time, Vec2 point) {
  const Vec2 moves = wall_motion(part, time);
  const auto* circle = std::get_if<CircleCurve>(&part.curve);
  if (!circle || time < part.begins) return moves;
  return moves + part.rotation * Vec2{point.z - circle->center.z, circle->center.x - point.x};
}

Vec2 wall_velocity(const Region& region, std::size_t number, double time, Vec2 point) {
  const RegionPart& part = region.parts[number];
  const Vec2 own = wall_velocity(part, time, point);
  const PartLine line = line_of(part, time);
  for (std::size_t k = 0; k < region.parts.size(); ++k) {
    const RegionPart& other = region.parts[k];
    if (k == number || !is_there(other, time) || is_open(other, time)) continue;
    const PartLine beside = line_of(other, time);
    const double s = beside.nearest(point);
    if (beside.distance(point) > at_a_wall || s < -at_a_wall || s > beside.length + at_a_wall) continue;
    return meeting(line.tangent(line.nearest(point)), own, beside.tangent(s),
                   wall_velocity(other, time, point));
  }
  return own;
}

std::vector<Vec2> corner_velocities(const Region& region, double time, const RegionMesh& mesh,
                                    std::span<const Vec2> corners, const CornerMotion& material) {
  std::vector<Freedom> freedom(mesh.vertices.size());
  Boundary(region, time, mesh, corners, material).mark(freedom);
  std::vector<Vec2> w(freedom.size());
  double largest = 0;
  for (std::size_t v = 0; v < w.size(); ++v) {
    w[v] = freedom[v].velocity;
    largest = std::max(largest, length(w[v]));
  }
  const auto around = neighbours(mesh);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0;
    for (std::size_t v = 0; v < w.size(); ++v) {
      const Freedom& may = freedom[v];
      if (!may.inside && !may.slides) continue;
      Vec2 mean{};
      for (const unsigned int of : around[v])
        mean = mean + (1.0 / static_cast<double>(around[v].size())) * w[of];
      if (may.slides) mean = may.velocity + dot(mean - may.velocity, *may.slides) * *may.slides;
      const Vec2 step = relaxation * (mean - w[v]);
      w[v] = w[v] + step;
      change = std::max(change, length(step));
    }
    if (change <= smooth_enough * largest) break;
  }
  return w;
}

std::vector<Vec2> held_by_walls(const Region& region, double time, double step, const RegionMesh& mesh,
                                const SizeField& size, std::vector<Vec2> x) {
  const auto& boundary = mesh.boundary;
  for (const auto& edge : boundary) {
    if (edge.part < 0) continue;
    const PartLine line = line_of(region.parts[static_cast<std::size_t>(edge.part)], time + step);
    if (!line.round()) continue;
    for (const unsigned int v : {edge.from, edge.to}) x[v] = line.at(line.nearest(x[v]));
  }
  const std::vector<std::size_t> side_before = sides_before(mesh);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto &before = boundary[side_before[i]], &after = boundary[i];
    if ((before.part < 0) == (after.part < 0)) continue;
    const RegionPart& wall = region.parts[static_cast<std::size_t>(std::max(before.part, after.part))];
    const unsigned int v = after.from, wet = before.part < 0 ? after.to : before.from;
    const PartLine old = line_of(wall, time), now = line_of(wall, time + step);
    if (old.round()) continue;
    const Vec2 was = mesh.vertices[v];
    const double dry = old.nearest(was) > old.nearest(mesh.vertices[wet]) ? 1 : -1;
    for (const RegionPart& part : region.parts) {
      const Vec2 moves = wall_motion(part, time);
      const PartLine from = line_of(part, time), to = line_of(part, time + step);
      if (&part == &wall || !is_there(part, time) || (moves.x == 0 && moves.z == 0)) continue;
      for (const double s : {0.0, to.length})
        if (now.distance(to.at(s)) < at_a_wall &&
            old.nearest(from.at(s)) * dry > old.nearest(was) * dry - hardly_past * size(was) &&
            now.nearest(x[v]) * dry > now.nearest(to.at(s)) * dry)
          x[v] = to.at(s);
    }
  }
  return x;
}

}  // namespace drumlin::continuum
