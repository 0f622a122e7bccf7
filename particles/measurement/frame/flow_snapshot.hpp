#pragma once
// A snapshot in the flow frame: made once, read by every part of a measurement.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "particles/bodies/period.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/frame/flow_frame.hpp"
#include "particles/measurement/frame/moments.hpp"

namespace drumlin::particles {

/// A loaded contact in the flow frame; the normal points from body j to grain i.
struct FlowContact {
  std::int32_t i = 0, j = 0;  ///< grains; j < 0: a wall
  double normal_x = 0, normal_z = 0;
  double force_x = 0, force_z = 0;  ///< on i
};

/// Components in the flow frame, one entry per grain. Velocities and spins are relative to the drum.
struct FlowSnapshot {
  std::vector<double> x, z, radius, v_x, v_z;
  std::vector<double> spin;                 ///< empty when the scene has none
  std::vector<double> density;              ///< of each grain, rho0; empty when all have 1
  std::vector<std::uint16_t> coordination;  ///< loaded contacts, those with walls included
  std::vector<FlowContact> contacts;
  bool contacts_known = true;  ///< false: contacts and coordination say nothing
  Period cell;                 ///< that is periodic in z too, where its grains stand; else open
  double depth = 0;            ///< of a slab of spheres; 0: discs
  std::vector<char> outside;   ///< of the slab, as SphereSlab has it

  /// Whether a grain enters bins, with its sides of contacts.
  bool shows(std::size_t grain) const { return outside.empty() || outside[grain] == 0; }

  double density_of(std::size_t grain) const { return density.empty() ? 1 : density[grain]; }
  GrainSample<2> grain(std::size_t i) const {
    return {i,
            {x[i], z[i]},
            {v_x[i], v_z[i]},
            radius[i],
            density_of(i),
            static_cast<double>(coordination[i]),
            spin.empty() ? 0 : spin[i],
            {},
            {},
            depth};
  }
  /// Both sides of each contact in turn, that of i first; a wall has none. Each is made when it is looked at:
  /// stored they would take three times the memory of the contacts.
  template <class Visit>
  void each_half_branch(const Visit& visit) const {
    for (std::size_t side = 0; side < 2 * contacts.size(); ++side) {
      const std::int32_t grain = side % 2 == 0 ? contacts[side / 2].i : contacts[side / 2].j;
      if (grain >= 0 && shows(static_cast<std::size_t>(grain))) visit(half_branch(side));
    }
  }

 private:
  HalfBranch<2> half_branch(std::size_t side) const;
};

inline HalfBranch<2> FlowSnapshot::half_branch(std::size_t side) const {
  const FlowContact& contact = contacts[side / 2];
  const double sign = side % 2 == 0 ? 1 : -1;
  const auto grain = static_cast<std::uint32_t>(side % 2 == 0 ? contact.i : contact.j);
  const double reach = -sign * radius[grain];
  return {grain,
          {x[grain], z[grain]},
          {reach * contact.normal_x, reach * contact.normal_z},
          {sign * contact.force_x, sign * contact.force_z},
          {contact.normal_x, contact.normal_z},
          contact.j<0, depth> 0 ? radius[grain] : 0};
}

/// Numbers of snapshots, of those that know spins, contacts and densities of their own, and of those of
/// spheres.
struct KnownSnapshots {
  double count = 0, spin = 0, contacts = 0, densities = 0, spheres = 0;
  void add(const FlowSnapshot& snapshot) {
    count += 1;
    spin += snapshot.spin.empty() ? 0 : 1;
    contacts += snapshot.contacts_known ? 1 : 0;
    densities += snapshot.density.empty() ? 0 : 1;
    spheres += snapshot.depth > 0 ? 1 : 0;
  }
};

/// Which velocity of a grain is meant.
enum class VelocityKind { window, instantaneous };

/// `window`: displacement over the stored window / window, the drum's own turn taken out exactly; a snapshot
/// without displacements has only the instantaneous velocity. Grains that have left a cell which is periodic
/// in z are put back into it. Overwrites `result`, whose memory is used again.
void to_flow_frame(const Snapshot& snapshot, const FlowFrame& frame, VelocityKind kind, FlowSnapshot& result);
inline FlowSnapshot in_flow_frame(const Snapshot& snapshot, const FlowFrame& frame = {},
                                  VelocityKind kind = VelocityKind::window) {
  FlowSnapshot result;
  to_flow_frame(snapshot, frame, kind, result);
  return result;
}

/// Velocities of the grains relative to a frame that turns with the container (the laboratory without one),
/// laboratory components.
struct RelativeVelocities {
  std::vector<double> x, z;
};
void relative_velocities(const Snapshot& snapshot, VelocityKind kind, RelativeVelocities& result);

}  // namespace drumlin::particles
