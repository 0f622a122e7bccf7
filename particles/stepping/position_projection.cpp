#include "particles/stepping/position_projection.hpp"

#include <algorithm>

namespace drumlin::particles {
namespace {

// A projection that takes away the whole overlap at once opens neighbouring contacts; the load closes them at
// gap/h in the next step, the packing heats, solves get worse and overlap grows: a settling drum of 7183
// discs blew up so.
constexpr double correction_share = 0.2;
constexpr double largest_correction = 2e-3;  // d per step
// Of the residual, relative to the corrections asked for. A few plain Gauss-Seidel sweeps leave the contacts
// that are solved early overlapped, the same ones in every step: their overlap grew to 0.1 d within a second.
constexpr double tolerance = 0.05;

}  // namespace

void PositionProjection::apply(Bodies& bodies, std::span<const ClosePair> pairs, const SweepPlan& plan,
                               int sweeps) {
  auto& W = problem_.W;
  W.clear();
  W.inverse_mass.assign(bodies.inverse_mass.begin(), bodies.inverse_mass.end());
  W.inverse_mass.push_back(0);
  problem_.q.clear();
  bool overlapped = false;
  for (const ClosePair& pair : pairs) {
    W.add(pair.i, pair.j < 0 ? static_cast<std::int32_t>(bodies.count()) : pair.j, pair.n_x, pair.n_z);
    problem_.q.push_back(pair.gap >= 0 ? pair.gap
                                       : std::max(correction_share * pair.gap, -largest_correction));
    overlapped = overlapped || pair.gap < 0;
  }
  if (!overlapped) return;
  W.plan = plan;
  solution_.impulses.assign(pairs.size(), 0.0);
  StoppingRule rule;
  rule.tolerance = tolerance;
  rule.max_sweeps = sweeps;
  // What is left is seen, and reported, as the overlap of the next step.
  (void)solve_accelerated(problem_, rule, work_, solution_);
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    bodies.x[b] += solution_.velocities.bodies[b].x;
    bodies.z[b] += solution_.velocities.bodies[b].z;
  }
}

}  // namespace drumlin::particles
