#include "particles/measurement/maps/field_values.hpp"

#include <cmath>
#include <tuple>

#include "coupling/core/results/quantities.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

using Known = MapSums::Snapshots;

constexpr MapQuantity quantities[] = {
    {"nu", &MapValues::nu},
    {"v_x", &MapValues::v_x},
    {"v_z", &MapValues::v_z},
    {"omega", &MapValues::omega, &Known::spin},
    {"d_v_x_dx", &MapValues::d_v_x_dx},
    {"d_v_x_dz", &MapValues::d_v_x_dz},
    {"d_v_z_dx", &MapValues::d_v_z_dx},
    {"d_v_z_dz", &MapValues::d_v_z_dz},
    {"D_xx", &MapValues::d_v_x_dx},
    {"D_zz", &MapValues::d_v_z_dz},
    {"D_xz", &MapValues::D_xz},
    {"dilation", &MapValues::dilation},
    {"strain_rate", &MapValues::strain_rate},
    {"half_vorticity", &MapValues::half_vorticity},
    {"sigma_xx", &MapValues::sigma_xx},
    {"sigma_zz", &MapValues::sigma_zz},
    {"sigma_xz", &MapValues::sigma_xz},
    {"sigma_zx", &MapValues::sigma_zx},
    {"sigma_xx_kinetic", &MapValues::sigma_xx_kinetic},
    {"sigma_zz_kinetic", &MapValues::sigma_zz_kinetic},
    {"sigma_xz_kinetic", &MapValues::sigma_xz_kinetic},
    {"p", &MapValues::p},
    {"tau", &MapValues::tau},
    {"I", &MapValues::I},
    {"mu", &MapValues::mu},
    {"k", &MapValues::k},
    {"axis_angle_deg", &MapValues::axis_angle_deg},
    {"fabric_xx", &MapValues::fabric_xx},
    {"fabric_zz", &MapValues::fabric_zz},
    {"fabric_xz", &MapValues::fabric_xz},
    {"wall_x", &MapValues::wall_x},
    {"wall_z", &MapValues::wall_z},
    {"residual_x", &MapValues::residual_x},
    {"residual_z", &MapValues::residual_z},
    {"residual_x_without_kinetic", &MapValues::residual_x_contact},
    {"residual_z_without_kinetic", &MapValues::residual_z_contact},
    {"inertia_x", &MapValues::inertia_x},
    {"inertia_z", &MapValues::inertia_z},
    {"number_density", &MapValues::number_density},
    {"density", &MapValues::density, &Known::densities},
    {"displacement_v_x", &MapValues::moved_v_x, &Known::pairs},
    {"displacement_v_z", &MapValues::moved_v_z, &Known::pairs},
    {"displacement_d_v_x_dx", &MapValues::moved_d_v_x_dx, &Known::pairs},
    {"displacement_d_v_x_dz", &MapValues::moved_d_v_x_dz, &Known::pairs},
    {"displacement_d_v_z_dx", &MapValues::moved_d_v_z_dx, &Known::pairs},
    {"displacement_d_v_z_dz", &MapValues::moved_d_v_z_dz, &Known::pairs},
    {"displacement_D_xx", &MapValues::moved_d_v_x_dx, &Known::pairs},
    {"displacement_D_zz", &MapValues::moved_d_v_z_dz, &Known::pairs},
    {"displacement_D_xz", &MapValues::moved_D_xz, &Known::pairs},
    {"displacement_dilation", &MapValues::moved_dilation, &Known::pairs},
    {"displacement_strain_rate", &MapValues::moved_strain_rate, &Known::pairs},
    {"displacement_half_vorticity", &MapValues::moved_half_vorticity, &Known::pairs},
    {"displacement_I", &MapValues::moved_I, &Known::pairs},
    {"displacement_axis_angle_deg", &MapValues::moved_axis_angle_deg, &Known::pairs}};

/// Derivative of a quotient of sums, each part by the kernel's own derivative.
double slope_of(double slope, double mean, double slope_of_weight, double weight) {
  return (slope - mean * slope_of_weight) / weight;
}

void set_velocity(const MapNode& m, MapValues& f) {
  const double mass = m.motion.weight;
  f.v_x = m.momentum[0] / mass;
  f.v_z = m.momentum[1] / mass;
  f.d_v_x_dx = slope_of(m.slope_x[1], f.v_x, m.slope_x[0], mass);
  f.d_v_x_dz = slope_of(m.slope_z[1], f.v_x, m.slope_z[0], mass);
  f.d_v_z_dx = slope_of(m.slope_x[2], f.v_z, m.slope_x[0], mass);
  f.d_v_z_dz = slope_of(m.slope_z[2], f.v_z, m.slope_z[0], mass);
  f.D_xz = (f.d_v_x_dz + f.d_v_z_dx) / 2;
  f.dilation = f.d_v_x_dx + f.d_v_z_dz;
}

/// `inside`: share of the kernel within the container.
void set_fields(const MapNode& m, double inside, MapValues& f) {
  const Fields<2> fields = derive(m, Background<2>{inside});
  const PlaneMatrix pressure = plane_matrix(fields.pressure());
  f.omega = fields.omega;
  static_cast<SharedFields&>(f) = fields;
  f.sigma_xx_kinetic = fields.kinetic[0][0];
  f.sigma_zz_kinetic = fields.kinetic[1][1];
  f.sigma_xz_kinetic = -fields.kinetic[0][1];
  // The reported shear stress is the traction of the upper side on the lower one.
  f.sigma_xx = pressure.xx;
  f.sigma_zz = pressure.zz;
  f.sigma_xz = -pressure.xz;
  f.sigma_zx = -pressure.zx;
  static_cast<PlaneInvariants&>(f) =
      plane_invariants(pressure, {f.d_v_x_dx, f.d_v_x_dz, f.d_v_z_dx, f.d_v_z_dz});
  f.fabric_xx = fields.fabric[0][0];
  f.fabric_xz = fields.fabric[0][1];
  f.fabric_zz = fields.fabric[1][1];
  f.wall_x = m.wall_force[0] / inside;
  f.wall_z = m.wall_force[1] / inside;
}

/// Balance of momentum in the laboratory, whose axes at this instant are those of the frame:
/// div(contact stress) + div(sum m u u phi) = density g + force of the walls, all without the share inside.
void set_balance(const MapNode& m, double gravity_x, double gravity_z, MapValues& f) {
  const double mass = m.motion.weight, weight = mass * std::hypot(gravity_x, gravity_z);
  if (!(weight > 0)) return;
  const double contact_x = m.contact_force[0] - m.force[0], contact_z = m.contact_force[1] - m.force[1];
  const double u_x = m.motion.mean(0), u_z = m.motion.mean(1);
  // div(nu U U) of the mean velocity U: what is left of the flux is the kinetic stress.
  const double divergence = m.slope_x[3] + m.slope_z[4];
  const auto mean_flux = [&](double u, std::size_t moment) {
    const double along = u_x * m.slope_x[moment] + u_z * m.slope_z[moment];
    return u * divergence + along - u * (u_x * m.slope_x[0] + u_z * m.slope_z[0]);
  };
  const double inertia_x = mean_flux(u_x, 3), inertia_z = mean_flux(u_z, 4);
  const double load_x = mass * gravity_x + m.wall_force[0], load_z = mass * gravity_z + m.wall_force[1];
  f.residual_x = (contact_x + m.flux_divergence[0] - load_x) / weight;
  f.residual_z = (contact_z + m.flux_divergence[1] - load_z) / weight;
  f.residual_x_contact = (contact_x + inertia_x - load_x) / weight;
  f.residual_z_contact = (contact_z + inertia_z - load_z) / weight;
  f.inertia_x = inertia_x / weight;
  f.inertia_z = inertia_z / weight;
}

/// What follows from contacts that nobody knows is not computed.
void forget_contacts(MapNode& m) {
  constexpr double none = MapValues::none;
  m.contacts = none;
  m.force = m.contact_force = m.wall_force = {none, none};
  m.force_branch = {{{none, none}, {none, none}}};
  m.fabric.fill(none);
}

}  // namespace

std::vector<MapQuantity> known_fields(const MapSums::Snapshots& all) {
  std::vector<MapQuantity> known;
  for (const MapQuantity& field : quantities)
    if (!field.needs || all.*field.needs > 0)
      known.push_back({field.name, field.value, field.needs, drumlin::period_of(field.name)});
  for (const auto& [name, value] : shared_fields) known.push_back({name, value});
  return known;
}

MapValues values_at(const MapNode& sums, const MapSums::Snapshots& snapshots, double inside) {
  const double share = 1 / snapshots.count;
  MapValues f;
  MapNode m;
  add_times(share, sums, m);
  if (snapshots.contacts < snapshots.count) forget_contacts(m);
  f.number_density = m.grains;
  f.nu = m.solid / inside;
  if (f.nu < least_map_nu) return f;
  f.density = m.motion.weight / inside;
  set_velocity(m, f);
  set_fields(m, inside, f);
  set_balance(m, share * snapshots.gravity_x, share * snapshots.gravity_z, f);
  return f;
}

void set_motion(const MapNode& sums, const PlaneMatrix& pressure, MapValues& f) {
  const auto& [sum, slope_x, slope_z] = std::tie(sums.moved, sums.moved_slope_x, sums.moved_slope_z);
  const double weight = sum[0];
  if (!(weight > 0)) return;
  f.moved_v_x = sum[1] / weight;
  f.moved_v_z = sum[2] / weight;
  const PlaneMatrix gradient{slope_of(slope_x[1], f.moved_v_x, slope_x[0], weight),
                             slope_of(slope_z[1], f.moved_v_x, slope_z[0], weight),
                             slope_of(slope_x[2], f.moved_v_z, slope_x[0], weight),
                             slope_of(slope_z[2], f.moved_v_z, slope_z[0], weight)};
  f.moved_d_v_x_dx = gradient.xx;
  f.moved_d_v_x_dz = gradient.xz;
  f.moved_d_v_z_dx = gradient.zx;
  f.moved_d_v_z_dz = gradient.zz;
  f.moved_D_xz = (gradient.xz + gradient.zx) / 2;
  f.moved_dilation = gradient.xx + gradient.zz;
  const PlaneInvariants invariants = plane_invariants(pressure, gradient);
  f.moved_strain_rate = invariants.strain_rate;
  f.moved_half_vorticity = invariants.half_vorticity;
  f.moved_I = invariants.I;
  f.moved_axis_angle_deg = invariants.axis_angle_deg;
}

}  // namespace drumlin::particles
