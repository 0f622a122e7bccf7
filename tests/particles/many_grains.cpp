#include "tests/particles/many_grains.hpp"

#include <cmath>

namespace drumlin::test {

using particles::RandomStream;

void Grains::add(double x, double z, double radius, double speed_x, double speed_z) {
  particles::add_body(bodies, x, z, radius);
  v_x.push_back(speed_x), v_z.push_back(speed_z);
}

Grains packed(int count, double smallest, double speed, RandomStream& random) {
  Grains g;
  const int side = static_cast<int>(std::sqrt(count));
  for (int k = 0; k < count; ++k) {
    const double x = k % side + random.uniform(-0.1, 0.1);
    const double z = static_cast<double>(k / side) + random.uniform(-0.1, 0.1);
    const double radius = random.uniform(smallest / 2, 0.5), v_x = random.uniform(-speed, speed);
    g.add(x, z, radius, v_x, random.uniform(-speed, speed));
  }
  return g;
}

Grains flowing(int count, RandomStream& random) {
  Grains g = packed(count, 0.8, 0.5, random);
  for (std::size_t b = 0; b < g.count(); ++b) g.v_x[b] += 0.3 * g.bodies.z[b];
  return g;
}

Grains all_fall(int count, RandomStream& random) {
  Grains g = packed(count, 0.8, 0.5, random);
  for (double& v : g.v_z) v -= 1000 / grains_time_step;
  return g;
}

Grains falling(int count, RandomStream& random) {
  Grains g = packed(count, 0.8, 0.5, random);
  const double middle = std::sqrt(count) / 2;
  for (std::size_t b = 0; b < g.count(); ++b)
    if (g.bodies.z[b] > middle) g.v_z[b] -= 1 / grains_time_step;
  return g;
}

Grains with_stray(int count, RandomStream& random) {
  Grains g = packed(count, 0.8, 0.5, random);
  g.add(1e7, 1e7, 0.5, 0, 0);
  return g;
}

Grains scattered(int count, RandomStream& random) {
  Grains g;
  const double side = 6 * std::sqrt(count), speed = 2 / grains_time_step;
  for (int k = 0; k < count; ++k) {
    const double x = random.uniform(0, side), z = random.uniform(0, side);
    const double radius = random.uniform(0.4, 0.5), v_x = random.uniform(-speed, speed);
    g.add(x, z, radius, v_x, random.uniform(-speed, speed));
  }
  return g;
}

Grains unlike(int count, RandomStream& random) {
  constexpr int small_ones = 50;
  Grains g;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(count) / (small_ones + 1))) + 1;
  for (int k = 0; static_cast<int>(g.count()) < count; ++k) {
    const double x = 2.0 * (k % side), z = static_cast<double>(k / side);
    g.add(x, z, random.uniform(0.4, 0.5), 0, 0);
    for (int s = 0; s < small_ones; ++s)
      g.add(x + 0.6 + 0.1 * (s % 8), z - 0.4 + 0.1 * static_cast<double>(s / 8), random.uniform(0.04, 0.05),
            0, 0);
  }
  return g;
}

}  // namespace drumlin::test
