// Pairs weighed on vectors are those weighed one by one.
#include "particles/detection/pair_weights.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "particles/detection/grain_pairs.hpp"
#include "particles/scene/random.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(PairWeights, OnVectorsAreThoseOfTheSinglePairs) {
  constexpr std::int32_t bodies = 40;
  RandomStream random(5, "test");
  std::vector<MovingDisc> discs;
  std::vector<double> radius;
  std::vector<NearGrain> grains;
  for (std::int32_t b = 0; b < bodies; ++b) {
    discs.push_back({random.uniform(), random.uniform(), random.uniform() - 0.5, random.uniform() - 0.5});
    radius.push_back(0.4 + 0.2 * random.uniform());
  }
  discs[7] = discs[3];                               // at the same place, with the same velocity
  discs[9].x = discs[3].x, discs[9].z = discs[3].z;  // with another one
  for (std::int32_t b = 0; b < bodies; ++b)
    grains.push_back({discs[b].x, discs[b].z, radius[b], discs[b].v_x, discs[b].v_z, b});
  std::vector<ListedPair> pairs;
  for (std::int32_t i = 0; i < bodies; ++i)
    for (std::int32_t j = i + 1; j < bodies; j += 1 + (i + j) % 3) pairs.push_back({i, j});
  pairs.push_back({3, 7}), pairs.push_back({3, 9}), pairs.push_back({7, 9}), pairs.push_back({0, 1});
  pairs.resize(pairs.size() / 4 * 4 + 3, {1, 2});
  std::vector<PairWeight> weights(pairs.size());
  const std::size_t done = weigh_on_vectors(pairs, discs.data(), radius.data(), 0.1, weights.data());
  EXPECT_TRUE(done == 0 || done == pairs.size() - 3);
  for (std::size_t k = 0; k < done; ++k) {
    const NearPair one = near_pair(grains[pairs[k].i], grains[pairs[k].j], {}, 0.05);
    EXPECT_EQ(weights[k].gap, one.gap) << k;
    EXPECT_EQ(std::pair(weights[k].n_x, weights[k].n_z), std::pair(one.n_x, one.n_z)) << k;
    EXPECT_EQ(weights[k].reach, one.reach) << k;
  }
}

}  // namespace
}  // namespace drumlin
