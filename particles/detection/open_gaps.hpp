#pragma once
// Insertion of many entries into a list at once.
#include <algorithm>
#include <cstddef>

namespace drumlin::particles {

/// Makes a list longer by `count` entries, so that new ones stand at the positions it[k] of the longer list,
/// ascending. place(k, end) gives it[k]: it is called from the last to the first, when the first `end`
/// entries still stand where they were. Each old entry moves once, and only as far as there are new ones
/// before it.
template <class List, class Place>
void open_gaps(List& list, std::size_t count, Place place) {
  std::size_t end = list.size();
  list.resize(end + count);
  for (std::size_t left = count; left > 0; --left) {
    const std::size_t old = place(left - 1, end) - (left - 1);
    std::move_backward(list.begin() + old, list.begin() + end, list.begin() + end + left);
    end = old;
  }
}

}  // namespace drumlin::particles
