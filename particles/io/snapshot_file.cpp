#include "particles/io/snapshot_file.hpp"

#include <algorithm>
#include <functional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"

namespace drumlin::particles {
namespace {

const std::string snapshot_format = "drumlin-snapshot-1";

/// Calls visit(name, number, words) for all single numbers, those of a cell apart.
template <class S, class Visit>
void each_number_of_snapshot(S& s, Visit visit) {
  visit("time", s.time, {"sqrt(d/g)", "since the start"});
  visit("time_step", s.time_step, {"sqrt(d/g)", "that led here", H5Range::from_0});
  visit("wall/angle", s.wall_angle, {"rad", "of the first wall that rotates, clockwise"});
  visit("wall/spin", s.wall_spin, {"sqrt(g/d)", "of the first wall that rotates, clockwise"});
  visit("container/x", s.container_x, {"d", "middle of the first circular container"});
  visit("container/z", s.container_z, {"d", "middle of the first circular container"});
  visit("container/radius", s.container_radius, {"d", "0: no circular container", H5Range::from_0});
  visit("gravity_x", s.gravity_x, {"g", "body acceleration"});
  visit("gravity_z", s.gravity_z, {"g", "body acceleration"});
  visit("velocity_window", s.velocity_window,
        {"sqrt(d/g)", "time that the displacements cover", H5Range::from_0});
  visit("period_x", s.period_x, {"d", "length of a periodic domain; 0: open", H5Range::from_0});
}

/// The same of a cell.
template <class Cell, class Visit>
void each_number_of_cell(Cell& cell, Visit visit) {
  visit("cell/x", cell.x, {"d", "lower left corner"});
  visit("cell/z", cell.z, {"d", "lower left corner"});
  visit("cell/height", cell.height, {"d", "height", H5Range::above_0});
  visit("cell/offset", cell.offset, {"d", "displacement of the image above along x"});
  visit("cell/rate_x", cell.rate_x, {"sqrt(g/d)", "rate of its length"});
  visit("cell/rate_z", cell.rate_z, {"sqrt(g/d)", "rate of its height"});
  visit("cell/shear", cell.shear, {"sqrt(g/d)", "velocity of the image above along x, over the height"});
}

/// Calls visit(name, values, words) for all arrays of numbers that each grain has, and for those that it may
/// have.
template <class S, class Visit>
void each_array_of_grains(S& s, Visit visit) {
  visit("grains/x", s.x, {"d", "centre, to the right"});
  visit("grains/z", s.z, {"d", "centre, upwards"});
  visit("grains/v_x", s.v_x, {"sqrt(g d)", "velocity to the right"});
  visit("grains/v_z", s.v_z, {"sqrt(g d)", "velocity upwards"});
  visit("grains/radius", s.radius, {"d", "radius", H5Range::above_0});
}
template <class S, class Visit>
void each_further_array_of_grains(S& s, Visit visit) {
  visit("grains/spin", s.spin, {"sqrt(g/d)", "angular velocity, clockwise"});
  visit("grains/mass", s.mass, {"rho0 d^2", "mass per depth", H5Range::above_0});
  visit("grains/displacement_x", s.displacement_x, {"d", "to the right, over the velocity window"});
  visit("grains/displacement_z", s.displacement_z, {"d", "upwards, over the velocity window"});
}

template <class S, class Visit>
void each_array_of_walls(S& s, Visit visit) {
  visit("walls/angle", s.wall_pose_angle, {"rad", "turned, clockwise"});
  visit("walls/x", s.wall_pose_x, {"d", "displacement to the right"});
  visit("walls/z", s.wall_pose_z, {"d", "displacement upwards"});
}

void add_contacts(const Snapshot& s, H5Writer& out) {
  const auto add = [&]<class T>(const char* name, T SnapshotContact::*member, H5Words words) {
    std::vector<T> values;
    values.reserve(s.contacts.size());
    for (const SnapshotContact& c : s.contacts) values.push_back(c.*member);
    out.add(name, values, words);
  };
  add("contacts/i", &SnapshotContact::i, {"1", "grain i"});
  add("contacts/j", &SnapshotContact::j, {"1", "grain j, or -1 - w for shape w of the walls"});
  add("contacts/normal_x", &SnapshotContact::normal_x, {"1", "unit normal from j to i"});
  add("contacts/normal_z", &SnapshotContact::normal_z, {"1", "unit normal from j to i"});
  const char* unit = "rho0 d^2 sqrt(g d)";
  add("contacts/impulse_n", &SnapshotContact::impulse_n, {unit, "on i along the normal"});
  add("contacts/impulse_t", &SnapshotContact::impulse_t, {unit, "on i along (n_z, -n_x)"});
}

void read_contacts(const H5Reader& in, Snapshot& s) {
  const auto i = in.ints("contacts/i"), j = in.ints("contacts/j");
  const auto numbers = [&in](const char* name) { return in.doubles(name, H5Range::finite); };
  const auto n_x = numbers("contacts/normal_x"), n_z = numbers("contacts/normal_z");
  const auto r_n = numbers("contacts/impulse_n"), r_t = numbers("contacts/impulse_t");
  for (const std::size_t size : {j.size(), n_x.size(), n_z.size(), r_n.size(), r_t.size()})
    if (size != i.size()) in.refuse("contacts", "arrays of unequal length");
  if (!i.empty()) in.number("time_step", H5Range::above_0);
  const auto bodies = static_cast<std::int32_t>(s.x.size());
  s.contacts.reserve(i.size());
  for (std::size_t c = 0; c < i.size(); ++c) {
    if (i[c] < 0 || i[c] >= bodies || j[c] >= bodies)
      in.refuse("contacts", "names a grain that does not exist");
    s.contacts.push_back(
        {i[c], j[c], static_cast<float>(n_x[c]), static_cast<float>(n_z[c]), r_n[c], r_t[c]});
  }
}

}  // namespace

std::string snapshot_image(const Snapshot& s) {
  H5Writer out;
  out.add_text("format", snapshot_format);
  out.add_number("step", s.step);
  const auto number = [&out](const char* name, double value, H5Words words) {
    out.add_number(name, value, words);
  };
  const auto array = [&out](const char* name, const std::vector<double>& values, H5Words words) {
    out.add(name, values, words);
  };
  each_number_of_snapshot(s, number);
  out.add_scales(s.scales);
  each_array_of_grains(s, array);
  each_further_array_of_grains(s, [&](const char* name, const auto& values, H5Words words) {
    if (!values.empty()) array(name, values, words);
  });
  if (!s.id.empty()) out.add("grains/id", s.id, {"1", "identity, never given twice"});
  if (!s.wall_pose_angle.empty()) each_array_of_walls(s, array);
  if (!s.wall_open.empty()) out.add("walls/open", s.wall_open, {"1", "1: gone"});
  if (s.cell) each_number_of_cell(*s.cell, number);
  if (s.contacts_known) add_contacts(s, out);
  return out.image();
}
void write_snapshot(const std::filesystem::path& file, const Snapshot& s) {
  replace_file(file, snapshot_image(s));
}
Snapshot read_snapshot(const std::filesystem::path& file) {
  const H5Reader in(file);
  in.require_format(snapshot_format);
  Snapshot s;
  s.step = in.integer("step", 0);
  const auto number = [&in](const char* name, double& value, H5Words words) {
    value = in.number(name, words.range);
  };
  each_number_of_snapshot(s, number);
  s.scales = in.scales();
  const auto per_grain = [&](const char* name, std::vector<double>& values, H5Words words) {
    values = in.doubles(name, words.range);
    if (values.size() != s.x.size()) in.refuse(name, "not one entry per grain");
  };
  each_array_of_grains(s, per_grain);
  each_further_array_of_grains(s, [&](const char* name, auto& values, H5Words words) {
    if (in.has(name)) per_grain(name, values, words);
  });
  if (in.has("grains/id")) {
    s.id = in.longs("grains/id");
    if (s.id.size() != s.x.size()) in.refuse("grains/id", "not one entry per grain");
    if (std::adjacent_find(s.id.begin(), s.id.end(), std::greater_equal<>()) != s.id.end())
      in.refuse("grains/id", "not ascending");
  }
  if (in.has("walls/angle"))
    each_array_of_walls(s, [&](const char* name, std::vector<double>& values, H5Words words) {
      values = in.doubles(name, words.range);
      if (values.size() != s.wall_pose_angle.size()) in.refuse("walls", "arrays of unequal length");
    });
  if (in.has("walls/open")) s.wall_open = in.ints("walls/open", 0, 1);
  if (in.has("cell")) each_number_of_cell(s.cell.emplace(), number);
  s.contacts_known = in.has("contacts");
  if (s.contacts_known) read_contacts(in, s);
  return s;
}

double snapshot_time(const std::filesystem::path& file) {
  const H5Reader in(file);
  in.require_format(snapshot_format);
  return in.number("time", H5Range::finite);
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
