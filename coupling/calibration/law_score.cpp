#include "coupling/calibration/law_score.hpp"

#include <cmath>

#include "coupling/core/statistics/quantiles.hpp"

namespace drumlin::coupling {
LawScore score_of(const std::string& run, const std::vector<FrictionPoint>& points,
                  const CalibratedLaw& law) {
  LawScore score{.run = run};
  const FormCurve curve = law.curve();
  const BandOfDraws band = law.band();
  double squares = 0, inside = 0;
  for (const FrictionPoint& point : points) {
    if (point.I < law.I_min * (1 - 1e-9) || point.I > law.I_max * (1 + 1e-9)) {
      ++score.outside_range;
      continue;
    }
    ++score.points;
    const CurvePoint at = curve.at(point.I);
    const double off = point.mu - at.value;
    squares += off * off;
    score.bias += off;
    const double error = std::hypot(known(point.mu_error), at.slope * known(point.I_error) / point.I,
                                    law.fit.intrinsic_scatter);
    inside +=
        std::abs(off) <= std::hypot(statistics::normal_quantile_99 * error, band.half_width_at(point.I));
    if (std::abs(off) > score.largest) {
      score.largest = std::abs(off);
      score.largest_at_I = point.I;
    }
  }
  if (score.points == 0) return score;
  const auto count = static_cast<double>(score.points);
  score.rms = std::sqrt(squares / count);
  score.bias /= count;
  score.inside_prediction = inside / count;
  return score;
}

}  // namespace drumlin::coupling
