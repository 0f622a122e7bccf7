#include "particles/effects/drag.hpp"

#include <cmath>
#include <numbers>

#include "particles/bodies/disc_inertia.hpp"

namespace drumlin::particles {
namespace {

/// What is left of a velocity after a step, and of what a constant force would give it without drag. x = rate
/// h.
struct Decay {
  double keeps = 1, force = 1;
  explicit Decay(double x) : keeps(std::exp(-x)), force(x > 0 ? -std::expm1(-x) / x : 1) {}
};

}  // namespace

DragLaw law_of(const Drag& key, const LawInput& in) {
  const double rate = key.rate_per_s * in.scales.time_s;
  return {rate, key.spin_rate_per_s ? *key.spin_rate_per_s * in.scales.time_s : rate,
          key.grows_with == DragOver::diameter};
}

double DragLaw::share(const Bodies& bodies, std::size_t b) const {
  return with_diameter ? std::numbers::pi / 2 * bodies.radius[b] * bodies.inverse_mass[b] : 1;
}

void DragLaw::move_freely(const Bodies& bodies, std::size_t begin, std::size_t end, double time_step,
                          FreeMotion& free) const {
  for (std::size_t b = begin; b < end; ++b) {
    const Decay decay(rate * share(bodies, b) * time_step);
    free.x[b] = decay.keeps * bodies.v_x[b] + decay.force * (free.x[b] - bodies.v_x[b]);
    free.z[b] = decay.keeps * bodies.v_z[b] + decay.force * (free.z[b] - bodies.v_z[b]);
    free.inverse_mass[b] *= decay.force;
  }
}

void DragLaw::turn_freely(Bodies& bodies, double time_step) const {
  for (std::size_t b = 0; b < bodies.spin.size(); ++b)
    bodies.spin[b] *= std::exp(-spin_rate * share(bodies, b) * time_step);
}

/// From v to w, other forces have given (w - keeps v) / force per unit of mass; what is missing is drag's.
double DragLaw::work(const Bodies& before, const Bodies& now, double time_step) const {
  double sum = 0;
  for (std::size_t b = 0; b < now.count(); ++b) {
    const double x = share(now, b) * time_step, r = now.radius[b];
    const Decay decay(rate * x);
    const auto of = [&decay](double v, double w, double keeps) {
      return (w - v - (w - keeps * v) / decay.force) * (v + w) / 2;
    };
    double work = of(before.v_x[b], now.v_x[b], decay.keeps) + of(before.v_z[b], now.v_z[b], decay.keeps);
    if (!now.spin.empty())
      work += disc_inertia * r * r * of(before.spin[b], now.spin[b], std::exp(-spin_rate * x));
    sum += work / now.inverse_mass[b];
  }
  return sum;
}

}  // namespace drumlin::particles
