#include "coupling/comparison/compared_scalars.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/profile_scalars.hpp"

namespace drumlin::coupling {

namespace {

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

/// What depends on where z = 0 is.
bool counts_from_surface(const std::string& name) {
  return name == "H" || name == "lambda" || name == "shear_rate" || name == "I_th";
}

double read_off(const ProfileScalars& reading, const std::string& name) {
  if (name == "Q") return reading.Q;
  if (name == "H") return reading.H;
  if (name == "lambda") return reading.lambda;
  if (name == "shear_rate") return reading.shear_rate;
  if (name == "I_th") return reading.I_th;
  return no_value;
}

/// What a side says of a scalar; the profile's own reading where it says nothing.
Scalar scalar_of(const ComparedSide& side, const ProfileScalars& reading, const std::string& name) {
  Scalar result = said(side, name);
  if (side.scalars.find(name) == nullptr) result.value = read_off(reading, name);
  return result;
}

}  // namespace

Scalar said(const ComparedSide& side, const std::string& name) {
  const Scalar* found = side.scalars.find(name);
  return found != nullptr ? *found : Scalar{name, no_value, std::nullopt};
}

std::vector<ScalarPair> scalar_pairs(const ComparedSide& particles, const ComparedSide& continuum,
                                     const ProfileSet& registered, double offset) {
  const ProfileScalars ours = profile_scalars(particles.profiles), theirs = profile_scalars(registered);
  std::vector<ScalarPair> pairs;
  for (const char* name : scalar_names) {
    const Scalar first = scalar_of(particles, ours, name);
    Scalar second = scalar_of(continuum, theirs, name);
    if (offset != 0 && counts_from_surface(name)) second.value = read_off(theirs, name);
    pairs.push_back({name, first.value, first.ci99, second.value, second.ci99, said(continuum, name).value});
  }
  const auto pair = [&](const std::string& name) -> const ScalarPair& {
    return *std::find_if(pairs.begin(), pairs.end(), [&](const auto& p) { return p.name == name; });
  };
  const auto share = [&](double ScalarPair::*side) {
    return linear_layer_share(pair("shear_rate").*side, pair("H").*side, pair("Q").*side);
  };
  const ScalarPair linear{"linear_layer_share", share(&ScalarPair::particles),
                          std::nullopt,         share(&ScalarPair::continuum),
                          std::nullopt,         no_value};
  const ScalarPair& lambda = pair("lambda");
  const ProfileScalarOptions window;
  const double H = pair("H").particles;
  const ScalarPair same{
      "lambda_same_window", lambda.particles,
      lambda.ci99,          decay_length(registered, -H - window.decay_from, -H - window.decay_to),
      std::nullopt,         no_value};
  pairs.push_back(linear);
  pairs.push_back(same);
  return pairs;
}

}  // namespace drumlin::coupling
