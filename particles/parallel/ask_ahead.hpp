#pragma once
// Memory that a loop needs soon, where its addresses come from a list: processors foresee only addresses that
// follow one another.
#include <cstddef>

namespace drumlin::particles {

/// How many turns of a loop ahead to ask: a turn takes some nanoseconds, memory some hundred.
inline constexpr int turns_ahead = 16;

/// Asks for what stands at an address, without waiting for it. Changes nothing.
inline void ask_for(const void* address) {
  __builtin_prefetch(address);
  // Else g++ 12 sees no effect in a function that does nothing but ask, and leaves out its calls.
  asm volatile("");
}

/// Asks for one entry of several lists.
template <class... Lists>
void ask_for_entry(std::size_t place, const Lists&... lists) {
  (ask_for(lists.data() + place), ...);
}

}  // namespace drumlin::particles
