#include "coupling/comparison/comparison.hpp"

#include <cmath>

#include "coupling/comparison/compared_scalars.hpp"
#include "coupling/comparison/map_sampling.hpp"
#include "coupling/comparison/targets.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin::coupling {

void require_same_drum(const ProfileSet& particles, const ProfileSet& continuum) {
  std::vector<InputProblem> problems;
  const auto differ = [&](const std::string& key, const std::string& allowed) {
    const auto shown = [&](const ProfileSet& side) {
      return header_text(side.header, key).value_or("nothing");
    };
    problems.push_back({"", 0, 0, key,
                        shown(particles) + " in the particles, " + shown(continuum) + " in the continuum",
                        allowed});
  };
  // Written by two programs from one scene: equal up to rounding, and up to the discs drawn against their
  // mean.
  constexpr double tolerance = 1e-3;
  for (const HeaderNumber number :
       {&RunHeader::rotation, &RunHeader::drum_radius, &RunHeader::diameter_m, &RunHeader::position}) {
    const double ours = number_or_nan(particles.header, number);
    const double theirs = number_or_nan(continuum.header, number);
    if (!(std::abs(ours - theirs) <= tolerance * std::abs(ours)))
      differ(key_of(number), "the same drum, speed, units and place on both sides");
  }
  if (number_or_nan(particles.header, &RunHeader::drum_radius) <= 0) differ("drum_radius", "a drum");
  if (particles.header.reduced != continuum.header.reduced || !particles.header.reduced)
    differ("reduced", "both reduced or both full");
  if (!problems.empty()) throw InputError(problems);
}

double linear_layer_share(double shear_rate, double H, double Q) { return 0.4 * shear_rate * H * H / Q; }

ProfileSet registered_centre(const ComparedSide& first, const ComparedSide& second, Registration by) {
  ProfileSet profiles = second.profiles;
  if (second.fields.maps && profiles.find("half_vorticity") == nullptr) {
    const double width = number_or_nan(profiles.header, &RunHeader::slice_width);
    const double thickness = number_or_nan(profiles.header, &RunHeader::layer_thickness);
    const ProfileSet through = profile_through(
        *second.fields.maps, number_or_nan(profiles.header, &RunHeader::position),
        std::isfinite(width) ? width : 20, profiles.z, std::isfinite(thickness) ? thickness : 1);
    for (const char* name : {"half_vorticity", "d_v_x_dx", "d_v_z_dz"})
      if (const ProfileColumn* column = through.find(name)) profiles.columns.push_back(*column);
  }
  return moved(std::move(profiles), registration_offset(first.profiles.header, second.profiles.header, by));
}

Comparison compare(const ComparedSide& particles, const ComparedSide& continuum,
                   const ComparisonOptions& options) {
  require_same_drum(particles.profiles, continuum.profiles);
  Comparison result;
  result.registration = options.registration;
  result.offset =
      registration_offset(particles.profiles.header, continuum.profiles.header, options.registration);
  if (!std::isfinite(result.offset))
    throw InputError("axis_depth: is missing in a header, and the sides are registered by the axis");
  const ProfileSet registered = registered_centre(particles, continuum, options.registration);
  result.scalars = scalar_pairs(particles, continuum, registered, result.offset);
  double H = no_value;
  for (const auto& pair : result.scalars)
    if (pair.name == "H") H = pair.particles;
  // A first side without gradients of its own (a continuum) gets them from its maps as well.
  const ProfileSet ours = registered_centre(particles, particles, Registration::surface);
  for (const auto& field : compared_fields()) {
    FieldComparison comparison{overlay(field, ours, registered), {}};
    for (const auto& zone : zones_of(ours, H, options.zones))
      comparison.zones.push_back({zone, errors_in(comparison.overlay, zone)});
    result.fields.push_back(std::move(comparison));
  }
  result.slices = compared_slices(particles.fields, continuum.fields, options.registration, options.zones);
  result.maps = compared_maps(particles.fields, continuum.fields, options.registration, options.zones);
  result.targets = judged_targets(result.fields, result.scalars);
  return result;
}

}  // namespace drumlin::coupling
