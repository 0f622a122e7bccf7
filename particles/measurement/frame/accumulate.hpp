#pragma once
// The way of a snapshot into bins: one for all of them.
#include <cstddef>

#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Puts a grain into bins. A binning is geometry alone, and calls action(bin, ...) for each bin that
/// something belongs to; what a bin makes of it, it knows itself:
///   each_part(grain, action(bin, area))              parts of a grain's area; bins.add_part(area, grain)
///   each_centre(grain, action(bin, weight, grain))   its centre, the grain as the bin sees it; add_centre()
///   each_share(branch, action(bin, share, branch))   the shares of a half branch; add_share()
///   each_end(branch, action(bin, weight, branch))    what counts at one point of a contact; add_end()
/// A binning without parts or ends is for bins that ask for none.
template <int D, class Binning, class Bins>
void add_grain(const GrainSample<D>& grain, Binning& binning, Bins& bins) {
  if constexpr (requires { binning.each_part(grain, [](std::size_t, double) {}); })
    binning.each_part(grain, [&](auto bin, double area) { bins[bin].add_part(area, grain); });
  binning.each_centre(grain, [&](auto bin, const auto& weight, const GrainSample<D>& seen) {
    bins[bin].add_centre(weight, seen);
  });
}

template <int D, class Binning, class Bins>
void add_branch(const HalfBranch<D>& branch, Binning& binning, Bins& bins) {
  binning.each_share(
      branch, [&](auto bin, double share, const HalfBranch<D>& seen) { bins[bin].add_share(share, seen); });
  if constexpr (requires { binning.each_end(branch, [](auto, double, const HalfBranch<D>&) {}); })
    binning.each_end(
        branch, [&](auto bin, double weight, const HalfBranch<D>& seen) { bins[bin].add_end(weight, seen); });
}

/// All grains, then all half branches.
template <class Binning, class Bins>
void accumulate(const FlowSnapshot& snapshot, Binning&& binning, Bins& bins) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i)
    if (snapshot.shows(i)) add_grain(snapshot.grain(i), binning, bins);
  snapshot.each_half_branch([&](const HalfBranch<2>& branch) { add_branch(branch, binning, bins); });
}

}  // namespace drumlin::particles
