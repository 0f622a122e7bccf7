#pragma once
// What a setting (tolerance, time step) does to a measured number, from runs at several values of it.
#include <optional>
#include <span>

namespace drumlin {

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

/// Weighted least squares over the points, with that of the powers which fits best; the interval is that of
/// C, widened where the points scatter more than their own intervals say. Settings more than five times as
/// large or small are left out as long as three remain: far away nothing goes with a power any more. Nothing
/// with fewer than three different settings.
std::optional<SettingError> setting_error(std::span<const SettingPoint> points, double setting,
                                          std::span<const double> powers);

}  // namespace drumlin
