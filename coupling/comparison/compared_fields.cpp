#include "coupling/comparison/compared_fields.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin::coupling {

namespace {

constexpr std::string_view of_logarithm = "log10_";

bool is_logarithm(const std::string& name) { return name.starts_with(of_logarithm); }

FieldValues plain(std::vector<double> value, std::vector<double> ci99) {
  const std::size_t size = value.size();
  if (ci99.empty()) ci99.assign(size, no_value);
  return {std::move(value), std::move(ci99), std::vector<char>(size, 0), true};
}

FieldValues absent(std::size_t size) {
  return {std::vector<double>(size, no_value), std::vector<double>(size, no_value),
          std::vector<char>(size, 0), false};
}

/// A measurement whose interval reaches zero has no known sign; a computed number is what it is.
std::vector<char> lost_in_noise(const FieldValues& rate, bool measured) {
  std::vector<char> lost(rate.value.size(), 0);
  for (std::size_t i = 0; measured && i < lost.size(); ++i)
    lost[i] = std::isfinite(rate.value[i]) && (rate.ci99[i] >= rate.value[i] || rate.value[i] <= 0);
  return lost;
}

void leave_out(FieldValues& field, const std::vector<char>& noise) {
  for (std::size_t i = 0; i < noise.size(); ++i)
    if (noise[i] != 0) field.value[i] = field.ci99[i] = no_value;
  field.noise = noise;
}

FieldValues logarithm(FieldValues field, const std::vector<char>& noise) {
  leave_out(field, noise);
  for (std::size_t i = 0; i < field.value.size(); ++i) {
    const double value = field.value[i];
    field.value[i] = value > 0 ? std::log10(value) : no_value;
    field.ci99[i] = value > 0 ? field.ci99[i] / (value * std::numbers::ln10) : no_value;
  }
  return field;
}

bool is_measured(const RunHeader& header) {
  return header.side.value_or(RunSide::particles) == RunSide::particles;
}

/// A column, or nothing.
FieldValues column_or_nothing(const ProfileSet& profiles, const std::string& name) {
  const ProfileColumn* column = profiles.find(name);
  return column == nullptr ? absent(profiles.z.size()) : plain(column->value, column->ci99);
}

FieldValues needed_column(const ProfileSet& profiles, const std::string& name) {
  const ProfileColumn& column = profiles.column(name);
  return plain(column.value, column.ci99);
}

/// a + share b, errors independent.
FieldValues sum(const FieldValues& a, double share, const FieldValues& b) {
  FieldValues result = a;
  result.present = a.present && b.present;
  for (std::size_t i = 0; i < a.value.size(); ++i) {
    result.value[i] = a.value[i] + share * b.value[i];
    result.ci99[i] = std::hypot(a.ci99[i], share * b.ci99[i]);
  }
  return result;
}

FieldValues times(double factor, FieldValues field) {
  for (double& value : field.value) value *= factor;
  for (double& half_width : field.ci99) half_width *= std::abs(factor);
  return field;
}

/// d/dz by the layers above and below.
FieldValues slope_over_layers(const std::vector<double>& z, const FieldValues& field) {
  FieldValues slope = absent(z.size());
  slope.present = field.present;
  for (std::size_t i = 1; i + 1 < z.size(); ++i) {
    const double height = z[i + 1] - z[i - 1];
    slope.value[i] = (field.value[i + 1] - field.value[i - 1]) / height;
    slope.ci99[i] = std::hypot(field.ci99[i + 1], field.ci99[i - 1]) / height;
  }
  return slope;
}

/// Half width of atan2(a, b)/2 in degrees, for the half widths of a and b.
double half_angle_ci99(double a, double a_ci99, double b, double b_ci99) {
  return std::hypot(b * a_ci99, a * b_ci99) / (2 * (a * a + b * b)) * 180 / std::numbers::pi;
}

FieldValues profile_angle(const ProfileSet& profiles) {
  const auto at = [&](const char* name) { return column_or_nothing(profiles, name); };
  const FieldValues rate = needed_column(profiles, "shear_rate"), curl = at("half_vorticity");
  const FieldValues v_z_dx = curl.present ? sum(rate, -2, curl) : at("d_v_z_dx");
  const FieldValues along_z = at("d_v_z_dz"), along_x = at("d_v_x_dx");
  const FieldValues v_z_dz = along_z.present ? along_z : slope_over_layers(profiles.z, at("v_z"));
  const FieldValues v_x_dx = along_x.present ? along_x : times(-1, v_z_dz);
  const FieldValues xx = needed_column(profiles, "sigma_xx"), zz = needed_column(profiles, "sigma_zz"),
                    xz = needed_column(profiles, "sigma_xz");
  FieldValues result = absent(profiles.z.size());
  result.present = v_z_dx.present && v_z_dz.present && v_x_dx.present;
  const FieldValues shear = sum(rate, 1, v_z_dx), stretch = sum(v_z_dz, -1, v_x_dx),
                    difference = sum(xx, -1, zz);
  for (std::size_t i = 0; i < result.value.size(); ++i) {
    result.value[i] = axis_angle_deg({xx.value[i], -xz.value[i], -xz.value[i], zz.value[i]},
                                     {v_x_dx.value[i], rate.value[i], v_z_dx.value[i], v_z_dz.value[i]});
    result.ci99[i] =
        std::hypot(half_angle_ci99(2 * xz.value[i], 2 * xz.ci99[i], difference.value[i], difference.ci99[i]),
                   half_angle_ci99(shear.value[i], shear.ci99[i], stretch.value[i], stretch.ci99[i]));
  }
  return result;
}

}  // namespace

const std::vector<std::string>& compared_fields() {
  static const std::vector<std::string> fields = [] {
    std::vector<std::string> names;
    for (const Quantity& row : quantities())
      if (!row.compared.empty())
        names.push_back(std::string(row.compared == "log10" ? of_logarithm : "").append(row.name));
    return names;
  }();
  return fields;
}

std::string name_in_maps(const std::string& field) {
  const std::string plain = is_logarithm(field) ? field.substr(of_logarithm.size()) : field;
  return plain == "shear_rate" ? "strain_rate" : plain;
}

FieldValues profile_field(const std::string& name, const ProfileSet& profiles) {
  if (name == "v_x" || name.starts_with("sigma_")) return needed_column(profiles, name);
  if (name == "p" && profiles.find("p") == nullptr)
    return times(0.5, sum(needed_column(profiles, "sigma_xx"), 1, needed_column(profiles, "sigma_zz")));
  if (!is_logarithm(name) && period_of(name) == 0) return column_or_nothing(profiles, name);
  const FieldValues rate = needed_column(profiles, "shear_rate");
  const auto noise = lost_in_noise(rate, is_measured(profiles.header));
  if (is_logarithm(name))
    return logarithm(column_or_nothing(profiles, name.substr(of_logarithm.size())), noise);
  FieldValues result = profile_angle(profiles);
  leave_out(result, noise);
  return result;
}

FieldValues map_field(const std::string& name, const FieldMap& map) {
  const auto at = [&](const std::string& field) {
    const MapField* found = map.find(field);
    return found == nullptr ? absent(map.grid.nodes()) : plain(found->value, found->ci99);
  };
  FieldValues result = at(name_in_maps(name));
  if (!is_logarithm(name) && period_of(name) == 0) return result;
  const auto noise = lost_in_noise(at("strain_rate"), is_measured(map.header));
  if (is_logarithm(name)) return logarithm(std::move(result), noise);
  leave_out(result, noise);
  return result;
}

}  // namespace drumlin::coupling
