#include "coupling/calibration/judgement.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/student.hpp"

namespace drumlin {
namespace {

std::vector<FrictionPoint> all_of(const std::vector<std::vector<FrictionPoint>>& runs) {
  std::vector<FrictionPoint> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

double known(double error) { return std::isfinite(error) ? error : 0; }

}  // namespace

CalibratedLaw calibrated(const std::vector<std::vector<FrictionPoint>>& runs, const FrictionForm& form,
                         int draws) {
  const std::vector<FrictionPoint> all = all_of(runs);
  const FrictionForm kept = kept_well_posed(form, fit_friction(all, form).law);
  CalibratedLaw law{kept, fit_friction(all, kept), bootstrapped(runs, kept, draws), all.front().I,
                    all.front().I};
  for (const FrictionPoint& point : all) {
    law.I_min = std::min(law.I_min, point.I);
    law.I_max = std::max(law.I_max, point.I);
  }
  return law;
}

double half_width_at(const CalibratedLaw& law, double I) {
  const FrictionBand band = band_at(law.form, law.draws, I);
  return (band.high - band.low) / 2;
}

LawScore score_of(const std::string& run, const std::vector<FrictionPoint>& points,
                  const CalibratedLaw& law) {
  LawScore score{.run = run};
  double squares = 0, inside = 0;
  for (const FrictionPoint& point : points) {
    if (point.I < law.I_min * (1 - 1e-9) || point.I > law.I_max * (1 + 1e-9)) {
      ++score.outside;
      continue;
    }
    ++score.points;
    const double off = point.mu - friction(law.form, law.fit.law, point.I);
    squares += off * off;
    score.bias += off;
    const double slope = friction_slope(law.form, law.fit.law, point.I);
    const double error =
        std::hypot(known(point.mu_error), slope * known(point.I_error) / point.I, law.fit.intrinsic_scatter);
    inside += std::abs(off) <= std::hypot(normal_quantile_99 * error, half_width_at(law, point.I));
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

OneLaw one_law_of(const std::vector<RunsOfSpeed>& speeds, const CalibratedLaw& common, int draws) {
  if (speeds.size() < 2) throw InputError("one law for all speeds: there is one speed only");
  OneLaw result;
  double squares_common = 0, squares_own = 0, count = 0;
  for (const RunsOfSpeed& speed : speeds) {
    const std::vector<FrictionPoint> points = all_of(speed.runs);
    FrictionForm form = common.form;
    if (form.kind == FormKind::table) {
      std::vector<double> I;
      for (const FrictionPoint& point : points) I.push_back(point.I);
      form.knots = table_knots(I);
    }
    const CalibratedLaw own = calibrated(speed.runs, form, draws);
    for (const FrictionPoint& point : points) {
      squares_common += std::pow(point.mu - friction(common.form, common.fit.law, point.I), 2);
      squares_own += std::pow(point.mu - friction(own.form, own.fit.law, point.I), 2);
      ++count;
    }
    const double low = std::max(own.I_min, common.I_min), high = std::min(own.I_max, common.I_max);
    constexpr int places = 25;
    for (int i = 0; i < places; ++i) {
      const double I = low * std::pow(high / low, static_cast<double>(i) / (places - 1));
      const double difference = friction(own.form, own.fit.law, I) - friction(common.form, common.fit.law, I);
      const double ratio = std::abs(difference) / std::hypot(half_width_at(own, I), half_width_at(common, I));
      if (!(ratio > result.largest_ratio)) continue;
      result.largest_ratio = ratio;
      result.difference = difference;
      result.at_I = I;
      result.speed = speed.name;
    }
  }
  result.rms_common = std::sqrt(squares_common / count);
  result.rms_own = std::sqrt(squares_own / count);
  result.holds = result.largest_ratio <= 1;
  return result;
}

}  // namespace drumlin
