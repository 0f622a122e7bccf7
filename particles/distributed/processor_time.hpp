#pragma once
// Processor time of this process, and how much of it was spent in waiting for other ranks: what a step costs
// on a machine that others use too.
#include <ctime>

namespace drumlin::particles {

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Adds the processor time of its life to a sum.
class WaitingTime {
 public:
  explicit WaitingTime(double& sum) : sum_(sum), begin_(processor_seconds()) {}
  ~WaitingTime() { sum_ += processor_seconds() - begin_; }
  WaitingTime(const WaitingTime&) = delete;
  WaitingTime& operator=(const WaitingTime&) = delete;

 private:
  double& sum_;
  double begin_;
};

}  // namespace drumlin::particles
