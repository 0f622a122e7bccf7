#pragma once
// Impacts within a step: pairs that meet, or touch, and close faster than 2 g h, or than twice what their
// load of the last step gives them, rebound before the contact problem of the step is assembled
// (docs/theory/impacts.md).
//
// A pass takes the velocities v at the beginning of the step to P(v), P the projection on u_n >= 0 of the
// closing pairs with Coulomb friction (compression), and gives each normal impulse p back e times, with
// friction up to mu e p (expansion). Without friction and for one e that is v -> (1 + e) P(v) - e v: Newton's
// law for impacts at once. Passes follow one another until no pair closes. No pass raises the energy: proof
// in the same place.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/parallel/team_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/contact_memory.hpp"
#include "particles/stepping/impact_pass.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// A grain that impacts have struck: the changes of its velocities, and what they were before.
struct StruckGrain {
  std::int32_t grain = 0;
  double v_x = 0, v_z = 0, spin = 0;
  Point before;
};

/// Picks out the pairs of struck grains; keeps workspace only.
class StruckPairs {
 public:
  /// Sets `selected` to the pairs pair(0), pair(1), ..., of `count`, in their order, of which
  /// place_of(struck) gives one side; -1: none.
  template <class Struck, class Place, class Pair>
  void select(std::size_t bodies, std::span<const Struck> struck, Place place_of, std::size_t count,
              Pair pair, std::vector<Candidate>& selected) {
    is_struck_.resize(bodies, 0);
    const auto mark = [&](char value) {
      for (const Struck& grain : struck)
        if (const std::int32_t b = place_of(grain); b >= 0) is_struck_[b] = value;
    };
    mark(1);
    selected.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const Candidate& found = pair(k);
      if (is_struck_[found.i] | (found.j >= 0 ? is_struck_[found.j] : 0)) selected.push_back(found);
    }
    mark(0);
  }

 private:
  std::vector<char> is_struck_;  // of each body, within select() alone
};

/// Resolves the impacts of steps; keeps workspace only, and does nothing in a step without impacts.
class Impacts {
 public:
  /// Lets a team share the work; the result does not depend on it.
  void use(ThreadTeam* team) { loops_ = TeamLoops(team); }
  /// Takes the pairs of each body from a memory, in the frame that is open in resolve().
  void use(WorkMemory* memory) { first_.use(memory), next_.use(memory), in_pass_.use(memory); }
  /// Adds what impacts change to the velocities and spins of `bodies`, those of `step`, and lists their
  /// impulses in `contacts.strikes`. Velocities of walls moved by a force change too: `contacts.wall_jumps`
  /// adds up by how much.
  void resolve(const StepInput& step, const RememberedLoads& loads, Bodies& bodies, StepContacts& contacts);

  /// The same of a part of the pairs: all that meet at first, and all pairs of the bodies b with whole[b].
  /// Returns false, and changes nothing, where a pass takes up other bodies, which missing() lists; else the
  /// result is that of all pairs, to the last bit.
  bool resolve_part(const StepInput& step, const RememberedLoads& loads, std::span<const char> whole,
                    Bodies& bodies, StepContacts& contacts);

  /// Whether resolve() would have anything to do; of a part of the pairs, whether these alone give it.
  bool any(const StepInput& step, const RememberedLoads& loads, const StepContacts& contacts);

  // Of the last call, which was any(): the pairs that meet.
  std::span<const std::int32_t> closings() const { return closings_; }
  // Of the last call of resolve_part() alone.
  std::span<const std::int32_t> missing() const { return missing_; }
  // Of the last call of resolve().
  std::span<const StruckGrain> struck() const { return struck_; }
  const ImpactWork& work() const { return work_; }
  /// Pairs that met, counted once per pass.
  int count() const { return count_; }

 private:
  /// The pairs that meet within the step.
  bool find_closings(const StepInput&, const StepContacts&);
  /// Lists the pairs of each body.
  void link(const StepInput&, const StepContacts&);
  /// Place of a body in the pass, where it is taken up if it is new there.
  std::int32_t take_up(const StepInput&, std::int32_t body);
  void add(const StepInput&, const Candidate& pair, std::int32_t index);
  /// Velocity of a body before the first pass, and after the passes so far.
  Point velocity_before(const StepInput&, std::int32_t body) const;
  Point velocity(const StepInput&, std::int32_t body) const;
  /// Whether pair a meets within the step fast enough, with the velocities as they stand.
  bool closes(const StepInput&, const StepContacts&, std::int32_t a) const;
  /// Whether pair a, which closes at u_n < 0, rests: its load would do as much within two steps.
  bool rests(const StepInput&, const Candidate& pair, std::int32_t a, double u_n) const;
  /// Ends passes that took up bodies without their pairs.
  void give_up(StepContacts&, std::size_t strikes);
  /// Takes in the touching pairs that the pass has made close; false if there are none.
  bool take_in_neighbours(const StepInput&, const StepContacts&);
  /// Compresses with all touching pairs that this closes.
  void compress(const StepInput&, const StepContacts&);
  void find_next_closings(const StepInput&, const StepContacts&);
  /// Lists the impulses of a pass.
  void list_strikes(StepContacts&);
  void give_back(const StepInput&, Bodies&, StepContacts&);
  template <class Visit>
  void each_pair_of(std::int32_t body, Visit visit) const {
    for (std::int32_t k = first_[body]; k >= 0; k = next_[k]) visit(k / 2);
  }

  ImpactPass pass_;
  std::vector<std::int32_t> closings_;    // pairs
  std::span<const char> whole_;           // of each body, whether its pairs are all there; empty: of all
  std::vector<std::int32_t> missing_;     // bodies taken up without that
  std::vector<std::int32_t> place_;       // of each body in the pass; -1: not there
  WorkArray<std::int32_t> first_, next_;  // pairs of each body, linked
  WorkArray<std::int32_t> in_pass_;       // number of the last pass in which a pair took part
  std::span<const double> wall_jumps_;    // those of the step so far
  std::vector<StruckGrain> struck_;
  ImpactWork work_;
  int count_ = 0, pass_number_ = 0;
  double slowest_ = 0;
  RememberedLoads loads_;
  TeamLoops loops_;
};

}  // namespace drumlin::particles
