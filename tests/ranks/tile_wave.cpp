// Waves over strips of tiles: what they and what is left of them do is what sweeps in turn do.
#include "particles/distributed/tile_wave.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace drumlin::particles {
namespace {

/// Strips of up to four tiles, one of each colour, some left out; `border`: of each strip.
struct Tiling {
  std::vector<TileRange> tiles;
  TileOrder order;
};

Tiling tiling(const std::vector<bool>& border, std::mt19937& random) {
  Tiling made;
  std::int32_t contacts = 0;
  for (std::size_t k = 0; k < border.size(); ++k) {
    TileStrip strip;
    strip.border = border[k];
    for (int phase : {0, 1}) {
      strip.phases[phase].begin = static_cast<std::int32_t>(made.tiles.size());
      for (int colour : {2 * phase, 2 * phase + 1}) {
        if (random() % 8 == 0) continue;
        const auto count = static_cast<std::int32_t>(1 + random() % 5);
        made.tiles.push_back({0, contacts, contacts + count, colour, border[k] && random() % 2 == 0});
        contacts += count;
      }
      strip.phases[phase].end = static_cast<std::int32_t>(made.tiles.size());
    }
    made.order.strips.push_back(strip);
  }
  made.order.rounds = rounds_of(made.tiles);
  return made;
}

/// What is done to the bodies in the left and the right half of each strip; whoever comes too early or too
/// late makes something else.
class Trace {
 public:
  explicit Trace(const Tiling& tiling) : tiling_(tiling), bodies_(2 * tiling.order.strips.size() + 1) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) bodies_[k] = k;
  }
  void go_on(int s, int strip) { mix(bodies_[2 * strip], 1000 + s), mix(bodies_[2 * strip + 1], 1000 + s); }
  /// Contacts of even columns touch the bodies of their strip; those of odd ones its right half and the left
  /// one of the next strip.
  void sweep(int s, std::int32_t tile) {
    const int strip = strip_of(tile), colour = tiling_.tiles[tile].colour;
    const std::size_t first = 2 * strip + colour / 2;
    mix(bodies_[first], 10 * s + colour), mix(bodies_[first + 1], 10 * s + colour + 5);
  }
  const std::vector<std::uint64_t>& bodies() const { return bodies_; }

 private:
  int strip_of(std::int32_t tile) const {
    int strip = 0;
    while (tiling_.order.strips[strip].phases[1].end <= tile) ++strip;
    return strip;
  }
  static void mix(std::uint64_t& body, int what) {
    body = 6364136223846793005U * (body ^ (body >> 7U)) + static_cast<std::uint64_t>(what) + 1;
  }
  const Tiling& tiling_;
  std::vector<std::uint64_t> bodies_;
};

void take_rounds(const TileRounds& rounds, int s, Trace& trace) {
  for (const TileRound& round : rounds)
    for (const auto* tiles : {&round.border, &round.inner})
      for (const std::int32_t t : *tiles) trace.sweep(s, t);
}

std::vector<std::uint64_t> in_turn(const Tiling& tiling, int sweeps) {
  Trace trace(tiling);
  for (int s = 0; s < sweeps; ++s) {
    for (int strip = 0; strip < std::ssize(tiling.order.strips); ++strip) trace.go_on(s, strip);
    take_rounds(tiling.order.rounds, s, trace);
  }
  return trace.bodies();
}

std::vector<std::uint64_t> in_a_wave(const Tiling& tiling, int sweeps, int threads) {
  Trace trace(tiling);
  const auto& [tiles, order] = tiling;
  const auto shares = shares_between_borders(tiles, order, sweeps, threads);
  for (const StripShare& share : shares)
    sweep_alone(share, sweeps, [&](int s, int strip, int phase) {
      EXPECT_FALSE(order.strips[strip].border);
      if (phase == 0) trace.go_on(s, strip);
      for (std::int32_t t = order.strips[strip].phases[phase].begin;
           t < order.strips[strip].phases[phase].end; ++t)
        trace.sweep(s, t);
    });
  const WavePlan plan = wave_plan(tiles, order, shares, sweeps);
  for (int s = 0; s < sweeps; ++s) {
    const LeftOfSweep& left = plan.left[s];
    for (const std::int32_t strip : left.strips) trace.go_on(s, strip);
    take_rounds(left.rounds, s, trace);
  }
  return trace.bodies();
}

TEST(TileWave, DoesWhatSweepsInTurnDo) {
  std::mt19937 random(3);
  int shares = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<bool> border(1 + random() % 40);
    const auto rarely = 1 + random() % 20;
    for (auto&& b : border) b = random() % rarely == 1;
    const Tiling made = tiling(border, random);
    for (const int sweeps : {1, 2, 5})
      for (const int threads : {1, 2, 3}) {
        EXPECT_EQ(in_a_wave(made, sweeps, threads), in_turn(made, sweeps)) << trial;
        shares += static_cast<int>(shares_between_borders(made.tiles, made.order, sweeps, threads).size());
      }
  }
  EXPECT_GT(shares, 400 * 9);
}

TEST(TileWave, LeavesNothingToMessagesOfARankAlone) {
  std::mt19937 random(4);
  const Tiling alone = tiling(std::vector<bool>(30, false), random);
  const auto shares = shares_between_borders(alone.tiles, alone.order, 5, 1);
  ASSERT_EQ(shares.size(), 1U);
  for (int s = 0; s < 5; ++s) EXPECT_TRUE(left_of_sweep(alone.tiles, alone.order, shares, s).nothing());
}

TEST(TileWave, CutsSharesOfAboutEqualNumbersOfContacts) {
  std::mt19937 random(5);
  const Tiling made = tiling(std::vector<bool>(60, false), random);
  const auto shares = shares_between_borders(made.tiles, made.order, 5, 3);
  ASSERT_EQ(shares.size(), 3U);
  for (const StripShare& share : shares) EXPECT_NEAR(share.end - share.first, 20, 5);
  EXPECT_EQ(shares[0].end, shares[1].first);
  EXPECT_EQ(shares[2].end, 60);
}

}  // namespace
}  // namespace drumlin::particles
