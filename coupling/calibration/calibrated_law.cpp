#include "coupling/calibration/calibrated_law.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::coupling {

std::vector<FrictionPoint> all_of(const std::vector<std::vector<FrictionPoint>>& runs) {
  std::vector<FrictionPoint> all;
  for (const auto& run : runs) all.insert(all.end(), run.begin(), run.end());
  return all;
}

CalibratedLaw calibrated(const std::vector<std::vector<FrictionPoint>>& runs, const FrictionForm& form,
                         int draws, const std::function<void()>& before_each) {
  const std::vector<FrictionPoint> all = all_of(runs);
  CalibratedLaw law{form, fit_friction(all, form), {}, all.front().I, all.front().I};
  // A table that is held in one interval may become too flat in the next.
  for (int round = 0; round < 20; ++round) {
    const FrictionForm constrained = well_posed_form(law.form, law.fit.law);
    if (constrained.least_growth == law.form.least_growth) break;
    law.form = constrained;
    law.fit = fit_friction(all, constrained);
  }
  law.draws = bootstrapped(runs, law.form, draws, 1, before_each);
  for (const FrictionPoint& point : all) {
    law.I_min = std::min(law.I_min, point.I);
    law.I_max = std::max(law.I_max, point.I);
  }
  return law;
}

SampledLaw sampled(const CalibratedLaw& law, int intervals) {
  const FormCurve curve = law.curve();
  const BandOfDraws band = law.band();
  SampledLaw samples;
  for (int i = 0; i <= intervals; ++i) {
    const double I = law.I_min * std::pow(law.I_max / law.I_min, static_cast<double>(i) / intervals);
    const FrictionBand at = band.at(I);
    samples.I.push_back(I);
    samples.value.push_back(curve.at(I).value);
    samples.low.push_back(at.low);
    samples.high.push_back(at.high);
  }
  return samples;
}

std::vector<FrictionBand> coefficient_ranges(const CalibratedLaw& law) {
  std::vector<FrictionBand> ranges;
  for (std::size_t j = 0; j < law.fit.law.size(); ++j) {
    std::vector<double> drawn;
    for (const Coefficients& draw : law.draws) drawn.push_back(draw[j]);
    ranges.push_back(range_of(std::move(drawn)));
  }
  return ranges;
}

double half_width_at(const CalibratedLaw& law, double I) { return law.band().half_width_at(I); }

}  // namespace drumlin::coupling
