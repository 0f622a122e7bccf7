#pragma once
// Velocity and pressure of a flow as plain numbers, independent of mesh objects and ranks: a stored state.
#include <array>
#include <cstdint>
#include <vector>

namespace drumlin::continuum {

/// Place of a cell in the refinement of the coarse mesh: deal.II's CellId as numbers.
using CellPlace = std::array<std::uint32_t, 4>;

/// Velocity and pressure on every cell (what else a flow has follows from them), sorted by cell: the same for
/// any number of ranks. Laboratory frame; d, sqrt(g d), rho0 g d.
struct FlowState {
  static constexpr int values_per_cell = 22;  ///< of Q2-Q1: two velocities at nine points, p at four
  double theta = 0;                           ///< rad
  std::vector<CellPlace> cells = {};
  std::vector<double> centres = {};  ///< x, z per cell
  std::vector<double> surface = {};  ///< coefficients of SurfaceShape where the surface has moved; else empty
  std::vector<double> values = {};   ///< values_per_cell per cell, in the order of deal.II's element
};

}  // namespace drumlin::continuum
