#include "particles/io/snapshot_file.hpp"

#include <algorithm>
#include <functional>

#include "coupling/common/errors.hpp"
#include "coupling/common/files/text_file.hpp"
#include "coupling/hdf5/h5_reader.hpp"
#include "coupling/hdf5/h5_writer.hpp"
#include "particles/io/snapshot_contents.hpp"

namespace drumlin::particles {
namespace {
void read_contacts(const H5Reader& in, Snapshot& s) {
  const auto i = in.ints("contacts/i"), j = in.ints("contacts/j");
  const auto n_x = in.floats("contacts/normal_x"), n_z = in.floats("contacts/normal_z");
  const auto r_n = in.doubles("contacts/impulse_n"), r_t = in.doubles("contacts/impulse_t");
  for (const std::size_t size : {j.size(), n_x.size(), n_z.size(), r_n.size(), r_t.size()})
    if (size != i.size()) in.refuse("contacts", "arrays of unequal length");
  const auto bodies = static_cast<std::int32_t>(s.x.size());
  s.contacts.reserve(i.size());
  for (std::size_t c = 0; c < i.size(); ++c) {
    if (i[c] < 0 || i[c] >= bodies || j[c] >= bodies)
      in.refuse("contacts", "names a grain that does not exist");
    s.contacts.push_back({i[c], j[c], n_x[c], n_z[c], r_n[c], r_t[c]});
  }
}

}  // namespace

std::string snapshot_image(const Snapshot& s) {
  H5Writer out;
  add_snapshot(s, out);
  return out.image();
}
void write_snapshot(const std::filesystem::path& file, const Snapshot& s) {
  replace_file(file, snapshot_image(s));
}
Snapshot read_snapshot(const std::filesystem::path& file) {
  const H5Reader in(file);
  if (!in.has("format") || in.text("format") != snapshot_format)
    in.refuse("format", in.has("format")
                            ? "'" + in.text("format") + "', this version reads " + snapshot_format
                            : "missing");
  Snapshot s;
  s.step = in.integer("step");
  const std::pair<const char*, double*> numbers[] = {{"time", &s.time},
                                                     {"time_step", &s.time_step},
                                                     {"wall/angle", &s.wall_angle},
                                                     {"wall/spin", &s.wall_spin},
                                                     {"container/x", &s.container_x},
                                                     {"container/z", &s.container_z},
                                                     {"container/radius", &s.container_radius},
                                                     {"gravity_x", &s.gravity_x},
                                                     {"gravity_z", &s.gravity_z},
                                                     {"velocity_window", &s.velocity_window},
                                                     {"period_x", &s.period_x},
                                                     {"scales/length_m", &s.scales.length_m},
                                                     {"scales/time_s", &s.scales.time_s},
                                                     {"scales/density_kg_m3", &s.scales.density_kg_m3}};
  for (const auto& [name, value] : numbers) *value = in.number(name);
  s.x = in.doubles("grains/x");
  const std::size_t grains = s.x.size();
  const auto per_grain = [&](const char* name, std::vector<double>& values, bool optional) {
    if (optional && !in.has(name)) return;
    values = in.doubles(name);
    if (values.size() != grains) in.refuse(name, "not one entry per grain");
  };
  per_grain("grains/z", s.z, false), per_grain("grains/v_x", s.v_x, false),
      per_grain("grains/v_z", s.v_z, false);
  per_grain("grains/radius", s.radius, false), per_grain("grains/spin", s.spin, true);
  per_grain("grains/displacement_x", s.displacement_x, true),
      per_grain("grains/displacement_z", s.displacement_z, true);
  per_grain("grains/mass", s.mass, true);
  if (in.has("grains/id")) {
    s.id = in.longs("grains/id");
    if (s.id.size() != grains) in.refuse("grains/id", "not one entry per grain");
    if (std::adjacent_find(s.id.begin(), s.id.end(), std::greater_equal<>()) != s.id.end())
      in.refuse("grains/id", "not ascending");
  }
  if (in.has("walls/angle")) {
    s.wall_pose_angle = in.doubles("walls/angle");
    s.wall_pose_x = in.doubles("walls/x"), s.wall_pose_z = in.doubles("walls/z");
    for (const std::size_t size : {s.wall_pose_x.size(), s.wall_pose_z.size()})
      if (size != s.wall_pose_angle.size()) in.refuse("walls", "arrays of unequal length");
  }
  if (in.has("walls/open")) s.wall_open = in.ints("walls/open", 0, 1);
  if (in.has("cell"))
    each_number_of_cell(s.cell.emplace(),
                        [&in](const char* name, double& number) { number = in.number(name); });
  s.contacts_known = in.has("contacts");
  if (s.contacts_known) read_contacts(in, s);
  return s;
}

std::vector<std::filesystem::path> snapshot_files(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / "snapshots", error))
    if (entry.path().extension() == ".h5") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace drumlin::particles
