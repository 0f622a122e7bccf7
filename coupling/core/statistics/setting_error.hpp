#pragma once
// What a setting (tolerance, time step) does to a measured number, from runs at several values of it.
#include <optional>
#include <span>

namespace drumlin::statistics {

/// A number measured at one value of the setting.
struct SettingPoint {
  double setting = 0;  ///< > 0, smaller is better
  double value = 0;
  double ci99 = 0;  ///< half width of its 99 % interval; 0: not known
};

/// value = limit + C setting^power: what is read off at one value of the setting.
struct SettingError {
  double error = 0;  ///< C setting^power, of either sign
  double ci99 = 0;   ///< half width of its 99 % interval
  double power = 0;
  double smallest = 0;  ///< the least setting that entered
  /// Whether the points tell the error from none.
  bool significant() const;
};

/// Weighted least squares over the points, with that of the powers (one at least) which fits best. The
/// interval is that of C: the larger of what the points' own intervals give and Student's t of their scatter,
/// with two degrees of freedom fewer than points (Variances::told; of the scatter alone where a
/// point has no interval). It covers the intervals of the other powers that the points leave open. Settings
/// more than five times as large or small are left out as long as three remain: far away nothing goes with a
/// power any more. Nothing with fewer than three different settings.
std::optional<SettingError> setting_error(std::span<const SettingPoint> points, double setting,
                                          std::span<const double> powers);

}  // namespace drumlin::statistics
