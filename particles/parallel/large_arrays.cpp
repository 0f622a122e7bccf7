#include "particles/parallel/large_arrays.hpp"

#include <malloc.h>

namespace drumlin::particles {

void release_large_arrays([[maybe_unused]] int bytes) {
#ifdef M_MMAP_MAX
  constexpr int most_arrays = 1 << 16;  // the default of the C library
  (void)::mallopt(M_MMAP_MAX, most_arrays);
  (void)::mallopt(M_MMAP_THRESHOLD, bytes);
  (void)::mallopt(M_TRIM_THRESHOLD, 2 * bytes);
#endif
}

}  // namespace drumlin::particles
