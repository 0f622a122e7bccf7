#pragma once
// Fields of each grain of a snapshot; the paper's profiles are averages of them (Sec. II).
#include <cstdint>
#include <vector>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/maps/velocity_map.hpp"

namespace drumlin::particles {

/// Compression positive; xz: the traction of what is above on what is below.
struct GrainStress {
  std::vector<double> xx, zz, xz;
};

/// One entry per grain, or none where nobody knows it. Dimensionless, flow frame, relative to the drum. NaN
/// where a grain has no cell.
struct GrainFields {
  std::vector<double> cell_area, nu;
  std::vector<std::int32_t> open_cell;  ///< 1: the cell ends in the free
  std::vector<double> v_x, v_z;         ///< over the stored window
  std::vector<double> spin;             ///< empty when the scene has none, as is the rotational stress
  /// Of the forces F on the grain, b from the contact to its centre: sum of F_a b_b / cell area. The paper's
  /// sum (Sec. II) names contacts between discs only, and takes half the distance of the centres for b; here
  /// walls count too, and b is the grain's own radius: so the cell, which ends at the contact, and the half
  /// branch belong together. The sum over all grains times their cells is the same.
  GrainStress contact;
  /// m c_a c_b / cell area, c from the mean velocity at the grain's place. NaN where that mean is not known.
  GrainStress kinetic;
  /// Isotropic: J spin^2 / (2 cell area), J = m r^2/2: what the grain's points owe to its spin. The paper
  /// names a rotational part without defining it.
  std::vector<double> rotational;
  std::vector<std::int32_t> coordination;  ///< loaded contacts, those with walls included
};

/// Without `mean_velocity` there is no kinetic stress.
GrainFields grain_fields(const Snapshot& snapshot, const FlowSnapshot& in_frame,
                         const VelocityMap* mean_velocity = nullptr);

}  // namespace drumlin::particles
