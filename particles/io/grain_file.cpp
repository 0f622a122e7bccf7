#include "particles/io/grain_file.hpp"

#include <string>

#include "coupling/hdf5/h5_writer.hpp"

namespace drumlin::particles {
namespace {

void add_floats(H5Writer& out, const std::string& name, const std::vector<double>& values) {
  if (values.empty()) return;
  const std::vector<float> rounded(values.begin(), values.end());
  out.add("grains/" + name, std::span<const float>(rounded));
}

void add_stress(H5Writer& out, const std::string& suffix, const GrainStress& stress) {
  add_floats(out, "sigma_xx" + suffix, stress.xx);
  add_floats(out, "sigma_zz" + suffix, stress.zz);
  add_floats(out, "sigma_xz" + suffix, stress.xz);
}

}  // namespace

void write_grains(const std::filesystem::path& file, const GrainRecord& record) {
  H5Writer out;
  out.add_text("format", "drumlin-grains-1");
  out.add_number("step", record.step);
  out.add_number("in_mirror", static_cast<std::int64_t>(record.in_mirror ? 1 : 0));
  const std::pair<const char*, double> numbers[] = {{"time", record.time},
                                                    {"frame_angle_deg", record.frame_angle_deg},
                                                    {"container/radius", record.container_radius},
                                                    {"container/z", record.axis_z},
                                                    {"period_x", record.period_x},
                                                    {"scales/length_m", record.scales.length_m},
                                                    {"scales/time_s", record.scales.time_s},
                                                    {"scales/density_kg_m3", record.scales.density_kg_m3}};
  for (const auto& [name, value] : numbers) out.add_number(name, value);
  const GrainFields& fields = record.fields;
  const std::pair<const char*, const std::vector<double>*> arrays[] = {
      {"x", &record.x},
      {"z", &record.z},
      {"radius", &record.radius},
      {"cell_area", &fields.cell_area},
      {"nu", &fields.nu},
      {"v_x", &fields.v_x},
      {"v_z", &fields.v_z},
      {"omega", &fields.spin},
      {"sigma_rotational", &fields.rotational}};
  for (const auto& [name, values] : arrays) add_floats(out, name, *values);
  add_stress(out, "_contact", fields.contact);
  add_stress(out, "_kinetic", fields.kinetic);
  if (!fields.open_cell.empty()) out.add("grains/open_cell", std::span<const std::int32_t>(fields.open_cell));
  if (!fields.coordination.empty())
    out.add("grains/coordination", std::span<const std::int32_t>(fields.coordination));
  out.save(file);
}

}  // namespace drumlin::particles
