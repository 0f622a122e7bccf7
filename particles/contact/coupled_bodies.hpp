#pragma once
// Bodies that many contacts push at once: walls that a force moves, and a cell under pressure. A scene has
// few or none of them.
#include <array>
#include <cmath>

namespace drumlin::particles {

/// A wall that moves along one direction, with a mass of its own; its velocity across is prescribed.
struct DrivenBody {
  double e_x = 0, e_z = 0;  ///< unit vector
  double inverse_mass = 0;

  /// Adds the opposite of an impulse on its grain.
  template <class Body>
  void push(const std::array<double, 2>& p, Body& wall) const {
    const double along = (p[0] * e_x + p[1] * e_z) * inverse_mass;
    wall.x -= along * e_x, wall.z -= along * e_z;
  }
};

/// A periodic cell whose rates of strain answer contacts: it gives each the rate times its arm.
struct CellBody {
  double inverse_inertia_x = 0, inverse_inertia_z = 0;
  double length_x = 1, length_z = 1;

  /// Adds to the rates what an impulse does at an arm.
  template <class Body>
  void push(const std::array<double, 2>& p, double arm_x, double arm_z, Body& rates) const {
    rates.x += inverse_inertia_x * arm_x * p[0];
    rates.z += inverse_inertia_z * arm_z * p[1];
  }
  /// Sum of the sizes of what crosses it.
  template <class Body>
  double impulses(const Body& rates) const {
    const auto across = [](double rate, double inverse_inertia, double length) {
      return inverse_inertia > 0 ? std::abs(rate) / (inverse_inertia * length) : 0;
    };
    return across(rates.x, inverse_inertia_x, length_x) + across(rates.z, inverse_inertia_z, length_z);
  }
};

}  // namespace drumlin::particles
