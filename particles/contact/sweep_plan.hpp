#pragma once
// The order in which contacts are solved, such that many of them can be solved side by side with the same
// result as one after the other.
#include <cstdint>
#include <span>
#include <vector>

namespace drumlin {

/// A sweep in two phases over lanes.
///
/// Bodies are cut into strips, in such a way that a contact joins bodies of one strip or of two successive
/// ones; a contact belongs to the first of its strips. Two successive strips are a lane. In the first phase
/// all lanes solve the contacts of their first strips, which touch bodies of their own lane only; in the
/// second phase those of their second strips, which touch the bodies of that strip and of the next one. So
/// within a phase no two lanes touch the same body, and a sweep meets twice, whatever the number of threads.
///
/// Within a strip, contacts stand in groups of one colour each: contacts of a group share no body, so that a
/// vector of them is solved at once. The fixed body that walls share is not counted.
struct SweepPlan {
  std::vector<std::int32_t> group_start;  ///< first contact of each group, and the number of contacts
  std::vector<std::int32_t> strip_start;  ///< first group of each strip, and the number of groups; strips
                                          ///< 2k and 2k + 1 are lane k
  std::vector<std::int32_t> body_order;   ///< bodies lane after lane; empty: not planned
  std::vector<std::int32_t> lane_bodies;  ///< first place in body_order of each lane, and the end

  bool empty() const { return lane_bodies.empty(); }
  int lanes() const { return empty() ? 0 : static_cast<int>(lane_bodies.size()) - 1; }
};

/// Strip of each of `bodies` bodies for the pairs (i, j); j outside of [0, bodies) is fixed. Strips are
/// levels of a breadth-first search from a body at the rim, merged to about equal numbers of contacts.
std::vector<std::int32_t> body_strips(std::int32_t bodies, std::span<const std::int32_t> i,
                                      std::span<const std::int32_t> j);

/// The same from where bodies are along an axis: slices as thick as the longest pair, merged likewise. Takes
/// a tenth of the time of a search.
std::vector<std::int32_t> body_strips_along(std::span<const double> position, std::span<const std::int32_t> i,
                                            std::span<const std::int32_t> j);

/// Plans one set of contacts after the other; keeps work space only.
class SweepPlanner {
 public:
  /// Plans the pairs (i, j) in given strips of bodies. `order` receives the pairs in solve order: strip by
  /// strip and greedy colour by colour, in the order given within a colour. False, and nothing planned, if
  /// the strips do not suit the pairs.
  bool plan(std::span<const std::int32_t> strip_of_body, std::span<const std::int32_t> i,
            std::span<const std::int32_t> j, SweepPlan& plan, std::vector<std::int32_t>& order);

 private:
  void append_colours(std::span<const std::int32_t> contacts, std::span<const std::int32_t> i,
                      std::span<const std::int32_t> j, SweepPlan& plan, std::vector<std::int32_t>& order);

  std::vector<std::int32_t> strip_of_contact_, by_strip_, start_;
  std::vector<std::int8_t> colour_;
  std::vector<std::uint64_t> used_;  // colours of the contacts of each body, one bit each
};

/// Both at once, for a single problem that comes without places.
SweepPlan sweep_plan(std::int32_t bodies, std::span<const std::int32_t> i, std::span<const std::int32_t> j,
                     std::vector<std::int32_t>& order);

}  // namespace drumlin
