#pragma once
// What the mesh of a region and the fields on it tell each other. Private to fem/.
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/detail/split_triangles.hpp"
#include "continuum/model/mesh_motion.hpp"

namespace drumlin::continuum::fem {

std::vector<Vec2> velocity_at_corners(const Discretisation& d, std::size_t corners, const FieldVector& u);
/// The field that is linear between the vertices of each quadrilateral.
FieldVector field_of_corners(const Discretisation& d, const SplitTriangles& split,
                             const std::vector<Vec2>& corners);

/// To first order, what the field is where its nodes go.
FieldVector displaced(const Discretisation& d, const FieldVector& u, const FieldVector& displacement);

/// Motion of the material as the mesh follows it, and what leaves through openings: area and kinetic energy
/// per time.
struct BoundaryFlow {
  CornerMotion motion;
  double outflow = 0, outflow_energy = 0;
};
BoundaryFlow boundary_flow(const SolvedLevel& level, const SplitTriangles& split, std::size_t corners);

/// Force of the material on each part of the region. Where two parts meet, each takes what acts across it.
std::vector<Vec2> loads_on(const Region& region, double time, const SolvedLevel& level);

/// Values of the old field at the nodes of the new mesh; outside of the old one that of its nearest point.
/// Throws NotConvergedError where a node lies far outside.
void transfer(const SolvedLevel& from, const RegionMesh& old_mesh, SolvedLevel& to);

}  // namespace drumlin::continuum::fem
