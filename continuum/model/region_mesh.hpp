#pragma once
// The mesh that fills the material: triangles.
#include <functional>
#include <span>

#include "continuum/model/region.hpp"

namespace drumlin::continuum {

/// Triangles with sides of about `size` (d). The outline's points are the first vertices; they should lie
/// about `size` apart, and none is added. Constrained Delaunay triangulation (ears clipped, sides flipped)
/// refined at circumcentres (Ruppert 1995; no side of the outline is split), smoothed to the centroids of
/// patches (Chen 2004). Throws NotConvergedError where the outline crosses itself.
RegionMesh mesh_of(const Outline& outline, const std::function<double(Vec2)>& size);
/// One mesh of several outlines; throws NotConvergedError where they meet.
RegionMesh mesh_of(std::span<const Outline> outlines, const std::function<double(Vec2)>& size);

std::vector<Outline> outlines_of(const RegionMesh& mesh);
/// Of each side of the boundary the one that ends where it begins.
std::vector<std::size_t> sides_before(const RegionMesh& mesh);

/// The least over all triangles of 4 sqrt(3) area over the sum of the squared sides: 1 if equilateral, 0 or
/// less where one is no triangle any more.
double quality(const RegionMesh& mesh);

}  // namespace drumlin::continuum
