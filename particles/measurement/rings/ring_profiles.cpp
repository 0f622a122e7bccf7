#include "particles/measurement/rings/ring_profiles.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/layers/velocity_moments.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Mean angular velocity about the centre, clockwise: sum of v_t r / sum of r^2.
double angular_velocity(const LayerSum& sum, double r) {
  const double inertia = sum.zeta_zeta + 2 * r * sum.zeta + sum.grains * r * r;
  return inertia > 0 ? (sum.zeta_v_x + r * sum.v_x) / inertia : none;
}

struct Rings {
  const RingGrid& grid;
  const LayerSums& sums;
  ProfileSet profiles;

  double area(std::size_t ring) const { return grid.area[ring] * static_cast<double>(sums.snapshots); }
  template <class Value>
  const std::vector<double>& add(const std::string& name, Value value) {
    std::vector<double> values(profiles.z.size());
    for (std::size_t l = 0; l < values.size(); ++l) values[l] = value(l, sums.layers[l]);
    profiles.columns.push_back({name, std::move(values), {}});
    return profiles.columns.back().value;
  }
};

/// v_t/r, and r times its slope.
struct Turning {
  std::vector<double> angular, shear_rate;
};

Turning add_kinematics(Rings& rings) {
  Turning turning;
  const auto& r = rings.profiles.z;
  for (std::size_t l = 0; l < r.size(); ++l)
    turning.angular.push_back(angular_velocity(rings.sums.layers[l], r[l]));
  const auto& w = turning.angular;
  turning.shear_rate.assign(r.size(), none);
  for (std::size_t l = 1; l + 1 < r.size(); ++l)
    turning.shear_rate[l] = r[l] * (w[l + 1] - w[l - 1]) / (2 * rings.grid.thickness);
  rings.add("v_t", [&](std::size_t l, const LayerSum&) { return w[l] * r[l]; });
  rings.add("v_r", [](std::size_t, const LayerSum& s) { return s.grains > 0 ? s.v_z / s.grains : none; });
  rings.add("shear_rate", [&](std::size_t l, const LayerSum&) { return turning.shear_rate[l]; });
  rings.add("half_vorticity",
            [&](std::size_t l, const LayerSum&) { return w[l] + turning.shear_rate[l] / 2; });
  if (rings.sums.with_spin)
    rings.add("omega",
              [](std::size_t, const LayerSum& s) { return s.grains > 0 ? s.spin / s.grains : none; });
  return turning;
}

void add_stresses(Rings& rings, const Turning& turning) {
  const auto nu =
      rings.add("nu", [&](std::size_t l, const LayerSum& s) { return s.covered / rings.area(l); });
  if (rings.sums.with_densities)
    rings.add("density", [&](std::size_t l, const LayerSum& s) { return s.covered_mass / rings.area(l); });
  const auto stress = [&](const std::string& name, double sign, double VelocityMoments::*moment,
                          double LayerSum::*contact) {
    const auto kinetic = rings.add(name + "_kinetic", [&](std::size_t l, const LayerSum& s) {
      const double shear = std::isfinite(turning.shear_rate[l]) ? turning.shear_rate[l] : 0;
      return s.grains > 0 ? sign * nu[l] * stress_moments(s, turning.angular[l] + shear).*moment : 0;
    });
    return rings.add(name, [&](std::size_t l, const LayerSum& s) {
      return rings.sums.with_contacts ? sign * s.*contact / rings.area(l) + kinetic[l] : none;
    });
  };
  const auto rr = stress("sigma_rr", 1, &VelocityMoments::zz, &LayerSum::force_z_branch_z);
  const auto tt = stress("sigma_tt", 1, &VelocityMoments::xx, &LayerSum::force_x_branch_x);
  // The traction of the outer side on the inner one, as that of the upper layer on the lower.
  const auto rt = stress("sigma_rt", -1, &VelocityMoments::xz, &LayerSum::force_x_branch_z);
  const auto loaded = [&](std::size_t l, double value) { return rr[l] > 0 ? value : none; };
  rings.add("I", [&](std::size_t l, const LayerSum&) {
    return loaded(l, turning.shear_rate[l] / std::sqrt(rr[l]));
  });
  rings.add("mu", [&](std::size_t l, const LayerSum&) { return loaded(l, rt[l] / rr[l]); });
  rings.add("k", [&](std::size_t l, const LayerSum&) { return loaded(l, tt[l] / rr[l]); });
}

}  // namespace

ProfileSet ring_profiles(const RingGrid& grid, const LayerSums& sums) {
  std::size_t end = grid.rings();
  while (end > 0 && !(sums.layers[end - 1].covered > 0)) --end;
  Rings rings{grid, sums, {}};
  for (std::size_t l = 0; l < end; ++l) rings.profiles.z.push_back(grid.r_of(l));
  add_stresses(rings, add_kinematics(rings));
  if (sums.with_contacts)
    rings.add("coordination",
              [](std::size_t, const LayerSum& s) { return s.grains > 0 ? s.contacts / s.grains : none; });
  rings.add("count", [](std::size_t, const LayerSum& s) { return s.grains; });
  return std::move(rings.profiles);
}

ProfileSet ring_profiles(const RingGrid& grid, const std::vector<LayerSums>& batches) {
  LayerSums total = total_of(batches);
  SliceProfiles measured{ring_profiles(grid, total), {}, 0, {}};
  if (batches.size() > 1)
    for (const LayerSums& batch : batches) {
      LayerSums rest = total;
      rest -= batch;
      measured.leave_one_out.push_back(ring_profiles(grid, rest));
    }
  add_intervals(measured);
  return std::move(measured.profiles);
}

}  // namespace drumlin::particles
