#pragma once
// A snapshot in the flow frame: made once, read by every part of a measurement.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

/// One grain's side of a contact: from its centre to the contact. Both sides together are the branch; across
/// a periodic boundary each stays with its grain, and a wall has none.
struct HalfBranch {
  std::uint32_t grain = 0;
  double x = 0, z = 0;                ///< centre of the grain
  double toward_x = 0, toward_z = 0;  ///< from the centre to the contact
  double force_x = 0, force_z = 0;    ///< on the grain
  bool at_wall = false;               ///< the other side is a wall
};

/// Components in the flow frame, one entry per grain. Velocities and spins are relative to the drum.
struct FlowSnapshot {
  std::vector<double> x, z, radius, v_x, v_z;
  std::vector<double> spin;                 ///< empty when the scene has none
  std::vector<double> density;              ///< of each grain, rho0; empty when all have 1
  std::vector<std::uint16_t> coordination;  ///< loaded contacts, those with walls included
  std::vector<HalfBranch> half_branches;
  bool contacts_known = true;  ///< false: half_branches and coordination say nothing
};

/// Which velocity of a grain is meant.
enum class VelocityKind { window, instantaneous };

/// `window`: displacement over the stored window / window, the drum's own turn taken out exactly; a snapshot
/// without displacements has only the instantaneous velocity. Overwrites `result`, whose memory is used
/// again.
void to_flow_frame(const Snapshot& snapshot, const FlowFrame& frame, VelocityKind kind, FlowSnapshot& result);

/// Velocities of the grains relative to a frame that turns with the container (the laboratory without one),
/// laboratory components.
struct RelativeVelocities {
  std::vector<double> x, z;
};
void relative_velocities(const Snapshot& snapshot, VelocityKind kind, RelativeVelocities& result);

}  // namespace drumlin::particles
