#pragma once
// Gives back the memory of vectors that are not needed any more.
#include <vector>

namespace drumlin {

/// Gives back what a vector holds. To assign {} to it would keep that for later.
template <class T>
void free_memory_of(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace drumlin
