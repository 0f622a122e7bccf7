// What ranks tell each other arrives whole, also where it is cut into parts, as messages of more than 2 GB
// are.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "particles/distributed/ranks.hpp"

namespace drumlin::particles {
namespace {

/// Numbers of rank r for rank `to`, more of them from each rank than from the one before.
std::vector<std::int32_t> numbers(int r, int to) {
  std::vector<std::int32_t> some(static_cast<std::size_t>(7 * r + 3 * to));
  for (std::size_t k = 0; k < some.size(); ++k) some[k] = static_cast<std::int32_t>(1000 * r + 100 * to + k);
  return some;
}

/// Cuts messages into parts of so many bytes while it lives.
struct CutMessages {
  explicit CutMessages(std::size_t bytes) { Ranks::cut_messages(bytes); }
  ~CutMessages() { Ranks::cut_messages(std::size_t{1} << 30); }
};

TEST(Messages, ArriveWholeHoweverTheyAreCut) {
  const Ranks ranks;
  const int here = ranks.rank(), count = ranks.count();
  for (const std::size_t bytes : {1U, 3U, 16U, 1U << 30}) {
    const CutMessages cut(bytes);
    std::vector<std::vector<std::int32_t>> to_rank;
    for (int to = 0; to < count; ++to) to_rank.push_back(numbers(here, to));
    const auto received = ranks.exchange(to_rank);
    for (int from = 0; from < count; ++from) EXPECT_EQ(received[from], numbers(from, here)) << bytes;

    std::vector<std::int32_t> all;
    for (int from = 0; from < count; ++from) {
      const auto some = numbers(from, 1);
      all.insert(all.end(), some.begin(), some.end());
    }
    const auto own = numbers(here, 1);
    for (int on = 0; on < count; ++on) {
      const auto gathered = ranks.gather(std::span<const std::int32_t>(own), on);
      EXPECT_EQ(gathered, here == on ? all : std::vector<std::int32_t>{}) << bytes;
    }
    EXPECT_EQ(ranks.gather_everywhere(std::span<const std::int32_t>(own)), all) << bytes;
  }
}

}  // namespace
}  // namespace drumlin::particles
