#pragma once
// The outline of the material as a polygon: where it lies on the parts of a region, its points, its area.
#include <functional>
#include <optional>
#include <span>

#include "continuum/model/region.hpp"

namespace drumlin::continuum {

/// Wanted distance of points, d.
using SizeField = std::function<double(Vec2)>;

/// The fill, its sides on the parts that are there (see `relabelled`), all divided evenly by `size`; those on
/// a circle are chords.
Outline outline_of(const Region& region, double time, const SizeField& size);

/// Sides cut where parts begin and end. A side lies on a part if both its ends do, to 1e-6 of its length; on
/// a circle, if it goes round less than an eighth of it with the material inside. What lay on a part stays on
/// it within its ends, though moved off it by some rounding. Openings, closed ones too, go before walls, then
/// the order of the parts. What lies on none, or on one that is gone, is free.
Outline relabelled(const Outline& outline, const Region& region, double time);

/// Sides on parts divided anew evenly, their contacts put on the part, or at its corner with the next one if
/// that is within a tenth of the size. Free sides longer than 1.5 size halved by cubic interpolation, points
/// less than half a size from the one before merged with it, the area kept; contacts stay.
Outline resampled(const Outline& outline, const Region& region, double time, const SizeField& size);

/// Contacts, where a free side and a part meet, put on the nearest point of their part.
Outline with_contacts_on_walls(Outline outline, const Region& region, double time);

/// Positive: anticlockwise.
double area(const Outline& outline);
double area(std::span<const Outline> outlines);  ///< sum

/// Free points moved along their normals, all by the same length, contacts along their walls, so that the
/// area is exact to rounding. Throws NotConvergedError where nothing is free.
Outline with_area(const Outline& outline, const Region& region, double time, double target);

/// Two sides, by the points from which they go.
struct Crossing {
  std::size_t first = 0, second = 0;
};
/// Two sides that meet and are no neighbours; or a side that has no length, or on which the next one turns
/// back, with that next one.
std::optional<Crossing> crossing_of(const Outline& outline);
/// Whether sides of one meet sides of the other.
bool meet(const Outline& one, const Outline& other);

}  // namespace drumlin::continuum
