#pragma once
// Second moments of the velocities of the grains in a layer.
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// Covariance per grain; never below zero by rounding where it is a variance. NaN without grains.
double covariance(double product_sum, double a_sum, double b_sum, double count);

/// Second moments of the velocity in one layer, v_x counted from its mean profile v_x(z) and not from one
/// number per layer: otherwise shear within a layer would pass for fluctuation.
struct VelocityMoments {
  double xx, zz, xz;
};
/// `shear_rate`: dv_x/dz; one that is not finite counts as 0.
VelocityMoments velocity_moments(const LayerSum& sum, double shear_rate);

/// The moments that a kinetic stress takes: per unit of nu. Grains of several densities count by their mass
/// per area, about the velocity of their centre of mass.
VelocityMoments stress_moments(const LayerSum& sum, double shear_rate);

}  // namespace drumlin::particles
