#include "particles/bodies/cell_path.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

/// The whole number of lattice vectors of `length` in `excess`; an image moves at `rate` times its distance,
/// of which the mean over a time counts half.
double images(double excess, double length, double rate, double time) {
  return std::round(excess / (length * std::max(0.5, 1 - rate * time / 2)));
}

}  // namespace

Period period_of(const Snapshot& s) {
  if (!s.cell) return {};
  const SnapshotCell& c = *s.cell;
  return {c.x, s.period_x, c.z, c.height, c.offset, c.rate_x, c.rate_z, c.shear};
}

MovingPoint grain_of(const Snapshot& s, std::size_t i) { return {{s.x[i], s.z[i]}, {s.v_x[i], s.v_z[i]}}; }

MovingPoint first_image(const Period& period, MovingPoint grain) {
  const Point first = period.first(grain.at);
  const Point faster = period.image_velocity({first.x - grain.at.x, first.z - grain.at.z});
  return {first, {grain.velocity.x + faster.x, grain.velocity.z + faster.z}};
}

std::optional<CellInstant> cell_instant(const Snapshot& s) {
  if (!s.cell) return std::nullopt;
  CellInstant instant{s.time, period_of(s), true};
  const double rounding = 1e-9 * (s.period_x + s.cell->height);
  const auto inside = [&](double place, double from, double length) {
    return place >= from - rounding && place <= from + length + rounding;
  };
  for (std::size_t i = 0; i < s.x.size() && instant.wrapped; ++i)
    instant.wrapped = inside(s.x[i], s.cell->x, s.period_x) && inside(s.z[i], s.cell->z, s.cell->height);
  return instant;
}

CellPath::CellPath(const CellInstant& before, const CellInstant& now)
    : time_(now.time - before.time),
      wrapped_(before.wrapped && now.wrapped),
      now_(now.period),
      half_way_(now.period),
      d_length_(now.period.length - before.period.length),
      d_height_(now.period.length_z - before.period.length_z),
      d_offset_(now.period.offset - before.period.offset) {
  half_way_.length -= d_length_ / 2, half_way_.length_z -= d_height_ / 2;
  // An image above that is one length further on is the same: its way is that which the rates tell.
  const double mean_shear = (before.period.shear + now.period.shear) / 2;
  d_offset_ -= now_.length * std::round((d_offset_ - time_ * mean_shear * half_way_.length_z) / now_.length);
  half_way_.offset -= d_offset_ / 2;
}

Point CellPath::displacement(const MovingPoint& before, const MovingPoint& now) const {
  Point d{now.at.x - before.at.x, now.at.z - before.at.z};
  if (!wrapped_) return d;
  const double half = time_ / 2;
  const double rows =
      images(d.z - half * (before.velocity.z + now.velocity.z), now_.length_z, now_.rate_z, time_);
  Point shift{rows * now_.offset, rows * now_.length_z};
  const Point faster = now_.image_velocity(shift);
  shift.x += now_.length * images(d.x - shift.x - half * (before.velocity.x + now.velocity.x - faster.x),
                                  now_.length, now_.rate_x, time_);
  return {d.x - shift.x, d.z - shift.z};
}

Point CellPath::change(Point shift) const {
  const double rows = std::round(shift.z / half_way_.length_z);
  const double columns = std::round((shift.x - rows * half_way_.offset) / half_way_.length);
  return {rows * d_offset_ + columns * d_length_, rows * d_height_};
}

}  // namespace drumlin::particles
