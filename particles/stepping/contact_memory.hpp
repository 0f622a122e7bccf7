#pragma once
// What contacts remember from one step to the next, by identity (i, j): the warm start.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/candidate.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// Contacts of the last step, in the order in which they were solved.
struct ContactMemory {
  std::vector<std::int32_t> i, j;
  std::vector<double> impulse;  ///< dim per contact, normal first: the warm start
  double time_step = 0;         ///< the impulses belong to: they scale with it
};

/// Finds contacts in a memory; keeps workspace only.
class Recollection {
 public:
  /// Lets a team share the work; the result does not depend on it.
  void use(ThreadTeam* team) { loops_ = TeamLoops(team); }
  /// Finds the pairs of grains 0 to `bodies` in the memory.
  void find(const ContactMemory&, std::size_t bodies, std::span<const Candidate> pairs);
  /// Impulses that a step of length `time_step` starts from: those remembered, 0 for new contacts.
  void warm_start(const ContactMemory&, int dim, double time_step, std::vector<double>& impulses) const;

 private:
  TeamLoops loops_;
  std::vector<std::int32_t> place_;                         // of each pair in the memory; -1: new
  std::vector<std::int32_t> first_of_body_, next_of_body_;  // places in the memory, linked by their i
};

/// Keeps contacts and impulses of a step.
void remember(std::span<const Candidate> pairs, const std::vector<double>& impulses, double time_step,
              ContactMemory&);

}  // namespace drumlin::particles
