#include "apps/commands/measure/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "apps/process/standard_streams.hpp"
#include "particles/measurement/layers/scalars.hpp"

namespace drumlin::apps {

namespace {

constexpr double wide = 0.1;  // half width of a change of energy that is worth a line
// Printed without --verbose.
constexpr std::array<std::string_view, 6> drum_numbers{"theta_deg", "Q",          "H",
                                                       "lambda",    "shear_rate", "nu_bulk"};

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

/// One that was measured.
void print_scalar(const Scalar& scalar, const particles::ScalarSensitivity& sensitivity) {
  const std::string value = fmt::format("{:.4g}", scalar.value);
  const bool known = scalar.ci99 && std::isfinite(*scalar.ci99);
  const std::string windows = sensitivity.changes.empty()
                                  ? ""
                                  : fmt::format("{:.4g} ... {:.4g}, most by {}", sensitivity.lowest,
                                                sensitivity.highest, sensitivity.strongest);
  print_out(fmt::format("{}\n",
                        trimmed(fmt::format("  {:32} {:>12} {:12} {}", scalar.name, value,
                                            known ? fmt::format("+- {:.2g}", *scalar.ci99) : "", windows))));
}

void print_steadiness(const particles::Steadiness& steadiness) {
  print_out(steadiness.steady  ? "steady"
            : steadiness.flows ? "not steady, or too short to say:"
                               : "not steady:");
  for (const std::string& reason : steadiness.reasons) print_out(fmt::format("\n  - {}", reason));
  if (!steadiness.flows) return print_out("\n");
  if (std::isfinite(steadiness.energy.value))
    print_out(fmt::format("{}energy {:+.1f} +- {:.1f} % from the first half to the second",
                          steadiness.steady ? ": " : "\n  ", 100 * steadiness.energy.value,
                          100 * steadiness.energy.ci99));
  if (std::isfinite(steadiness.slope_deg.value))
    print_out(
        fmt::format(", slope {:+.2f} +- {:.2f} deg", steadiness.slope_deg.value, steadiness.slope_deg.ci99));
  if (std::isfinite(steadiness.pressure.value))
    print_out(fmt::format(", pressure {:+.1f} +- {:.1f} %", 100 * steadiness.pressure.value,
                          100 * steadiness.pressure.ci99));
  print_out(fmt::format("; judged by {}\n", steadiness.judged_by));
  if (steadiness.energy.ci99 > wide)
    print_out(fmt::format(
        "  a change of the energy by less than {:.0f} % would not be seen: sample longer, or more "
        "snapshots\n",
        100 * steadiness.energy.ci99));
}

void print_scattered(const particles::Measurement& measured) {
  if (!measured.scattered) return;
  const particles::MeasurementFrame& place = measured.place;
  print_out(
      fmt::format("measured is the window x {:.4g} ... {:.4g} d, z {:.4g} ... {:.4g} d around the densest "
                  "part; outside fly "
                  "{:.4g} grains in the mean, {} at most, {} at the end\n",
                  place.reach.x_min, place.reach.x_max, place.reach.z_min, place.reach.z_max,
                  measured.scattered->mean, measured.scattered->most, measured.scattered->last));
}

/// In a line each: what was not measured though it belongs to the geometry, and how much does not belong.
void print_unmeasured(const particles::MeasurementFrame& place, const ScalarSet& scalars) {
  std::vector<std::string> unknown;
  int of_a_drum = 0;
  for (const Scalar& scalar : scalars.scalars) {
    if (std::isfinite(scalar.value)) continue;
    if (!(place.container_radius > 0) && particles::belongs_to_a_drum(scalar.name))
      ++of_a_drum;
    else
      unknown.push_back(scalar.name);
  }
  if (!unknown.empty()) print_out(fmt::format("  not measured: {}\n", fmt::join(unknown, ", ")));
  if (of_a_drum > 0)
    print_out(fmt::format("  {} numbers of a drum's flow do not belong to {} (null in measured.json)\n",
                          of_a_drum, place.period > 0 ? "layers" : "an open packing"));
}

/// The numbers that say most of a run, at most six: those of a drum, else the first.
std::vector<Scalar> main_numbers(const ScalarSet& scalars) {
  std::vector<Scalar> drum, first;
  for (const Scalar& scalar : scalars.scalars) {
    if (!std::isfinite(scalar.value)) continue;
    if (std::ranges::find(drum_numbers, scalar.name) != drum_numbers.end()) drum.push_back(scalar);
    if (first.size() < drum_numbers.size()) first.push_back(scalar);
  }
  return drum.size() > 1 ? drum : first;
}

}  // namespace

void print_summary(const particles::Measurement& measured, const ScalarSet& scalars, bool with_windows,
                   bool verbose) {
  if (with_windows)
    print_out(fmt::format("  {:32} {:>12} {:12} {}\n", "", "value", "99 %",
                          verbose ? "by other windows (measured.json has all)"
                                  : "by other windows (--verbose prints all, measured.json has them)"));
  for (const Scalar& scalar : verbose ? scalars.scalars : main_numbers(scalars))
    if (std::isfinite(scalar.value))
      print_scalar(scalar, particles::sensitivity_of(scalar, measured.variants));
  print_unmeasured(measured.place, scalars);
  print_scattered(measured);
  print_steadiness(measured.steadiness);
}

}  // namespace drumlin::apps
