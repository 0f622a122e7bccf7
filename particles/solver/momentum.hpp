#pragma once
// Extrapolation factor of the accelerated Gauss-Seidel method.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace drumlin::particles {

/// How sweeps start from where the last one has led.
enum class SweepExtrapolation {
  none,
  rounded,  ///< impulses and velocities go further on, each rounded by itself
  /// Velocities receive what the impulses round off, too. Momentum would carry it on, and impulses under a
  /// deep bed are large beside what is left of them at a disc (docs/decisions.md).
  exact
};

/// From so many contacts on sweeps extrapolate exactly; smaller problems meet their tolerances without.
inline constexpr std::int64_t least_contacts_of_exact_sweeps = 400'000;

inline SweepExtrapolation extrapolation_of(bool accelerated, std::int64_t contacts) {
  if (!accelerated) return SweepExtrapolation::none;
  return contacts < least_contacts_of_exact_sweeps ? SweepExtrapolation::rounded : SweepExtrapolation::exact;
}

/// Nesterov's extrapolation y = x + beta (x - x_before) between the sweeps of NLGS, x = sweep(y). beta is at
/// least 0.8, and (k - 1)/(k + 2) at age k (Nesterov 1983; Beck and Teboulle 2009), which gives a chain of n
/// discs its some n instead of n^2 sweeps. Where the steps of a sweep exceed the least since then, the age is
/// halved, or begins again from nothing when it is young (O'Donoghue and Candes 2015 always do): steps grow
/// whenever contacts open, close, stick or slip, somewhere in a flow in one sweep of twenty, and most of a
/// momentum that has grown old is still right. The least of them, not the last, since a chain swings so
/// slowly that no sweep differs much from the one before.
///
/// Measured on flow steps of 7183 discs, mu = 0.4, warm: 174 sweeps to a residual of 3e-3 where beginning
/// again from nothing takes 204; a column of 1000 discs, cold, 6,190 to 1e-4 in place of 24,440
/// (docs/decisions.md).
///
/// The age begins where a solve is expected to need it: by the tolerance, since 0.8 is what the first fifty
/// sweeps of a flow can use and larger factors what the next hundred can; and by the size, since a wide
/// packing has slow modes that a small one lacks. Flow steps of 7183 discs take 162 sweeps to 3e-3 where they
/// took 188 from 0, 66 to 1e-2 as before (81 from 42).
class Momentum {
 public:
  Momentum() = default;
  /// For a solve of so many contacts to this residual.
  Momentum(double tolerance, std::size_t contacts)
      : age_(std::clamp(80 * std::log10(1e-2 / tolerance), 0.0,
                        std::sqrt(static_cast<double>(contacts)) / 3)) {}

  /// beta of the next extrapolation, from the sum of squares of the steps of the last sweep.
  double next(double step_squares) {
    const bool grows = !(step_squares <= growth * least_squares_);
    least_squares_ = grows ? step_squares : std::min(least_squares_, step_squares);
    const bool begins = grows && of_age(age_) < least;
    if (!grows) return next_of_falling();
    age_ = begins ? 1 : age_ / 2;
    return begins ? 0 : std::max(least, of_age(age_));
  }
  /// The same of a sweep whose steps have not grown.
  double next_of_falling() { return std::max(least, of_age(++age_)); }

 private:
  static double of_age(double age) { return (age - 1) / (age + 2); }

  static constexpr double least = 0.8;   // 0.9 without restarts ends in cycles at residuals of 3e-3
  static constexpr double growth = 1.1;  // of the squares; at 1.5 flows cycle
  double least_squares_ = std::numeric_limits<double>::infinity();  // of the sweeps since the age was halved
  double age_ = 0;                                                  // in sweeps
};

}  // namespace drumlin::particles
