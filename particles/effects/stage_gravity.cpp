#include "particles/effects/stage_gravity.hpp"

namespace drumlin::particles {

Gravity gravity_in_stage(const std::optional<StageGravity>& requested, const Gravity& before, double done) {
  if (!requested) return before;
  const double share = requested->ramp ? done : 1;
  const auto reached = [share](double from, const std::optional<double>& to) {
    if (!to || share <= 0) return from;
    return share >= 1 ? *to : from + share * (*to - from);
  };
  return {reached(before.acceleration_m_s2, requested->acceleration_m_s2),
          reached(before.direction_deg, requested->direction_deg)};
}

}  // namespace drumlin::particles
