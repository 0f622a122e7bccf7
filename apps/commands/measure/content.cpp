#include "apps/commands/measure/content.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

void add_law(const LogLaw& law, ScalarSet& scalars) {
  scalars.scalars.push_back({"mu_a", law.a, {}});
  scalars.scalars.push_back({"mu_b", law.b, {}});
}

}  // namespace

Json settings_of(const particles::Measurement& m, const particles::MeasurementOptions& options,
                 const coupling::LayerSelection& selection) {
  Json settings{
      {"frame", "turns with the drum; x downslope, z along the normal of the surface"},
      {"frame_from", name_of(m.place.source)},
      {"frame_angle_deg", m.frame_angle_deg},
      {"seen_in_a_mirror", m.place.in_mirror},
      {"slope_isoline_nu", options.slope_isoline},
      {"slope_half_width", m.slope_half_width},
      {"slope_half_width_asked", options.slope_half_width},
      {"surface_nu", options.surface_nu},
      {"position", options.position},
      {"slice_width", m.place.slice_width},
      {"slice_width_asked", options.slice_width},
      {"layer_thickness", m.layer_thickness},
      {"velocity_window", m.velocity_window},
      {"surface_speed_depth", options.scalars.surface_speed_depth},
      {"linear_share", options.scalars.linear_share},
      {"decay_window_below_H", {options.scalars.decay_to, options.scalars.decay_from}},
      {"bulk_margin", options.bulk_margin},
      {"wall_margin", options.wall_margin},
      {"fluctuation_I_min", options.fluctuation_I_min},
      {"mu_fit_I", {selection.I_min, selection.I_max}},
      {"mu_fit_surface_margin", selection.surface_margin},
      {"mu_fit_wall_margin", selection.wall_margin},
      {"intervals", "99 %, delete-one jackknife over contiguous batches, neighbours' correlation, Student t"},
      {"batches", m.place.batches},
      {"snapshots", m.place.snapshots},
      {"first_snapshot", m.first_snapshot},
      {"first_time", m.first_time()},
      {"last_time", m.last_time()},
      {"rotation", m.place.rotation},
      {"axis_depth", m.axis_depth},
      {"wall_z", m.wall_z},
      {"drum_radius", m.place.container_radius},
      {"scales", m.scales}};
  settings["geometry"] = m.place.container_radius > 0 ? "drum" : m.place.period > 0 ? "layers" : "open";
  if (m.layer_thickness != options.layer_thickness)
    settings["layer_thickness_asked"] = options.layer_thickness;
  if (m.scattered)
    settings["window"] = {{"x", {m.place.reach.x_min, m.place.reach.x_max}},
                          {"z", {m.place.reach.z_min, m.place.reach.z_max}},
                          {"scattered_mean", m.scattered->mean},
                          {"scattered_most", m.scattered->most},
                          {"scattered_last", m.scattered->last}};
  if (options.gradient_step) {
    settings["gradient_step"] = m.place.gradient_step;
    settings["gradient_step_asked"] = *options.gradient_step;
  }
  return settings;
}

Json steadiness_of(const particles::Steadiness& s) {
  const auto drift = [](const particles::Drift& d) { return to_json(Scalar{"", d.value, d.ci99}); };
  const auto number = [](double value) { return number_or_null(value); };
  return {{"steady", s.steady},
          {"flows", s.flows},
          {"reasons", s.reasons},
          {"turns", number(s.turns)},
          {"turns_before", number(s.turns_before)},
          {"energy_change", drift(s.energy)},
          {"energy_std", number(s.energy_std)},
          {"slope_change_deg", drift(s.slope_deg)},
          {"slope_std_deg", number(s.slope_std_deg)},
          {"judged_by", s.judged_by},
          {"energy_trend", to_json(Scalar{"", s.energy_trend.value, s.energy_trend.ci99})},
          {"pressure_change", drift(s.pressure)},
          {"shear_stress_change", drift(s.shear_stress)},
          {"shear_rate_change", drift(s.shear_rate)}};
}

Json scalar_with_sensitivity(const Scalar& scalar, const particles::ScalarSensitivity& sensitivity) {
  Json json = to_json(scalar);
  if (!json.is_object() || sensitivity.changes.empty()) return json;
  Json changes;
  for (const auto& one : sensitivity.changes) changes[one.change] = number_or_null(one.value);
  json["sensitivity"] = {{"lowest", sensitivity.lowest},
                         {"highest", sensitivity.highest},
                         {"strongest", sensitivity.strongest},
                         {"changes", changes}};
  return json;
}

void add_friction_variants(const particles::Measurement& measured, const coupling::LayerSelection& selection,
                           std::vector<particles::ScalarVariant>& variants) {
  for (particles::ScalarVariant& variant : variants)
    if (!variant.profiles.z.empty())
      add_law(coupling::friction_with_borrowed_intervals(variant.profiles, measured.profiles, selection),
              variant.scalars);
  for (const coupling::FrictionVariant& variant : coupling::friction_variants(measured.profiles, selection)) {
    variants.push_back({variant.change, {}, {}});
    add_law(variant.law, variants.back().scalars);
  }
}

}  // namespace drumlin::apps
