#include "tests/hardcases/hard_case.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace drumlin {

bool HardCheck::holds() const {
  switch (relation) {
    case Relation::equals:
      return std::abs(got - expected) <= tolerance;
    case Relation::at_most:
      return got <= expected + tolerance;
    case Relation::at_least:
      return got >= expected - tolerance;
  }
  return false;
}

HardCheck equals(std::string what, double expected, double got, double tolerance, std::string reason) {
  return {std::move(what), Relation::equals, expected, got, tolerance, std::move(reason)};
}

HardCheck at_most(std::string what, double bound, double got, std::string reason) {
  return {std::move(what), Relation::at_most, bound, got, 0, std::move(reason)};
}

HardCheck at_least(std::string what, double bound, double got, std::string reason) {
  return {std::move(what), Relation::at_least, bound, got, 0, std::move(reason)};
}

double larger(double a, double b) { return std::isnan(a) || a > b ? a : b; }

bool HardResult::passed() const {
  return !checks.empty() &&
         std::all_of(checks.begin(), checks.end(), [](const HardCheck& check) { return check.holds(); });
}

HardResult run_hard_case(const HardCase& hard) {
  const auto start = std::chrono::steady_clock::now();
  HardResult result;
  result.checks = hard.run();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<HardCase> joined(std::initializer_list<std::vector<HardCase>> lists) {
  std::vector<HardCase> cases;
  for (const auto& list : lists) cases.insert(cases.end(), list.begin(), list.end());
  return cases;
}

}  // namespace drumlin
