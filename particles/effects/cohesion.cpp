#include "particles/effects/cohesion.hpp"

#include <numbers>

#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {

CohesionLaw cohesion_law(const Cohesion& key, const std::vector<std::string>& materials) {
  // Unit: the weight of a disc of diameter 1 and density 1 in gravity 1.
  return {pair_law(key, materials, std::numbers::pi / 4), key.range_d};
}

void attract(const CohesionLaw& law, std::span<const Candidate> pairs, const Bodies& bodies,
             const WallStep& walls, const MaterialsOf& materials, double h, FreeMotion& free,
             std::vector<double>& attraction) {
  attraction.resize(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Candidate& pair = pairs[p];
    const double pull = pair.gap < law.range ? h * value_of(law.force, pair.i, pair.j, materials) : 0;
    attraction[p] = pull;
    const double change = pull * bodies.inverse_mass[pair.i];
    free.x[pair.i] -= change * pair.n_x, free.z[pair.i] -= change * pair.n_z;
    if (const std::int32_t k = driven_wall_of(walls, pair); k >= 0) {
      const Driven& wall = walls.driven[k];
      free.driven[k] +=
          pull * wall.inverse_mass * (pair.n_x * wall.direction.x + pair.n_z * wall.direction.z);
    }
    if (pair.j < 0) continue;
    const double back = pull * bodies.inverse_mass[pair.j];
    free.x[pair.j] += back * pair.n_x, free.z[pair.j] += back * pair.n_z;
  }
}

}  // namespace drumlin::particles
