#include "particles/measurement/layers/velocity_moments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::particles {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double covariance(double product_sum, double a_sum, double b_sum, double count) {
  return count > 0 ? product_sum / count - a_sum / count * (b_sum / count) : none;
}

VelocityMoments velocity_moments(const LayerSum& sum, double shear_rate) {
  const double slope = std::isfinite(shear_rate) ? shear_rate : 0;
  const double n = sum.grains;
  const double xx = covariance(sum.v_x_v_x, sum.v_x, sum.v_x, n) -
                    2 * slope * covariance(sum.zeta_v_x, sum.zeta, sum.v_x, n) +
                    slope * slope * covariance(sum.zeta_zeta, sum.zeta, sum.zeta, n);
  return {std::max(0.0, xx), std::max(0.0, covariance(sum.v_z_v_z, sum.v_z, sum.v_z, n)),
          covariance(sum.v_x_v_z, sum.v_x, sum.v_z, n)};
}

VelocityMoments stress_moments(const LayerSum& sum, double shear_rate) {
  if (sum.density == 0) return velocity_moments(sum, shear_rate);
  LayerSum dense;
  dense.grains = sum.density;
  dense.zeta = sum.dense_zeta;
  dense.v_x = sum.dense_v_x;
  dense.v_z = sum.dense_v_z;
  dense.zeta_zeta = sum.dense_zeta_zeta;
  dense.zeta_v_x = sum.dense_zeta_v_x;
  dense.v_x_v_x = sum.dense_v_x_v_x;
  dense.v_z_v_z = sum.dense_v_z_v_z;
  dense.v_x_v_z = sum.dense_v_x_v_z;
  const VelocityMoments of_mass = velocity_moments(dense, shear_rate);
  const double mean_density = sum.density / sum.grains;
  return {mean_density * of_mass.xx, mean_density * of_mass.zz, mean_density * of_mass.xz};
}

}  // namespace drumlin::particles
