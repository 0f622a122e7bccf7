#include "particles/measurement/motion_difference.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "particles/measurement/frame/moments.hpp"

namespace drumlin::particles {
namespace {

constexpr double side_of_square = 4;  // d: some sixteen grains

struct VectorField {
  std::vector<double> x, z;
};

VectorField difference(const std::vector<double>& x, const std::vector<double>& z,
                       const std::vector<double>& x0, const std::vector<double>& z0) {
  VectorField d{x, z};
  for (std::size_t b = 0; b < x.size(); ++b) d.x[b] -= x0[b], d.z[b] -= z0[b];
  return d;
}

double mean_square(const Bodies& bodies, const VectorField& v) {
  double sum = 0, mass = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double m = 1 / bodies.inverse_mass[b];
    sum += m * (v.x[b] * v.x[b] + v.z[b] * v.z[b]);
    mass += m;
  }
  return sum / mass;
}

// What no rigid motion of all grains explains; rotations are small or velocities.
VectorField without_rigid_part(const Bodies& at, VectorField v) {
  double mass = 0, x = 0, z = 0, v_x = 0, v_z = 0;
  for (std::size_t b = 0; b < at.count(); ++b) {
    const double m = 1 / at.inverse_mass[b];
    mass += m, x += m * at.x[b], z += m * at.z[b], v_x += m * v.x[b], v_z += m * v.z[b];
  }
  x /= mass, z /= mass, v_x /= mass, v_z /= mass;
  double inertia = 0, momentum = 0;
  for (std::size_t b = 0; b < at.count(); ++b) {
    const double m = 1 / at.inverse_mass[b], dx = at.x[b] - x, dz = at.z[b] - z;
    inertia += m * (dx * dx + dz * dz);
    momentum += m * (dz * (v.x[b] - v_x) - dx * (v.z[b] - v_z));
  }
  const double spin = momentum / inertia;
  for (std::size_t b = 0; b < at.count(); ++b) {
    v.x[b] -= v_x + spin * (at.z[b] - z);
    v.z[b] -= v_z - spin * (at.x[b] - x);
  }
  return v;
}

// Every grain gets the mean of its square.
VectorField averaged(const Bodies& at, const VectorField& v) {
  const auto square_of = [&](std::size_t b) {
    return std::pair(std::floor(at.x[b] / side_of_square), std::floor(at.z[b] / side_of_square));
  };
  std::map<std::pair<double, double>, Spread<2>> sums;
  for (std::size_t b = 0; b < at.count(); ++b)
    sums[square_of(b)].add(1 / at.inverse_mass[b], {v.x[b], v.z[b]});
  VectorField mean = v;
  for (std::size_t b = 0; b < at.count(); ++b) {
    const Spread<2>& sum = sums.at(square_of(b));
    mean.x[b] = sum.mean(0), mean.z[b] = sum.mean(1);
  }
  return mean;
}

/// The grains of one state that are in two others too.
Bodies shared(Bodies bodies, const Bodies& a, const Bodies& b) {
  std::vector<std::uint8_t> keep;
  for (const std::int64_t id : bodies.id)
    keep.push_back(std::binary_search(a.id.begin(), a.id.end(), id) &&
                   std::binary_search(b.id.begin(), b.id.end(), id));
  keep_bodies(keep, bodies);
  return bodies;
}

}  // namespace

MotionDifference motion_difference(const Bodies& start, const Bodies& reference, const Bodies& other) {
  if (!start.id.empty() && !(start.id == reference.id && start.id == other.id))
    return motion_difference(shared(start, reference, other), shared(reference, start, other),
                             shared(other, start, reference));
  const VectorField velocity = without_rigid_part(start, {reference.v_x, reference.v_z});
  const VectorField path = without_rigid_part(start, difference(reference.x, reference.z, start.x, start.z));
  const VectorField apart = difference(other.x, other.z, reference.x, reference.z);
  const auto relative = [&](const VectorField& d, const VectorField& of) {
    return std::sqrt(mean_square(start, d) / mean_square(start, of));
  };
  return {relative(difference(other.v_x, other.v_z, reference.v_x, reference.v_z), velocity),
          relative(apart, path), relative(averaged(start, apart), averaged(start, path)),
          std::abs(kinetic_energy(other) / kinetic_energy(reference) - 1)};
}

}  // namespace drumlin::particles
