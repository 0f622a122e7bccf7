#include "particles/measurement/maps/field_values.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "coupling/core/results/quantities.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

using Known = MapSums::Snapshots;

struct Row {
  const char* name;
  double MapValues::*value;
  double Known::*needs = nullptr;
};
constexpr Row quantities[] = {{"nu", &MapValues::nu},
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
                              {"v_y", &MapValues::v_y, &Known::spheres},
                              {"sigma_yy", &MapValues::sigma_yy, &Known::spheres},
                              {"sigma_xy", &MapValues::sigma_xy, &Known::spheres},
                              {"sigma_yz", &MapValues::sigma_yz, &Known::spheres},
                              {"sigma_yy_kinetic", &MapValues::sigma_yy_kinetic, &Known::spheres},
                              {"sigma_xy_kinetic", &MapValues::sigma_xy_kinetic, &Known::spheres},
                              {"sigma_yz_kinetic", &MapValues::sigma_yz_kinetic, &Known::spheres},
                              {"fabric_yy", &MapValues::fabric_yy, &Known::spheres},
                              {"fabric_xy", &MapValues::fabric_xy, &Known::spheres},
                              {"fabric_yz", &MapValues::fabric_yz, &Known::spheres},
                              {"temperature", &MapValues::temperature, &Known::spheres},
                              {"p_space", &MapValues::p_space, &Known::spheres},
                              {"I_invariant", &MapValues::I_invariant, &Known::spheres},
                              {"mu_invariant", &MapValues::mu_invariant, &Known::spheres},
                              {"N1_over_p", &MapValues::N1_over_p, &Known::spheres},
                              {"N2_over_p", &MapValues::N2_over_p, &Known::spheres},
                              {"wall_x", &MapValues::wall_x},
                              {"wall_z", &MapValues::wall_z},
                              {"residual_x", &MapValues::residual_x},
                              {"residual_z", &MapValues::residual_z},
                              {"residual_x_without_kinetic", &MapValues::residual_x_contact},
                              {"residual_z_without_kinetic", &MapValues::residual_z_contact},
                              {"inertia_x", &MapValues::inertia_x},
                              {"inertia_z", &MapValues::inertia_z},
                              {"number_density", &MapValues::number_density},
                              {"density", &MapValues::density, &Known::densities}};

/// Those that displacements tell of too.
constexpr double MapValues::*of_motion[] = {&MapValues::v_x,         &MapValues::v_z,
                                            &MapValues::d_v_x_dx,    &MapValues::d_v_x_dz,
                                            &MapValues::d_v_z_dx,    &MapValues::d_v_z_dz,
                                            &MapValues::D_xz,        &MapValues::dilation,
                                            &MapValues::strain_rate, &MapValues::half_vorticity,
                                            &MapValues::I,           &MapValues::axis_angle_deg};

PlaneMatrix gradient_of(const MapValues& f) { return {f.d_v_x_dx, f.d_v_x_dz, f.d_v_z_dx, f.d_v_z_dz}; }

template <std::size_t N>
void set_velocity(const KernelSums<N>& sums, MapValues& f) {
  f.v_x = sums.mean(1);
  f.v_z = sums.mean(2);
  f.d_v_x_dx = sums.slope(1, sums.slope_x);
  f.d_v_x_dz = sums.slope(1, sums.slope_z);
  f.d_v_z_dx = sums.slope(2, sums.slope_x);
  f.d_v_z_dz = sums.slope(2, sums.slope_z);
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
  static_cast<PlaneInvariants&>(f) = plane_invariants(pressure, gradient_of(f));
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
  const KernelSums<5>& c = m.carried;
  const double divergence = c.slope_x[3] + c.slope_z[4];
  const auto along = [&](std::size_t moment) { return u_x * c.slope_x[moment] + u_z * c.slope_z[moment]; };
  const auto mean_flux = [&](double u, std::size_t moment) {
    return u * divergence + along(moment) - u * along(0);
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
template <int D>
void forget_contacts(Moments<D>& m) {
  m.contacts = no_value;
  for (Vector<D>& row : m.force_branch) row.fill(no_value);
  m.fabric.fill(no_value);
}

}  // namespace

std::vector<MapQuantity> known_fields(const MapSums::Snapshots& all) {
  std::vector<MapQuantity> known, displaced;
  for (const auto& [name, value, needs] : quantities) {
    const double period = drumlin::period_of(name);
    if (!needs || all.*needs > 0) known.push_back({name, value, period});
    if (all.pairs > 0 && std::find(std::begin(of_motion), std::end(of_motion), value) != std::end(of_motion))
      displaced.push_back({std::string("displacement_") + name, value, period, true});
  }
  known.insert(known.end(), displaced.begin(), displaced.end());
  for (const auto& [name, value] : shared_fields) known.push_back({name, value});
  return known;
}

MapValues values_at(const MapNode& sums, const MapSums::Snapshots& snapshots, double inside) {
  const double share = 1 / snapshots.count;
  MapValues f;
  MapNode m;
  add_times(share, sums, m);
  if (snapshots.contacts < snapshots.count) {
    forget_contacts<2>(m);
    m.force = m.contact_force = m.wall_force = {no_value, no_value};
  }
  f.number_density = m.grains;
  f.nu = m.solid / inside;
  if (f.nu < least_map_nu) return f;
  f.density = m.motion.weight / inside;
  set_velocity(m.carried, f);
  set_fields(m, inside, f);
  set_balance(m, share * snapshots.gravity_x, share * snapshots.gravity_z, f);
  return f;
}

void set_space(const SpaceNode& sums, const MapSums::Snapshots& snapshots, double inside, MapValues& f) {
  if (!std::isfinite(f.v_x)) return;  // too few grains
  SpaceNode m;
  add_times(1 / snapshots.count, sums, m);
  if (snapshots.contacts < snapshots.count) forget_contacts<3>(m);
  const Fields<3> fields = derive(m, Background<3>{inside});
  const Tensor<3> sigma = fields.pressure();
  enum { X, Z, Y };
  f.v_y = m.across.mean(1);
  f.sigma_yy = sigma[Y][Y], f.sigma_yy_kinetic = fields.kinetic[Y][Y];
  f.sigma_xy = sigma[X][Y], f.sigma_xy_kinetic = fields.kinetic[X][Y];
  // As sigma_xz, the traction of the upper side on the lower one.
  f.sigma_yz = -sigma[Y][Z], f.sigma_yz_kinetic = -fields.kinetic[Y][Z];
  f.fabric_xx = fields.fabric[X][X], f.fabric_zz = fields.fabric[Z][Z], f.fabric_yy = fields.fabric[Y][Y];
  f.fabric_xz = fields.fabric[X][Z], f.fabric_xy = fields.fabric[X][Y], f.fabric_yz = fields.fabric[Y][Z];
  // |D|^2 has D_xy^2 + D_yz^2 beside the plane's part.
  const double strain_rate =
      std::hypot(f.strain_rate, m.across.slope(1, m.across.slope_x), m.across.slope(1, m.across.slope_z));
  static_cast<SpaceInvariants&>(f) = space_invariants(fields, strain_rate);
}

MapValues displaced_values(const MapNode& sums, const PlaneMatrix& pressure) {
  MapValues f;
  if (!(sums.displaced.value[0] > 0)) return f;
  set_velocity(sums.displaced, f);
  static_cast<PlaneInvariants&>(f) = plane_invariants(pressure, gradient_of(f));
  return f;
}

}  // namespace drumlin::particles
