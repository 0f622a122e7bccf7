#include "particles/measurement/maps/field_maps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/exchange/plane_invariants.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/spline_kernel.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// All fields at one node.
struct Values {
  double nu = none, number_density = none, v_x = none, v_z = none, omega = none;
  double d_v_x_dx = none, d_v_x_dz = none, d_v_z_dx = none, d_v_z_dz = none;
  double D_xx = none, D_zz = none, D_xz = none, dilation = none, strain_rate = none, half_vorticity = none;
  double sigma_xx = none, sigma_zz = none, sigma_xz = none, sigma_zx = none;
  double sigma_xx_kinetic = none, sigma_zz_kinetic = none, sigma_xz_kinetic = none;
  double p = none, tau = none, I = none, mu = none, k = none, axis_angle = none;
  double coordination = none, fabric_xx = none, fabric_zz = none, fabric_xz = none;
  double wall_x = none, wall_z = none;
  double residual_x = none, residual_z = none, residual_x_contact = none, residual_z_contact = none;
  double inertia_x = none, inertia_z = none;
  double density = none;
};

struct NamedField {
  const char* name;
  double Values::*value;
};
constexpr NamedField named_fields[] = {{"nu", &Values::nu},
                                       {"v_x", &Values::v_x},
                                       {"v_z", &Values::v_z},
                                       {"omega", &Values::omega},
                                       {"d_v_x_dx", &Values::d_v_x_dx},
                                       {"d_v_x_dz", &Values::d_v_x_dz},
                                       {"d_v_z_dx", &Values::d_v_z_dx},
                                       {"d_v_z_dz", &Values::d_v_z_dz},
                                       {"D_xx", &Values::D_xx},
                                       {"D_zz", &Values::D_zz},
                                       {"D_xz", &Values::D_xz},
                                       {"dilation", &Values::dilation},
                                       {"strain_rate", &Values::strain_rate},
                                       {"half_vorticity", &Values::half_vorticity},
                                       {"sigma_xx", &Values::sigma_xx},
                                       {"sigma_zz", &Values::sigma_zz},
                                       {"sigma_xz", &Values::sigma_xz},
                                       {"sigma_zx", &Values::sigma_zx},
                                       {"sigma_xx_kinetic", &Values::sigma_xx_kinetic},
                                       {"sigma_zz_kinetic", &Values::sigma_zz_kinetic},
                                       {"sigma_xz_kinetic", &Values::sigma_xz_kinetic},
                                       {"p", &Values::p},
                                       {"tau", &Values::tau},
                                       {"I", &Values::I},
                                       {"mu", &Values::mu},
                                       {"k", &Values::k},
                                       {"axis_angle_deg", &Values::axis_angle},
                                       {"coordination", &Values::coordination},
                                       {"fabric_xx", &Values::fabric_xx},
                                       {"fabric_zz", &Values::fabric_zz},
                                       {"fabric_xz", &Values::fabric_xz},
                                       {"wall_x", &Values::wall_x},
                                       {"wall_z", &Values::wall_z},
                                       {"residual_x", &Values::residual_x},
                                       {"residual_z", &Values::residual_z},
                                       {"residual_x_without_kinetic", &Values::residual_x_contact},
                                       {"residual_z_without_kinetic", &Values::residual_z_contact},
                                       {"inertia_x", &Values::inertia_x},
                                       {"inertia_z", &Values::inertia_z},
                                       {"number_density", &Values::number_density},
                                       {"density", &Values::density}};

/// What sums know beside their nodes, of some batches.
struct Share {
  std::size_t snapshots = 0;
  double gravity_x = 0, gravity_z = 0;
  bool with_spin = true, with_contacts = true, with_density = false;
};

Share share_of(std::span<const MapSums> batches) {
  Share share;
  for (const MapSums& batch : batches) {
    share.snapshots += batch.snapshots;
    share.gravity_x += batch.gravity_x;
    share.gravity_z += batch.gravity_z;
    share.with_spin = share.with_spin && batch.with_spin;
    share.with_contacts = share.with_contacts && batch.with_contacts;
    share.with_density = share.with_density || batch.area;
  }
  return share;
}

Share without(Share share, const MapSums& batch) {
  share.snapshots -= batch.snapshots;
  share.gravity_x -= batch.gravity_x;
  share.gravity_z -= batch.gravity_z;
  return share;
}

/// Those that the snapshots tell of.
std::vector<NamedField> known_fields(const Share& total) {
  std::vector<NamedField> known;
  for (const NamedField& field : named_fields) {
    if (field.value == &Values::omega && !total.with_spin) continue;
    if (field.value == &Values::density && !total.with_density) continue;  // it is nu
    known.push_back(field);
  }
  return known;
}

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

Means means_of(const MapNode& node, const Share& sums) {
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

void set_velocity(const Means& m, bool with_spin, Values& f) {
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
void set_stress(const Means& m, double inside, Values& f) {
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
  const PlaneInvariants at = plane_invariants(pressure, {f.d_v_x_dx, f.d_v_x_dz, f.d_v_z_dx, f.d_v_z_dz});
  f.strain_rate = at.strain_rate;
  f.half_vorticity = at.half_vorticity;
  f.p = at.p;
  f.tau = at.tau;
  f.I = at.I;
  f.mu = at.mu;
  f.k = at.k;
  f.axis_angle = at.axis_angle_deg;
}

void set_contacts(const Means& m, double inside, Values& f) {
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
void set_balance(const Means& m, Values& f) {
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
  m.contacts = m.force_x = m.force_z = none;
  std::fill(std::begin(m.branch), std::end(m.branch), none);
  std::fill(std::begin(m.contact), std::end(m.contact), none);
}

/// Sums of some batches at one node.
struct NodeSums {
  MapNode node;
  double area = 0;  ///< as MapSums::area_at

  void add(const MapSums& batch, std::size_t at) {
    node += batch.nodes[at];
    area += batch.area_at(at);
  }
  void take(const MapSums& batch, std::size_t at) {
    node -= batch.nodes[at];
    area -= batch.area_at(at);
  }
};

NodeSums sums_at(std::size_t node, std::span<const MapSums> batches) {
  NodeSums sums{batches.front().nodes[node], batches.front().area_at(node)};
  for (const MapSums& batch : batches.subspan(1)) sums.add(batch, node);
  return sums;
}

Values values_at(const NodeSums& sums, const Share& share, double inside) {
  Values f;
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

void set_intervals(const std::vector<Values>& leave_one_out, const Values& whole, std::size_t node,
                   std::span<const NamedField> known, std::vector<MapField>& fields) {
  std::vector<double> values(leave_one_out.size());
  for (std::size_t f = 0; f < known.size(); ++f) {
    const NamedField& field = known[f];
    for (std::size_t b = 0; b < values.size(); ++b) {
      values[b] = leave_one_out[b].*field.value;
      if (field.value == &Values::axis_angle) values[b] = nearest_turn(values[b] - whole.*field.value, 180);
    }
    fields[f].ci99[node] = jackknife_ci99(values);
  }
}

/// Rows up to the highest one that a grain reaches: half of a drum is air.
std::size_t rows_reached(const MapGrid& grid, std::span<const MapSums> batches) {
  const auto is_empty = [&](std::size_t row) {
    for (const MapSums& batch : batches)
      for (std::size_t column = 0; column < grid.columns; ++column)
        if (batch.nodes(column, row).grain[0] != 0) return false;
    return true;
  };
  std::size_t rows = grid.rows;
  while (rows > 1 && is_empty(rows - 1)) --rows;
  return rows;
}

/// Share of the kernel at a node that lies within the container, 1 without one; 0 for a node outside.
double share_inside(const CoarseGraining& graining, std::size_t node, double container_radius) {
  if (!(container_radius > 0)) return 1;
  const double x = graining.grid.x_of(node % graining.grid.columns);
  const double z = graining.grid.z_of(node / graining.grid.columns);
  if (std::hypot(x, z) > container_radius) return 0;
  return kernel_share_in_circle(x, z, graining.width, container_radius);
}

FieldMap empty_map(const CoarseGraining& graining, std::span<const MapSums> batches,
                   std::span<const NamedField> known, double surface_z, bool with_intervals) {
  FieldMap map;
  map.grid = graining.grid;
  map.grid.z_first -= surface_z;
  map.grid.rows = rows_reached(map.grid, batches);
  for (const NamedField& field : known) {
    map.fields.push_back({field.name, std::vector<double>(map.grid.nodes(), none), {}});
    if (with_intervals) map.fields.back().ci99.assign(map.grid.nodes(), none);
  }
  return map;
}

void set_values(const Values& values, std::size_t node, std::span<const NamedField> known, FieldMap& map) {
  for (std::size_t f = 0; f < known.size(); ++f) map.fields[f].value[node] = values.*known[f].value;
}

}  // namespace

FieldMap field_maps(const CoarseGraining& graining, std::span<const MapSums> batches, double container_radius,
                    double surface_z) {
  const bool with_intervals = batches.size() > 1;
  const Share all = share_of(batches);
  const std::vector<NamedField> known = known_fields(all);
  FieldMap map = empty_map(graining, batches, known, surface_z, with_intervals);
  std::vector<Values> leave_one_out(with_intervals ? batches.size() : 0);
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double inside = share_inside(graining, node, container_radius);
    if (inside == 0) continue;
    const NodeSums total = sums_at(node, batches);
    const Values whole = values_at(total, all, inside);
    set_values(whole, node, known, map);
    if (!with_intervals) continue;
    for (std::size_t b = 0; b < batches.size(); ++b) {
      NodeSums rest = total;
      rest.take(batches[b], node);
      leave_one_out[b] = values_at(rest, without(all, batches[b]), inside);
    }
    set_intervals(leave_one_out, whole, node, known, map.fields);
  }
  return map;
}

FieldMap field_maps_without(std::size_t left_out, const CoarseGraining& graining,
                            std::span<const MapSums> batches, double container_radius, double surface_z) {
  const Share all = share_of(batches), share = without(all, batches[left_out]);
  const std::vector<NamedField> known = known_fields(all);
  FieldMap map = empty_map(graining, batches, known, surface_z, false);
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    const double inside = share_inside(graining, node, container_radius);
    if (inside == 0) continue;
    NodeSums rest = sums_at(node, batches);
    rest.take(batches[left_out], node);
    set_values(values_at(rest, share, inside), node, known, map);
  }
  return map;
}

}  // namespace drumlin::particles
