#pragma once
// The end of a step whose contacts are solved: which grains fly, and which end in others from which no pair
// of the step kept them apart.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/disc_delassus.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// The motion of grains over a step, from its beginning to the velocities that contacts leave.
struct StepEnd {
  const StepInput& step;
  std::span<const BodyVelocity> changes;  ///< of velocities, by contacts; empty: none acts

  bool is_pushed(std::size_t b) const {
    return !changes.empty() && !(changes[b].x == 0 && changes[b].z == 0);
  }
  /// Velocity of a grain at the end.
  Point velocity(std::size_t b) const {
    const Point free = particles::velocity(step.free, b);
    return is_pushed(b) ? free + Point{changes[b].x, changes[b].z} : free;
  }
  /// Displacement of a grain from where its path begins: with the velocity at the end where contacts act,
  /// which leaves no overlap; with the mean of a grain that flies, which is exact.
  Point displacement(std::size_t b, bool flies) const {
    const Point v = velocity(b);
    return step.time_step * (flies ? 0.5 * (particles::velocity(step.bodies, b) + v) : v);
  }
  /// From its position at the beginning to where its path begins.
  Point shift(std::size_t b) const { return particles::shift(step.free, b); }
};

/// Sets `flies` of each grain: those that no contact pushes, and whose flight does not end in a pushed one.
void find_flights(const StepEnd& end, std::span<const Candidate> pairs, const PairBodies& bodies,
                  std::vector<char>& flies);

/// Finds pairs of grains that impacts and contacts have brought together and that the step did not take in;
/// keeps workspace only.
class MissedPairs {
 public:
  /// Looks among the listed pairs of the detection for those that overlap at the end and are not among
  /// `pairs`, to which all with gaps below the margin belong; false if there are none. `searched`: the
  /// velocities with which it looked last.
  bool find(const StepEnd& end, const FreeMotion& searched, const ContactDetection& detection,
            std::span<const Candidate> pairs);
  /// Of the last search, in the order of (i, j).
  std::span<const Candidate> pairs() const { return missed_; }

 private:
  bool find_thrown(const StepEnd& end, const FreeMotion& searched, const ContactDetection& detection);

  std::vector<char> is_thrown_;  // grains that moved further than the search allowed for
  std::vector<Candidate> missed_;
};

}  // namespace drumlin::particles
