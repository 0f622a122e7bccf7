#include "apps/commands/measure/grains_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/support/snapshot_list.hpp"
#include "particles/io/grain_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/grains/grain_fields.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

GrainRecord record_of(Snapshot snapshot, const Measurement& measured, const VelocityMap& mean_velocity) {
  // The mean velocity is that of the last motion of the wall: no fluctuations are counted from it before.
  const bool same_motion = snapshot.time >= measured.first_time();
  if (measured.in_mirror) snapshot = mirrored(std::move(snapshot));
  const MeasurementFrame& place = measured.place;
  FlowSnapshot in_frame;
  to_flow_frame(snapshot, place.frame, VelocityKind::window, in_frame);
  GrainRecord record;
  record.step = snapshot.step;
  record.time = snapshot.time;
  record.frame_angle_deg = measured.frame_angle_deg;
  record.in_mirror = measured.in_mirror;
  record.container_radius = place.container_radius;
  record.axis_z = -measured.surface_z;
  record.period_x = place.period;
  record.scales = measured.scales;
  GrainFieldSet wanted{GrainField::cell,           GrainField::velocity,          GrainField::spin,
                       GrainField::contact_stress, GrainField::rotational_stress, GrainField::coordination};
  if (same_motion) wanted.add(GrainField::kinetic_stress);
  record.fields = grain_fields(snapshot, in_frame, wanted, &mean_velocity);
  record.x = std::move(in_frame.x);
  record.z = std::move(in_frame.z);
  record.radius = std::move(in_frame.radius);
  for (double& z : record.z) z -= measured.surface_z;
  return record;
}

}  // namespace

Part grains_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  const auto files = listed_snapshots(options.run, snapshot_files(options.run), "--grains", options.grains);
  auto mean_velocity = std::make_shared<std::optional<VelocityMap>>();
  Part part;
  part.name = "grains";
  part.reading.begin = [mean_velocity](const MeasurementFrame& place) {
    mean_velocity->emplace(place.x_min, place.x_max, place.z_min, place.z_max, place.period);
  };
  part.reading.add = [mean_velocity](const Snapshot&, const FlowSnapshot& in_frame, std::size_t) {
    (*mean_velocity)->add(in_frame);
  };
  part.write = [mean_velocity, files](const Measurement& measured, const PartOutput& output) {
    fs::create_directories(output.folder / "grains");
    for (const fs::path& file : files)
      write_grains(output.folder / "grains" / file.filename(),
                   record_of(read_snapshot(file), measured, **mean_velocity));
    output.content["settings"]["grains"] = {{"cell_reach", VoronoiOptions{}.reach},
                                            {"files", static_cast<int>(files.size())}};
  };
  part.figures = "grain_field_figures.py";
  return part;
}

}  // namespace drumlin::apps
