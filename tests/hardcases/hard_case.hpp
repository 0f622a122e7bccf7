#pragma once
// A hard case: a small problem with a known outcome. It states what a closed form or an invariant demands,
// runs one of the two simulators, and sets the two side by side.
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "coupling/core/basics/enum_names.hpp"

namespace drumlin {

enum class Relation { equals, at_most, at_least };
constexpr auto names_of(Relation) { return std::array{"equals", "at_most", "at_least"}; }

/// One number that a case demands. Dimensionless (d, sqrt(d/g), rho0 g d) unless `what` says otherwise.
struct HardCheck {
  std::string what;
  Relation relation = Relation::equals;
  double expected = 0;
  double got = 0;        ///< NaN fails whatever is expected
  double tolerance = 0;  ///< absolute
  std::string reason;    ///< why this tolerance, or this bound
  bool holds() const;
};
HardCheck equals(std::string what, double expected, double got, double tolerance, std::string reason);
HardCheck at_most(std::string what, double bound, double got, std::string reason);
HardCheck at_least(std::string what, double bound, double got, std::string reason);

/// The larger of two values, NaN as soon as one of them is: what std::max drops fails a check.
double larger(double a, double b);

struct HardCase {
  std::string name;
  std::string outcome;  ///< the closed form or invariant, and where it comes from
  bool fast = false;    ///< about a second in a release build, and met: part of ./check
  std::function<std::vector<HardCheck>()> run;
};

struct HardResult {
  std::vector<HardCheck> checks;
  double seconds = 0;  ///< wall time
  bool passed() const;
};
HardResult run_hard_case(const HardCase&);

/// The lists one after the other.
std::vector<HardCase> joined(std::initializer_list<std::vector<HardCase>> lists);

}  // namespace drumlin
