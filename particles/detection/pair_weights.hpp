#pragma once
// What a search finds of the pairs that it has listed, on vectors: their gaps, normals and approach.
#include <cstddef>
#include <cstdint>
#include <span>

namespace drumlin::particles {

/// Two bodies, i < j.
struct ListedPair {
  std::int32_t i, j;
};

/// Position and velocity of a body side by side, since pairs come in no order: one load.
struct alignas(32) MovingDisc {
  double x, z, v_x, v_z;
};

/// Gap, normal from j to i, and how far the pair may close, twice over: 2 h a.
struct alignas(32) PairWeight {
  double gap, n_x, n_z, reach;
};

/// Weighs pairs in an open domain, four at a time where the processor has vectors for that; returns how many
/// of them, from the first on. `twice_step`: 2 h. The numbers are those of near_pair().
std::size_t weigh_on_vectors(std::span<const ListedPair> pairs, const MovingDisc* discs, const double* radius,
                             double twice_step, PairWeight* weights);

}  // namespace drumlin::particles
