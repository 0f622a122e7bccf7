#pragma once
// The order in which the contacts of a step are solved.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/sweep_plan.hpp"
#include "particles/detection/contact_list.hpp"

namespace drumlin::particles {

/// The solve order of contacts; keeps work space only.
class ContactOrder {
 public:
  /// Lets a pool share the work; the order does not depend on it.
  void use(ThreadPool* pool) {
    loops_ = ParallelLoops(pool);
    planner_.use(pool);
  }
  /// Takes work space from a memory, in the scope that is open when pairs are sorted.
  void use(WorkMemory* memory) { planner_.use(memory); }
  /// Finds the order of `pairs`, and their plan: slices along the longer side of the packing (along z in a
  /// periodic domain; in a cell, folded there).
  void find(std::span<const Candidate> pairs, const Bodies& bodies, const Period& period, SweepPlan& plan);
  std::size_t bytes() const { return bytes_of(order_) + bytes_of(i_) + bytes_of(j_); }
  /// The pairs given, without the rest of a candidate: many loops need no more.
  std::span<const std::int32_t> i() const { return i_; }
  std::span<const std::int32_t> j() const { return j_; }
  /// Position among the pairs given of each pair in solve order.
  std::span<const std::int32_t> order() const { return order_; }

 private:
  ParallelLoops loops_;
  std::span<const double> folded(const Bodies& bodies, const Period& period);

  SweepPlanner planner_;
  std::vector<double> folded_;
  std::vector<std::int32_t> i_, j_, order_;
};

}  // namespace drumlin::particles
