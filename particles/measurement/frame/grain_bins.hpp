#pragma once
// Whole grains in bins, and binnings that need no geometry: everything in one region, and each grain for
// itself, with its half branches.
#include "particles/measurement/frame/accumulate.hpp"

namespace drumlin::particles {

/// Moments with the area of the grains and their motion by mass; with places where N = 2 D.
template <int D, int N = D>
struct WholeGrainSum : Moments<D, N> {
  void add_part(double area, const GrainSample<D>&) { this->solid += area; }
  void add_centre(double weight, const GrainSample<D>& grain) {
    Moments<D, N>::add_centre(weight, grain);
    Vector<N> q;
    std::copy(grain.velocity.begin(), grain.velocity.end(), q.begin());
    if constexpr (N == 2 * D) std::copy(grain.at.begin(), grain.at.end(), q.begin() + D);
    this->motion.add(weight * grain.mass(), q);
  }
};
using GrainSum = WholeGrainSum<2>;

template <bool each_for_itself>
struct WholeGrains {
  static std::size_t bin_of(std::size_t grain) { return each_for_itself ? grain : 0; }
  void each_part(const auto& grain, auto action) const { action(bin_of(grain.index), grain.area()); }
  void each_centre(const auto& grain, auto action) const { action(bin_of(grain.index), 1.0, grain); }
  void each_share(const auto& branch, auto action) const { action(bin_of(branch.grain), 1.0, branch); }
};
using Everywhere = WholeGrains<false>;
using EachGrain = WholeGrains<true>;  ///< the region of a grain is its Voronoi cell

/// Of each grain of a snapshot.
inline std::vector<GrainSum> sums_of_grains(const FlowSnapshot& snapshot) {
  std::vector<GrainSum> sums(snapshot.x.size());
  accumulate(snapshot, EachGrain{}, sums);
  return sums;
}

}  // namespace drumlin::particles
