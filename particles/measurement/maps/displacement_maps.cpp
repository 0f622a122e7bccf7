#include "particles/measurement/maps/displacement_maps.hpp"

#include <cmath>
#include <vector>

#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {

namespace {

using NodeMotion = DisplacementMotion;
constexpr double none = NodeMotion::none;

struct NamedField {
  const char* name;
  double (*value)(const NodeMotion&);
};
constexpr NamedField named_fields[] = {
    {"displacement_v_x", [](const NodeMotion& m) { return m.v_x; }},
    {"displacement_v_z", [](const NodeMotion& m) { return m.v_z; }},
    {"displacement_d_v_x_dx", [](const NodeMotion& m) { return m.gradient.xx; }},
    {"displacement_d_v_x_dz", [](const NodeMotion& m) { return m.gradient.xz; }},
    {"displacement_d_v_z_dx", [](const NodeMotion& m) { return m.gradient.zx; }},
    {"displacement_d_v_z_dz", [](const NodeMotion& m) { return m.gradient.zz; }},
    {"displacement_D_xx", [](const NodeMotion& m) { return m.gradient.xx; }},
    {"displacement_D_zz", [](const NodeMotion& m) { return m.gradient.zz; }},
    {"displacement_D_xz", [](const NodeMotion& m) { return m.D_xz; }},
    {"displacement_dilation", [](const NodeMotion& m) { return m.dilation; }},
    {"displacement_strain_rate", [](const NodeMotion& m) { return m.invariants.strain_rate; }},
    {"displacement_half_vorticity", [](const NodeMotion& m) { return m.invariants.half_vorticity; }},
    {"displacement_I", [](const NodeMotion& m) { return m.invariants.I; }},
    {"displacement_axis_angle_deg", [](const NodeMotion& m) { return m.invariants.axis_angle_deg; }}};

NodeMotion motion_at(const DisplacementNode& node, const PlaneMatrix& pressure) {
  NodeMotion m;
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

}  // namespace

DisplacementFields::DisplacementFields(const MapBatches& batches)
    : pairs_(batches.pairs()), left_out_(batches.size() > 1 ? batches.size() : 0), values_(left_out_.size()) {
  longest_ = longest_displacement * batches.graining().width * static_cast<double>(pairs_) / batches.time();
}

void DisplacementFields::add_empty_fields(std::size_t nodes, std::vector<MapField>& fields) const {
  if (pairs_ == 0) return;
  for (const NamedField& field : named_fields) {
    fields.push_back({field.name, std::vector<double>(nodes, none), {}});
    if (!left_out_.empty()) fields.back().ci99.assign(nodes, none);
  }
}

void DisplacementFields::set_node(const TileOfBatches& tile, std::size_t place, const MapValues& known,
                                  std::size_t at, std::span<MapField> fields) {
  if (pairs_ == 0 || std::isnan(known.v_x)) return;
  const PlaneMatrix pressure{known.sigma_xx, -known.sigma_xz, -known.sigma_zx, known.sigma_zz};
  DisplacementNode total = tile.displacement(0, place);
  for (std::size_t b = 1; b < tile.batches.size(); ++b) total += tile.displacement(b, place);
  const NodeMotion whole = motion_at(total, pressure);
  if (!(std::hypot(whole.v_x, whole.v_z) <= longest_)) return;
  for (std::size_t f = 0; f < std::size(named_fields); ++f)
    fields[f].value[at] = named_fields[f].value(whole);
  if (left_out_.empty()) return;
  for (std::size_t b = 0; b < left_out_.size(); ++b) {
    DisplacementNode without = total;
    without -= tile.displacement(b, place);
    left_out_[b] = motion_at(without, pressure);
  }
  for (std::size_t f = 0; f < std::size(named_fields); ++f) {
    const auto value_of = named_fields[f].value;
    const bool angle = fields[f].name == "displacement_axis_angle_deg";
    for (std::size_t b = 0; b < values_.size(); ++b)
      values_[b] =
          angle ? nearest_turn(value_of(left_out_[b]) - value_of(whole), 180) : value_of(left_out_[b]);
    fields[f].ci99[at] = jackknife_ci99(values_);
  }
}

}  // namespace drumlin::particles
