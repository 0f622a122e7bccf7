#pragma once
// Steps of a flowing drum, kept so that every solver can be given the very same ones.
#include <filesystem>
#include <string>
#include <vector>

#include "particles/stepping/moreau_jean.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::benchmark {

/// What Stepper::advance takes, before it is called.
struct FlowStep {
  particles::Bodies bodies;
  particles::ImpulseCache memory;
  particles::WallStep walls;
};

struct Flow {
  int discs = 0;
  particles::StepLaws laws;
  double time_step = 0;  ///< sqrt(d/g)
  std::vector<FlowStep> steps;
};

/// A drum of `discs` grains like that of `scene`: filled as much, turned at the same Froude number, settled
/// and then turned until it flows (above 10,000 discs: until it begins to turn); then `steps` steps of it.
/// The state is kept in the folder `cache`.
Flow flow_of(const particles::Scene& scene, int discs, int steps, const std::filesystem::path& cache);

/// A solver that is given steps again and again: its work space is warm after the first.
class Replay {
 public:
  Replay(const Flow& flow, const std::string& solver, int threads, const particles::StoppingRule& rule);
  particles::StepReport operator()(const FlowStep& step);

 private:
  particles::StepLaws laws_;
  double time_step_;
  std::unique_ptr<particles::Stepper> stepper_;
  FlowStep work_;
};

/// Largest resident memory, in MB, of a process that does nothing but steps of this drum.
double peak_memory_mb(const particles::Scene& scene, int discs, const std::filesystem::path& cache);

}  // namespace drumlin::benchmark
