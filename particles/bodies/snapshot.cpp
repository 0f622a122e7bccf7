#include "particles/bodies/snapshot.hpp"

#include <numbers>

#include "particles/bodies/bodies.hpp"

namespace drumlin::particles {

double mass_of(const Snapshot& snapshot, std::size_t grain) {
  const double r = snapshot.radius[grain];
  if (snapshot.spheres) return 4 * std::numbers::pi / 3 * r * r * r / snapshot.spheres->depth;
  return snapshot.mass.empty() ? mass_of_disc(r) : snapshot.mass[grain];
}

std::vector<SameGrain> same_grains(const Snapshot& before, const Snapshot& now) {
  return same_grains(before.id, before.x.size(), now.id, now.x.size());
}

std::vector<SameGrain> same_grains(std::span<const std::int64_t> id_before, std::size_t count_before,
                                   std::span<const std::int64_t> id_now, std::size_t count_now) {
  std::vector<SameGrain> same;
  if (id_before.empty() && id_now.empty()) {
    if (count_before == count_now)
      for (std::size_t i = 0; i < count_now; ++i) same.push_back({i, i});
    return same;
  }
  for (std::size_t a = 0, b = 0; a < id_before.size() && b < id_now.size();) {
    if (id_before[a] == id_now[b]) same.push_back({a, b});
    const bool first = id_before[a] <= id_now[b], second = id_now[b] <= id_before[a];
    a += first, b += second;
  }
  return same;
}

}  // namespace drumlin::particles
