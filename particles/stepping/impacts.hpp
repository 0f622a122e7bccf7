#pragma once
// Impacts within a step: pairs that meet, faster than what a force does within a step, rebound at the time at
// which they meet, before the contact problem of the step is assembled (docs/theory/impacts.md).
//
// Impacts follow one another in time. Each is one pass: it takes the velocities v to P(v), P the projection
// on u_n >= 0 of the pair and of those that touch then and would close, with Coulomb friction (compression),
// and gives each normal impulse p back e times, with friction up to mu e p (expansion). Without friction and
// for one e that is v -> (1 + e) P(v) - e v: Newton's law for impacts at once. No pass raises the energy:
// the proof is there too.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/impact_pass.hpp"
#include "particles/stepping/impulse_cache.hpp"
#include "particles/stepping/meeting.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// A grain that impacts have hit: the changes of its velocities and of its shift (FreeMotion), and its
/// velocity before.
struct CollidedGrain {
  std::int32_t grain = 0;
  double v_x = 0, v_z = 0, spin = 0;
  Point before;
  Point shift;
};

/// What impacts of a step depend on: pairs as they were found, in the order of (i, j), and the loads that
/// they carried in the last step.
struct ImpactInput {
  const StepInput& step;
  std::span<const Candidate> pairs;
  const SavedLoads& loads;
  std::span<const double> wall_jumps;  ///< what impacts have added to the velocity of each driven wall
};

/// What they change: velocities and spins of the bodies, those of the step, the shifts of its free motion,
/// the velocities of driven walls; their impulses are added to the list of impacts.
struct ImpactOutput {
  Bodies& bodies;
  std::vector<PathShift>& shift;
  StepContacts& contacts;
};

/// Resolves the impacts of steps; keeps workspace only, and does nothing in a step without impacts.
class Impacts {
 public:
  /// Lets a pool share the work; the result does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool); }
  /// Takes the pairs of each body from a memory, in the scope that is open in resolve().
  void use(WorkMemory* memory) {
    first_.use(memory), next_.use(memory), met_.use(memory), in_pass_.use(memory);
  }
  void resolve(const ImpactInput& input, const ImpactOutput& output);

  /// Whether it would have anything to do once more, after a search for more pairs: only at grains that the
  /// last call hit.
  bool go_on(const ImpactInput& input);

  // Of the last call of resolve().
  std::span<const CollidedGrain> collided() const { return collided_; }
  const ImpactWork& work() const { return work_; }
  /// Pairs that met, counted once per impact.
  int count() const { return count_; }
  /// Pairs of a restitution above 0 that met more often than is resolved: the contact problem stops them.
  int unresolved() const { return unresolved_; }

 private:
  /// A pair that meets at a time, if neither side has been hit since that was found.
  struct Event {
    double time = 0;
    std::int32_t pair = 0;
    int passes = 0;  // of both sides
    bool operator>(const Event& other) const {
      return time != other.time ? time > other.time : pair > other.pair;
    }
  };

  void begin(const ImpactInput&);
  /// The pairs that may meet within the step, all or those of some bodies alone.
  bool find_closings(std::span<const char> of_bodies = {});
  /// Lists the pairs of each body.
  void link();
  std::int32_t grains() const;
  std::int32_t second_body_of(const Candidate& pair) const;
  /// Position of a body in the impact in hand, where it is taken up if it is new there.
  std::int32_t enter(std::int32_t body);
  /// Velocity of a body before the first impact, and after those so far.
  Point velocity_before(std::int32_t body) const;
  Point velocity(std::int32_t body) const;
  PathShift shift(std::int32_t body) const;
  /// When a side of a pair was hit last within the step.
  double collided_at(const Candidate& pair) const;
  int passes_of(const Candidate& pair) const;
  /// Velocity that forces give a body in a unit of time.
  Point acceleration_of(std::int32_t body) const;
  /// Of the wall of a pair, or of the image of j, but for what its own body has, with the normal as it is
  /// now.
  Point prescribed_velocity(const Candidate& pair) const;
  PairPath path_of(const Candidate& pair) const;
  /// Whether pair a, with these surfaces at a time on its path, closes there fast enough for an impact.
  bool collides(std::int32_t a, const PairPath& path, const Surfaces& now, double time, bool may_be_alone);
  bool rests(std::int32_t a, double u_n) const;
  /// Whether a grain has no other pair than one.
  bool is_alone(std::int32_t body) const;
  /// How often a pair may meet within the step.
  int most() const;
  double restitution_of(const Candidate& pair) const;
  /// When pair a meets next, from a time on.
  void schedule(std::int32_t a, double from);
  void add(std::int32_t a, const Surfaces& now, double time);
  /// One impact, with the pairs that it makes close at the same time.
  void collide(const Event& event, StepContacts&);
  /// Takes in the touching pairs that the pass has made close; false if there are none.
  bool take_in_neighbours(double time);
  void list_impacts(StepContacts&);
  void give_back(const ImpactOutput&);
  template <class Visit>
  void each_pair_of(std::int32_t body, Visit visit) const {
    for (std::int32_t k = first_[body]; k >= 0; k = next_[k]) visit(k / 2);
  }

  const ImpactInput* in_ = nullptr;  // within a call
  ImpactPass pass_;
  std::vector<Event> events_;              // a heap, the first one in time on top
  std::vector<std::int32_t> closings_;     // pairs
  std::vector<ImpactBody> taken_;          // bodies that impacts have taken up
  std::vector<std::int32_t> place_;        // of each body among them; -1: not there
  WorkArray<std::int32_t> first_, next_;   // pairs of each body, linked
  WorkArray<std::int32_t> met_, in_pass_;  // how often each pair has met; the last impact that it was in
  std::vector<CollidedGrain> collided_;
  std::vector<char> has_collided_;  // of each body, within go_on() alone
  ImpactWork work_;
  int count_ = 0, unresolved_ = 0, passes_ = 0;
  double slowest_ = 0;
  ParallelLoops loops_;
};

}  // namespace drumlin::particles
