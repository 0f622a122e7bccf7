#pragma once
// A run on several ranks: the first one reads and writes all files and says what is done; the others follow
// it and do their shares of its steps (docs/decisions.md).
#include <cstdint>
#include <filesystem>
#include <vector>

#include "coupling/core/documents/described.hpp"
#include "particles/parallel/world.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

/// What a rank has cost so far.
struct RankCosts {
  double cpu_seconds = 0, waiting_seconds = 0, peak_memory_mb = 0;
};
DRUMLIN_DESCRIBED(RankCosts, cpu_seconds, waiting_seconds, peak_memory_mb)

/// The ranks beside the first one, as that sees them. Without a world there are none, and nothing is done.
class Followers {
 public:
  explicit Followers(particles::World* world) : world_(world) {}
  particles::World* world() const { return world_; }
  /// Lets them make the simulation of the scene in the run folder, from its last checkpoint if it goes on.
  /// Throws IoError where one of them cannot, or has another state than this one.
  void begin(const std::filesystem::path& run, bool goes_on, int threads,
             const particles::Simulation& simulation) const;
  /// One step, which they take, too. Throws as the simulation does, and IoError where one of them has come to
  /// another state.
  particles::StepReport step(particles::Simulation& simulation) const;
  /// Of each rank, this one first.
  std::vector<RankCosts> costs() const;
  /// Lets them end with an exit code.
  void end(int exit_code) const;

 private:
  /// Throws IoError where one of them has another mark of its state than `own`.
  void compare(std::uint64_t own, const particles::Simulation& simulation) const;
  particles::World* world_;
};

/// What another rank than the first does; returns its exit code.
int follow(particles::World& world);

}  // namespace drumlin::apps
