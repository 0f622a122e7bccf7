#pragma once
// The stress and the shear rate of all grains together at one instant.
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

/// Dimensionless; NaN where it is not known: no contacts in the snapshot, or fewer than three grains that
/// touch something at two heights.
struct BulkState {
  double pressure = 0;      ///< half the sum over contacts of F_a b_a, over the area of all discs
  double shear_stress = 0;  ///< of -F_x b_z, over the same: what the upper grains do to the lower ones
  double shear_rate =
      0;  ///< slope of v_x (over the stored window) over z among the grains that touch something
};

/// F is the force on a grain, b goes from the contact to its centre. Grains in free flight enter by their
/// area alone.
BulkState bulk_state(const Snapshot& snapshot, const FlowFrame& frame);

}  // namespace drumlin::particles
