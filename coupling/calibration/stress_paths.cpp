#include "coupling/calibration/stress_paths.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::coupling {
namespace {

/// Least speed for the length of a step in time, in speeds of the drum 1 d from its axis: where the material
/// stands still in the laboratory no path leads anywhere.
constexpr double least_speed = 3;

double inertial(const PathPoint& point) { return 2 * std::abs(point.rate) / std::sqrt(point.p); }

bool is_known(const PathPoint& point) { return point.p > 0 && std::abs(point.rate) > 0; }

/// Steps from (x, z) backwards in time, the youngest first.
std::vector<PathStep> traced_back(const PathFields& fields, double x, double z, const PathOptions& options) {
  std::vector<PathStep> steps;
  double strain = 0;
  while (steps.size() < options.most_steps && strain < options.strain) {
    const PathPoint here = fields.at(x, z);
    const double speed = std::max(std::hypot(here.u, here.w), least_speed * std::abs(fields.rotation()));
    const double time = options.step / speed;
    double middle_x = x - time / 2 * here.u, middle_z = z - time / 2 * here.w;
    fields.bring_inside(middle_x, middle_z);
    const PathPoint middle = fields.at(middle_x, middle_z);
    if (!is_known(middle)) break;
    const double rate = std::abs(middle.rate);
    steps.push_back({rate * time, middle.spin * time, middle.rate / rate, std::log(inertial(middle)),
                     middle.dilation / (2 * rate), middle.p});
    strain += rate * time;
    x -= time * middle.u;
    z -= time * middle.w;
    fields.bring_inside(x, z);
  }
  return steps;
}

}  // namespace

std::vector<StressPath> stress_paths(const PathFields& fields, const PathOptions& options) {
  const MapGrid& grid = fields.grid();
  std::vector<StressPath> paths;
  for (std::size_t column = 0; column < grid.columns; column += options.stride)
    for (std::size_t row = 0; row < grid.rows; row += options.stride) {
      const double x = grid.x_of(column), z = grid.z_of(row), height = z - fields.axis();
      const double distance = std::hypot(x, height);
      if (!fields.speaks(row * grid.columns + column) || distance > fields.radius() - options.wall_margin ||
          z > std::min(0.0, fields.surface(x)) - options.surface_margin)
        continue;
      const PathPoint point = fields.at(x, z);
      if (!is_known(point) || inertial(point) < options.I_min) continue;
      StressPath path{x,
                      z,
                      std::atan2(x, -height),
                      distance,
                      point.rate / std::abs(point.rate),
                      std::log(inertial(point)),
                      std::abs(point.spin / point.rate),
                      point.stress / point.p,
                      point.p,
                      traced_back(fields, x, z, options)};
      if (path.steps.empty()) continue;
      std::reverse(path.steps.begin(), path.steps.end());
      paths.push_back(std::move(path));
    }
  return paths;
}

void add_own_weight(std::vector<StressPath>& paths, double w) {
  const auto weigh = [w](auto& at) { at.ln_I -= 0.5 * std::log1p(w / at.p); };
  for (StressPath& path : paths) {
    weigh(path);
    for (PathStep& step : path.steps) weigh(step);
  }
}

}  // namespace drumlin::coupling
