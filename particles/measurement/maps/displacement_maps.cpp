#include "particles/measurement/maps/displacement_maps.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "coupling/exchange/plane_invariants.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// All fields at one node.
struct Motion {
  double v_x = none, v_z = none;
  PlaneMatrix gradient{none, none, none, none};
  double D_xz = none, dilation = none;
  PlaneInvariants invariants = {};
};

struct NamedField {
  const char* name;
  double (*value)(const Motion&);
};
constexpr NamedField named_fields[] = {
    {"displacement_v_x", [](const Motion& m) { return m.v_x; }},
    {"displacement_v_z", [](const Motion& m) { return m.v_z; }},
    {"displacement_d_v_x_dx", [](const Motion& m) { return m.gradient.xx; }},
    {"displacement_d_v_x_dz", [](const Motion& m) { return m.gradient.xz; }},
    {"displacement_d_v_z_dx", [](const Motion& m) { return m.gradient.zx; }},
    {"displacement_d_v_z_dz", [](const Motion& m) { return m.gradient.zz; }},
    {"displacement_D_xx", [](const Motion& m) { return m.gradient.xx; }},
    {"displacement_D_zz", [](const Motion& m) { return m.gradient.zz; }},
    {"displacement_D_xz", [](const Motion& m) { return m.D_xz; }},
    {"displacement_dilation", [](const Motion& m) { return m.dilation; }},
    {"displacement_strain_rate", [](const Motion& m) { return m.invariants.strain_rate; }},
    {"displacement_half_vorticity", [](const Motion& m) { return m.invariants.half_vorticity; }},
    {"displacement_I", [](const Motion& m) { return m.invariants.I; }},
    {"displacement_axis_angle_deg", [](const Motion& m) { return m.invariants.axis_angle_deg; }}};

Motion motion_at(const DisplacementNode& node, const PlaneMatrix& pressure) {
  Motion m;
  const double weight = node.sum[0];
  if (!(weight > 0)) return m;
  m.v_x = node.sum[1] / weight;
  m.v_z = node.sum[2] / weight;
  // The derivative of the quotient, each part by the kernel's own derivative.
  const auto slope = [&](const std::array<double, 3>& slopes, std::size_t moment, double velocity) {
    return (slopes[moment] - velocity * slopes[0]) / weight;
  };
  m.gradient = {slope(node.slope_x, 1, m.v_x), slope(node.slope_z, 1, m.v_x), slope(node.slope_x, 2, m.v_z),
                slope(node.slope_z, 2, m.v_z)};
  m.D_xz = (m.gradient.xz + m.gradient.zx) / 2;
  m.dilation = m.gradient.xx + m.gradient.zz;
  m.invariants = plane_invariants(pressure, m.gradient);
  return m;
}

/// Stresses of the map at a node, with the sign of a pressure.
PlaneMatrix pressure_at(const FieldMap& map, std::size_t node) {
  const auto value = [&](const char* name) { return map.field(name).value[node]; };
  return {value("sigma_xx"), -value("sigma_xz"), -value("sigma_zx"), value("sigma_zz")};
}

void set_intervals(const std::vector<Motion>& leave_one_out, const Motion& whole, std::size_t node,
                   std::vector<MapField>& fields) {
  std::vector<double> values(leave_one_out.size());
  for (std::size_t f = 0; f < std::size(named_fields); ++f) {
    const auto value_of = named_fields[f].value;
    const bool angle = fields[f].name == "displacement_axis_angle_deg";
    for (std::size_t b = 0; b < values.size(); ++b)
      values[b] = angle ? nearest_turn(value_of(leave_one_out[b]) - value_of(whole), 180)
                        : value_of(leave_one_out[b]);
    fields[f].ci99[node] = jackknife_ci99(values);
  }
}

}  // namespace

void add_displacement_fields(const CoarseGraining& graining, std::span<const DisplacementSums> batches,
                             FieldMap& map) {
  std::size_t pairs = 0;
  double time = 0;
  for (const DisplacementSums& batch : batches) {
    pairs += batch.pairs;
    time += batch.time;
  }
  if (pairs == 0) return;
  const double longest = longest_displacement * graining.width * static_cast<double>(pairs) / time;
  const bool with_intervals = batches.size() > 1;
  const MapField& v_x = map.field("v_x");
  std::vector<MapField> fields;
  for (const NamedField& field : named_fields) {
    fields.push_back({field.name, std::vector<double>(map.grid.nodes(), none), {}});
    if (with_intervals) fields.back().ci99.assign(map.grid.nodes(), none);
  }
  std::vector<Motion> leave_one_out(with_intervals ? batches.size() : 0);
  for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
    if (std::isnan(v_x.value[node])) continue;
    DisplacementNode total = batches.front().nodes[node];
    for (const DisplacementSums& batch : batches.subspan(1)) total += batch.nodes[node];
    const PlaneMatrix pressure = pressure_at(map, node);
    const Motion whole = motion_at(total, pressure);
    if (!(std::hypot(whole.v_x, whole.v_z) <= longest)) continue;
    for (std::size_t f = 0; f < std::size(named_fields); ++f)
      fields[f].value[node] = named_fields[f].value(whole);
    for (std::size_t b = 0; b < leave_one_out.size(); ++b) {
      DisplacementNode without = total;
      without -= batches[b].nodes[node];
      leave_one_out[b] = motion_at(without, pressure);
    }
    if (with_intervals) set_intervals(leave_one_out, whole, node, fields);
  }
  for (MapField& field : fields) map.fields.push_back(std::move(field));
}

}  // namespace drumlin::particles
