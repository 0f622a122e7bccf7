#pragma once
// Maps with intervals from the sums at their nodes (docs/theory/coarse-graining.md defines each field).
#include <cstddef>
#include <optional>
#include <span>

#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Least volume fraction at which a node has more than its volume fraction: above the surface a few grains in
/// flight would stand for a field.
constexpr double least_map_nu = 0.05;

/// The fields of docs/formats/maps.md, NaN outside of a circle of `container_radius` about the frame's origin
/// (0: none) and, nu and number_density apart, where nu < least_map_nu. z counts from `surface_z` (in the
/// frame); rows above all grains are left out. Intervals by leaving one batch out each; none with fewer than
/// two batches. `batches` must not be empty.
FieldMap field_maps(const CoarseGraining& graining, std::span<const MapSums> batches, double container_radius,
                    double surface_z);

/// The same of all batches but one, without intervals.
FieldMap field_maps_without(std::size_t left_out, const CoarseGraining& graining,
                            std::span<const MapSums> batches, double container_radius, double surface_z);

}  // namespace drumlin::particles
