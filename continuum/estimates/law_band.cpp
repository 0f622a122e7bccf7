#include "continuum/estimates/law_band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/statistics/quantiles.hpp"

namespace drumlin::continuum {
namespace {

// Half width of each entry over samples of equal length; NaN where fewer than three are numbers.
std::vector<double> half_widths(const std::vector<std::vector<double>>& samples) {
  std::vector<double> widths(samples.empty() ? 0 : samples.front().size(), no_value);
  for (std::size_t i = 0; i < widths.size(); ++i) {
    double mean = 0, squares = 0;
    int count = 0;
    for (const auto& sample : samples) {
      if (!std::isfinite(sample[i])) continue;
      ++count;
      const double step = sample[i] - mean;
      mean += step / count;
      squares += step * (sample[i] - mean);
    }
    if (count > 2) widths[i] = statistics::student_quantile_99(count - 1) * std::sqrt(squares / (count - 1));
  }
  return widths;
}

// samples[draw][column] -> half widths per column.
std::vector<std::vector<double>> half_widths_of_columns(
    const std::vector<std::vector<std::vector<double>>>& samples) {
  std::vector<std::vector<double>> widths;
  for (std::size_t column = 0; !samples.empty() && column < samples.front().size(); ++column) {
    std::vector<std::vector<double>> of_column;
    for (const auto& sample : samples) of_column.push_back(sample[column]);
    widths.push_back(half_widths(of_column));
  }
  return widths;
}

double norm_ratio(const std::vector<double>& of, const std::vector<double>& over) {
  double above = 0, below = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (!std::isfinite(of[i]) || !std::isfinite(over[i])) continue;
    above += of[i] * of[i];
    below += over[i] * over[i];
  }
  return std::sqrt(above / below);
}

// Results of the flows with the drawn laws, one entry per law that converged.
struct DrawnFlows {
  std::vector<ScalarSet> scalars;
  std::vector<std::vector<std::vector<double>>> profiles, maps;  // [draw][column or field]

  void add(const FlowCase& flow_case, const FlowField& field, double map_spacing) {
    scalars.push_back(flow_case.scalars(field));
    profiles.emplace_back();
    for (const ProfileColumn& column : flow_case.profiles(field).columns)
      profiles.back().push_back(column.value);
    maps.emplace_back();
    for (const MapField& map : flow_map(field, flow_case.map_area(field), map_spacing).fields)
      maps.back().push_back(map.value);
  }
};

ScalarSet half_widths_of_scalars(const std::vector<ScalarSet>& samples) {
  std::vector<std::vector<double>> values;
  for (const ScalarSet& set : samples) {
    values.emplace_back();
    for (const Scalar& scalar : set.scalars) values.back().push_back(scalar.value);
  }
  const std::vector<double> widths = half_widths(values);
  ScalarSet result;
  for (std::size_t s = 0; s < widths.size(); ++s)
    result.scalars.push_back({samples.front().scalars[s].name, widths[s], {}});
  return result;
}

}  // namespace

LawBand law_band_of(const FlowCase& flow_case, const FlowSolution& solution, const RheologyFit& fit,
                    int draws, double map_spacing, const FlowSolverOptions& options) {
  const auto begun = std::chrono::steady_clock::now();
  LawBand band;
  DrawnFlows flows;
  for (const FrictionLaw& draw : fit.draws) {
    if (band.draws == draws) break;
    ++band.draws;
    FlowProblem problem = flow_case.problem;
    RheologyFit drawn = fit;
    drawn.mu = draw;
    problem.law = stress_law(drawn);
    const FlowSolution moved = solve_flow_again(solution.field, problem, options);
    band.iterations += moved.report.iterations;
    if (!moved.report.converged) continue;
    ++band.found;
    flows.add(flow_case, moved.field, map_spacing);
  }
  band.profiles = half_widths_of_columns(flows.profiles);
  band.maps = half_widths_of_columns(flows.maps);
  band.scalars = half_widths_of_scalars(flows.scalars);
  const ProfileSet own = flow_case.profiles(solution.field);
  band.profile = no_value;
  for (std::size_t c = 0; c < band.profiles.size(); ++c)
    if (own.columns[c].name == "v_x") band.profile = norm_ratio(band.profiles[c], own.columns[c].value);
  band.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return band;
}

void add_band(const LawBand& band, ProfileSet& profiles) {
  if (band.found == 0) return;
  for (std::size_t c = 0; c < band.profiles.size(); ++c) profiles.columns[c].ci99 = band.profiles[c];
  profiles.header.band = fmt::format("law, {} draws", band.found);
}

void add_band(const LawBand& band, FieldMap& maps) {
  if (band.found == 0) return;
  for (std::size_t f = 0; f < band.maps.size(); ++f) maps.fields[f].ci99 = band.maps[f];
  maps.header.band = fmt::format("law, {} draws", band.found);
}

}  // namespace drumlin::continuum
