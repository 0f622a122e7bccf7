#include "continuum/io/flow_state_file.hpp"

#include <algorithm>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"

namespace drumlin::continuum {
namespace {

const std::string state_format = "drumlin-flow-state-1", checkpoint_format = "drumlin-flow-checkpoint-1";

void put(const FlowState& state, H5Writer& out) {
  std::vector<std::int64_t> cells;
  for (const CellPlace& place : state.cells) cells.insert(cells.end(), place.begin(), place.end());
  out.add_number("theta", state.theta, {"rad", "slope"});
  out.add("cells", cells, {"1", "four numbers per cell, deal.II's CellId"});
  if (!state.surface.empty())
    out.add_table("surface", state.surface, 1, {"d", "Chebyshev coefficients of its height"});
  out.add_table("centres", state.centres, 2, {"d", "middles of the cells, along x and z"});
  out.add_table(
      "values", state.values, FlowState::values_per_cell,
      {"sqrt(g d), rho0 g d", "two velocities at nine points, then pressure at four, of each cell"});
}

FlowState state_in(const H5Reader& in) {
  FlowState state;
  state.theta = in.number("theta", H5Range::finite);
  const std::vector<std::int64_t> cells = in.longs("cells");
  if (in.has("surface")) state.surface = in.doubles("surface", H5Range::finite);
  state.centres = in.doubles("centres", H5Range::finite);
  state.values = in.doubles("values", H5Range::finite);
  const std::size_t count = cells.size() / 4;
  if (count == 0 || cells.size() != 4 * count) in.refuse("cells", "not four numbers per cell");
  if (state.centres.size() != 2 * count) in.refuse("centres", "not two numbers per cell");
  if (state.values.size() != FlowState::values_per_cell * count)
    in.refuse("values", "not 22 numbers per cell");
  for (std::size_t c = 0; c < count; ++c) {
    CellPlace place;
    for (std::size_t i = 0; i < place.size(); ++i) place[i] = static_cast<std::uint32_t>(cells[4 * c + i]);
    state.cells.push_back(place);
  }
  if (!std::is_sorted(state.cells.begin(), state.cells.end())) in.refuse("cells", "not in their order");
  return state;
}

}  // namespace

void write_flow_state(const std::filesystem::path& file, const FlowState& state) {
  H5Writer out;
  out.add_text("format", state_format);
  put(state, out);
  out.save(file);
}

FlowState read_flow_state(const std::filesystem::path& flow_run) {
  const std::filesystem::path file = flow_run / "state.h5";
  if (!std::filesystem::exists(file))
    throw InputError(flow_run.string() + ": holds no state.h5 to start from: no finished flow");
  const H5Reader in(file);
  in.require_format(state_format);
  return state_in(in);
}

void keep_flow_checkpoint(const std::filesystem::path& flow_run, const FlowCheckpoint& checkpoint) {
  H5Writer out;
  out.add_text("format", checkpoint_format);
  out.add_number("steps", static_cast<std::int64_t>(checkpoint.at.steps));
  out.add_number("start_share", checkpoint.at.start_share,
                 {"1", "speed of rotation at the start over that of the scene"});
  out.add_text("scene", checkpoint.scene);
  out.add_text("law", checkpoint.law);
  put(checkpoint.at.state, out);
  out.save(flow_run / checkpoint_name, flow_run / previous_checkpoint_name);
}

FlowCheckpoint read_flow_checkpoint(const std::filesystem::path& file) {
  constexpr std::int64_t most_steps = std::numeric_limits<int>::max();
  const H5Reader in(file);
  in.require_format(checkpoint_format);
  return FlowCheckpoint{.at = {.state = state_in(in),
                               .steps = static_cast<int>(in.integer("steps", 1, most_steps)),
                               .start_share = in.number("start_share", H5Range::from_0)},
                        .scene = in.text("scene"),
                        .law = in.text("law")};
}

}  // namespace drumlin::continuum
