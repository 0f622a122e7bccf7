#include "coupling/calibration/fabric_relaxation.hpp"

#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "coupling/statistics/quantiles.hpp"

namespace drumlin::coupling {
namespace {

// Values of a field at the node nearest to (x, z).
double nearest(const FieldMap& map, const MapField& field, double x, double z) {
  const MapGrid& grid = map.grid;
  const auto column = static_cast<std::size_t>(std::lround((x - grid.x_first) / grid.spacing_x));
  const auto row = static_cast<std::size_t>(std::lround((z - grid.z_first) / grid.spacing_z));
  if (column >= grid.columns || row >= grid.rows) return std::numeric_limits<double>::quiet_NaN();
  return field.value[row * grid.columns + column];
}

// Left side and what c multiplies, in one block.
struct Pair {
  double x = 0;
  double change = 0;
  double wish = 0;
};

double slope_of(const std::vector<Pair>& pairs, double without_x) {
  double products = 0, squares = 0;
  for (const Pair& pair : pairs) {
    if (pair.x == without_x) continue;
    products += pair.change * pair.wish;
    squares += pair.wish * pair.wish;
  }
  return products / squares;
}

}  // namespace

FabricRelaxation fabric_relaxation(const FieldMap& map, const FormCurve& turn,
                                   const BlockSelection& selection, double I_min) {
  const double rotation = needed_number(map.header, &RunHeader::rotation, "maps.h5");
  const double axis = needed_number(map.header, &RunHeader::axis_depth, "maps.h5");
  const MapField& v_x = map.field("v_x");
  const MapField& v_z = map.field("v_z");
  const std::vector<LawBlock> points = law_points(map, selection);
  const auto key = [&](double x, double z) {
    return std::pair(std::lround(x / selection.width), std::lround(z / map.grid.spacing_z));
  };
  std::map<std::pair<long, long>, const LawBlock*> places;
  for (const LawBlock& point : points) places[key(point.x, point.z)] = &point;
  const auto turn_at = [&](double x, double z) {
    const auto found = places.find(key(x, z));
    return found == places.end() ? std::numeric_limits<double>::quiet_NaN() : found->second->turn;
  };

  std::vector<Pair> pairs;
  double squares = 0;
  for (const LawBlock& point : points) {
    if (point.friction.I < I_min) continue;
    const double dx = selection.width, dz = map.grid.spacing_z;
    const double along = (turn_at(point.x + dx, point.z) - turn_at(point.x - dx, point.z)) / (2 * dx);
    const double up = (turn_at(point.x, point.z + dz) - turn_at(point.x, point.z - dz)) / (2 * dz);
    // The drum turns such that its lowest point moves upslope.
    const double u_x = nearest(map, v_x, point.x, point.z) + rotation * (point.z - axis);
    const double u_z = nearest(map, v_z, point.x, point.z) - rotation * point.x;
    const Pair pair{point.x, u_x * along + u_z * up,
                    point.strain_rate * (turn.at(point.friction.I).value - point.turn)};
    if (!std::isfinite(pair.change) || !std::isfinite(pair.wish)) continue;
    pairs.push_back(pair);
    squares += pair.change * pair.change;
  }
  FabricRelaxation result{.c = std::numeric_limits<double>::quiet_NaN(),
                          .ci99 = std::numeric_limits<double>::quiet_NaN(),
                          .explained = std::numeric_limits<double>::quiet_NaN(),
                          .points = pairs.size()};
  std::map<double, double> columns;
  for (const Pair& pair : pairs) columns[pair.x] = 0;
  if (pairs.size() < 10 || columns.size() < 3) return result;
  result.c = slope_of(pairs, std::numeric_limits<double>::quiet_NaN());
  double sum = 0;
  for (const auto& column : columns) sum += std::pow(slope_of(pairs, column.first) - result.c, 2);
  const auto count = static_cast<double>(columns.size());
  result.ci99 = statistics::student_quantile_99(static_cast<int>(columns.size()) - 1) *
                std::sqrt(sum * (count - 1) / count);
  double left = 0;
  for (const Pair& pair : pairs) left += std::pow(pair.change - result.c * pair.wish, 2);
  result.explained = 1 - left / squares;
  return result;
}

}  // namespace drumlin::coupling
