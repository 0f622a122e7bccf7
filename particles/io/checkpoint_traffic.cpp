#include "particles/io/checkpoint_traffic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "particles/io/checkpoint_stages.hpp"

namespace drumlin::particles {
namespace {

constexpr std::size_t columns_of_waiting = 3;
constexpr double most_materials = 255;

void put_left(const LeftGrains& left, H5Content& out) {
  out.add("left/grains", std::vector<std::int32_t>(left.has_left.begin(), left.has_left.end()));
  out.add("left/per_stage", left.per_stage);
  out.add_number("left/named", static_cast<std::int64_t>(left.first.size()));
  for (std::size_t f = 0; f < left.first.size(); ++f) {
    const std::string name = fmt::format("left/{}/", f);
    out.add_number(name + "grain", left.first[f].grain);
    out.add_number(name + "stage", static_cast<std::int64_t>(left.first[f].stage));
    out.add_number(name + "time", left.first[f].time, {"sqrt(d/g)", "when the grain left"});
  }
}

LeftGrains left_in(const H5Reader& in) {
  LeftGrains left;
  for (const std::int32_t gone : in.ints("left/grains", 0, 1))
    left.has_left.push_back(static_cast<std::uint8_t>(gone));
  left.per_stage = in.longs("left/per_stage");
  const auto named = in.integer("left/named", 0, static_cast<std::int64_t>(named_left));
  const auto stages = static_cast<std::int64_t>(left.per_stage.size());
  for (std::int64_t f = 0; f < named; ++f) {
    const std::string name = fmt::format("left/{}/", f);
    left.first.push_back({in.integer(name + "grain", 0),
                          static_cast<std::int32_t>(in.integer(name + "stage", 0, stages - 1)),
                          in.number(name + "time", H5Range::from_0)});
  }
  return left;
}

}  // namespace

void put_traffic(const Checkpoint& checkpoint, H5Content& out) {
  const SimulationState& state = checkpoint.state;
  if (state.left) put_left(*state.left, out);
  if (!state.traffic) return;
  const Traffic& traffic = *state.traffic;
  out.add("bodies/id", state.bodies.id);
  out.add_number("traffic/next_id", traffic.next_id);
  out.add_number("traffic/regions_bytes", checkpoint.regions_bytes);
  out.add("traffic/poured", traffic.poured);
  out.add_number("traffic/outlets", static_cast<std::int64_t>(traffic.outlets.size()));
  for (std::size_t o = 0; o < traffic.outlets.size(); ++o) {
    const OutletState& outlet = traffic.outlets[o];
    const std::string name = fmt::format("traffic/{}/", o);
    out.add(name + "times", outlet.times, {"sqrt(d/g)", "when grains came out"});
    out.add_number(name + "mass", outlet.mass, {"rho0 d^2", "mass that came out, per depth"});
    out.add_number(name + "at_stage_start", outlet.at_stage_start);
    std::vector<double> rows;
    for (const WaitingGrain& grain : outlet.waiting)
      rows.insert(rows.end(), {grain.radius, grain.inverse_mass, static_cast<double>(grain.material)});
    out.add(name + "waiting", rows, {"d, 1/(rho0 d^2), 1", "radius, inverse mass and material of each"});
  }
}

void get_traffic(const H5Reader& in, Checkpoint& checkpoint) {
  SimulationState& state = checkpoint.state;
  if (in.has("left")) state.left = left_in(in);
  if (!in.has("traffic")) return;
  Traffic& traffic = state.traffic.emplace();
  state.bodies.id = in.longs("bodies/id");
  traffic.next_id = in.integer("traffic/next_id", 0);
  checkpoint.regions_bytes = in.integer("traffic/regions_bytes", 0);
  traffic.poured = in.longs("traffic/poured");
  if (std::any_of(traffic.poured.begin(), traffic.poured.end(), [](std::int64_t n) { return n < 0; }))
    in.refuse("traffic/poured", "counts below 0");
  const auto outlets = in.integer("traffic/outlets", 0);
  for (std::int64_t o = 0; o < outlets; ++o) {
    const std::string name = fmt::format("traffic/{}/", o);
    OutletState& outlet = traffic.outlets.emplace_back();
    outlet.times = rows_of(in, name + "times", 1);
    outlet.mass = in.number(name + "mass", H5Range::from_0);
    outlet.at_stage_start = in.integer(name + "at_stage_start", 0, outlet.taken());
    const auto rows = rows_of(in, name + "waiting", columns_of_waiting);
    for (std::size_t at = 0; at < rows.size(); at += columns_of_waiting) {
      if (!(rows[at] > 0 && rows[at + 1] > 0 && rows[at + 2] >= 0 && rows[at + 2] <= most_materials))
        in.refuse(name + "waiting", "is no grain");
      outlet.waiting.push_back({rows[at], rows[at + 1], static_cast<std::int32_t>(rows[at + 2])});
    }
  }
}

}  // namespace drumlin::particles
