#include "apps/commands/measure/frames_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/measurement/layers/slice.hpp"
#include "particles/measurement/spheres/space_layers.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;
using particles::FlowSnapshot;
using particles::MeasurementFrame;
using particles::Rectangle;
using particles::Snapshot;

/// One table of profiles, and the layers or rings that grow while the snapshots are read.
struct OwnFrame {
  std::string name, coordinate;
  Json place;
  std::span<const particles::LayerQuantity> quantities;
  particles::Slice slice;
  std::optional<particles::SpaceLayers> space = {};  ///< of spheres over radius or height
};

struct Frames {
  std::size_t batches = 0;
  bool in_mirror = false;
  std::vector<OwnFrame> frames;
};

/// The box of what is measured, from the axes of the measurement back in those of the scene.
Rectangle reach_of(const MeasurementFrame& place) {
  const particles::FlowFrame& f = place.frame;
  Rectangle reach = particles::no_rectangle;
  for (const double x : {place.reach.x_min, place.reach.x_max})
    for (const double z : {place.reach.z_min, place.reach.z_max}) {
      const double there = f.origin_x + x * f.x_axis_x - z * f.x_axis_z;
      const double scene_x = place.in_mirror ? -there : there;
      const double scene_z = f.origin_z + x * f.x_axis_z + z * f.x_axis_x;
      reach.widen({scene_x, scene_x, scene_z, scene_z});
    }
  return reach;
}

/// The centre of the rings in the axes of the scene.
std::array<double, 2> centre_of(const MeasureOptions& options, const MeasurementFrame& place) {
  if (options.radial.front() != "axis")
    return {*finite_number(options.radial[0]), *finite_number(options.radial[1])};
  if (!(place.container_radius > 0))
    throw InputError("--radial axis: the scene has no circular wall (allowed: X,Z, a point in d)");
  return {place.in_mirror ? -place.frame.origin_x : place.frame.origin_x, place.frame.origin_z};
}

void begin(const MeasureOptions& options, const MeasurementFrame& place, Frames& frames) {
  if (place.period > 0)
    throw InputError(
        "--radial, --height, --width: the scene is periodic in x, where rings and bands would be cut at the "
        "seam (allowed: scenes without periodic_x; layers over the whole period are profiles.csv)");
  frames.batches = place.batches;
  frames.in_mirror = place.in_mirror;
  const double thickness = options.layer_thickness;
  const Rectangle reach = reach_of(place);
  const auto add = [&](const char* name, const char* coordinate, const Json& its_place,
                       std::span<const particles::LayerQuantity> quantities,
                       const particles::LayerGrid& grid) {
    frames.frames.push_back(
        {name, coordinate, its_place, quantities, particles::empty_slice(grid, place.batches)});
  };
  if (!options.radial.empty()) {
    const auto [x, z] = centre_of(options, place);
    double r_to = 0;
    for (const double corner_x : {reach.x_min, reach.x_max})
      for (const double corner_z : {reach.z_min, reach.z_max})
        r_to = std::max(r_to, std::hypot(corner_x - x, corner_z - z));
    const bool about_axis = options.radial.front() == "axis";
    add("radial", "r", {{"center", about_axis ? "axis" : "point"}, {"center_x", x}, {"center_z", z}},
        particles::ring_quantities(),
        particles::ring_grid(x, z, thickness, r_to, about_axis ? place.container_radius : 0));
  }
  if (const auto& band = options.height; !band.empty())
    add("height", "z", {{"x_from", band[0]}, {"x_to", band[1]}}, particles::height_quantities(),
        particles::height_grid(band[0], band[1], reach, thickness));
  if (const auto& band = options.width; !band.empty())
    add("width", "x", {{"z_from", band[0]}, {"z_to", band[1]}}, particles::width_quantities(),
        particles::width_grid(band[0], band[1], reach, thickness));
}

/// Velocities are those of the laboratory at the instant of the snapshot: a turning wall takes nothing off.
void add(Snapshot snapshot, std::size_t batch, Frames& frames) {
  if (frames.in_mirror) snapshot = particles::mirrored(std::move(snapshot));
  snapshot.wall_spin = 0;
  for (OwnFrame& one : frames.frames) {
    const particles::LayerGrid& grid = one.slice.grid;
    const FlowSnapshot seen = in_flow_frame(snapshot, grid.frame, particles::VelocityKind::instantaneous);
    add_snapshot(grid, seen, one.slice.batches[batch]);
    if (!snapshot.spheres || one.name == "width") continue;
    if (!one.space) one.space = particles::empty_space_layers(grid, one.slice.batches.size());
    add_snapshot(grid, snapshot, seen, one.space->batches[batch]);
  }
}

/// Of spheres with the columns of space that the view lacks. No surface crosses infinity: z counts from the
/// origin of the frame.
ProfileSet table_of(const OwnFrame& one) {
  ProfileSet table = table_of(slice_profiles(one.slice, INFINITY), one.quantities);
  if (!one.space) return table;
  ProfileSet space = particles::space_profiles(*one.space, 0);
  for (ProfileColumn& column : space.columns)
    if (!table.find(column.name)) table.columns.push_back(std::move(column));
  return table;
}

/// As profiles.csv, but for the name of its first column and for a header that names the frame.
void write_table(const std::filesystem::path& file, const std::string& coordinate, const Json& frame,
                 const ProfileSet& profiles) {
  std::string text = "# drumlin-frame-1\n";
  for (const auto& [key, value] : frame.items())
    text += fmt::format("# {} = {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  replace_file(file, text + column_lines(profiles) + profile_table(profiles, coordinate));
}

void write(const MeasureOptions& options, const PartOutput& output, const Frames& frames) {
  Json list = Json::array();
  for (const OwnFrame& one : frames.frames) {
    Json header{{"frame", one.name}};
    header.update(one.place);
    header["layer_thickness"] = options.layer_thickness;
    header["batches"] = frames.batches;
    if (output.reduced) header["reduced"] = true;
    const std::string file = one.name + ".csv";
    write_table(output.folder / file, one.coordinate, header, table_of(one));
    header["file"] = file;
    list.push_back(header);
  }
  output.content["frames"] = list;
}

void print(const MeasureOptions& options) {
  const auto line = [](bool requested, const char* name, const char* over) {
    if (requested) print_out(fmt::format("  {}.csv: profiles over {}\n", name, over));
  };
  line(!options.radial.empty(), "radial", "the distance from a point");
  line(!options.height.empty(), "height", "the height");
  line(!options.width.empty(), "width", "the width");
}

/// Two numbers, the second one greater.
void check_band(const char* option, const std::vector<double>& band) {
  if (band.empty() || (band.size() == 2 && band[0] < band[1])) return;
  throw InputError(fmt::format("{}: takes two numbers in d, the second one greater", option));
}

void check_centre(const std::vector<std::string>& radial) {
  const bool point = radial.size() == 2 && finite_number(radial[0]) && finite_number(radial[1]);
  if (radial.empty() || point || (radial.size() == 1 && radial[0] == "axis")) return;
  throw InputError("--radial: takes axis, or X,Z in d");
}

}  // namespace

bool asks_for_frames(const MeasureOptions& options) {
  return !options.radial.empty() || !options.height.empty() || !options.width.empty();
}

Part frames_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  check_centre(options.radial);
  check_band("--height", options.height);
  check_band("--width", options.width);
  auto frames = std::make_shared<Frames>();
  Part part;
  part.name = "frames";
  part.reading.begin = [=](const MeasurementFrame& place) { begin(options, place, *frames); };
  part.reading.add = [=](const Snapshot& snapshot, const FlowSnapshot&, std::size_t batch) {
    add(snapshot, batch, *frames);
  };
  part.write = [=](const particles::Measurement&, const PartOutput& output) {
    write(options, output, *frames);
  };
  part.print = [=] { print(options); };
  part.figures = "frame_figures.py";
  return part;
}

}  // namespace drumlin::apps
