#include "coupling/core/hdf5/field_map_file.hpp"

#include <cmath>
#include <sstream>
#include <tuple>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin {
namespace {

const std::string format = "drumlin-maps-1";
constexpr int packed_value_bits = 14;    // a relative error of 3e-5, below that of any mean
constexpr int packed_interval_bits = 6;  // of 1 %
constexpr double even = 1e-9;  // how far nodes may lie off equal spacing, of the spacing: rounding, no more

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// First node and spacing of an axis that is stored as all its nodes.
std::pair<double, double> axis(const H5Reader& in, const char* name, const std::vector<double>& nodes) {
  if (nodes.empty()) in.refuse(name, "empty");
  const auto last = static_cast<double>(nodes.size() - 1);
  // A single node has no neighbour that would give a spacing.
  const double spacing = nodes.size() > 1 ? (nodes.back() - nodes.front()) / last : 1;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!(std::abs(nodes[i] - nodes.front() - static_cast<double>(i) * spacing) <= even * spacing))
      in.refuse(name, "not ascending in equal steps");
  return {nodes.front(), spacing};
}

/// Lines are counted within the dataset.
RunHeader header(const H5Reader& in, const std::filesystem::path& file) {
  const std::vector<std::string> texts = lines_of(in.text("header"));
  std::vector<HeaderLine> lines;
  for (const std::string& text : texts) lines.push_back({static_cast<int>(lines.size()) + 1, text});
  return read_header(lines, file.string() + " header");
}

std::vector<double> over_grid(const H5Reader& in, const std::string& name, const MapGrid& grid) {
  if (in.shape(name) != std::vector<std::size_t>{grid.rows, grid.columns})
    in.refuse(name, "not one entry per row and column of the grid");
  return in.doubles(name);
}

/// All but the fields themselves.
void add_outline(const FieldMap& map, H5Content& out) {
  std::string names;
  for (const MapField& field : map.fields) names.append(field.name).append("\n");
  out.add_text("format", format);
  out.add_text("header", header_lines(map.header, ""));
  out.add_text("names", names);
  out.add_scales(map.scales);
  add_nodes(map.grid, out);
}

void refuse_faults(const std::filesystem::path& file, const FieldMap& map) {
  if (const std::string fault = fault_of(map); !fault.empty()) throw InputError(file.string() + ": " + fault);
}

/// Calls action(name, values, words, bits when packed) for all datasets of the fields, in their order.
template <class Action>
void each_set(const std::vector<MapField>& fields, Action action) {
  for (const MapField& field : fields) {
    const auto [unit, meaning] = quantity_words(field.name);
    action("fields/" + field.name, field.value, H5Words{unit, meaning}, packed_value_bits);
    const std::string half_width = meaning.empty() ? "" : "half width of the 99 % interval of " + meaning;
    if (!field.ci99.empty())
      action("ci99/" + field.name, field.ci99, H5Words{unit, half_width}, packed_interval_bits);
  }
}

}  // namespace

void add_nodes(const MapGrid& grid, H5Content& out) {
  std::vector<double> x(grid.columns), z(grid.rows);
  for (std::size_t column = 0; column < x.size(); ++column) x[column] = grid.x_of(column);
  for (std::size_t row = 0; row < z.size(); ++row) z[row] = grid.z_of(row);
  out.add("x", x, {"d", "nodes along x"});
  out.add("z", z, {"d", "nodes along z"});
}

void write_field_map(const std::filesystem::path& file, const FieldMap& map, MapStorage storage) {
  refuse_faults(file, map);
  H5Writer out;
  add_outline(map, out);
  each_set(map.fields,
           [&](const std::string& name, const std::vector<double>& values, H5Words words, int bits) {
             if (storage == MapStorage::whole)
               out.add_table(name, values, map.grid.columns, words);
             else
               out.add_packed_table(name, values, map.grid.columns, bits, words);
           });
  out.save(file);
}

FieldMapWriter::FieldMapWriter(std::filesystem::path file, FieldMap outline)
    : file_(std::move(file)), outline_(std::move(outline)), out_(file_) {}

void FieldMapWriter::add(const std::vector<MapField>& fields) {
  FieldMap rows;
  rows.grid = outline_.grid;
  rows.grid.rows = fields.empty() ? 0 : fields.front().value.size() / rows.grid.columns;
  rows.fields = fields;
  refuse_faults(file_, rows);
  if (rows_ == 0) {
    for (const MapField& field : fields) outline_.fields.push_back({field.name, {}, {}});
    add_outline(outline_, out_);
  }
  each_set(fields, [&](const std::string& name, const std::vector<double>& values, H5Words words, int) {
    if (rows_ == 0)
      out_.begin_table(name, values, outline_.grid.rows, outline_.grid.columns, words);
    else
      out_.add_rows(name, rows_, values);
  });
  rows_ += rows.grid.rows;
}

void FieldMapWriter::save() {
  if (rows_ != outline_.grid.rows)
    throw InputError(file_.string() + ": of " + std::to_string(outline_.grid.rows) + " rows of the map " +
                     std::to_string(rows_) + " were given");
  out_.save();
}

FieldMap read_field_map(const std::filesystem::path& file) {
  const H5Reader in(file);
  in.require_format(format);
  FieldMap map;
  map.header = header(in, file);
  map.scales = in.scales();
  const std::vector<double> x = in.doubles("x", H5Range::finite), z = in.doubles("z", H5Range::finite);
  std::tie(map.grid.x_first, map.grid.spacing_x) = axis(in, "x", x);
  std::tie(map.grid.z_first, map.grid.spacing_z) = axis(in, "z", z);
  map.grid.columns = x.size();
  map.grid.rows = z.size();
  for (const std::string& name : lines_of(in.text("names"))) {
    MapField field{name, over_grid(in, "fields/" + name, map.grid), {}};
    if (in.has("ci99/" + name)) field.ci99 = over_grid(in, "ci99/" + name, map.grid);
    map.fields.push_back(std::move(field));
  }
  refuse_faults(file, map);
  return map;
}

}  // namespace drumlin
