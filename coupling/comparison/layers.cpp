#include "coupling/comparison/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/comparison/compared_scalars.hpp"
#include "coupling/comparison/overlay_profiles.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin::coupling {

namespace {

constexpr double surface_speed_depth = 1;  // as profile_scalars() reads it

bool is_continuum(const ProfileSet& profiles) { return profiles.header.side == RunSide::continuum; }

/// The highest layer that is half as dense as the densest.
double dense_top(const ProfileSet& profiles) {
  const std::vector<double>& nu = profiles.column("nu").value;
  double densest = 0, top = no_value;
  for (const double value : nu)
    if (value > densest) densest = value;
  for (std::size_t l = 0; l < nu.size(); ++l)
    if (densest > 0 && nu[l] >= densest / 2) top = profiles.z[l];
  return top;
}

Zone bulk_of(const ProfileSet& profiles, const LayerOptions& options) {
  const double wall = needed_number(profiles.header, &RunHeader::wall_z, "profiles.csv");
  // The middle of a chute is no end of the packing.
  const bool half = geometry_of(profiles) == Geometry::chute;
  const double top = !half                    ? dense_top(profiles) - options.top_margin
                     : is_continuum(profiles) ? 0
                                              : (wall + dense_top(profiles)) / 2;
  return {"bulk", wall + options.wall_margin, top};
}

/// Indices of the layers within a zone.
std::vector<std::size_t> layers_in(const std::vector<double>& z, const Zone& zone) {
  std::vector<std::size_t> layers;
  for (std::size_t l = 0; l < z.size(); ++l)
    if (z[l] >= zone.from && z[l] <= zone.to) layers.push_back(l);
  return layers;
}

double mean_of(const std::vector<double>& values, const std::vector<std::size_t>& layers) {
  double sum = 0;
  for (const std::size_t l : layers) sum += values[l];
  return layers.empty() ? no_value : sum / static_cast<double>(layers.size());
}

/// Between Gibbs' dividing planes.
LayerExtent extent_of_packing(const ProfileSet& profiles, const LayerOptions& options) {
  const std::vector<double>& nu = profiles.column("nu").value;
  const std::vector<std::size_t> bulk = layers_in(profiles.z, bulk_of(profiles, options));
  const double bulk_nu = mean_of(nu, bulk);
  if (!(bulk_nu > 0))
    throw InputError("profiles.csv: z: no layer of a bulk is left between the margins of wall and surface");
  const double thickness = profiles.header.layer_thickness.value_or(1);
  const std::size_t middle = bulk[bulk.size() / 2];
  LayerExtent extent{profiles.z[middle] - thickness / 2, profiles.z[middle] - thickness / 2};
  for (std::size_t l = 0; l < nu.size(); ++l) {
    const double held = std::isfinite(nu[l]) ? thickness * nu[l] / bulk_nu : 0;
    (l < middle ? extent.base : extent.top) += l < middle ? -held : held;
  }
  return extent;
}

std::string angle_text(const ProfileSet& side) {
  return header_text(side.header, "theta_deg").value_or("nothing");
}

void require_same_layers(const ProfileSet& first, const ProfileSet& second) {
  std::vector<InputProblem> problems;
  const auto differ = [&](const std::string& key, const std::string& ours, const std::string& theirs,
                          const std::string& allowed) {
    problems.push_back({"", 0, 0, key, ours + " in the first side, " + theirs + " in the second", allowed});
  };
  const double ours = number_or_nan(first.header, &RunHeader::diameter_m),
               theirs = number_or_nan(second.header, &RunHeader::diameter_m);
  if (!(std::abs(ours - theirs) <= 1e-3 * std::abs(ours)))
    differ("diameter_m", fmt::format("{:.6g}", ours), fmt::format("{:.6g}", theirs), "the same grains");
  const double slope = number_or_nan(first.header, &RunHeader::theta_deg) -
                       number_or_nan(second.header, &RunHeader::theta_deg);
  if (!(std::abs(slope) <= 0.01))
    differ("theta_deg", angle_text(first), angle_text(second), "the same slope, to 0.01 deg");
  if (first.header.reduced != second.header.reduced || !first.header.reduced)
    differ("reduced", header_text(first.header, "reduced").value_or("nothing"),
           header_text(second.header, "reduced").value_or("nothing"), "both reduced or both full");
  if (!problems.empty()) throw InputError(std::move(problems));
}

void require_same_height(const LayerExtent& first, const LayerExtent& second) {
  if (std::abs(first.height() - second.height()) <= 0.1 * first.height()) return;
  throw InputError({InputProblem{
      "", 0, 0, "height",
      fmt::format("{:.4g} d in the first side, {:.4g} d in the second", first.height(), second.height()),
      "the same to a tenth"}});
}

/// Means over the layers of the bulk, of one side of the overlays.
std::vector<Scalar> bulk_means(const std::vector<FieldComparison>& fields,
                               const std::vector<double> FieldOverlay::*side, const Zone& bulk) {
  const auto mean = [&](const std::string& name) {
    const auto found = std::find_if(fields.begin(), fields.end(), [&](const FieldComparison& field) {
      return field.overlay.field == name;
    });
    return mean_of(found->overlay.*side, layers_in(found->overlay.z, bulk));
  };
  const double rate = mean("shear_rate"), normal = mean("sigma_zz"), shear = mean("sigma_xz");
  return {{"bulk_shear_rate", rate, {}},
          {"bulk_sigma_zz", normal, {}},
          {"bulk_sigma_xz", shear, {}},
          {"bulk_mu", shear / normal, {}},
          {"bulk_I", rate / std::sqrt(normal), {}},
          {"bulk_nu", mean("nu"), {}}};
}

std::vector<ScalarPair> layer_scalars(const ComparedSide& first, const ComparedSide& second,
                                      const ProfileSet& registered, const LayerComparison& comparison,
                                      const Zone& bulk) {
  const auto angle_of = [](const ComparedSide& side) {
    return number_or_nan(side.profiles.header, &RunHeader::theta_deg);
  };
  const auto speed = [](const ProfileSet& profiles) {
    return interpolated(profiles.z, profiles.column("v_x").value, -surface_speed_depth);
  };
  std::vector<ScalarPair> pairs{
      {"theta_deg", angle_of(first), std::nullopt, angle_of(second)},
      {"height", comparison.first.height(), std::nullopt, comparison.second.height()},
      {"surface_speed", speed(first.profiles), said(first, "surface_speed").ci99, speed(registered),
       std::nullopt, said(second, "surface_speed").value}};
  // Half of a chute is solved, and all of it is measured.
  if (comparison.geometry != Geometry::chute)
    pairs.push_back({"Q", said(first, "Q").value, said(first, "Q").ci99, said(second, "Q").value,
                     said(second, "Q").ci99});
  const auto ours = bulk_means(comparison.fields, &FieldOverlay::particles, bulk),
             theirs = bulk_means(comparison.fields, &FieldOverlay::continuum, bulk);
  for (std::size_t i = 0; i < ours.size(); ++i)
    pairs.push_back({ours[i].name, ours[i].value, said(first, ours[i].name).ci99, theirs[i].value});
  return pairs;
}

}  // namespace

std::optional<Geometry> geometry_of(const ProfileSet& profiles) {
  if (number_or_nan(profiles.header, &RunHeader::drum_radius) > 0) return Geometry::drum;
  return profiles.header.geometry;
}

void require_same_geometry(const ProfileSet& first, const ProfileSet& second) {
  const auto ours = geometry_of(first), theirs = geometry_of(second);
  if (ours && ours == theirs) return;
  const auto named = [](std::optional<Geometry> one) { return one ? name_of(*one) : "none"; };
  throw InputError({InputProblem{
      "", 0, 0, "geometry", fmt::format("{} in the first side, {} in the second", named(ours), named(theirs)),
      fmt::format(
          "the same on both sides ({}); layers that name none: measured by an older version, of a level "
          "bed, or pulled towards -x",
          fmt::join(names_of(Geometry{}), ", "))}});
}

std::vector<Zone> layer_zones(const ProfileSet& first, const LayerOptions& options) {
  const LayerExtent extent = layer_extent(first, options);
  const Zone bulk = bulk_of(first, options);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double half = first.header.layer_thickness.value_or(1) / 2;
  const double lowest = extent.base + half, highest = extent.top - half;
  return {bulk,
          {"near_base", lowest, std::nextafter(bulk.from, -infinity)},
          {"near_top", std::nextafter(bulk.to, infinity), highest},
          {"all", lowest, highest}};
}

LayerExtent layer_extent(const ProfileSet& profiles, const LayerOptions& options) {
  if (is_continuum(profiles)) return {needed_number(profiles.header, &RunHeader::wall_z, "profiles.csv"), 0};
  LayerExtent extent = extent_of_packing(profiles, options);
  if (geometry_of(profiles) == Geometry::chute) extent.top = (extent.base + extent.top) / 2;
  return extent;
}

const std::vector<std::string>& compared_layer_fields() {
  static const std::vector<std::string> fields{"v_x", "shear_rate", "sigma_zz", "sigma_xz", "sigma_xx",
                                               "p",   "mu",         "I",        "k",        "nu"};
  return fields;
}

LayerComparison compare_layers(const ComparedSide& first, const ComparedSide& second, Registration by,
                               const LayerOptions& options) {
  require_same_geometry(first.profiles, second.profiles);
  require_same_layers(first.profiles, second.profiles);
  LayerComparison result;
  result.geometry = *geometry_of(first.profiles);
  result.registration = by;
  result.first = layer_extent(first.profiles, options);
  result.second = layer_extent(second.profiles, options);
  require_same_height(result.first, result.second);
  if (by == Registration::axis) result.offset = result.first.base - result.second.base;
  const ProfileSet registered = moved(second.profiles, result.offset);
  const std::vector<Zone> zones = layer_zones(first.profiles, options);
  for (const std::string& field : compared_layer_fields()) {
    FieldComparison comparison{overlay(field, first.profiles, registered), {}};
    for (const Zone& zone : zones) comparison.zones.push_back({zone, errors_in(comparison.overlay, zone)});
    result.fields.push_back(std::move(comparison));
  }
  result.scalars = layer_scalars(first, second, registered, result, zones.front());
  return result;
}

ProfileSet layer_overlay(const LayerComparison& comparison, const ProfileSet& first) {
  ProfileSet set = compared_columns(comparison.fields, first.header.reduced.value());
  set.header.geometry = comparison.geometry;
  set.header.position = first.header.position;
  return set;
}

}  // namespace drumlin::coupling
