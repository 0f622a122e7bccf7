#include "particles/measurement/run_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/statistics/samples.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

constexpr std::array columns{"time_s", "stage", "overlap_mean", "overlap_max", "residual"};

struct LogRow {
  double time_s = no_value;
  std::string stage;
  double overlap_mean = no_value, overlap_max = no_value, residual = no_value;
};

std::vector<LogRow> read_log(const std::filesystem::path& file) {
  std::istringstream stream(input_text(file));
  std::string line;
  std::getline(stream, line);
  std::map<std::string, std::size_t, std::less<>> place;
  for (const std::string_view name : csv_fields(line)) place.emplace(name, place.size());
  for (const char* name : columns)
    if (!place.contains(name))
      throw InputError({{file.string(), 1, 0, name, "no such column in the log", ""}});

  std::vector<LogRow> rows;
  for (int number = 2; std::getline(stream, line); ++number) {
    const auto fields = csv_fields(line);
    if (fields.size() != place.size())
      throw InputError({{file.string(), number, 0, "", fmt::format("holds {} fields", fields.size()),
                         fmt::format("{}, as many as the first line", place.size())}});
    const auto number_in = [&](std::size_t c) {
      return finite_number(fields[place[columns[c]]]).value_or(no_value);
    };
    LogRow row{number_in(0), std::string(fields[place[columns[1]]]), number_in(2), number_in(3),
               number_in(4)};
    if (!std::isfinite(row.time_s))
      throw InputError({{file.string(), number, 0, "time_s", "is no number", ""}});
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Stage that runs at a time: that of the first row not before it.
std::string stage_at(const std::vector<LogRow>& rows, double time_s) {
  const double rounding = 1e-9 * std::abs(time_s);
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const LogRow& r) { return r.time_s >= time_s - rounding; });
  return row == rows.end() ? rows.back().stage : row->stage;
}

std::vector<double> finite_values(const std::vector<LogRow>& rows, double LogRow::*column) {
  std::vector<double> values;
  for (const LogRow& row : rows)
    if (std::isfinite(row.*column)) values.push_back(row.*column);
  return values;
}

Scalar averaged(const std::string& name, const std::vector<double>& values) {
  return {name, statistics::mean(values), mean_ci99(values)};
}

}  // namespace

ScalarSet accuracy_scalars(const std::filesystem::path& log_csv, double first_time_s, double last_time_s) {
  std::vector<LogRow> rows = read_log(log_csv);
  if (!rows.empty()) {
    const std::string from = stage_at(rows, first_time_s), to = stage_at(rows, last_time_s);
    const auto begin =
        std::find_if(rows.begin(), rows.end(), [&](const LogRow& r) { return r.stage == from; });
    const auto end =
        std::find_if(rows.rbegin(), rows.rend(), [&](const LogRow& r) { return r.stage == to; }).base();
    rows = std::vector<LogRow>(begin, end);
  }
  const auto largest = finite_values(rows, &LogRow::overlap_max);
  return ScalarSet{
      {averaged("overlap_mean", finite_values(rows, &LogRow::overlap_mean)),
       {"overlap_max", largest.empty() ? no_value : *std::max_element(largest.begin(), largest.end()), {}},
       averaged("residual_mean", finite_values(rows, &LogRow::residual))}};
}

}  // namespace drumlin::particles
