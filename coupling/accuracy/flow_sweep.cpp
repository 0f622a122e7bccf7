#include "coupling/accuracy/flow_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/common/errors.hpp"

namespace drumlin::coupling {
namespace {

void add(std::vector<FlowSettings>& points, const FlowSettings& one) {
  if (std::find(points.begin(), points.end(), one) == points.end()) points.push_back(one);
}

SweepCurve mesh_curve(const FlowSettings& standard, const SweepAxis& axis) {
  SweepCurve curve{axis.name, {standard}};
  std::vector<double> levels;
  for (int level = 1; level <= standard.levels + 1; ++level) levels.push_back(level);
  for (const double level : numbers_of(axis, levels)) {
    if (level != std::floor(level) || level > 8)
      throw InputError("--sweep mesh: its values are numbers of meshes (allowed: integer >= 1 and <= 8)");
    add(curve.points, {static_cast<int>(level), standard.eps, standard.tolerance});
  }
  std::sort(curve.points.begin(), curve.points.end(), [](auto& a, auto& b) { return a.levels < b.levels; });
  return curve;
}

SweepCurve eps_curve(const FlowSettings& standard, const SweepAxis& axis) {
  SweepCurve curve{axis.name, {standard}};
  const double eps = standard.eps;
  for (const double value : numbers_of(axis, {1000 * eps, 100 * eps, 10 * eps, eps, eps / 10}))
    add(curve.points, {standard.levels, value, standard.tolerance});
  std::sort(curve.points.begin(), curve.points.end(), [](auto& a, auto& b) { return a.eps > b.eps; });
  return curve;
}

SweepCurve tolerance_curve(const FlowSettings& standard, const SweepAxis& axis) {
  SweepCurve curve{axis.name, {standard}};
  for (const double value : numbers_of(axis, {1e-2, 1e-4, 1e-6, standard.tolerance}))
    add(curve.points, {standard.levels, standard.eps, value});
  std::sort(curve.points.begin(), curve.points.end(),
            [](auto& a, auto& b) { return a.tolerance > b.tolerance; });
  return curve;
}

double profile_difference(const std::vector<double>& here, const std::vector<double>& there) {
  if (here.size() != there.size()) return NAN;
  double change = 0, size = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (!std::isfinite(here[i]) || !std::isfinite(there[i])) continue;
    change += std::pow(here[i] - there[i], 2);
    size += std::pow(there[i], 2);
  }
  return std::sqrt(change / size);
}

NamedNumbers scalar_differences(const NamedNumbers& here, const NamedNumbers& there) {
  NamedNumbers differences;
  for (const auto& [name, value] : there) {
    const double number = number_named(here, name);
    if (std::isfinite(value) && value != 0 && std::isfinite(number))
      differences.emplace_back(name, std::abs(number / value - 1));
  }
  return differences;
}

NamedNumbers closed_form_errors(const FlowNumbers& flow) {
  const ClosedFormErrors& closed = flow.closed_form.value();
  NamedNumbers errors = scalar_differences(flow.scalars, closed.scalars);
  errors.emplace_back("v_x", closed.v_x);
  errors.emplace_back("v_x_mesh", closed.v_x_mesh);
  return errors;
}

bool lies_on(const SweptFlow& point, const std::string& axis) {
  return std::find(point.axes.begin(), point.axes.end(), axis) != point.axes.end();
}

}  // namespace

std::string name_of(const FlowSettings& s) {
  return fmt::format("levels-{}-eps-{:g}-tolerance-{:g}", s.levels, s.eps, s.tolerance);
}

std::vector<std::string> changes_of(const FlowSettings& s, const FlowSettings& standard,
                                    double surface_cell) {
  return {
      fmt::format("mesh.levels={}", s.levels),
      fmt::format("mesh.surface_cell={}", surface_cell * std::pow(2.0, standard.levels - s.levels)),
      fmt::format("regularisation.shear_rate={}", s.eps),
      fmt::format("solver.tolerance={}", s.tolerance),
  };
}

const std::vector<std::string>& flow_axes() {
  static const std::vector<std::string> axes = {"mesh", "eps", "tolerance"};
  return axes;
}

std::vector<SweepCurve> sweep_curves(const FlowSettings& standard, const std::vector<SweepAxis>& axes) {
  std::vector<SweepCurve> curves;
  for (const SweepAxis& axis : axes) {
    if (axis.name == "mesh")
      curves.push_back(mesh_curve(standard, axis));
    else if (axis.name == "eps")
      curves.push_back(eps_curve(standard, axis));
    else
      curves.push_back(tolerance_curve(standard, axis));
  }
  return curves;
}

FlowSettings reference_settings(const FlowSettings& standard, const std::vector<SweepCurve>& curves) {
  FlowSettings finest = standard;
  for (const SweepCurve& curve : curves) {
    const FlowSettings& last = curve.points.back();
    if (curve.axis == "mesh") finest.levels = last.levels + 1;
    if (curve.axis == "eps") finest.eps = last.eps / 10;
    // No tighter: rounding is near, and the last step of Newton's method leaves far less than it was asked
    // for.
    if (curve.axis == "tolerance") finest.tolerance = std::min(finest.tolerance, last.tolerance);
  }
  return finest;
}

NamedNumbers relative_differences(const FlowNumbers& flow, const FlowNumbers& reference) {
  NamedNumbers differences = scalar_differences(flow.scalars, reference.scalars);
  differences.emplace_back("v_x", profile_difference(flow.v_x, reference.v_x));
  return differences;
}

std::vector<FlowErrors> flow_errors(std::span<const SweptFlow> points, const std::vector<SweepCurve>& curves,
                                    const std::optional<FlowNumbers>& reference) {
  std::vector<FlowErrors> errors(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].numbers)
      errors[i].errors = reference ? relative_differences(*points[i].numbers, *reference)
                                   : closed_form_errors(*points[i].numbers);
  for (const SweepCurve& curve : curves) {
    const auto finest = std::find_if(points.begin(), points.end(), [&](const SweptFlow& point) {
      return point.settings == curve.points.back();
    });
    if (finest == points.end() || !finest->numbers) continue;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].numbers && lies_on(points[i], curve.axis) && points[i].settings != finest->settings)
        errors[i].alone.emplace_back(curve.axis, relative_differences(*points[i].numbers, *finest->numbers));
  }
  return errors;
}

std::vector<std::string> quantities_of(std::span<const FlowErrors> errors) {
  std::vector<std::string> names;
  for (const FlowErrors& one : errors)
    for (const auto& [name, error] : one.errors)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

}  // namespace drumlin::coupling
