#include "coupling/calibration/one_law.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::coupling {

OneLaw one_law_of(const std::vector<RunsOfSpeed>& speeds, const CalibratedLaw& common, int draws) {
  if (speeds.size() < 2) throw InputError("one law for all speeds: there is one speed only");
  const FormCurve common_curve = common.curve();
  const BandOfDraws common_band = common.band();
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
    // What holds the common table well-posed belongs to its knots.
    form.least_growth.clear();
    const CalibratedLaw own = calibrated(speed.runs, form, draws);
    const FormCurve own_curve = own.curve();
    const BandOfDraws own_band = own.band();
    for (const FrictionPoint& point : points) {
      squares_common += std::pow(point.mu - common_curve.at(point.I).value, 2);
      squares_own += std::pow(point.mu - own_curve.at(point.I).value, 2);
      ++count;
    }
    const double low = std::max(own.I_min, common.I_min), high = std::min(own.I_max, common.I_max);
    constexpr int places = 25;
    for (int i = 0; i < places; ++i) {
      const double I = low * std::pow(high / low, static_cast<double>(i) / (places - 1));
      const double difference = own_curve.at(I).value - common_curve.at(I).value;
      const double ratio =
          std::abs(difference) / std::hypot(own_band.half_width_at(I), common_band.half_width_at(I));
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

}  // namespace drumlin::coupling
