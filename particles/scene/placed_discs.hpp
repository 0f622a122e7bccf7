#pragma once
// Discs that have found their places, by cells, so that those near a place are found at once.
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "particles/effects/key_ranges.hpp"

namespace drumlin::particles {

/// Discs by octave of size, each octave in cells of its largest diameter. Cells share the lists of a table: a
/// disc of another cell is looked at in vain, but does no harm.
class PlacedDiscs {
 public:
  struct Disc {
    Point_mm center;
    double radius;
    std::int32_t next;  ///< of the same list; -1: the last
  };

  /// With room for discs of these radii.
  explicit PlacedDiscs(std::span<const double> radii) {
    std::map<int, std::size_t> count;
    for (const double radius : radii) ++count[octave_of(radius)];
    for (const auto& [octave, discs] : count) octaves_[octave].assign(std::bit_ceil(2 * discs), -1);
    discs_.reserve(radii.size());
  }

  void add(const Point_mm& center, double radius) {
    const int octave = octave_of(radius);
    Lists& lists = octaves_.at(octave);
    std::int32_t& first = lists[list(lists, cell(center[0], octave), cell(center[1], octave))];
    discs_.push_back({center, radius, first});
    first = static_cast<std::int32_t>(discs_.size()) - 1;
  }

  /// Calls see(disc), until it returns true, with all discs that reach into a box, and with others near it.
  /// Returns whether it did.
  template <class See>
  bool any_near(const Point_mm& low, const Point_mm& high, const See& see) const {
    for (auto entry = octaves_.rbegin(); entry != octaves_.rend(); ++entry) {  // the largest fill most
      const auto& [octave, lists] = *entry;
      const double reach = size(octave) / 2;
      const auto right = cell(high[0] + reach, octave), top = cell(high[1] + reach, octave);
      for (auto x = cell(low[0] - reach, octave); x <= right; ++x)
        for (auto z = cell(low[1] - reach, octave); z <= top; ++z)
          for (std::int32_t d = lists[list(lists, x, z)]; d >= 0; d = discs_[d].next)
            if (see(discs_[d])) return true;
    }
    return false;
  }

  /// Whether a disc would overlap none of them.
  bool free(const Point_mm& center, double radius) const {
    return !any_near({center[0] - radius, center[1] - radius}, {center[0] + radius, center[1] + radius},
                     [&](const Disc& disc) { return overlap(disc, center, radius); });
  }

 private:
  using Lists = std::vector<std::int32_t>;  // the disc that each begins with; -1: none
  static int octave_of(double radius) { return std::ilogb(2 * radius); }
  static double size(int octave) { return std::ldexp(1.0, octave + 1); }
  static std::int64_t cell(double x, int octave) {
    const double place = x / size(octave);
    const auto towards_0 = static_cast<std::int64_t>(place);
    return towards_0 - (place < static_cast<double>(towards_0));
  }
  static std::size_t list(const Lists& lists, std::int64_t x, std::int64_t z) {
    const auto mixed = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                       static_cast<std::uint64_t>(z) * 0xc2b2ae3d27d4eb4fu;
    return static_cast<std::size_t>(mixed ^ mixed >> 32) & (lists.size() - 1);
  }
  static bool overlap(const Disc& disc, const Point_mm& center, double radius) {
    const double dx = disc.center[0] - center[0], dz = disc.center[1] - center[1], sum = disc.radius + radius;
    return dx * dx + dz * dz < 1.000001 * sum * sum && std::hypot(dx, dz) < sum;
  }

  std::vector<Disc> discs_;
  std::map<int, Lists> octaves_;
};

}  // namespace drumlin::particles
