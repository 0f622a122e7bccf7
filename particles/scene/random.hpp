#pragma once
// Random numbers that are the same everywhere: one 64-bit seed, named streams, own map from bits to doubles
// (std::uniform_real_distribution differs between libraries).
#include <array>
#include <cstdint>
#include <string_view>

namespace drumlin::particles {

/// xoshiro256++ (Blackman and Vigna 2019), seeded through splitmix64 from the scene's seed and the stream's
/// name.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);
  std::uint64_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace drumlin::particles
