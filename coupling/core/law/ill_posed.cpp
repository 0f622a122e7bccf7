#include "coupling/core/law/ill_posed.hpp"

#include <cmath>

#include "coupling/core/law/well_posedness.hpp"

namespace drumlin {
namespace {

// At p = 1; the margin depends on I alone.
template <class Law>
bool ill_posed_at(const Law& law, const StressRatioLaw* k, double I) {
  if (!k) return well_posedness_margin(strength(law, 0.5 * I, 1), 0.5 * I) < 0;
  const double ratio = k->at_ln(std::log(I)).value;
  const double rate = 0.5 * I * std::sqrt(2 / (1 + ratio));  // sigma_zz = 2/(1 + k)
  return well_posedness_margin(turned_strength(law, LocalRatio{k, 1}, rate, 1), rate) < 0;
}

// ln I between a good and a bad end at which the one turns into the other.
template <class Bad>
double edge(const Bad& bad, double low, double high) {
  const bool bad_low = bad(low);
  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);
    (bad(middle) == bad_low ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::vector<InertialRange> ill_posed_intervals(const FrictionLaw& law, const StressRatioLaw* k, double I_min,
                                               double I_max) {
  const auto bad = [&](double ln_I) {
    return std::visit(
        [&]<class Law>(const Law& of) {
          if constexpr (OfInertialNumber<Law>) return ill_posed_at(of, k, std::exp(ln_I));
          return false;
        },
        law);
  };
  const double first = std::log(I_min), last = std::log(I_max);
  const int steps = static_cast<int>(std::ceil((last - first) / 0.01));
  std::vector<InertialRange> ranges;
  bool before = false;
  for (int i = 0; i <= steps; ++i) {
    const double here = first + i * (last - first) / steps, previous = here - (last - first) / steps;
    const bool now = bad(here);
    if (now && !before) ranges.push_back({i == 0 ? I_min : std::exp(edge(bad, previous, here)), I_max});
    if (!now && before) ranges.back().to = std::exp(edge(bad, previous, here));
    before = now;
  }
  return ranges;
}

std::vector<InertialRange> ill_posed_intervals(const RheologyFit& law) {
  if (!law.k) return ill_posed_intervals(law.mu, nullptr);
  const StressRatioLaw k = stress_ratio_law(*law.k);
  return ill_posed_intervals(law.mu, &k);
}

}  // namespace drumlin
