#include "particles/measurement/frame/bulk_state.hpp"

#include <limits>
#include <numbers>
#include <vector>

#include "coupling/statistics/straight_line.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

BulkState bulk_state(const Snapshot& snapshot, const FlowFrame& frame) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!snapshot.contacts_known) return {none, none, none};
  FlowSnapshot seen;
  to_flow_frame(snapshot, frame, VelocityKind::window, seen);
  double area = 0, trace = 0, shear = 0;
  for (const double radius : seen.radius) area += std::numbers::pi * radius * radius;
  for (const HalfBranch& branch : seen.half_branches()) {
    trace -= branch.force_x * branch.toward_x + branch.force_z * branch.toward_z;
    shear += branch.force_x * branch.toward_z;
  }
  std::vector<double> heights, velocities;
  for (std::size_t i = 0; i < seen.x.size(); ++i) {
    if (seen.coordination[i] == 0) continue;
    heights.push_back(seen.z[i]);
    velocities.push_back(seen.v_x[i]);
  }
  const auto line = heights.size() < 3 ? std::nullopt : statistics::fit_line(heights, velocities);
  return {trace / (2 * area), shear / area, line ? line->slope : none};
}

}  // namespace drumlin::particles
