#include "particles/distributed/tile_wave.hpp"

#include <algorithm>
#include <utility>

namespace drumlin::particles {
namespace {

/// Cuts the strips of a share into parts of about equal numbers of contacts.
void cut_into(std::span<const TileRange> tiles, const TileOrder& order, const StripShare& whole, int parts,
              std::vector<StripShare>& shares) {
  const auto append = [&](StripShare share) {
    share.fewest = share.end - share.first;
    shares.push_back(share);
  };
  const auto contacts_up_to = [&](int strip) {  // its own included
    const std::int32_t end = order.strips[strip].phases[1].end;
    return end > 0 ? std::int64_t{tiles[end - 1].end} : 0;
  };
  const std::int64_t before = whole.first > 0 ? contacts_up_to(whole.first - 1) : 0;
  const std::int64_t all = contacts_up_to(whole.end - 1) - before;
  StripShare share = whole;
  for (int part = 1; part < parts; ++part) {
    share.end = share.first;
    while (share.end < whole.end && contacts_up_to(share.end) - before < all * part / parts) ++share.end;
    share.right = true;
    append(share);
    share.first = share.end, share.left = true;
  }
  share.end = whole.end, share.right = whole.right;
  append(share);
}

}  // namespace

std::vector<StripShare> shares_between_borders(std::span<const TileRange> tiles, const TileOrder& order,
                                               int sweeps, int threads) {
  std::vector<StripShare> shares;
  const int count = static_cast<int>(order.strips.size());
  for (int first = 0, end = 0; first < count; first = end + 1) {
    end = first;
    while (end < count && !order.strips[end].border) ++end;
    if (end == first) continue;
    StripShare share;
    share.first = first, share.end = end;
    share.left = first > 0, share.right = end < count;
    cut_into(tiles, order, share, end - first >= 2 * sweeps * threads ? threads : 1, shares);
  }
  return shares;
}

bool LeftOfSweep::nothing() const {
  return strips.empty() && std::all_of(rounds.begin(), rounds.end(), [](const TileRound& round) {
           return round.border.empty() && round.inner.empty();
         });
}

LeftOfSweep left_of_sweep(std::span<const TileRange> tiles, const TileOrder& order,
                          std::span<const StripShare> shares, int s) {
  LeftOfSweep left;
  for (int strip = 0; strip < std::ssize(order.strips); ++strip)
    for (const int phase : {0, 1}) {
      const bool done = std::any_of(shares.begin(), shares.end(), [&](const StripShare& share) {
        return alone(share, s, phase).holds(strip);
      });
      if (done) continue;
      if (phase == 0) left.strips.push_back(strip);
      const auto [begin, end] = order.strips[strip].phases[phase];
      for (std::int32_t t = begin; t < end; ++t) left.rounds[tiles[t].colour].add(t, tiles[t].border);
    }
  return left;
}

WavePlan wave_plan(std::span<const TileRange> tiles, const TileOrder& order, std::vector<StripShare> shares,
                   int sweeps) {
  WavePlan plan{std::move(shares), {}};
  for (int s = 0; s < sweeps; ++s) plan.left.push_back(left_of_sweep(tiles, order, plan.shares, s));
  return plan;
}

}  // namespace drumlin::particles
