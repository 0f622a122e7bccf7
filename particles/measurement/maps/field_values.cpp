#include "particles/measurement/maps/field_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::particles {
namespace {

constexpr NamedMapField named_fields[] = {{"nu", &MapValues::nu},
                                          {"v_x", &MapValues::v_x},
                                          {"v_z", &MapValues::v_z},
                                          {"omega", &MapValues::omega},
                                          {"d_v_x_dx", &MapValues::d_v_x_dx},
                                          {"d_v_x_dz", &MapValues::d_v_x_dz},
                                          {"d_v_z_dx", &MapValues::d_v_z_dx},
                                          {"d_v_z_dz", &MapValues::d_v_z_dz},
                                          {"D_xx", &MapValues::D_xx},
                                          {"D_zz", &MapValues::D_zz},
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
                                          {"coordination", &MapValues::coordination},
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
                                          {"density", &MapValues::density}};

/// Means over the snapshots of what MapNode adds up, by name.
struct Means {
  double grains, contacts, spin, mass, v_x, v_z, u_x, u_z, u_x_u_x, u_x_u_z, u_z_u_z, force_x, force_z;
  std::array<double, 5> slope_x, slope_z;  ///< of m, m v_x, m v_z, m u_x, m u_z
  std::array<double, 2> flux_divergence;
  std::array<double, 4> branch;
  std::array<double, 7> contact;
  double gravity_x, gravity_z;
};

template <std::size_t n>
std::array<double, n> scaled(std::array<double, n> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Means means_of(const MapNode& node, const MapShare& sums) {
  const double share = 1 / static_cast<double>(sums.snapshots);
  const auto g = scaled(node.grain, share);
  return {g[0],
          g[1],
          g[2],
          g[3],
          g[4],
          g[5],
          g[6],
          g[7],
          g[8],
          g[9],
          g[10],
          g[11],
          g[12],
          scaled(node.slope_x, share),
          scaled(node.slope_z, share),
          scaled(node.flux_divergence, share),
          scaled(node.branch, share),
          scaled(node.contact, share),
          share * sums.gravity_x,
          share * sums.gravity_z};
}

void set_velocity(const Means& m, bool with_spin, MapValues& f) {
  f.v_x = m.v_x / m.mass;
  f.v_z = m.v_z / m.mass;
  if (with_spin) f.omega = m.spin / m.grains;
  // The derivative of the quotient, each part by the kernel's own derivative.
  f.d_v_x_dx = (m.slope_x[1] - f.v_x * m.slope_x[0]) / m.mass;
  f.d_v_x_dz = (m.slope_z[1] - f.v_x * m.slope_z[0]) / m.mass;
  f.d_v_z_dx = (m.slope_x[2] - f.v_z * m.slope_x[0]) / m.mass;
  f.d_v_z_dz = (m.slope_z[2] - f.v_z * m.slope_z[0]) / m.mass;
  f.D_xx = f.d_v_x_dx;
  f.D_zz = f.d_v_z_dz;
  f.D_xz = (f.d_v_x_dz + f.d_v_z_dx) / 2;
  f.dilation = f.D_xx + f.D_zz;
}

/// `inside`: share of the kernel within the container.
void set_stress(const Means& m, double inside, MapValues& f) {
  const double mean_u_x = m.u_x / m.mass, mean_u_z = m.u_z / m.mass;
  const PlaneMatrix kinetic{
      m.u_x_u_x - m.mass * mean_u_x * mean_u_x, m.u_x_u_z - m.mass * mean_u_x * mean_u_z,
      m.u_x_u_z - m.mass * mean_u_x * mean_u_z, m.u_z_u_z - m.mass * mean_u_z * mean_u_z};
  const PlaneMatrix pressure{(m.branch[0] + kinetic.xx) / inside, (m.branch[1] + kinetic.xz) / inside,
                             (m.branch[2] + kinetic.zx) / inside, (m.branch[3] + kinetic.zz) / inside};
  f.sigma_xx_kinetic = kinetic.xx / inside;
  f.sigma_zz_kinetic = kinetic.zz / inside;
  f.sigma_xz_kinetic = -kinetic.xz / inside;
  // The reported shear stress is the traction of the upper side on the lower one.
  f.sigma_xx = pressure.xx;
  f.sigma_zz = pressure.zz;
  f.sigma_xz = -pressure.xz;
  f.sigma_zx = -pressure.zx;
  static_cast<PlaneInvariants&>(f) =
      plane_invariants(pressure, {f.d_v_x_dx, f.d_v_x_dz, f.d_v_z_dx, f.d_v_z_dz});
}

void set_contacts(const Means& m, double inside, MapValues& f) {
  f.coordination = m.contacts / m.grains;
  const double sides = m.contact[4] + m.contact[6];
  if (sides > 0) {
    f.fabric_xx = m.contact[4] / sides;
    f.fabric_xz = m.contact[5] / sides;
    f.fabric_zz = m.contact[6] / sides;
  }
  f.wall_x = m.contact[2] / inside;
  f.wall_z = m.contact[3] / inside;
}

/// Balance of momentum in the laboratory, whose axes at this instant are those of the frame:
/// div(contact stress) + div(sum m u u phi) = density g + force of the walls, all without the share inside.
void set_balance(const Means& m, MapValues& f) {
  const double gravity = std::hypot(m.gravity_x, m.gravity_z), weight = m.mass * gravity;
  if (!(weight > 0)) return;
  const double contact_x = m.contact[0] - m.force_x, contact_z = m.contact[1] - m.force_z;
  const double u_x = m.u_x / m.mass, u_z = m.u_z / m.mass;
  // div(nu U U) of the mean velocity U: what is left of the flux is the kinetic stress.
  const double divergence = m.slope_x[3] + m.slope_z[4];
  const auto mean_flux = [&](double u, std::size_t moment) {
    const double along = u_x * m.slope_x[moment] + u_z * m.slope_z[moment];
    return u * divergence + along - u * (u_x * m.slope_x[0] + u_z * m.slope_z[0]);
  };
  const double inertia_x = mean_flux(u_x, 3), inertia_z = mean_flux(u_z, 4);
  const double load_x = m.mass * m.gravity_x + m.contact[2], load_z = m.mass * m.gravity_z + m.contact[3];
  f.residual_x = (contact_x + m.flux_divergence[0] - load_x) / weight;
  f.residual_z = (contact_z + m.flux_divergence[1] - load_z) / weight;
  f.residual_x_contact = (contact_x + inertia_x - load_x) / weight;
  f.residual_z_contact = (contact_z + inertia_z - load_z) / weight;
  f.inertia_x = inertia_x / weight;
  f.inertia_z = inertia_z / weight;
}

/// What follows from contacts that nobody knows is not computed.
void forget_contacts(Means& m) {
  m.contacts = m.force_x = m.force_z = MapValues::none;
  std::fill(std::begin(m.branch), std::end(m.branch), MapValues::none);
  std::fill(std::begin(m.contact), std::end(m.contact), MapValues::none);
}

}  // namespace

void MapShare::add(const MapSums& batch) {
  snapshots += batch.snapshots;
  gravity_x += batch.gravity_x;
  gravity_z += batch.gravity_z;
  with_spin = with_spin && batch.with_spin;
  with_contacts = with_contacts && batch.with_contacts;
  with_density = with_density || batch.area;
}

void MapShare::take(const MapShare& batch) {
  snapshots -= batch.snapshots;
  gravity_x -= batch.gravity_x;
  gravity_z -= batch.gravity_z;
}

std::vector<NamedMapField> known_fields(const MapShare& total) {
  std::vector<NamedMapField> known;
  for (const NamedMapField& field : named_fields) {
    if (field.value == &MapValues::omega && !total.with_spin) continue;
    if (field.value == &MapValues::density && !total.with_density) continue;  // it is nu
    known.push_back(field);
  }
  return known;
}

NodeSums& NodeSums::operator+=(const NodeSums& other) {
  node += other.node;
  area += other.area;
  return *this;
}

NodeSums& NodeSums::operator-=(const NodeSums& other) {
  node -= other.node;
  area -= other.area;
  return *this;
}

MapValues values_at(const NodeSums& sums, const MapShare& share, double inside) {
  MapValues f;
  Means m = means_of(sums.node, share);
  if (!share.with_contacts) forget_contacts(m);
  f.number_density = m.grains;
  f.nu = sums.area / static_cast<double>(share.snapshots) / inside;
  if (f.nu < least_map_nu) return f;
  f.density = m.mass / inside;
  set_velocity(m, share.with_spin, f);
  set_stress(m, inside, f);
  set_contacts(m, inside, f);
  set_balance(m, f);
  return f;
}

}  // namespace drumlin::particles
