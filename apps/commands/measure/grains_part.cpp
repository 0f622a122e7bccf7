#include "apps/commands/measure/grains_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "coupling/core/files/text_file.hpp"
#include "particles/io/grain_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/io/snapshot_list.hpp"
#include "particles/measurement/grains/grain_fields.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

particles::GrainRecord record_of(particles::Snapshot snapshot, const particles::Measurement& measured,
                                 const particles::VelocityMap& mean_velocity) {
  // The mean velocity is that of the last motion of the wall: no fluctuations are counted from it before.
  const bool same_motion = snapshot.time >= measured.first_time();
  if (measured.place.in_mirror) snapshot = particles::mirrored(std::move(snapshot));
  const particles::MeasurementFrame& place = measured.place;
  particles::FlowSnapshot in_frame = particles::in_flow_frame(snapshot, place.frame);
  particles::GrainRecord record;
  record.step = snapshot.step;
  record.time = snapshot.time;
  record.frame_angle_deg = measured.frame_angle_deg;
  record.in_mirror = measured.place.in_mirror;
  record.container_radius = place.container_radius;
  record.axis_z = -measured.surface_z;
  record.period_x = place.period;
  record.scales = measured.scales;
  record.fields = particles::grain_fields(snapshot, in_frame, same_motion ? &mean_velocity : nullptr);
  record.x = std::move(in_frame.x);
  record.z = std::move(in_frame.z);
  record.radius = std::move(in_frame.radius);
  for (double& z : record.z) z -= measured.surface_z;
  return record;
}

}  // namespace

Part grains_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  const auto files = particles::listed_snapshots(options.run(), particles::snapshot_files(options.run()),
                                                 "--grains", options.grains);
  auto mean_velocity = std::make_shared<std::optional<particles::VelocityMap>>();
  Part part;
  part.name = "grains";
  part.reading.begin = [mean_velocity](const particles::MeasurementFrame& place) {
    mean_velocity->emplace(place.reach, place.period);
  };
  part.reading.add = [mean_velocity](const particles::Snapshot&, const particles::FlowSnapshot& in_frame,
                                     std::size_t) { (*mean_velocity)->add(in_frame); };
  part.write = [mean_velocity, files](const particles::Measurement& measured, const PartOutput& output) {
    make_folders(output.folder / "grains");
    for (const fs::path& file : files)
      particles::write_grains(output.folder / "grains" / file.filename(),
                              record_of(particles::read_snapshot(file), measured, **mean_velocity));
    output.content["settings"]["grains"] = {{"cell_reach", particles::voronoi_reach},
                                            {"files", static_cast<int>(files.size())}};
  };
  part.figures = "grain_field_figures.py";
  return part;
}

}  // namespace drumlin::apps
