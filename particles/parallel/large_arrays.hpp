#pragma once
// Where large arrays have their memory from.

namespace drumlin::particles {

/// Lets each array of so many bytes or more have pages of its own, which go back to the system with it. Else
/// the C library learns from the arrays of the start to cut later ones from its heap, where holes between
/// them stay.
void release_large_arrays(int bytes);

}  // namespace drumlin::particles
