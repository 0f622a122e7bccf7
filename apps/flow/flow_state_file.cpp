#include "apps/flow/flow_state_file.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/exchange/errors.hpp"
#include "coupling/files/h5_image.hpp"

namespace drumlin::apps {
namespace {

const std::string format = "drumlin-flow-state-1";

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

void write_flow_state(const std::filesystem::path& file, const FlowState& state) {
  std::vector<std::int64_t> cells;
  for (const CellPlace& place : state.cells) cells.insert(cells.end(), place.begin(), place.end());
  H5Writer out;
  out.add_text("format", format);
  out.add_number("theta", state.theta);
  out.add("cells", std::span<const std::int64_t>(cells));
  out.add_table("centres", state.centres, 2);
  out.add_table("values", state.values, FlowState::values_per_cell);
  out.save(file);
}

FlowState read_flow_state(const std::filesystem::path& flow_run) {
  const std::filesystem::path file = flow_run / "state.h5";
  if (!std::filesystem::exists(file))
    throw InputError(flow_run.string() + ": holds no state.h5 to start from: no finished flow");
  const H5Reader in(file);
  if (!in.has("format") || in.text("format") != format)
    in.refuse("format",
              in.has("format") ? "'" + in.text("format") + "', this version reads " + format : "missing");
  FlowState state;
  state.theta = in.number("theta");
  const std::vector<std::int64_t> cells = in.longs("cells");
  state.centres = in.doubles("centres");
  state.values = in.doubles("values");
  const std::size_t count = cells.size() / 4;
  if (count == 0 || cells.size() != 4 * count) in.refuse("cells", "not four numbers per cell");
  if (state.centres.size() != 2 * count) in.refuse("centres", "not two numbers per cell");
  if (state.values.size() != FlowState::values_per_cell * count)
    in.refuse("values", "not 22 numbers per cell");
  if (!std::isfinite(state.theta) || !all_finite(state.centres) || !all_finite(state.values))
    in.refuse("values", "holds numbers that are none");
  for (std::size_t c = 0; c < count; ++c) {
    CellPlace place;
    for (std::size_t i = 0; i < place.size(); ++i) place[i] = static_cast<std::uint32_t>(cells[4 * c + i]);
    state.cells.push_back(place);
  }
  if (!std::is_sorted(state.cells.begin(), state.cells.end())) in.refuse("cells", "not in their order");
  return state;
}

}  // namespace drumlin::apps
