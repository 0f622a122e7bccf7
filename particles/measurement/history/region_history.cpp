#include "particles/measurement/history/region_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin::particles {
namespace {

/// The period with its first one about the middle of the box.
Period about(const Rectangle& box, Period period) {
  period.origin = 0.5 * (box.x_min + box.x_max - period.length);
  period.origin_z = 0.5 * (box.z_min + box.z_max - period.length_z);
  return period;
}

Period period_at(const Snapshot& snapshot) {
  Period period = period_of(snapshot);
  period.length = snapshot.period_x;
  return period;
}

constexpr PlaneMatrix unknown{no_value, no_value, no_value, no_value};

using RegionSum = WholeGrainSum<2, 4>;

/// Of the motion in the laboratory at the instant of the snapshot.
RegionSum sum_of(const Rectangle& box, Snapshot snapshot) {
  snapshot.wall_spin = 0;
  std::array<RegionSum, 1> sum{};
  accumulate(in_flow_frame(snapshot, {}, VelocityKind::instantaneous), BoxBinning(box, period_at(snapshot)),
             sum);
  return sum[0];
}

/// The matrix of the least squares fit of a vector, the first two components, that is affine in the place.
std::optional<PlaneMatrix> affine_matrix(const Spread<4>& fit) {
  if (fit.weight < 4) return std::nullopt;
  const double xx = fit.covariance(2, 2), xz = fit.covariance(2, 3), zz = fit.covariance(3, 3);
  const double det = xx * zz - xz * xz;
  if (!(det > 1e-12 * xx * zz)) return std::nullopt;
  const auto row = [&](std::size_t a) {
    const double x = fit.covariance(a, 2), z = fit.covariance(a, 3);
    return std::pair((x * zz - z * xz) / det, (z * xx - x * xz) / det);
  };
  const auto [g_xx, g_xz] = row(0);
  const auto [g_zx, g_zz] = row(1);
  return PlaneMatrix{g_xx, g_xz, g_zx, g_zz};
}

}  // namespace

BoxBinning::BoxBinning(const Rectangle& box, const Period& period)
    : period_(about(box, period)),
      open_(box),
      middle_{0.5 * (box.x_min + box.x_max), 0.5 * (box.z_min + box.z_max)} {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nearly = 1 - 1e-9;
  if (!period.open() && box.width() > nearly * period.length) open_.x_min = -infinity, open_.x_max = infinity;
  if (!period.open_z() && box.height() > nearly * period.length_z)
    open_.z_min = -infinity, open_.z_max = infinity;
}

double share_inside(const Rectangle& box, double x, double z, double dx, double dz) {
  LinePart part;
  part.cut(x, dx, box.x_min, box.x_max);
  part.cut(z, dz, box.z_min, box.z_max);
  return std::max(0.0, part.end - part.begin);
}

std::optional<PlaneMatrix> mean_gradient(const Rectangle& box, const Snapshot& before, const Snapshot& now) {
  const double time = now.time - before.time;
  if (!(time > 0)) return std::nullopt;
  std::optional<CellPath> path;
  if (before.cell && now.cell) path.emplace(*cell_instant(before), *cell_instant(now));
  const BoxBinning binning(box, path ? path->half_way() : period_at(now));
  Spread<4> fit;
  for (const auto& [then, i] : same_grains(before, now)) {
    Point by{now.x[i] - before.x[then], now.z[i] - before.z[then]};
    Point half_way{now.x[i] - 0.5 * by.x, now.z[i] - 0.5 * by.z};
    if (path) {  // of the image that it was before
      by = path->displacement(grain_of(before, then), grain_of(now, i));
      half_way = {before.x[then] + 0.5 * by.x, before.z[then] + 0.5 * by.z};
    }
    const Point at = binning.period().first(half_way);
    if (!binning.holds(at)) continue;
    const Point more = path ? path->change({at.x - half_way.x, at.z - half_way.z}) : Point{};
    const auto [x, z] = binning.place(at);
    fit.add(1, {(by.x + more.x) / time, (by.z + more.z) / time, x, z});
  }
  return affine_matrix(fit);
}

const RegionState& RegionHistory::add(const Snapshot& snapshot) {
  if (snapshot.period_x > 0 && box_.width() > (1 + 1e-9) * snapshot.period_x)
    throw InputError(
        fmt::format("a box {} d wide in a domain with a period of {} d (allowed: up to the period)",
                    box_.width(), snapshot.period_x));
  if (snapshot.cell && box_.height() > (1 + 1e-9) * snapshot.cell->height)
    throw InputError(
        fmt::format("a box {} d high in a cell {} d high (allowed: up to the height of the cell)",
                    box_.height(), snapshot.cell->height));
  RegionState next;
  next.time = snapshot.time;
  next.strain = state_.strain;
  next.gradient = unknown;
  if (before_)
    if (const auto gradient = mean_gradient(box_, *before_, snapshot)) {
      next.gradient = *gradient;
      const double diagonal = gradient->xx - gradient->zz, shear = gradient->xz + gradient->zx;
      next.strain += std::hypot(diagonal, shear) * (snapshot.time - before_->time);
    }
  const RegionSum sum = sum_of(box_, snapshot);
  const PlaneMatrix& G = next.gradient;
  const Tensor<2> gradient{{{G.xx, G.xz}, {G.zx, G.zz}}};
  const Fields<2> fields = derive(sum, Background<2>{box_.area(), std::isnan(G.xx) ? Tensor<2>{} : gradient});
  next.grains = static_cast<std::size_t>(sum.grains);
  next.nu = fields.nu;
  next.kinetic = plane_matrix(fields.kinetic);
  next.coordination = snapshot.contacts_known ? fields.coordination : no_value;
  next.pressure = snapshot.contacts_known ? plane_matrix(fields.pressure()) : unknown;
  next.fabric = snapshot.contacts_known ? plane_matrix(fields.fabric) : unknown;
  state_ = next;
  before_ = snapshot;
  return state_;
}

}  // namespace drumlin::particles
