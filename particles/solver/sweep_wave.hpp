#pragma once
// Several sweeps over strips at once: the order in which their phases are done, so that strips stay in the
// caches from one sweep to the next.
#include <algorithm>

namespace drumlin::particles {

/// Most sweeps of a wave.
inline constexpr int longest_wave = 5;

/// The strips of one thread of a team, and how many the thread with the fewest has.
struct StripShare {
  int first = 0, end = 0, fewest = 0;
  bool left = false, right = false;  ///< whether another thread's strips come before and after

  /// Whether so many sweeps go through it together; else they are taken in turn.
  bool takes_wave(int sweeps) const { return sweeps > 1 && ((!left && !right) || fewest >= 2 * sweeps); }
};

/// Strips first to end - 1.
struct StripRange {
  int first = 0, end = 0;
  bool holds(int strip) const { return strip >= first && strip < end; }
};

/// The strips on which a share takes a phase of sweep s of a wave without the shares beside it.
inline StripRange alone(const StripShare& share, int s, int phase) {
  return {share.first + (share.left ? s : 0), share.end - (share.right ? s + phase : 0)};
}

/// A share's part of a wave that needs nothing of the shares beside it: part(s, strip, phase) does a phase of
/// sweep s on a strip.
template <class Part>
void sweep_alone(const StripShare& share, int sweeps, Part part) {
  for (int front = share.first; front < share.end + sweeps; ++front)
    for (int s = 0; s < sweeps; ++s)
      for (const int phase : {0, 1})
        if (const int strip = front - s - phase; alone(share, s, phase).holds(strip)) part(s, strip, phase);
}

/// strips: tells first_strip(thread, threads), as StripProblem does.
template <class Strips>
StripShare share_of(const Strips& strips, int thread, int threads) {
  StripShare share{strips.first_strip(thread, threads), strips.first_strip(thread + 1, threads)};
  share.left = thread > 0, share.right = thread + 1 < threads;
  share.fewest = share.end - share.first;
  for (int t = 0; t < threads && threads > 1; ++t)
    share.fewest =
        std::min(share.fewest, strips.first_strip(t + 1, threads) - strips.first_strip(t, threads));
  return share;
}

/// One thread's share of a number of sweeps over strips, which meets the others by calling meet();
/// part(s, strip, phase) does a phase of sweep s on a strip.
///
/// Every strip sees the phases in the order of the sweeps: phase 0 of a strip comes after phase 1 of the
/// sweep before on it and on the strip before, phase 1 after phase 0 on it and on the next strip. Nothing
/// else ties strips together, so that the next sweep may follow one strip behind: the result is that of
/// sweeps in turn. Where the shares of two threads meet, each leaves out what would need the other's; one of
/// them does that after they have met. Shares that are too narrow for it take the sweeps in turn.
template <class Part, class Meet>
void sweep_wave(const StripShare& share, int sweeps, Part part, Meet meet) {
  const int first = share.first, end = share.end;
  if (!share.takes_wave(sweeps)) {
    for (int s = 0; s < sweeps; ++s)
      for (const int phase : {0, 1}) {
        for (int strip = first; strip < end; ++strip) part(s, strip, phase);
        meet();
      }
    return;
  }
  sweep_alone(share, sweeps, part);
  meet();
  if (share.right)
    for (int s = 0; s < sweeps; ++s) {
      for (int strip = end - s; strip < end + s; ++strip) part(s, strip, 0);
      for (int strip = end - s - 1; strip < end + s; ++strip) part(s, strip, 1);
    }
  meet();
}

}  // namespace drumlin::particles
