#pragma once
// A layer in shear as a map of tensors: a law of friction and a turn of the stress that are known.
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "coupling/calibration/law_points.hpp"

namespace drumlin::testing {

inline const coupling::FrictionForm logarithm{.formula = LogLaw{}};
inline const coupling::Coefficients truth{0.36, 0.014};
inline constexpr double turn = 0.05;  // of the stress, at every I

/// A layer under its own weight that shears ever more slowly downwards, turned by `angle` against the axes of
/// the map; noise of the stresses and of the gradient as shares of p and |D|, two neighbouring nodes alike.
/// `turn_at`: stress across the strain rate over the pressure, by 2|D|/sqrt(p).
inline FieldMap layer(
    double angle, double of_stress, double of_gradient, unsigned seed = 1,
    const std::function<double(double)>& turn_at = [](double) { return turn; }) {
  FieldMap map;
  map.grid = {-30, -40, 1, 1, 61, 40};
  map.header.drum_radius = map.header.axis_depth = map.header.rotation = 0;
  const std::vector<std::string> names{"nu",       "v_x",      "v_z",      "sigma_xx", "sigma_zz", "sigma_xz",
                                       "sigma_zx", "d_v_x_dx", "d_v_x_dz", "d_v_z_dx", "d_v_z_dz"};
  for (const std::string& name : names) map.fields.push_back({name, {}, {}});
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  const double c = std::cos(2 * angle), s = std::sin(2 * angle);
  std::array<double, 8> shaken_by{};
  for (std::size_t row = 0; row < map.grid.rows; ++row)
    for (std::size_t column = 0; column < map.grid.columns; ++column) {
      const double p = 0.8 * (1 - map.grid.z_of(row));
      const double I = 0.1 * std::exp(map.grid.z_of(row) / 7), D = 0.5 * I * std::sqrt(p);
      const double M = coupling::friction(logarithm, truth, I), N = turn_at(I);
      // Traceless tensors ((a, b), (b, -a)) turn by twice the angle.
      const double D_a = D * s, D_b = D * c;
      const double tau_a = p * (M * s - N * c), tau_b = p * (M * c + N * s);
      if (column % 2 == 0)
        for (double& z : shaken_by) z = normal(random);
      std::size_t next = 0;
      const auto shaken = [&](double value, double size) { return value + size * shaken_by[next++]; };
      const double e = of_gradient * D, f = of_stress * p;
      const double values[] = {0.8,
                               0,
                               0,
                               shaken(p - tau_a, f),
                               shaken(p + tau_a, f),
                               shaken(tau_b, f),
                               shaken(tau_b, f),
                               shaken(D_a, e),
                               shaken(D_b + 0.3 * D, e),
                               shaken(D_b - 0.3 * D, e),
                               shaken(-D_a, e)};
      for (std::size_t i = 0; i < names.size(); ++i) {
        map.fields[i].value.push_back(values[i]);
        if (i >= 3) map.fields[i].ci99.push_back(2.576 * (i < 7 ? f : e));
      }
    }
  return map;
}

inline const coupling::BlockSelection anywhere{.I_min = 1e-5, .I_max = 1, .wall_margin = 0};

}  // namespace drumlin::testing
