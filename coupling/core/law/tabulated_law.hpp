#pragma once
// mu over ln I through the points of a table: MonotoneCubic between them, and outside straight in ln I as the
// two outermost points say, so that mu goes on growing as a logarithm does (a table that ended level would be
// ill-posed there); kept positive.
#include <functional>
#include <limits>
#include <optional>

#include "coupling/core/law/form.hpp"
#include "coupling/core/law/monotone_cubic.hpp"

namespace drumlin {

/// The points.
struct FrictionTable {
  std::vector<double> I;   ///< ascending, two at least
  std::vector<double> mu;  ///< growing
};
std::vector<FormFault> faults_of(const FrictionTable& points);

/// A friction of one's own as a table, `per_decade` points to a decade of I. A flow evaluates the table:
/// between its points and beyond them it is TabulatedLaw. Throws InputError where mu is not positive, finite
/// and growing, or the range is none.
FrictionTable sampled_friction(const std::function<double(double)>& mu, double I_min, double I_max,
                               int per_decade = 8);

class TabulatedLaw {
 public:
  static constexpr const char *name = "table", *sentence = "Points, smoothly interpolated.";
  /// How mu goes on above the last point, straight as the last two say.
  enum class Beyond { straight_in_ln_I, straight_in_I };

  TabulatedLaw() = default;
  /// Where I and mu are not two at least, and as many, there is no friction.
  TabulatedLaw(std::vector<double> I, std::vector<double> mu, Beyond beyond = Beyond::straight_in_ln_I);
  TabulatedLaw(FrictionTable points) : TabulatedLaw(std::move(points.I), std::move(points.mu)) {}

  const FrictionTable& points() const { return points_; }
  FrictionValue friction(double I) const;
  std::vector<double> coefficients() const { return points_.mu; }
  TabulatedLaw with(std::span<const double> mu) const { return {points_.I, {mu.begin(), mu.end()}}; }
  std::string words() const;
  std::vector<FormFault> faults() const { return faults_of(points_); }

 private:
  FrictionTable points_;
  std::optional<MonotoneCubic> mu_of_ln_I_;
  double straight_from_ = std::numeric_limits<double>::infinity();  // I; infinite: nowhere
};

template <class Visitor>
void describe(Visitor& v, TabulatedLaw& t) {
  FrictionTable points = t.points();
  v.value("I", points.I, required("", number_range(), "Inertial numbers, ascending, two at least."));
  v.value("mu", points.mu,
          required("", friction_range(), "Friction there, growing; smooth in ln I between."));
  t = TabulatedLaw(std::move(points));
}

}  // namespace drumlin
