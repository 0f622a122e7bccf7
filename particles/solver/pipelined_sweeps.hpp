#pragma once
// Several sweeps over strips at once: the order in which their phases are done, so that strips stay in the
// caches from one sweep to the next.
#include <algorithm>

namespace drumlin::particles {

/// Most sweeps of a pipeline.
inline constexpr int longest_pipeline = 5;

/// The strips of one thread of a rank, and how many the thread with the fewest has.
struct StripShare {
  int first = 0, end = 0, fewest = 0;
  bool left = false, right = false;  ///< whether strips of others come before and after

  /// Whether so many sweeps go through it together; else, and where it is empty, they are taken in turn.
  bool is_pipelined(int sweeps) const {
    return first < end && sweeps > 1 && ((!left && !right) || fewest >= 2 * sweeps);
  }
};

/// Strips first to end - 1.
struct StripRange {
  int first = 0, end = 0;
  bool holds(int strip) const { return strip >= first && strip < end; }
};

/// The strips on which a share takes a phase of sweep s of a pipeline without the shares beside it.
inline StripRange alone(const StripShare& share, int s, int phase) {
  return {share.first + (share.left ? s : 0), share.end - (share.right ? s + phase : 0)};
}

/// A share's part of a pipeline that needs nothing of the shares beside it: part(s, strip, phase) does a
/// phase of sweep s on a strip.
template <class Part>
void sweep_alone(const StripShare& share, int sweeps, Part part) {
  for (int front = share.first; front < share.end + sweeps; ++front)
    for (int s = 0; s < sweeps; ++s)
      for (const int phase : {0, 1})
        if (const int strip = front - s - phase; alone(share, s, phase).holds(strip)) part(s, strip, phase);
}

/// strips: tells first_strip(rank, thread, threads), and the ranks() that share them, as StripProblem does.
/// Whether sweeps are pipelined follows from the `size` of the pool: all ranks must agree.
template <class Strips>
StripShare share_of(const Strips& strips, int thread, int threads, int size) {
  const int rank = strips.rank(), ranks = strips.ranks();
  StripShare share{strips.first_strip(rank, thread, threads), strips.first_strip(rank, thread + 1, threads)};
  share.left = thread > 0 || rank > 0, share.right = thread + 1 < threads || rank + 1 < ranks;
  share.fewest = strips.strips();
  for (int r = 0; r < ranks; ++r)
    for (int t = 0; t < size; ++t)
      share.fewest =
          std::min(share.fewest, strips.first_strip(r, t + 1, size) - strips.first_strip(r, t, size));
  return share;
}

/// One thread's share of a number of sweeps over strips, which meets the others by calling meet(phase) after
/// each phase; part(s, strip, phase) does a phase of sweep s on a strip.
///
/// Every strip sees the phases in the order of the sweeps: phase 0 of a strip comes after phase 1 of the
/// sweep before on it and on the strip before, phase 1 after phase 0 on it and on the next strip. Nothing
/// else ties strips together, so that the next sweep may follow one strip behind: the result is that of
/// sweeps in turn. Where two shares meet, each leaves out what would need the other's, and does it in turn
/// with the other. Shares that are too narrow for it take the sweeps in turn.
template <class Part, class Meet>
void pipelined_sweeps(const StripShare& share, int sweeps, Part part, Meet meet) {
  const bool pipeline = share.is_pipelined(sweeps);
  if (pipeline) sweep_alone(share, sweeps, part);
  for (int s = 0; s < sweeps; ++s)
    for (const int phase : {0, 1}) {
      const StripRange done = pipeline ? alone(share, s, phase) : StripRange{share.first, share.first};
      for (int strip = share.first; strip < done.first; ++strip) part(s, strip, phase);
      for (int strip = done.end; strip < share.end; ++strip) part(s, strip, phase);
      meet(phase);
    }
}

}  // namespace drumlin::particles
