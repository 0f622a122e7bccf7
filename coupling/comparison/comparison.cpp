#include "coupling/comparison/comparison.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "coupling/comparison/targets.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/profile_scalars.hpp"

namespace drumlin {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Text of a header entry, empty if it is missing.
std::string header_text(const ProfileSet& profiles, const std::string& key) {
  const auto found = profiles.header.find(key);
  return found == profiles.header.end() ? std::string() : found->second;
}

double header_number(const ProfileSet& profiles, const std::string& key) {
  const std::string text = header_text(profiles, key);
  double value = nan;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : nan;
}

/// What a side says of a scalar; the profile's own reading where it says nothing.
Scalar scalar_of(const ComparedSide& side, const ProfileScalars& read_off, const std::string& name) {
  if (const auto* found = side.scalars.find(name)) return *found;
  Scalar result{name, nan, std::nullopt};
  if (name == "Q") result.value = read_off.Q;
  if (name == "H") result.value = read_off.H;
  if (name == "lambda") result.value = read_off.lambda;
  if (name == "shear_rate") result.value = read_off.shear_rate;
  if (name == "I_th") result.value = read_off.I_th;
  return result;
}

constexpr std::array scalar_names{"theta_deg",
                                  "Q",
                                  "H",
                                  "lambda",
                                  "shear_rate",
                                  "I_th",
                                  "nu_bulk",
                                  "mu_a",
                                  "mu_b",
                                  "k_flowing",
                                  "spin_over_half_vorticity",
                                  "dv_over_shear",
                                  "domega_over_shear"};

std::vector<ScalarPair> scalar_pairs(const ComparedSide& particles, const ComparedSide& continuum) {
  const ProfileScalars particle_reading = profile_scalars(particles.profiles);
  const ProfileScalars continuum_reading = profile_scalars(continuum.profiles);
  std::vector<ScalarPair> pairs;
  for (const auto* name : scalar_names) {
    const Scalar ours = scalar_of(particles, particle_reading, name);
    pairs.push_back({name, ours.value, ours.ci99, scalar_of(continuum, continuum_reading, name).value});
  }
  const auto value = [&](const char* name, double ScalarPair::*side) {
    for (const auto& pair : pairs)
      if (pair.name == name) return pair.*side;
    return nan;
  };
  const auto share = [&](double ScalarPair::*side) {
    return linear_layer_share(value("shear_rate", side), value("H", side), value("Q", side));
  };
  pairs.push_back(
      {"linear_layer_share", share(&ScalarPair::particles), std::nullopt, share(&ScalarPair::continuum)});
  return pairs;
}

}  // namespace

void require_same_drum(const ProfileSet& particles, const ProfileSet& continuum) {
  std::vector<InputProblem> problems;
  const auto differ = [&](const std::string& key, const std::string& allowed) {
    const auto shown = [&](const ProfileSet& side) {
      const std::string text = header_text(side, key);
      return text.empty() ? std::string("nothing") : text;
    };
    problems.push_back({"", 0, 0, key,
                        shown(particles) + " in the particles, " + shown(continuum) + " in the continuum",
                        allowed});
  };
  // Written by two programs from one scene: equal up to rounding, and up to the discs drawn against their
  // mean.
  constexpr double tolerance = 1e-3;
  for (const auto* key : {"rotation", "drum_radius", "diameter_m"}) {
    const double ours = header_number(particles, key);
    const double theirs = header_number(continuum, key);
    if (!(std::abs(ours - theirs) <= tolerance * std::abs(ours)))
      differ(key, "the same drum, speed and units on both sides");
  }
  if (header_text(particles, "reduced") != header_text(continuum, "reduced") ||
      header_text(particles, "reduced").empty())
    differ("reduced", "both reduced or both full");
  if (!problems.empty()) throw InputError(problems);
}

double linear_layer_share(double shear_rate, double H, double Q) { return 0.4 * shear_rate * H * H / Q; }

Comparison compare(const ComparedSide& particles, const ComparedSide& continuum, const ZoneOptions& options) {
  require_same_drum(particles.profiles, continuum.profiles);
  Comparison result;
  result.scalars = scalar_pairs(particles, continuum);
  double H = nan;
  for (const auto& pair : result.scalars)
    if (pair.name == "H") H = pair.particles;
  for (const auto& field : compared_fields()) {
    FieldComparison comparison{overlay(field, particles.profiles, continuum.profiles), {}};
    for (const auto& zone : zones_of(particles.profiles, H, options))
      comparison.zones.push_back({zone, errors_in(comparison.overlay, zone)});
    result.fields.push_back(std::move(comparison));
  }
  result.targets = judged_targets(result.fields, result.scalars);
  return result;
}

}  // namespace drumlin
