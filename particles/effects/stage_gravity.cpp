#include "particles/effects/stage_gravity.hpp"

namespace drumlin::particles {

Gravity gravity_in_stage(const std::optional<StageGravity>& asked, const Gravity& before, double done) {
  if (!asked) return before;
  const double share = asked->ramp ? done : 1;
  const auto reached = [share](double from, const std::optional<double>& to) {
    if (!to || share <= 0) return from;
    return share >= 1 ? *to : from + share * (*to - from);
  };
  return {reached(before.acceleration_m_s2, asked->acceleration_m_s2),
          reached(before.direction_deg, asked->direction_deg)};
}

}  // namespace drumlin::particles
