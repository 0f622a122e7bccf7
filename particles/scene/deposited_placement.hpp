#pragma once
// Places discs as if they fell one after the other: a packing that is nearly at rest.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/scene/region.hpp"

namespace drumlin::particles {

/// Centres, in mm, of discs of the given diameters inside the region, in their order. Each falls, along -z,
/// where the surface is lowest, rolls downhill over the discs and the border of the region, and stays in the
/// first hollow, between two supports (Visscher and Bolsterli, Nature 239, 504, 1972, in two dimensions; they
/// drop discs anywhere, which here would heap them along the sides of a circle). Gaps are 4e-7 of the radii,
/// at least. Some microseconds a disc. Throws InputError when the region is full.
std::vector<Point_mm> deposited_centers_mm(std::span<const double> diameters_mm, const Region& region,
                                           std::uint64_t seed);

/// Share of a region that deposited discs can hardly exceed.
constexpr double deposited_share = 0.9;

}  // namespace drumlin::particles
