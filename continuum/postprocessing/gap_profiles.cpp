#include "continuum/postprocessing/gap_profiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "continuum/postprocessing/gauss_points.hpp"
#include "continuum/reference/gap_solution.hpp"
#include "coupling/core/results/layer_ratios.hpp"

namespace drumlin::continuum {
namespace {

constexpr double degrees_of_turn = 180 / std::numbers::pi;

// A field in the axes of the flow at its place.
struct LocalState {
  double v_x = 0, v_z = 0, shear_rate = 0, sigma_xx = 0, sigma_zz = 0, sigma_xz = 0;
};

LocalState local_state(const GapPlace& place, const PointState& s) {
  const auto product = [](Vec2 a, double xx, double xz, double zx, double zz, Vec2 b) {
    return a.x * (xx * b.x + xz * b.z) + a.z * (zx * b.x + zz * b.z);
  };
  const auto stress = [&](Vec2 a, Vec2 b) {  // tension positive
    return product(a, -s.sigma_xx, s.sigma_xz, s.sigma_xz, -s.sigma_zz, b);
  };
  const double D_xz = 0.5 * (s.dvx_dz + s.dvz_dx);
  return {.v_x = s.velocity.x * place.along.x + s.velocity.z * place.along.z,
          .v_z = s.velocity.x * place.upward.x + s.velocity.z * place.upward.z,
          .shear_rate = 2 * product(place.along, s.dvx_dx, D_xz, D_xz, s.dvz_dz, place.upward),
          .sigma_xx = -stress(place.along, place.along),
          .sigma_zz = -stress(place.upward, place.upward),
          .sigma_xz = stress(place.along, place.upward)};
}

// Places along the flow that are looked at: a strip is the same everywhere.
int sections(const Gap& gap) { return gap.inner_radius > 0 ? 8 : 1; }

// Off the corners of cells, that none is looked for on two of them.
double section_share(int section, int count) { return (section + 0.37) / count; }

// The mesh has quadratic arcs for the circles of an annulus: a point next to a wall may fall outside by 1e-5
// of the radius. It takes what the nearest point of its section has.
void fill_gaps(std::vector<PointState>& states, int along) {
  const auto count = static_cast<int>(states.size());
  const auto missing = [&](int k) { return !std::isfinite(states[k].pressure); };
  for (int k = along; k < count; ++k)
    if (missing(k)) states[k] = states[k - along];
  for (int k = count - along - 1; k >= 0; --k)
    if (missing(k)) states[k] = states[k + along];
}

// At each distance from the top, one after another, all sections.
std::vector<LocalState> local_states(const FlowField& field, const Gap& gap,
                                     const std::vector<double>& distances) {
  const int along = sections(gap);
  std::vector<GapPlace> places;
  std::vector<Vec2> points;
  for (const double y : distances)
    for (int i = 0; i < along; ++i) {
      places.push_back(gap_place(gap, y, section_share(i, along)));
      points.push_back(places.back().point);
    }
  auto states = field.at(points);
  fill_gaps(states, along);
  std::vector<LocalState> result;
  for (std::size_t k = 0; k < states.size(); ++k) result.push_back(local_state(places[k], states[k]));
  return result;
}

// Distances with the weights of their share of the gap: pieces that crowd where the shear is strongest.
struct Points {
  std::vector<double> y, weight;
};
Points across(const Gap& gap) {
  constexpr int pieces = 200;
  Points points;
  const auto end = [&](int i) {
    const double t = static_cast<double>(i) / pieces;
    return gap.depth * t * t * (3 - 2 * t);
  };
  for (int i = 0; i < pieces; ++i)
    for (const GaussPoint& g : gauss) {
      points.y.push_back(end(i) + (end(i + 1) - end(i)) * g.place);
      points.weight.push_back((end(i + 1) - end(i)) * g.weight);
    }
  return points;
}

// Integral over the gap of nu v_x at one section.
double flux(const Gap& gap, const Points& points, const std::vector<LocalState>& states, int section) {
  const auto along = static_cast<std::size_t>(sections(gap));
  double sum = 0;
  for (std::size_t k = 0; k < points.y.size(); ++k)
    sum += gap.nu * states[k * along + section].v_x * points.weight[k];
  return sum;
}

double mean_I(const Gap& gap, const Points& points, const std::vector<LocalState>& states) {
  const auto along = static_cast<std::size_t>(sections(gap));
  double sum = 0, weight = 0;
  for (std::size_t k = 0; k < states.size(); ++k)
    if (states[k].sigma_zz > 0) {
      sum += inertial_number(states[k].shear_rate, states[k].sigma_zz) * points.weight[k / along];
      weight += points.weight[k / along];
    }
  return sum / weight;
}

double rotation_of(const Gap& gap) { return *gap.speed / gap.inner_radius; }

// Along the wall: the period of a strip, the circumference of the inner wall.
double wall_length(const FlowIntegrals& sums, const Gap& gap) {
  return gap.inner_radius > 0 ? 2 * std::numbers::pi * gap.inner_radius : sums.area / gap.depth;
}

// Of the driven wall, from the power that it puts in; without one, of the wall at rest, from its force.
double wall_shear_stress(const FlowIntegrals& sums, const Gap& gap) {
  const double force = gap.speed ? sums.given_side_power / *gap.speed : -sums.given_side_force_x;
  return force / wall_length(sums, gap);
}

double wall_pressure(const Gap& gap) { return gap_pressure(gap, gap.speed ? 0 : gap.depth); }

struct Reading {
  double Q = 0, top_speed = 0, top_shear_rate = 0, I = 0, wall_shear_stress = 0;
};

// All that may be said; the gap names what means something in it.
ScalarSet scalars_of(const Gap& gap, const Reading& reading) {
  ScalarSet all{{{"theta_deg", gap.slope * degrees_of_turn, {}},
                 {"Q", reading.Q, {}},
                 {"surface_speed", reading.top_speed, {}},
                 {"mean_speed", reading.Q / gap.nu / gap.depth, {}},
                 {"shear_rate", reading.top_speed / gap.depth, {}},
                 {"I", reading.I, {}},
                 {"mu_wall", reading.wall_shear_stress / wall_pressure(gap), {}}}};
  if (gap.inner_radius > 0) {
    const double r = gap.inner_radius;
    all.scalars.push_back({"torque", 2 * std::numbers::pi * r * r * reading.wall_shear_stress, {}});
    // z points at the axis: dv/dz is the shear rate less v/r.
    all.scalars.push_back({"lambda", reading.top_speed / (reading.top_shear_rate - rotation_of(gap)), {}});
  }
  ScalarSet chosen;
  for (const std::string& name : gap.scalars) chosen.scalars.push_back(*all.find(name));
  return chosen;
}

}  // namespace

ProfileSet gap_profiles(const FlowField& field, const Gap& gap, double layer_thickness) {
  const int layers = static_cast<int>(std::ceil(gap.depth / layer_thickness - 1e-9));
  std::vector<double> distances;
  ProfileSet set;
  for (int layer = layers - 1; layer >= 0; --layer) {
    const double top = layer * layer_thickness, bottom = std::min(gap.depth, top + layer_thickness);
    set.z.push_back(-0.5 * (top + bottom));
    for (const GaussPoint& g : gauss) distances.push_back(top + (bottom - top) * g.place);
  }
  const auto states = local_states(field, gap, distances);
  const std::size_t per_layer = gauss.size() * static_cast<std::size_t>(sections(gap));
  const auto column = [&](const std::string& name, auto&& value) {
    ProfileColumn result{name, {}, {}};
    for (int row = 0; row < layers; ++row) result.value.push_back(value(row));
    set.columns.push_back(std::move(result));
  };
  const auto mean = [&](int row, double LocalState::*quantity) {
    double sum = 0;
    for (std::size_t k = 0; k < per_layer; ++k)
      sum += states[row * per_layer + k].*quantity * gauss[k / (per_layer / gauss.size())].weight;
    return sum / sections(gap);
  };
  column("v_x", [&](int row) { return mean(row, &LocalState::v_x); });
  column("v_z", [&](int row) { return mean(row, &LocalState::v_z); });
  column("shear_rate", [&](int row) { return mean(row, &LocalState::shear_rate); });
  column("nu", [&](int) { return gap.nu; });
  column("sigma_xx", [&](int row) { return mean(row, &LocalState::sigma_xx); });
  column("sigma_zz", [&](int row) { return mean(row, &LocalState::sigma_zz); });
  column("sigma_xz", [&](int row) { return mean(row, &LocalState::sigma_xz); });
  add_layer_ratios(set);
  return set;
}

ScalarSet gap_scalars(const FlowField& field, const Gap& gap) {
  const FlowIntegrals sums = field.integrals();
  const Points points = across(gap);
  const auto states = local_states(field, gap, points.y);
  Reading reading{.I = mean_I(gap, points, states), .wall_shear_stress = wall_shear_stress(sums, gap)};
  for (int i = 0; i < sections(gap); ++i) {
    reading.Q += flux(gap, points, states, i) / sections(gap);
    reading.top_speed += states[i].v_x / sections(gap);
    reading.top_shear_rate += states[i].shear_rate / sections(gap);
  }
  if (gap.speed) reading.top_speed = *gap.speed;
  return scalars_of(gap, reading);
}

ScalarSet gap_checks(const FlowField& field, const Gap& gap) {
  const FlowIntegrals sums = field.integrals();
  const double supplied = sums.given_side_power + sums.weight_power;
  ScalarSet checks{{{"dissipation", sums.dissipation, {}},
                    {"wall_power", sums.given_side_power, {}},
                    {"weight_power", sums.weight_power, {}},
                    {"power_relative_error", sums.dissipation / supplied - 1, {}}}};
  const auto add = [&](const char* name, double value) { checks.scalars.push_back({name, value, {}}); };
  const double of_wall = wall_shear_stress(sums, gap) * wall_length(sums, gap);
  if (gap.inner_radius > 0) {
    const double torque = of_wall * gap.inner_radius;
    add("inner_wall_torque", torque);
    // The inner wall turns against the sense of given_side_torque.
    add("outer_wall_torque", -sums.given_side_torque - torque);
    add("torque_relative_error", -sums.given_side_torque / torque);
    const Points points = across(gap);
    const auto states = local_states(field, gap, points.y);
    std::vector<double> fluxes;
    for (int i = 0; i < sections(gap); ++i) fluxes.push_back(flux(gap, points, states, i));
    const auto [least, most] = std::minmax_element(fluxes.begin(), fluxes.end());
    add("Q_relative_error", *most / *least - 1);
  } else {
    const double weight = gap.weight * std::sin(gap.slope) * sums.area;
    add("wall_force", sums.given_side_force_x);
    add("weight_force", weight);
    add("force_relative_error", (sums.given_side_force_x + weight) / of_wall);
  }
  return checks;
}

GapComparison gap_comparison(const FlowField& field, const Gap& gap, const StressLaw& law,
                             const Regularisation& regularisation) {
  // Vanishing: the root of p at a free surface and the slowest shear lie far above.
  constexpr Regularisation unregularised{1e-14, 1e-9};
  const Regularisation without_eps{unregularised.shear_rate, regularisation.pressure};
  const Points points = across(gap);
  const auto states = local_states(field, gap, points.y);
  const GapSolution same = gap_solution(gap, law, regularisation, points.y),
                    closed = gap_solution(gap, law, unregularised, points.y);
  GapComparison result;
  result.speed = same.top_speed;
  result.speed_without_eps = gap_solution(gap, law, without_eps, {}).top_speed;
  const auto along = static_cast<std::size_t>(sections(gap));
  const auto errors = [&](const GapSolution& exact, double& rms, double& largest) {
    double sum = 0, of = 0, top = 0;
    largest = 0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const double weight = points.weight[k / along], v = exact.speed[k / along];
      const double difference = states[k].v_x - v;
      sum += weight * difference * difference;
      of += weight * v * v;
      largest = std::max(largest, std::abs(difference));
      top = std::max(top, std::abs(v));
    }
    rms = std::sqrt(sum / of);
    largest /= top;
  };
  errors(same, result.mesh_error, result.mesh_error_max);
  errors(closed, result.closed_form_error, result.closed_form_error_max);

  Reading reading{.Q = closed.Q, .top_speed = closed.top_speed};
  double weight = 0;
  for (std::size_t k = 0; k < points.y.size(); ++k)
    if (const double p = gap_pressure(gap, points.y[k]); p > 0) {
      reading.I += inertial_number(closed.shear_rate[k], p) * points.weight[k];
      weight += points.weight[k];
    }
  reading.I /= weight;
  reading.top_shear_rate =
      shear_rate(law, unregularised, gap_pressure(gap, 0), gap_shear_stress(gap, closed.top_shear_stress, 0));
  reading.wall_shear_stress = gap_shear_stress(gap, closed.top_shear_stress, gap.speed ? 0 : gap.depth);
  result.closed_form = scalars_of(gap, reading);
  for (std::size_t k = 1; k < points.y.size(); k += 2 * gauss.size()) {
    result.z.push_back(-points.y[k]);
    double mean = 0;
    for (std::size_t i = 0; i < along; ++i) mean += states[k * along + i].v_x / static_cast<double>(along);
    result.v_x.push_back(mean);
    result.v_x_closed_form.push_back(closed.speed[k]);
  }
  return result;
}

MapArea gap_map_area(const Gap& gap, double strip_width) {
  RunHeader header;
  if (gap.inner_radius > 0) {
    const double inner = gap.inner_radius, outer = inner + gap.depth;
    header.inner_radius = inner;
    header.outer_radius = outer;
    return {.x_min = -outer,
            .x_max = outer,
            .z_min = -outer,
            .z_max = outer,
            .inside =
                [inner, outer](Vec2 p) {
                  const double r = std::hypot(p.x, p.z);
                  return inner <= r && r <= outer;
                },
            .nu = gap.nu,
            .frame = {},
            .header = header};
  }
  header.gap = gap.depth;
  return {.x_min = -0.5 * strip_width,
          .x_max = 0.5 * strip_width,
          .z_min = -gap.depth,
          .z_max = 0,
          .inside = [](Vec2) { return true; },
          .nu = gap.nu,
          .frame = {},
          .header = header};
}

}  // namespace drumlin::continuum
