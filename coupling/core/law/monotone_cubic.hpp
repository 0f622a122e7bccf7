#pragma once
// A smooth curve through the points of a table.
#include <optional>
#include <vector>

namespace drumlin {

/// A value and its derivative.
struct CurvePoint {
  double value = 0;
  double slope = 0;
};

/// C1 piecewise cubic that is monotone between its points, so that it adds no extremum of its own (Steffen,
/// Astron. Astrophys. 239 (1990) 443), and straight outside. Exact for points on a straight line when it goes
/// on.
class MonotoneCubic {
 public:
  /// How the curve leaves the table on either side, which is also its slope at the outermost points.
  enum class Outside {
    level,   ///< stays at the last value
    goes_on  ///< goes on as the chord of the last two points
  };
  /// x ascending, as many y; `goes_on` needs two points. `last_slope`: where it goes on, in place of the last
  /// chord's; of its sign and at most three times as steep.
  MonotoneCubic(std::vector<double> x, std::vector<double> y, Outside outside,
                std::optional<double> last_slope = {});
  CurvePoint at(double x) const;

 private:
  std::vector<double> x_, y_, slope_;  // never empty, equally long
};

/// Their natural logarithms: laws are curves over ln I.
std::vector<double> logarithms(std::vector<double> values);

}  // namespace drumlin
