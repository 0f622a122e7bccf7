// Laws that are ill-posed, and one that makes no sense.
#include <algorithm>
#include <cmath>
#include <string>

#include "continuum/fem/flow_solver.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/ill_posed.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "tests/hardcases/continuum/case_lists.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin {
using namespace continuum;
namespace {

// The decimal logarithm in place of the natural one: b = 0.013/ln 10.
const LogLaw decimal{0.35, 0.013 / 2.302585092994046};

// Barker, Schaeffer, Bohorquez & Gray (2015): ill-posed where 4 y^2 - 4 y + mu^2 (1 - y/2)^2 > 0, y = b/mu.
double barker(const LogLaw& law, double I) {
  const double mu = law.a + law.b * std::log(I), y = law.b / mu;
  return 4 * y * y - 4 * y + mu * mu * (1 - y / 2) * (1 - y / 2);
}

std::vector<HardCheck> decimal_logarithm() {
  double low = 1e-8, high = 1e-2;  // well-posed, ill-posed
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (barker(decimal, middle) > 0 ? high : low) = middle;
  }
  const auto ranges = ill_posed_intervals(decimal, nullptr);
  const auto natural = ill_posed_intervals(paper_law, nullptr);
  const double from = ranges.empty() ? std::nan("") : ranges.front().from;
  const FlowSolution flow = solve_flow(small_drum_problem(decimal), one_mesh());
  const FlowIntegrals sums = flow.field.integrals();
  return {
      equals("log10 (I) above which it is ill-posed", std::log10(low), std::log10(from), 1e-3,
             "Barker's condition by bisection against the symbol's minimum, ends to 1e-6; the floor of mu"),
      equals("ranges of I in 1e-6 .. 1 with the natural logarithm", 0, static_cast<double>(natural.size()), 0,
             ""),
      at_least("small drum: ill-posed share of the area, reported", 0.01, sums.ill_posed_area / sums.area,
               "I passes 1e-5 in all of the flowing layer"),
      at_least("small drum: converged", 1, flow.report.converged, "it is solved in spite of that"),
      at_most("  |Q/Q_expected - 1|", 1e-3, flux_error(flow.field, small_drum()), "mass balance")};
}

RheologyFit logarithm(double b) {
  RheologyFit fit;
  fit.mu = LogLaw{.a = 0.35, .b = b, .I_min = 1e-4, .I_max = 1e-1};
  fit.nu = 0.82;
  return fit;
}

// Three values of the paper's text: 0.8 for I -> 0, 1.2 at 1e-3, 1 in the flowing layer.
std::vector<HardCheck> bump_of_k() {
  const StressRatioLaw k({1e-5, 1e-3, 1e-2}, {0.8, 1.2, 1.0});
  const auto ranges = ill_posed_intervals(paper_law, &k);
  double covered = 0;  // of 1e-5 .. 1e-3, in decades
  for (const InertialRange& range : ranges)
    covered += std::max(0.0, std::log10(std::min(range.to, 1e-3) / std::max(range.from, 1e-5)));
  // A larger eps would hide it: a fluid of constant viscosity.
  FlowProblem problem = small_drum_problem(paper_law, 1e-5);
  problem.turned = NonCoaxialStress{.k = k};
  FlowSolverOptions options = one_mesh();
  options.max_picard_updates = 3;
  const FlowSolution flow = solve_flow(problem, options);
  const FlowIntegrals sums = flow.field.integrals();
  return {at_least("small drum: ill-posed share of the area, reported", 0.001,
                   sums.ill_posed_area / sums.area, "I below 1e-3 is found in its nearly rigid part"),
          at_least("small drum: converged in 3 Picard updates", 1, flow.report.converged,
                   "k moves little from one to the next: 5e-4 in the second"),
          at_most("  |Q/Q_expected - 1|", 1e-3, flux_error(flow.field, small_drum()), "mass balance"),
          at_least("ill-posed share of ln I in 1e-5 .. 1e-3", 0.5, covered / 2,
                   "k leaves the well-posed interval 0.89 .. 1.12 below I = 1e-3")};
}

std::vector<HardCheck> falling_friction() {
  const std::string text = rheology_text(logarithm(-0.013));
  bool refused = false, says_why = false;
  try {
    (void)parse_rheology(text, "falling.toml");
  } catch (const InputError& error) {
    refused = true;
    says_why = std::string(error.what()).find("mu falls with I") != std::string::npos;
  }
  // What would come of it: every pipeline grows.
  const auto ranges = ill_posed_intervals(LogLaw{0.35, -0.013}, nullptr, 1e-4, 1e-1);
  const bool everywhere = ranges.size() == 1 && ranges[0].from <= 1e-4 && ranges[0].to >= 1e-1;
  return {at_least("refused as wrong input (exit 2)", 1, refused, ""),
          at_least("with the reason: mu falls with I", 1, says_why, ""),
          at_least("ill-posed for every I in 1e-4 .. 0.1", 1, everywhere, "y < 0 in Barker's condition")};
}

}  // namespace

std::vector<HardCase> law_flow_cases() {
  return {
      {"flow-log10", "log10 in place of ln: ill-posed for I > 1e-5, and the solver says how much of the drum",
       true, decimal_logarithm},
      {"flow-paper-k", "the paper's k from 0.8 to 1.2 is ill-posed below I = 1e-3: not solved without a word",
       true, bump_of_k},
      {"flow-falling-mu", "b < 0 is refused where the law is read", true, falling_friction}};
}

}  // namespace drumlin
