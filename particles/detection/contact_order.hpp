#pragma once
// The order in which contacts are solved: by colour, so that neighbours in the order share no body. A sweep
// in this order does not wait for the result that it has just written, which is most of the time of a sweep
// in natural order.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/detection/contact_list.hpp"

namespace drumlin {

/// Places of `pairs` sorted by greedy colour, in the order of the list within a colour.
struct ContactOrder {
  std::vector<std::int32_t> place;
  void sort(std::span<const Candidate> pairs, std::size_t bodies);

 private:
  std::vector<std::uint64_t> used_;
  std::vector<std::int32_t> colour_;
};

}  // namespace drumlin
