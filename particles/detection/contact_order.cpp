#include "particles/detection/contact_order.hpp"

#include <array>
#include <bit>

namespace drumlin {

void ContactOrder::sort(std::span<const Candidate> pairs, std::size_t bodies) {
  // One bit per colour and body; a body with more than 63 contacts puts the rest into the last colour, where
  // order still is fixed but neighbours may share it.
  constexpr int colours = 64;
  used_.assign(bodies, 0);
  colour_.resize(pairs.size());
  std::array<std::int32_t, colours + 1> start{};
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto& pair = pairs[p];
    const std::uint64_t taken = used_[pair.i] | (pair.j >= 0 ? used_[pair.j] : 0);
    const int colour = std::min(std::countr_one(taken), colours - 1);
    const std::uint64_t bit = std::uint64_t{1} << colour;
    used_[pair.i] |= bit;
    if (pair.j >= 0) used_[pair.j] |= bit;
    colour_[p] = colour;
    ++start[colour + 1];
  }
  for (int c = 0; c < colours; ++c) start[c + 1] += start[c];
  place.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) place[start[colour_[p]]++] = static_cast<std::int32_t>(p);
}

}  // namespace drumlin
