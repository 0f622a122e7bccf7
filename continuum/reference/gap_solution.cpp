#include "continuum/reference/gap_solution.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drumlin::continuum {
namespace {

constexpr std::array<double, 3> gauss_place = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> gauss_weight = {5.0 / 18, 8.0 / 18, 5.0 / 18};

// What turns the shear rate into a speed: v itself, or v/r in an annulus.
double rate_share(const Gap& gap, double y) { return gap.inner_radius > 0 ? 1 / (gap.inner_radius + y) : 1; }

class Integral {
 public:
  Integral(const Gap& gap, const StressLaw& law, const Regularisation& regularisation, double top)
      : gap_(gap), law_(law), regularisation_(regularisation), top_(top) {}

  double rate(double y) const {
    return continuum::shear_rate(law_, regularisation_, gap_pressure(gap_, y),
                                 gap_shear_stress(gap_, top_, y));
  }
  /// Of rate * rate_share over [from, to].
  double over(double from, double to) const {
    double sum = 0;
    for (std::size_t q = 0; q < gauss_place.size(); ++q) {
      const double y = from + (to - from) * gauss_place[q];
      sum += gauss_weight[q] * (to - from) * rate(y) * rate_share(gap_, y);
    }
    return sum;
  }

 private:
  const Gap& gap_;
  const StressLaw& law_;
  const Regularisation& regularisation_;
  double top_;
};

// Pieces that crowd at both ends, where the shear is thin or starts as a root, with the asked distances
// between.
std::vector<double> pieces(const Gap& gap, std::span<const double> distances, int count) {
  std::vector<double> ends;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count, s = t * t * t * (10 - 15 * t + 6 * t * t);
    ends.push_back(s * gap.depth);
  }
  for (const double y : distances)
    if (y > 0 && y < gap.depth) ends.push_back(y);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

double top_speed(const Gap& gap, const Integral& integral, int count) {
  const auto ends = pieces(gap, {}, count);
  double sum = 0;
  for (std::size_t i = 1; i < ends.size(); ++i) sum += integral.over(ends[i - 1], ends[i]);
  return sum / rate_share(gap, 0);
}

double driving_shear_stress(const Gap& gap, const StressLaw& law, const Regularisation& regularisation) {
  double low = 0, high = 10 * gap.pressure;
  while (top_speed(gap, Integral(gap, law, regularisation, high), 60) < *gap.speed) high *= 2;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (top_speed(gap, Integral(gap, law, regularisation, middle), 60) < *gap.speed ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double shear_rate(const StressLaw& law, const Regularisation& r, double p, double shear_stress) {
  const auto carried = [&](double rate) {
    const PlaneTensor D{0, 0, 0.5 * rate};
    return std::visit([&](const auto& chosen) { return stress_response(chosen, r, D, p, D).stress.xz; }, law);
  };
  double low = std::log(1e-30), high = std::log(1e6);
  if (carried(std::exp(low)) >= shear_stress) return 0;
  for (int i = 0; i < 70; ++i) {
    const double middle = 0.5 * (low + high);
    (carried(std::exp(middle)) < shear_stress ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

GapSolution gap_solution(const Gap& gap, const StressLaw& law, const Regularisation& regularisation,
                         std::span<const double> distances) {
  GapSolution solution;
  if (gap.speed) solution.top_shear_stress = driving_shear_stress(gap, law, regularisation);
  const Integral integral(gap, law, regularisation, solution.top_shear_stress);
  const auto ends = pieces(gap, distances, 400);
  std::vector<double> speed(ends.size(), 0.0);  // over rate_share; from the wall at rest upwards
  for (std::size_t i = ends.size() - 1; i-- > 0;)
    speed[i] = speed[i + 1] + integral.over(ends[i], ends[i + 1]);
  for (std::size_t i = 0; i < ends.size(); ++i) speed[i] /= rate_share(gap, ends[i]);
  solution.top_speed = speed.front();
  // Simpson's rule with the speed at the middle of each piece from its own shear.
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double middle = 0.5 * (ends[i - 1] + ends[i]);
    const double there =
        (speed[i] * rate_share(gap, ends[i]) + integral.over(middle, ends[i])) / rate_share(gap, middle);
    solution.Q += gap.nu * (ends[i] - ends[i - 1]) * (speed[i - 1] + 4 * there + speed[i]) / 6;
  }
  for (const double y : distances) {
    const auto found = std::lower_bound(ends.begin(), ends.end(), std::clamp(y, 0.0, gap.depth));
    solution.speed.push_back(speed[std::min<std::size_t>(found - ends.begin(), ends.size() - 1)]);
    solution.shear_rate.push_back(integral.rate(y));
  }
  return solution;
}

}  // namespace drumlin::continuum
