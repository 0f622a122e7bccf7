#include "coupling/study/judged_limits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/comparison/map_sampling.hpp"
#include "coupling/study/study_run.hpp"

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Outcome = Target::Outcome;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? nan : sum / static_cast<double>(values.size());
}

/// One side against another: the comparison and what stands along the wall.
struct Pair {
  Comparison comparison;
  std::vector<double> first_traction, second_traction;
};

/// The errors are kept, the fields are not: a study has dozens of pairs.
void forget_places(std::vector<FieldComparison>& fields) {
  for (FieldComparison& field : fields) {
    FieldOverlay named;
    named.field = field.overlay.field;
    field.overlay = std::move(named);
  }
}

Pair pair_of(const ComparedSide& first, const ComparedSide& second, Registration by) {
  Pair pair{compare(first, second, {.registration = by, .zones = {}}), {}, {}};
  forget_places(pair.comparison.fields);
  forget_places(pair.comparison.maps.part.fields);
  pair.comparison.slices = {};
  if (first.fields.maps && second.fields.maps) {
    pair.first_traction = traction_ratios(*first.fields.maps);
    pair.second_traction = traction_ratios(*second.fields.maps);
  }
  return pair;
}

struct Measured {
  double value = nan;
  bool undefined = false;
};

Measured field_error(const std::vector<FieldComparison>& fields, const Limit& limit) {
  for (const FieldComparison& field : fields) {
    if (field.overlay.field != limit.quantity) continue;
    for (const auto& [zone, errors] : field.zones)
      if (zone.name == limit.zone)
        return {limit.measure == "relative" ? errors.rel_l2 : errors.rms, errors.undefined > 0};
  }
  return {};
}

Measured map_error(const MapComparison& maps, const Limit& limit) {
  for (const FieldComparison& field : maps.fields) {
    if (field.overlay.field != limit.quantity) continue;
    for (const auto& [zone, errors] : field.zones)
      if (zone.name == limit.zone) return {limit.measure == "relative" ? errors.rel_l2 : errors.rms, false};
  }
  return {};
}

double traction_error(const Pair& pair) {
  std::vector<double> squares;
  for (std::size_t i = 0; i < pair.first_traction.size(); ++i)
    squares.push_back(std::pow(pair.second_traction[i] - pair.first_traction[i], 2));
  return std::sqrt(mean_of(squares));
}

/// Signed, second less first; relative to the first where asked.
double scalar_difference(const Comparison& comparison, const Limit& limit) {
  for (const ScalarPair& pair : comparison.scalars)
    if (pair.name == limit.quantity)
      return (pair.continuum - pair.particles) / (limit.measure == "relative" ? std::abs(pair.particles) : 1);
  return nan;
}

/// Of a scalar the difference keeps its sign.
Measured measured(const Pair& pair, const Limit& limit) {
  if (limit.where == "centre") return field_error(pair.comparison.fields, limit);
  if (limit.where == "map")
    return pair.comparison.maps.missing.empty() ? map_error(pair.comparison.maps.part, limit) : Measured{};
  if (limit.where == "wall") return {traction_error(pair), false};
  if (limit.where == "scalar") return {scalar_difference(pair.comparison, limit), false};
  return {};
}

/// A flow, the runs that judge it and all pairs of them, by one registration.
struct Speed {
  double rotation_rpm = 0;
  const JudgedSide* flow = nullptr;
  std::vector<const JudgedSide*> runs;
  std::vector<Pair> against_runs, between_runs;
};

double cost_of(const JudgedSide& flow, const Limit& limit) {
  const bool cold = flow.start.starts_with("cold");
  return cold == (limit.quantity == "seconds_cold") ? flow.cpu_seconds : nan;
}

/// Half width of the interval of a scalar, pooled over the runs.
double pooled_interval(const Speed& speed, const std::string& name) {
  std::vector<Scalar> found;
  for (const JudgedSide* run : speed.runs)
    if (const Scalar* scalar = run->side.scalars.find(name)) found.push_back(*scalar);
  return found.empty() ? nan : pooled(name, found).ci99.value_or(nan);
}

LimitCell cell_of(const Speed& speed, const Limit& limit) {
  LimitCell cell{.rotation_rpm = speed.rotation_rpm, .limit = limit.must};
  if (limit.where == "cost") {
    cell.value = cost_of(*speed.flow, limit);
    return cell;
  }
  std::vector<double> values, floors;
  for (const Pair& pair : speed.against_runs) {
    const Measured found = measured(pair, limit);
    values.push_back(found.value);
    cell.undefined = cell.undefined || found.undefined;
  }
  for (const Pair& pair : speed.between_runs) floors.push_back(std::abs(measured(pair, limit).value));
  cell.value = std::abs(mean_of(values));
  cell.floor = mean_of(floors);
  if (limit.measure == "inside_interval") {
    cell.value /= pooled_interval(speed, limit.quantity);
    cell.floor = nan;
    cell.limit = 1;
  }
  return cell;
}

void take_floors_of_others(std::vector<LimitCell>& cells) {
  std::vector<double> known;
  for (const LimitCell& cell : cells)
    if (!std::isnan(cell.floor)) known.push_back(cell.floor);
  if (known.empty()) return;
  for (LimitCell& cell : cells) {
    if (!std::isnan(cell.floor)) continue;
    cell.floor = mean_of(known);
    cell.floor_of_others = true;
  }
}

Outcome outcome_of(bool measured, bool met) {
  return !measured ? Outcome::not_measured : met ? Outcome::met : Outcome::missed;
}

/// Whether `wanted` holds: at each speed, in the mean, or for a share of the speeds.
bool holds(const LimitRow& row, double wanted, double factor) {
  const auto allowed = [&](const LimitCell& cell, double limit) {
    return std::isnan(cell.floor) ? limit : std::max(limit, factor * cell.floor);
  };
  double sum = 0, allowed_sum = 0, inside = 0, count = 0;
  bool each = true, worst = true;
  for (const LimitCell& cell : row.cells) {
    if (std::isnan(cell.value) && !cell.undefined) continue;
    count += 1;
    sum += cell.value;
    allowed_sum += allowed(cell, wanted);
    inside += cell.value <= 1 ? 1 : 0;
    each = each && !cell.undefined && cell.value <= allowed(cell, wanted);
    worst = worst && !cell.undefined && cell.value <= allowed(cell, row.limit.must_worst.value_or(0));
  }
  if (row.limit.measure == "inside_interval") return inside >= wanted * count - 1e-9;
  return row.limit.must_worst ? worst && sum <= allowed_sum : each;
}

LimitRow row_of(const std::vector<Speed>& speeds, const Limit& limit, Registration by, double factor) {
  LimitRow row{.limit = limit, .registration = by, .cells = {}};
  for (const Speed& speed : speeds) row.cells.push_back(cell_of(speed, limit));
  if (limit.where != "cost" && limit.measure != "inside_interval") take_floors_of_others(row.cells);
  bool any = false;
  for (LimitCell& cell : row.cells) {
    if (limit.measure != "inside_interval") {
      cell.limit = limit.must_worst.value_or(limit.must);
      if (!std::isnan(cell.floor)) cell.limit = std::max(cell.limit, factor * cell.floor);
    }
    cell.met = !cell.undefined && cell.value <= cell.limit;
    any = any || cell.undefined || !std::isnan(cell.value);
  }
  row.must = outcome_of(any, holds(row, limit.must, factor));
  row.aim = outcome_of(any, holds(row, limit.aim, factor));
  return row;
}

std::vector<Speed> speeds_of(const std::vector<JudgedSide>& runs, const std::vector<JudgedSide>& flows,
                             const std::set<std::string>& fitted_on) {
  std::vector<Speed> speeds;
  for (const JudgedSide& flow : flows) {
    Speed speed{
        .rotation_rpm = flow.rotation_rpm, .flow = &flow, .runs = {}, .against_runs = {}, .between_runs = {}};
    std::vector<const JudgedSide*> calibrating;
    for (const JudgedSide& run : runs)
      if (same_speed(run.rotation_rpm, flow.rotation_rpm))
        (fitted_on.contains(run.name) ? calibrating : speed.runs).push_back(&run);
    if (speed.runs.empty()) speed.runs = calibrating;
    if (!speed.runs.empty()) speeds.push_back(std::move(speed));
  }
  std::sort(speeds.begin(), speeds.end(),
            [](const Speed& a, const Speed& b) { return a.rotation_rpm < b.rotation_rpm; });
  return speeds;
}

void compare_all(Speed& speed, Registration by) {
  speed.against_runs.clear();
  speed.between_runs.clear();
  for (std::size_t i = 0; i < speed.runs.size(); ++i) {
    speed.against_runs.push_back(pair_of(speed.runs[i]->side, speed.flow->side, by));
    for (std::size_t j = i + 1; j < speed.runs.size(); ++j)
      speed.between_runs.push_back(pair_of(speed.runs[i]->side, speed.runs[j]->side, by));
  }
}

}  // namespace

std::vector<double> traction_ratios(const FieldMap& map) {
  const double axis = needed_number(map.header, &RunHeader::axis_depth, "maps");
  const double radius = needed_number(map.header, &RunHeader::drum_radius, "maps");
  const auto &xx = map.field("sigma_xx").value, &zz = map.field("sigma_zz").value,
             &xz = map.field("sigma_xz").value;
  std::vector<double> ratios;
  for (int degrees = -45; degrees <= 45; degrees += 5) {
    const double angle = degrees * std::numbers::pi / 180, s = std::sin(angle), c = std::cos(angle);
    std::vector<double> several;
    for (const double inside : {5.0, 7.0, 9.0, 11.0}) {
      const double x = (radius - inside) * s, z = axis - (radius - inside) * c;
      const double at_xx = bilinear(map.grid, xx, x, z), at_zz = bilinear(map.grid, zz, x, z),
                   at_xz = bilinear(map.grid, xz, x, z);
      // Outward normal (s, -c), tangent (c, s); sigma_xz is minus the entry of the pressure tensor.
      const double on_x = at_xx * s + at_xz * c, on_z = -at_xz * s - at_zz * c;
      several.push_back((c * on_x + s * on_z) / (s * on_x - c * on_z));
    }
    ratios.push_back(mean_of(several));
  }
  return ratios;
}

JudgedLimits judged_limits(const Limits& limits, const std::vector<JudgedSide>& runs,
                           const std::vector<JudgedSide>& flows, const std::set<std::string>& fitted_on) {
  JudgedLimits judged;
  std::vector<Speed> speeds = speeds_of(runs, flows, fitted_on);
  for (const Speed& speed : speeds) {
    judged.speeds.push_back(speed.rotation_rpm);
    for (const JudgedSide* run : speed.runs)
      (fitted_on.contains(run->name) ? judged.calibrated_by : judged.judged_by).push_back(run->name);
  }
  for (const Registration by : {Registration::axis, Registration::surface}) {
    for (Speed& speed : speeds) compare_all(speed, by);
    for (const Limit& limit : limits.limits)
      judged.rows.push_back(row_of(speeds, limit, by, limits.floor_factor));
  }
  return judged;
}

}  // namespace drumlin::coupling
