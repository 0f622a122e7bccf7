#include "particles/measurement/history/region_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/common/errors.hpp"
#include "coupling/common/no_value.hpp"
#include "particles/bodies/cell_path.hpp"

namespace drumlin::particles {
namespace {

double disc_area(double radius) { return std::numbers::pi * radius * radius; }

/// The period with its first one about the middle of the box: of the images of a grain that one is nearest.
Period about(const Box& box, Period period) {
  period.origin = 0.5 * (box.x_min + box.x_max - period.length);
  period.origin_z = 0.5 * (box.z_min + box.z_max - period.length_z);
  return period;
}

Period about(const Box& box, const Snapshot& snapshot) {
  Period period = period_of(snapshot);
  period.length = snapshot.period_x;
  return about(box, period);
}

/// A box as wide as the period has no sides, one as high as the cell neither floor nor top.
Box without_sides(Box box, const Period& period) {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nearly = 1 - 1e-9;
  if (!period.open() && box.x_max - box.x_min > nearly * period.length)
    box.x_min = -infinity, box.x_max = infinity;
  if (!period.open_z() && box.z_max - box.z_min > nearly * period.length_z)
    box.z_min = -infinity, box.z_max = infinity;
  return box;
}

void add_dyad(double a_x, double a_z, double b_x, double b_z, double weight, PlaneMatrix& sum) {
  sum.xx += weight * a_x * b_x;
  sum.xz += weight * a_x * b_z;
  sum.zx += weight * a_z * b_x;
  sum.zz += weight * a_z * b_z;
}

PlaneMatrix scaled(double factor, const PlaneMatrix& m) {
  return {factor * m.xx, factor * m.xz, factor * m.zx, factor * m.zz};
}

/// Grains: number, nu, and the stress of what they move relative to their affine mean (or to their common
/// velocity while that is not known).
void add_grains(const Box& box, const Snapshot& s, RegionState& state) {
  double mass = 0, all_area = 0, momentum_x = 0, momentum_z = 0, first_x = 0, first_z = 0;
  const Period period = about(box, s);
  const Box open = without_sides(box, period);
  std::vector<std::pair<MovingPoint, double>> inside;  // with its mass
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const MovingPoint grain = first_image(period, grain_of(s, i));
    if (!open.holds(grain.at.x, grain.at.z)) continue;
    const double m = mass_of(s, i);
    inside.emplace_back(grain, m);
    all_area += disc_area(s.radius[i]);
    mass += m;
    momentum_x += m * grain.velocity.x;
    momentum_z += m * grain.velocity.z;
    first_x += m * grain.at.x;
    first_z += m * grain.at.z;
  }
  state.grains = inside.size();
  state.nu = all_area / box.area();
  if (inside.empty()) return;
  const PlaneMatrix G = std::isnan(state.gradient.xx) ? PlaneMatrix{} : state.gradient;
  for (const auto& [grain, m] : inside) {
    const double x = grain.at.x - first_x / mass, z = grain.at.z - first_z / mass;
    const double c_x = grain.velocity.x - momentum_x / mass - G.xx * x - G.xz * z;
    const double c_z = grain.velocity.z - momentum_z / mass - G.zx * x - G.zz * z;
    add_dyad(c_x, c_z, c_x, c_z, m / box.area(), state.kinetic);
  }
}

/// Contacts: each half branch counts with the share of it that lies in the box.
void add_contacts(const Box& box, const Snapshot& s, RegionState& state) {
  const Period period = about(box, s);
  const Box open = without_sides(box, period);
  double ends = 0, fabric = 0;
  for (const SnapshotContact& contact : s.contacts) {
    const double n_x = contact.normal_x, n_z = contact.normal_z;
    const double f_n = contact.impulse_n / s.time_step, f_t = contact.impulse_t / s.time_step;
    const double f_x = f_n * n_x + f_t * n_z, f_z = f_n * n_z - f_t * n_x;
    const auto half_branch = [&](std::int32_t grain, double side) {
      const auto g = static_cast<std::size_t>(grain);
      const auto [x, z] = period.first({s.x[g], s.z[g]});
      const double r = side * s.radius[g];
      add_dyad(side * f_x, side * f_z, r * n_x, r * n_z,
               share_inside(open, x, z, -r * n_x, -r * n_z) / box.area(), state.pressure);
      if (!open.holds(x, z)) return;
      ends += 1;
      if (contact.j < 0) return;
      fabric += 1;
      add_dyad(n_x, n_z, n_x, n_z, 1, state.fabric);
    };
    half_branch(contact.i, 1);
    if (contact.j >= 0) half_branch(contact.j, -1);
  }
  state.coordination = state.grains > 0 ? ends / static_cast<double>(state.grains) : no_value;
  state.fabric =
      fabric > 0 ? scaled(1 / fabric, state.fabric) : PlaneMatrix{no_value, no_value, no_value, no_value};
}

/// Sums for a least squares fit of a vector that is affine in the place.
struct AffineFit {
  double n = 0, x = 0, z = 0, xx = 0, xz = 0, zz = 0;
  double d_x = 0, d_z = 0, d_x_x = 0, d_x_z = 0, d_z_x = 0, d_z_z = 0;

  void add(double at_x, double at_z, double by_x, double by_z) {
    n += 1;
    x += at_x, z += at_z;
    xx += at_x * at_x, xz += at_x * at_z, zz += at_z * at_z;
    d_x += by_x, d_z += by_z;
    d_x_x += by_x * at_x, d_x_z += by_x * at_z, d_z_x += by_z * at_x, d_z_z += by_z * at_z;
  }
  std::optional<PlaneMatrix> matrix() const {
    if (n < 4) return std::nullopt;
    const double s_xx = xx - x * x / n, s_xz = xz - x * z / n, s_zz = zz - z * z / n;
    const double det = s_xx * s_zz - s_xz * s_xz;
    if (!(det > 1e-12 * s_xx * s_zz)) return std::nullopt;
    const auto row = [&](double d, double by_x, double by_z) {
      const double c_x = by_x - d * x / n, c_z = by_z - d * z / n;
      return std::pair((c_x * s_zz - c_z * s_xz) / det, (c_z * s_xx - c_x * s_xz) / det);
    };
    const auto [g_xx, g_xz] = row(d_x, d_x_x, d_x_z);
    const auto [g_zx, g_zz] = row(d_z, d_z_x, d_z_z);
    return PlaneMatrix{g_xx, g_xz, g_zx, g_zz};
  }
};

}  // namespace

double share_inside(const Box& box, double x, double z, double dx, double dz) {
  double from = 0, to = 1;
  const auto cut = [&](double start, double step, double low, double high) {
    if (step == 0) {
      if (start < low || start > high) to = from;
      return;
    }
    const double a = (low - start) / step, b = (high - start) / step;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  };
  cut(x, dx, box.x_min, box.x_max);
  cut(z, dz, box.z_min, box.z_max);
  return std::max(0.0, to - from);
}

std::optional<PlaneMatrix> mean_gradient(const Box& box, const Snapshot& before, const Snapshot& now) {
  if (!(now.time > before.time)) return std::nullopt;
  std::optional<CellPath> path;
  if (before.cell && now.cell) path.emplace(*cell_instant(before), *cell_instant(now));
  const Period period = path ? about(box, path->half_way()) : about(box, now);
  const Box open = without_sides(box, period);
  AffineFit fit;
  for (const auto& [then, i] : same_grains(before, now)) {
    Point by{now.x[i] - before.x[then], now.z[i] - before.z[then]};
    Point half_way{now.x[i] - 0.5 * by.x, now.z[i] - 0.5 * by.z};
    if (path) {  // of the image that it was before
      by = path->displacement(grain_of(before, then), grain_of(now, i));
      half_way = {before.x[then] + 0.5 * by.x, before.z[then] + 0.5 * by.z};
    }
    const Point at = period.first(half_way);
    if (!open.holds(at.x, at.z)) continue;
    const Point more = path ? path->change({at.x - half_way.x, at.z - half_way.z}) : Point{};
    fit.add(at.x, at.z, by.x + more.x, by.z + more.z);
  }
  const auto matrix = fit.matrix();
  if (!matrix) return std::nullopt;
  return scaled(1 / (now.time - before.time), *matrix);
}

const RegionState& RegionHistory::add(const Snapshot& snapshot) {
  if (snapshot.period_x > 0 && box_.x_max - box_.x_min > (1 + 1e-9) * snapshot.period_x)
    throw InputError(
        fmt::format("a box {} d wide in a domain with a period of {} d (allowed: up to the period)",
                    box_.x_max - box_.x_min, snapshot.period_x));
  if (snapshot.cell && box_.z_max - box_.z_min > (1 + 1e-9) * snapshot.cell->height)
    throw InputError(
        fmt::format("a box {} d high in a cell {} d high (allowed: up to the height of the cell)",
                    box_.z_max - box_.z_min, snapshot.cell->height));
  RegionState next;
  next.time = snapshot.time;
  next.strain = state_.strain;
  next.gradient = {no_value, no_value, no_value, no_value};
  if (before_)
    if (const auto gradient = mean_gradient(box_, *before_, snapshot)) {
      next.gradient = *gradient;
      const double diagonal = gradient->xx - gradient->zz, shear = gradient->xz + gradient->zx;
      next.strain += std::hypot(diagonal, shear) * (snapshot.time - before_->time);
    }
  add_grains(box_, snapshot, next);
  if (snapshot.contacts_known) {
    add_contacts(box_, snapshot, next);
    next.pressure = {next.pressure.xx + next.kinetic.xx, next.pressure.xz + next.kinetic.xz,
                     next.pressure.zx + next.kinetic.zx, next.pressure.zz + next.kinetic.zz};
  } else {
    next.pressure = next.fabric = {no_value, no_value, no_value, no_value};
    next.coordination = no_value;
  }
  state_ = next;
  before_ = snapshot;
  return state_;
}

}  // namespace drumlin::particles
