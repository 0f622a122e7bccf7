#include "coupling/law/rheology_fit.hpp"

#include <limits>
#include <sstream>

namespace drumlin {
namespace {

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string in_words(const LogFriction& mu) {
  return "mu = " + number(mu.a) + " + " + number(mu.b) + " ln I";
}
std::string in_words(const LogLinearFriction& mu) {
  return in_words(LogFriction{.a = mu.a, .b = mu.b}) + " + " + number(mu.c) + " I";
}
std::string in_words(const ConstantFriction& mu) { return "mu = " + number(mu.mu); }
std::string in_words(const JopFriction& mu) {
  return "mu = " + number(mu.mu_s) + " + " + number(mu.mu_2 - mu.mu_s) + "/(" + number(mu.I_0) + "/I + 1)";
}
std::string in_words(const FrictionTable& mu) {
  return "mu from " + number(mu.mu.front()) + " at I = " + number(mu.I.front()) + " to " +
         number(mu.mu.back()) + " at I = " + number(mu.I.back()) + ", " + std::to_string(mu.I.size()) +
         " points";
}

}  // namespace

double largest_measured_I(const MeasuredFriction& mu) {
  return std::visit(
      [](const auto& chosen) {
        if constexpr (requires { chosen.I_max; })
          return chosen.I_max > 0 ? chosen.I_max : std::numeric_limits<double>::infinity();
        else if constexpr (requires { chosen.I.back(); })
          return chosen.I.back();
        else
          return std::numeric_limits<double>::infinity();
      },
      mu);
}

std::string described(const MeasuredFriction& mu) {
  return std::visit([](const auto& chosen) { return in_words(chosen); }, mu);
}

}  // namespace drumlin
