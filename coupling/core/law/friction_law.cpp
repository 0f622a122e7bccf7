#include "coupling/core/law/friction_law.hpp"

#include <limits>
#include <type_traits>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

FrictionValue friction_at(const FrictionLaw& law, double I) {
  return std::visit(
      [I]<class Law>(const Law& of) -> FrictionValue {
        if constexpr (OfInertialNumber<Law>)
          return of.friction(I);
        else
          throw InputError("mu of the law \"" + std::string(Law::name) + "\" does not follow from I alone");
      },
      law);
}

std::optional<double> threshold(const FrictionLaw& law) {
  return std::visit(
      [](const auto& of) -> std::optional<double> {
        if constexpr (requires { of.threshold(); })
          return of.threshold();
        else
          return {};
      },
      law);
}

double largest_measured_I(const FrictionLaw& law) {
  return std::visit(
      []<class Law>(const Law& of) {
        double largest = 0;  // not known
        if constexpr (requires { of.I_max; }) largest = std::optional<double>(of.I_max).value_or(0);
        if constexpr (requires { of.points(); }) largest = of.points().I.back();
        return largest > 0 ? largest : std::numeric_limits<double>::infinity();
      },
      law);
}

std::string described(const FrictionLaw& law) {
  return std::visit([](const auto& of) { return of.words(); }, law);
}

std::vector<FormFault> faults_of(const FrictionLaw& law) {
  return std::visit([](const auto& of) { return of.faults(); }, law);
}

std::string name_of(const FrictionLaw& law) {
  return std::visit([]<class Law>(const Law&) { return std::string(Law::name); }, law);
}

std::vector<FrictionLaw> fitted_laws() {
  std::vector<FrictionLaw> laws;
  const auto add = [&]<class... Laws>(std::type_identity<std::variant<Laws...>>) {
    ((Fitted<Laws> ? laws.push_back(Laws{}) : void()), ...);
  };
  add(std::type_identity<FrictionLaw>());
  return laws;
}

std::vector<std::string> fitted_names() {
  std::vector<std::string> names;
  for (const FrictionLaw& law : fitted_laws()) names.push_back(name_of(law));
  return names;
}

std::vector<double> coefficients_of(const FrictionLaw& law) {
  return std::visit(
      []<class Law>(const Law& of) {
        if constexpr (Fitted<Law>)
          return of.coefficients();
        else
          return std::vector<double>();
      },
      law);
}

FrictionLaw with_coefficients(const FrictionLaw& law, std::span<const double> coefficients) {
  return std::visit(
      [&]<class Law>(const Law& of) -> FrictionLaw {
        if constexpr (Fitted<Law>)
          return of.with(coefficients);
        else
          return of;
      },
      law);
}

}  // namespace drumlin
