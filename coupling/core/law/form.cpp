#include "coupling/core/law/form.hpp"

#include <fmt/format.h>

namespace drumlin {
namespace {

constexpr double least_mu = 1e-3;  // m of kept_positive()

}  // namespace

const char* const mu_falls =
    "mu falls with I: faster shear would meet less resistance, so that no flow of this law is stable, and "
    "its equations are ill-posed";

FrictionValue kept_positive(double mu, double slope) {
  const double root = std::sqrt(mu * mu + 4 * least_mu * least_mu);
  return {0.5 * (mu + root), 0.5 * slope * (1 + mu / root)};
}

double positivity_slope(double kept) { return kept * kept / (kept * kept + least_mu * least_mu); }

std::vector<FormFault> faults_of_fit(double mu, double I_min, double I_max) {
  std::vector<FormFault> faults;
  if (!friction_range().holds(mu))
    faults.push_back({"a", fmt::format("gives mu = {:.3g} at I_max", mu), "mu of 0.001 to 10 there"});
  if (!(I_min < I_max)) faults.push_back({"I_max", "is not above I_min", "> I_min"});
  return faults;
}

std::string in_words(double number) { return fmt::format("{:g}", number); }

}  // namespace drumlin
