#include "coupling/core/hdf5/frames_file.hpp"

#include <fmt/format.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin {
namespace {

/// One dataset of all frames; `values_of(frame)`: those of one, of the lengths `each`.
void add_set(H5Content& out, const Frames& all, const std::string& group, const std::string& name,
             const std::vector<std::size_t>& each, const auto& values_of) {
  std::vector<double> values;
  for (const Frame& frame : all.frames) {
    const auto& of_one = values_of(frame);
    values.insert(values.end(), of_one.begin(), of_one.end());
  }
  const auto [unit, meaning] =
      group == "loads/" ? QuantityWords{"rho0 g d^2", "force on the walls of this name, along x, z"}
                        : quantity_words(name);
  std::vector<std::size_t> lengths{all.runs.size(), all.times.size()}, piece;
  lengths.insert(lengths.end(), each.begin(), each.end());
  if (each.size() == 2) piece = {1, 1, each[0], each[1]};  // most nodes of a field hold nothing
  out.add_array(group + name, values, lengths, {unit, meaning}, piece);
}

std::string lines_of_names(const auto& names) {
  std::string lines;
  for (const std::string& name : names) lines.append(name).append("\n");
  return lines;
}

}  // namespace

void write_frames(const std::filesystem::path& file, const Frames& frames) {
  if (const std::string fault = fault_of(frames); !fault.empty())
    throw InputError(file.string() + ": " + fault);
  const MapGrid& grid = frames.grid;
  const Frame& first = frames.frames.front();
  RunHeader header = frames.header;
  header.further["time_origin_s"] = fmt::format("{}", frames.time_origin_s);
  header.further["nu_bulk"] = fmt::format("{}", frames.nu_bulk);
  std::vector<std::string> names;
  for (const auto& [name, values] : first.fields) names.push_back(name);
  H5FileWriter out(file);
  out.add_text("format", "drumlin-frames-1");
  out.add_text("header", header_lines(header, ""));
  out.add_text("names", lines_of_names(names));
  out.add_text("runs", lines_of_names(frames.runs));
  out.add_scales(frames.scales);
  out.add("times", frames.times, {"sqrt(d/g)", "since time_origin_s"});
  add_nodes(grid, out);
  add_set(
      out, frames, "", "height", {grid.columns}, [](const Frame& f) -> auto& { return f.height; });
  add_set(
      out, frames, "", "mass_height", {grid.columns}, [](const Frame& f) -> auto& { return f.mass_height; });
  for (const std::string& name : names)
    add_set(
        out, frames, "fields/", name,
        {grid.rows, grid.columns}, [&](const Frame& f) -> auto& { return f.fields.at(name); });
  for (const auto& [name, value] : first.scalars)
    add_set(out, frames, "scalars/", name, {},
            [&name = name](const Frame& f) { return std::array{f.scalars.at(name)}; });
  for (const auto& [name, value] : first.loads)
    add_set(
        out, frames, "loads/", name,
        {2}, [&name = name](const Frame& f) -> auto& { return f.loads.at(name); });
  out.save();
}

}  // namespace drumlin
