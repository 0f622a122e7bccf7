#include "particles/io/checkpoint_stages.hpp"

#include <fmt/format.h>

#include <limits>
#include <span>

namespace drumlin::particles {
namespace {

/// Calls visit(number) for all numbers of a wall's load.
template <class Load, class Visit>
void each_number(Load& load, Visit visit) {
  visit(load.impulse_x), visit(load.impulse_z), visit(load.moment), visit(load.time);
  for (auto* place : {&load.place, &load.first, &load.last})
    visit(place->x), visit(place->z), visit(place->angle);
}
constexpr std::size_t numbers_of_load = 13;

/// Calls visit(name, number, words) for all numbers of a cell.
template <class Cell, class Visit>
void each_number_of(Cell& cell, Visit visit) {
  visit("cell/middle_x", cell.middle_x, {"d", "middle"});
  visit("cell/middle_z", cell.middle_z, {"d", "middle"});
  visit("cell/length_x", cell.length_x, {"d", "length", H5Range::above_0});
  visit("cell/length_z", cell.length_z, {"d", "height", H5Range::above_0});
  visit("cell/offset", cell.offset, {"d", "displacement of the image above along x"});
  visit("cell/rate_x", cell.rate_x, {"sqrt(g/d)", "rate of its length"});
  visit("cell/rate_z", cell.rate_z, {"sqrt(g/d)", "rate of its height"});
  visit("cell/shear", cell.shear, {"sqrt(g/d)", "velocity of the image above along x, over the height"});
  visit("cell/struck_x", cell.struck_x, {"rho0 d^3 sqrt(g d)", "impulse times branch of impacts"});
  visit("cell/struck_z", cell.struck_z, {"rho0 d^3 sqrt(g d)", "impulse times branch of impacts"});
}

}  // namespace

std::vector<double> rows_of(const H5Reader& in, const std::string& name, std::size_t columns) {
  std::vector<double> values = in.doubles(name, H5Range::finite);
  if (values.size() % columns != 0)
    in.refuse(name, fmt::format("{} numbers", values.size()), fmt::format("rows of {}", columns));
  return values;
}

void put_stage_changes(const Checkpoint& checkpoint, H5Content& out) {
  const SimulationState& state = checkpoint.state;
  if (!state.ends.empty() || state.rest_steps > 0) {
    out.add_number("stages/rest_steps", state.rest_steps);
    out.add_number("stages/ended", static_cast<std::int64_t>(state.ends.size()));
    for (std::size_t e = 0; e < state.ends.size(); ++e) {
      out.add_number(fmt::format("stages/{}/steps", e), state.ends[e].steps);
      out.add_number(fmt::format("stages/{}/by", e), static_cast<std::int64_t>(state.ends[e].by));
    }
  }
  if (state.gravity) {
    out.add_number("gravity/acceleration_m_s2", state.gravity->acceleration_m_s2, {"m/s2", "gravity"});
    out.add_number("gravity/direction_deg", state.gravity->direction_deg, {"deg", "anticlockwise from +x"});
  }
  if (state.cell)
    each_number_of(*state.cell, [&out](const char* name, double number, H5Words words) {
      out.add_number(name, number, words);
    });
  if (!state.loads) return;
  out.add_number("loads/bytes", checkpoint.walls_bytes);
  out.add_number("loads/time", state.loads->time, {"sqrt(d/g)", "length of the interval so far"});
  std::vector<double> rows;
  for (const WallLoad& load : state.loads->walls)
    each_number(load, [&rows](double number) { rows.push_back(number); });
  out.add("loads/walls", rows,
          {"rho0 d^2 sqrt(g d), rho0 d^3 sqrt(g d), sqrt(d/g), d, rad",
           "impulse, moment, time and places of each wall"});
}

void get_stage_changes(const H5Reader& in, Checkpoint& checkpoint) {
  SimulationState& state = checkpoint.state;
  if (in.has("stages")) {
    state.rest_steps = in.integer("stages/rest_steps", 0);
    const auto ended = in.integer("stages/ended", 0);
    for (std::int64_t e = 0; e < ended; ++e)
      state.ends.push_back({in.integer(fmt::format("stages/{}/steps", e), 1),
                            static_cast<EndedBy>(in.integer(fmt::format("stages/{}/by", e), 0,
                                                            static_cast<std::int64_t>(EndedBy::outlet)))});
  }
  if (in.has("gravity"))
    state.gravity = {in.number("gravity/acceleration_m_s2", H5Range::from_0),
                     in.number("gravity/direction_deg", H5Range::finite)};
  if (in.has("cell"))
    each_number_of(state.cell.emplace(), [&in](const char* name, double& number, H5Words words) {
      number = in.number(name, words.range);
    });
  if (!in.has("loads")) return;
  checkpoint.walls_bytes = in.integer("loads/bytes", 0);
  state.loads.emplace().time = in.number("loads/time", H5Range::from_0);
  const auto rows = rows_of(in, "loads/walls", numbers_of_load);
  for (std::size_t at = 0; at < rows.size();)
    each_number(state.loads->walls.emplace_back(), [&](double& number) { number = rows[at++]; });
}

}  // namespace drumlin::particles
