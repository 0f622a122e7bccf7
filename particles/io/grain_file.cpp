#include "particles/io/grain_file.hpp"

#include <string>

#include "coupling/core/hdf5/h5_writer.hpp"

namespace drumlin::particles {
namespace {

void add_floats(H5Writer& out, const std::string& name, const std::vector<double>& values, H5Words words) {
  if (!values.empty()) out.add("grains/" + name, std::vector<float>(values.begin(), values.end()), words);
}

void add_stress(H5Writer& out, const std::string& part, const GrainStress& stress) {
  const H5Words words{"rho0 g d", "stress of the cell, compression positive; xz: of what is above on below"};
  add_floats(out, "sigma_xx" + part, stress.xx, words);
  add_floats(out, "sigma_zz" + part, stress.zz, words);
  add_floats(out, "sigma_xz" + part, stress.xz, words);
}

}  // namespace

void write_grains(const std::filesystem::path& file, const GrainRecord& record) {
  H5Writer out;
  out.add_text("format", "drumlin-grains-1");
  out.add_number("step", record.step);
  out.add_number("in_mirror", static_cast<std::int64_t>(record.in_mirror ? 1 : 0));
  out.add_number("time", record.time, {"sqrt(d/g)", "since the start"});
  out.add_number("frame_angle_deg", record.frame_angle_deg, {"deg", "of x below the horizontal"});
  out.add_number("container/radius", record.container_radius, {"d", "of the drum; 0: none"});
  out.add_number("container/z", record.axis_z, {"d", "of the drum's axis above the surface"});
  out.add_number("period_x", record.period_x, {"d", "length of a periodic domain; 0: open"});
  out.add_scales(record.scales);
  add_floats(out, "x", record.x, {"d", "centre, downslope"});
  add_floats(out, "z", record.z, {"d", "centre, from the surface along its normal"});
  add_floats(out, "radius", record.radius, {"d", "radius"});
  const GrainFields& fields = record.fields;
  add_floats(out, "cell_area", fields.cell_area, {"d^2", "area of the Voronoi cell"});
  add_floats(out, "nu", fields.nu, {"1", "area of the grain over that of its cell"});
  add_floats(out, "v_x", fields.v_x, {"sqrt(g d)", "velocity downslope, over the window"});
  add_floats(out, "v_z", fields.v_z, {"sqrt(g d)", "velocity along the normal, over the window"});
  add_floats(out, "omega", fields.spin, {"sqrt(g/d)", "spin relative to the drum, clockwise"});
  add_floats(out, "sigma_rotational", fields.rotational, {"rho0 g d", "energy of the spin per area"});
  add_stress(out, "_contact", fields.contact);
  add_stress(out, "_kinetic", fields.kinetic);
  if (!fields.open_cell.empty())
    out.add("grains/open_cell", fields.open_cell, {"1", "1: the cell ends at its reach"});
  if (!fields.coordination.empty())
    out.add("grains/coordination", fields.coordination, {"1", "loaded contacts, walls included"});
  out.save(file);
}

}  // namespace drumlin::particles
