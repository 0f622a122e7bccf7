#pragma once
// Wall time of a solve by kind of work. Private to fem/.
#include <array>
#include <chrono>
#include <cstddef>

namespace drumlin::continuum::fem {

enum class Work : std::size_t {
  assembly,
  factorisation,
  linear_solves,
  step_length,
  local_steps,
  refinement,
  evaluation
};
constexpr std::array<const char*, 7> work_names = {
    "assembly", "factorisation", "linear solves", "step length", "local steps", "refinement", "evaluation"};

/// Seconds since an arbitrary moment.
inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class WorkClock {
 public:
  /// Runs `action` and books its wall time.
  template <class Action>
  decltype(auto) operator()(Work work, Action&& action) {
    const Booking booking(*this, work);
    return action();
  }
  double seconds(Work work) const { return seconds_[static_cast<std::size_t>(work)]; }
  int times(Work work) const { return times_[static_cast<std::size_t>(work)]; }

 private:
  struct Booking {
    Booking(WorkClock& of, Work kind) : clock(of), work(static_cast<std::size_t>(kind)), start(now()) {}
    ~Booking() {
      clock.seconds_[work] += now() - start;
      ++clock.times_[work];
    }
    WorkClock& clock;
    std::size_t work;
    double start;
  };
  std::array<double, work_names.size()> seconds_{};
  std::array<int, work_names.size()> times_{};
};

}  // namespace drumlin::continuum::fem
