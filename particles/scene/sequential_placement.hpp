#pragma once
// Places discs of very different sizes: a lattice of the largest ones would leave the small ones scattered.
#include <span>
#include <vector>

#include "particles/scene/obstacles.hpp"

namespace drumlin::particles {

/// Centres, in mm, of discs of the given diameters inside the region, nowhere closer to one another, or to an
/// obstacle, than 1 % of their radii:
/// the largest first, each at the first free of random places in the lowest part of the region that has room
/// (random sequential addition; the part grows when a disc finds none). Throws InputError when the region is
/// full.
std::vector<Point_mm> sequential_centers_mm(std::span<const double> diameters_mm, const Region& region,
                                            const Obstacles& obstacles, std::uint64_t seed);

/// Share of a region that random places can be counted on to fill.
constexpr double sequential_share = 0.5;

double area_mm2(const Region& region);

}  // namespace drumlin::particles
