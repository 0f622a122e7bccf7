#include "particles/measurement/frames/run_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/history/wall_history.hpp"
#include "particles/measurement/maps/field_values.hpp"

namespace drumlin::particles {
namespace {

constexpr double bulk_depth = 3;    // d
constexpr double outline_nu = 0.4;  // at the outline of a packing, half of that inside
constexpr double most_nodes = 5e7;  // of all frames: a file of some 4 GB
constexpr double endless = std::numeric_limits<double>::infinity();

std::optional<Rectangle> box_around(const Shape& shape) {
  if (const auto* round = std::get_if<Container>(&shape))
    return Rectangle{round->center.x - round->radius, round->center.x + round->radius,
                     round->center.z - round->radius, round->center.z + round->radius};
  const auto reaches = reaches_of(shape);
  if (!reaches) return std::nullopt;
  return Rectangle{reaches->x_low, reaches->x_high, reaches->z_low, reaches->z_high};
}

/// Where grains count: not below all walls, along gravity.
class Inside {
 public:
  Inside(const Snapshot& origin, std::span<const Shape> shapes) : x_(origin.gravity_x), z_(origin.gravity_z) {
    for (const Shape& shape : shapes)
      if (const auto box = box_around(shape))
        for (const double x : {box->x_min, box->x_max})
          for (const double z : {box->z_min, box->z_max}) deepest_ = std::max(deepest_, depth(x, z));
    if (deepest_ == -endless) deepest_ = endless;  // no walls
  }
  /// Calls action(i) for the grains inside.
  void each(const Snapshot& snapshot, const auto& action) const {
    for (std::size_t i = 0; i < snapshot.x.size(); ++i)
      if (depth(snapshot.x[i], snapshot.z[i]) <= deepest_) action(i);
  }

 private:
  double depth(double x, double z) const { return x_ * x + z_ * z; }
  double x_, z_, deepest_ = -endless;
};

Rectangle centre_alone(const Snapshot& snapshot, std::size_t i) {
  return {snapshot.x[i], snapshot.x[i], snapshot.z[i], snapshot.z[i]};
}

/// The fields of one snapshot in the laboratory.
void set_laboratory_fields(const CoarseGraining& graining, double nu_bulk, Snapshot snapshot, Frame& frame) {
  snapshot.wall_spin = 0;
  MapSums sums = empty_sums(graining);
  add_snapshot(graining, snapshot, in_flow_frame(snapshot), sums);
  const auto flow_at = [&](std::size_t node) -> NodeFlow {
    const MapValues v = values_at(sums.nodes[node], sums.snapshots, 1);
    return {v.nu,
            v.v_x,
            v.v_z,
            {v.d_v_x_dx, v.d_v_x_dz, v.d_v_z_dx, v.d_v_z_dz},
            {v.sigma_xx, -v.sigma_xz, -v.sigma_zx, v.sigma_zz}};
  };
  set_fields(graining.grid, nu_bulk, flow_at, frame);
}

/// The frames of one run, in order of time.
class FrameMaker {
 public:
  FrameMaker(const CoarseGraining& graining, double nu_bulk, const FrameRun& run, const Snapshot& origin)
      : graining_(graining), nu_bulk_(nu_bulk), run_(run), inside_(origin, run.shapes_at(origin)) {
    (void)area_inside(origin);
  }

  Frame frame(const Snapshot& snapshot) {
    Frame frame;
    set_laboratory_fields(graining_, nu_bulk_, snapshot, frame);
    set_mass_height(snapshot, frame);
    set_scalars(snapshot, frame);
    const auto states =
        wall_states(snapshot, run_.walls.size(), run_.wall_of_shape, run_.shapes_at(snapshot), 1);
    for (std::size_t w = 0; w < states.size(); ++w)
      frame.loads[run_.walls[w]] = {states[w].force_x, states[w].force_z};
    return frame;
  }

 private:
  /// Remembers the grains.
  double area_inside(const Snapshot& snapshot) {
    double area = 0;
    inside_.each(snapshot, [&](std::size_t i) {
      const auto id = snapshot.id.empty() ? static_cast<std::int64_t>(i) : snapshot.id[i];
      if (seen_.insert({id, mass_of_disc(snapshot.radius[i])}).second)
        area_seen_ += mass_of_disc(snapshot.radius[i]);
      area += mass_of_disc(snapshot.radius[i]);
    });
    return area;
  }

  void set_mass_height(const Snapshot& snapshot, Frame& frame) const {
    const MapGrid& grid = graining_.grid;
    const auto columns = static_cast<double>(grid.columns);
    frame.mass_height.assign(grid.columns, 0);
    inside_.each(snapshot, [&](std::size_t i) {
      const double r = snapshot.radius[i] / grid.spacing_x;
      const double x = (snapshot.x[i] - grid.x_first) / grid.spacing_x + 0.5;  // columns are [c, c + 1]
      for (double c = std::max(0.0, std::floor(x - r)); c < std::min(columns, x + r); ++c)
        frame.mass_height[static_cast<std::size_t>(c)] +=
            (disc_area_left_of(r, c + 1 - x) - disc_area_left_of(r, c - x)) * grid.spacing_x / nu_bulk_;
    });
  }

  void set_scalars(const Snapshot& snapshot, Frame& frame) {
    double mass = 0, x = 0, z = 0, energy = 0;
    inside_.each(snapshot, [&](std::size_t i) {
      const double m = mass_of(snapshot, i), v_x = snapshot.v_x[i], v_z = snapshot.v_z[i];
      mass += m, x += m * snapshot.x[i], z += m * snapshot.z[i];
      energy += m / 2 * (v_x * v_x + v_z * v_z);
    });
    const double area = area_inside(snapshot);
    frame.scalars = {{"area", area / nu_bulk_},
                     {"centre_x", x / mass},
                     {"centre_z", z / mass},
                     {"kinetic_energy", energy},
                     {"discharged", (area_seen_ - area) / nu_bulk_}};
  }

  const CoarseGraining& graining_;
  double nu_bulk_;
  const FrameRun& run_;
  Inside inside_;
  std::map<std::int64_t, double> seen_;
  double area_seen_ = 0;
};

/// From the time before to the time after, or as far as there are any.
void set_discharge_rates(std::span<const double> times, std::span<Frame> frames) {
  for (std::size_t t = 0; t < times.size(); ++t) {
    const std::size_t from = t > 0 ? t - 1 : 0, to = std::min(t + 1, times.size() - 1);
    frames[t].scalars["discharge_rate"] =
        to > from ? (frames[to].scalars.at("discharged") - frames[from].scalars.at("discharged")) /
                        (times[to] - times[from])
                  : no_value;
  }
}

/// A run with the snapshots that are asked for.
struct ChosenRun {
  const FrameRun* run;
  std::size_t origin = 0;
  std::vector<std::size_t> snapshots;
};

/// `distance`: widened to that of each snapshot.
ChosenRun chosen(const FrameRun& run, const FrameOptions& options, double& distance) {
  const auto number = [&](double time) {
    const auto found = next_snapshot(run.times, time);
    if (!found)
      throw InputError(fmt::format(
          "{}: has no snapshot at the time {:.6g} sqrt(d/g), {:.6g} after the origin (it has {} from {:.6g} "
          "to {:.6g})",
          run.name, time, time - options.origin, run.times.size(),
          run.times.empty() ? no_value : run.times.front(), run.times.empty() ? no_value : run.times.back()));
    distance = std::max(distance, std::abs(run.times[*found] - time));
    return *found;
  };
  ChosenRun result{&run, number(options.origin), {}};
  for (const double time : options.times) result.snapshots.push_back(number(options.origin + time));
  return result;
}

/// Of so many frames.
MapGrid frame_grid(const Rectangle& reach, std::size_t frames, const FrameOptions& options) {
  const double rim = 2 * options.width;
  const auto [x_from, x_to] = options.x.value_or(std::array{reach.x_min - rim, reach.x_max + rim});
  const auto [z_from, z_to] = options.z.value_or(std::array{reach.z_min - rim, reach.z_max + rim});
  if (!(x_from <= x_to && z_from <= z_to)) throw InputError("there are no grains at these times");
  const double nodes = (x_to - x_from) / options.spacing * (z_to - z_from) / options.spacing;
  if (nodes * static_cast<double>(frames) > most_nodes)
    throw InputError(
        fmt::format("{} frames of {:.3g} nodes each, from x = {:.6g} to {:.6g} and z = {:.6g} to "
                    "{:.6g} d (allowed: {:g} nodes in all; --x, --z, --map-spacing)",
                    frames, nodes, x_from, x_to, z_from, z_to, most_nodes));
  return grid_over(x_from, x_to, z_from, z_to, options.spacing, options.width);
}

}  // namespace

std::optional<std::size_t> next_snapshot(std::span<const double> times, double time) {
  constexpr double rounding = 1e-6;  // of times that users give in seconds
  const std::size_t count = times.size();
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(times, time) - times.begin());
  if (after > 0 && after < count) return after - (time - times[after - 1] < times[after] - time ? 1 : 0);
  if (count == 0) return std::nullopt;
  const std::size_t end = after == 0 ? 0 : count - 1, beside = count == 1 ? 0 : after == 0 ? 1 : count - 2;
  const double interval = std::abs(times[end] - times[beside]), distance = std::abs(times[end] - time);
  return distance <= interval / 2 + rounding * std::max(1.0, std::abs(time)) ? std::optional(end)
                                                                             : std::nullopt;
}

double bulk_nu(const Snapshot& snapshot, double spacing, double width) {
  if (snapshot.x.empty()) return no_value;
  Rectangle reach = no_rectangle;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) reach.widen(centre_alone(snapshot, i));
  FrameOptions options;
  options.spacing = spacing, options.width = width;
  const MapGrid grid = frame_grid(reach, 1, options);
  const KernelNodes nodes(grid, width);
  std::vector<double> nu(grid.nodes(), 0.0);
  for (std::size_t i = 0; i < snapshot.x.size(); ++i)
    nodes.each_node(snapshot.x[i], snapshot.z[i], [&](MapPlace at, const KernelWeight& weight) {
      nu[at.row * grid.columns + at.column] += weight.phi * mass_of_disc(snapshot.radius[i]);
    });
  const auto steps = static_cast<std::ptrdiff_t>(std::floor(bulk_depth / spacing));
  const auto columns = static_cast<std::ptrdiff_t>(grid.columns),
             rows = static_cast<std::ptrdiff_t>(grid.rows);
  const auto is_deep = [&](std::ptrdiff_t column, std::ptrdiff_t row) {
    for (std::ptrdiff_t r = row - steps; r <= row + steps; ++r)
      for (std::ptrdiff_t c = column - steps; c <= column + steps; ++c) {
        if (std::hypot(static_cast<double>(r - row), static_cast<double>(c - column)) * spacing > bulk_depth)
          continue;
        if (r < 0 || r >= rows || c < 0 || c >= columns) return false;
        if (nu[static_cast<std::size_t>(r * columns + c)] < outline_nu) return false;
      }
    return true;
  };
  double sum = 0, count = 0;
  for (std::ptrdiff_t row = 0; row < rows; ++row)
    for (std::ptrdiff_t column = 0; column < columns; ++column)
      if (is_deep(column, row)) sum += nu[static_cast<std::size_t>(row * columns + column)], ++count;
  return sum / count;
}

Frames frames_of(std::span<const FrameRun> runs, const FrameOptions& options,
                 const std::function<void(std::size_t, std::size_t)>& progress) {
  Frames result;
  double distance = 0;
  std::vector<ChosenRun> all;
  for (const FrameRun& run : runs) all.push_back(chosen(run, options, distance));
  const std::size_t reads = 2 * runs.size() * (options.times.size() + 1);
  std::size_t done = 0;
  const auto read = [&](const ChosenRun& chosen, std::size_t number) {
    if (progress) progress(++done, reads);
    return chosen.run->read(number);
  };

  Rectangle reach = no_rectangle;
  double nu = 0;
  for (const ChosenRun& one : all) {
    const Snapshot origin = read(one, one.origin);
    const Inside inside(origin, one.run->shapes_at(origin));
    if (!options.nu_bulk)
      nu += bulk_nu(origin, options.spacing, options.width) / static_cast<double>(runs.size());
    result.scales = origin.scales;
    for (const std::size_t number : one.snapshots) {
      const Snapshot snapshot = read(one, number);
      inside.each(snapshot, [&](std::size_t i) { reach.widen(centre_alone(snapshot, i)); });
    }
  }
  result.nu_bulk = options.nu_bulk.value_or(nu);
  if (!(result.nu_bulk > 0))
    throw InputError(
        "no fill at the origin is deeper than 3 d on all sides, so that nothing tells nu_bulk (--nu-bulk)");
  const CoarseGraining graining{
      {}, frame_grid(reach, runs.size() * options.times.size(), options), options.width, 0};
  result.grid = graining.grid;

  for (const ChosenRun& one : all) {
    FrameMaker maker(graining, result.nu_bulk, *one.run, read(one, one.origin));
    for (const std::size_t number : one.snapshots) result.frames.push_back(maker.frame(read(one, number)));
    set_discharge_rates(options.times, std::span(result.frames).last(options.times.size()));
    result.runs.push_back(one.run->name);
  }
  result.times = options.times;
  result.time_origin_s = options.origin * result.scales.time_s;
  result.header.side = RunSide::particles;
  result.header.diameter_m = result.scales.length_m;
  result.header.kernel = spline_kernel_name;
  result.header.kernel_width = options.width;
  result.header.further["snapshot_distance"] = fmt::format("{}", distance);
  result.header.further["velocities"] = "over the velocity window before each snapshot";
  return result;
}

}  // namespace drumlin::particles
