#pragma once
// Grains that outlets take away, give back and sources pour, between two steps.
#include <cstdint>
#include <deque>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// A grain that waits for room.
struct WaitingGrain {
  double radius = 0, inverse_mass = 0;
  std::int32_t material = 0;
};

/// What one outlet has done so far.
struct OutletState {
  std::vector<double> times;         ///< at which grains were taken, one per grain
  double mass = 0;                   ///< taken
  std::int64_t at_stage_start = 0;   ///< taken before the current stage
  std::deque<WaitingGrain> waiting;  ///< to come back, the first one first

  std::int64_t taken() const { return static_cast<std::int64_t>(times.size()); }
};

/// All that outlets and sources have done so far. What sources draw depends on the seed, the number of the
/// grain and the step alone: random numbers have no state.
struct Traffic {
  std::int64_t next_id = 0;
  std::vector<OutletState> outlets;
  std::vector<std::int64_t> poured;  ///< by each source
};

struct EventInput;

/// The traffic of a scene before its first step; the grains get their identities.
Traffic first_traffic(const Scene&, Bodies&);
/// Takes away what stands in outlets, then puts in what comes back and what is poured, where there is room: a
/// new disc and what is there are apart by 1 % of its radius at least. New grains stand behind all others.
void exchange_grains(const EventInput&);
/// Grains of a source that should be there by now and found no room.
std::int64_t waiting(const Source&, std::int64_t poured, double seconds);

}  // namespace drumlin::particles
