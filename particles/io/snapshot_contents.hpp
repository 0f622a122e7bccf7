#pragma once
// What a snapshot file holds, item by item.
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "particles/io/snapshot_file.hpp"

namespace drumlin::particles {

inline const std::string snapshot_format = "drumlin-snapshot-1";

/// Calls visit(name, number) for all numbers of a cell.
template <class Cell, class Visit>
void each_number_of_cell(Cell& cell, Visit visit) {
  visit("cell/x", cell.x), visit("cell/z", cell.z), visit("cell/height", cell.height);
  visit("cell/offset", cell.offset);
  visit("cell/rate_x", cell.rate_x), visit("cell/rate_z", cell.rate_z), visit("cell/shear", cell.shear);
}

template <class Out>
void add_snapshot_contacts(const Snapshot& s, Out& out) {
  std::vector<std::int32_t> i, j;
  std::vector<float> n_x, n_z;
  std::vector<double> r_n, r_t;
  i.reserve(s.contacts.size()), j.reserve(s.contacts.size());
  n_x.reserve(s.contacts.size()), n_z.reserve(s.contacts.size());
  r_n.reserve(s.contacts.size()), r_t.reserve(s.contacts.size());
  for (const SnapshotContact& c : s.contacts) {
    i.push_back(c.i), j.push_back(c.j), n_x.push_back(c.normal_x), n_z.push_back(c.normal_z);
    r_n.push_back(c.impulse_n), r_t.push_back(c.impulse_t);
  }
  out.add("contacts/i", std::span<const std::int32_t>(i));
  out.add("contacts/j", std::span<const std::int32_t>(j));
  out.add("contacts/normal_x", std::span<const float>(n_x));
  out.add("contacts/normal_z", std::span<const float>(n_z));
  out.add("contacts/impulse_n", std::span<const double>(r_n));
  out.add("contacts/impulse_t", std::span<const double>(r_t));
}

/// Adds all of it to `out`, which has the members of H5Content. What there is once for each grain or contact
/// has names that begin with "grains/" or "contacts/".
template <class Out>
void add_snapshot(const Snapshot& s, Out& out) {
  out.add_text("format", snapshot_format);
  out.add_number("step", s.step);
  const std::pair<const char*, double> numbers[] = {{"time", s.time},
                                                    {"time_step", s.time_step},
                                                    {"wall/angle", s.wall_angle},
                                                    {"wall/spin", s.wall_spin},
                                                    {"container/x", s.container_x},
                                                    {"container/z", s.container_z},
                                                    {"container/radius", s.container_radius},
                                                    {"gravity_x", s.gravity_x},
                                                    {"gravity_z", s.gravity_z},
                                                    {"velocity_window", s.velocity_window},
                                                    {"period_x", s.period_x},
                                                    {"scales/length_m", s.scales.length_m},
                                                    {"scales/time_s", s.scales.time_s},
                                                    {"scales/density_kg_m3", s.scales.density_kg_m3}};
  for (const auto& [name, value] : numbers) out.add_number(name, value);
  const std::pair<const char*, const std::vector<double>*> arrays[] = {{"grains/x", &s.x},
                                                                       {"grains/z", &s.z},
                                                                       {"grains/v_x", &s.v_x},
                                                                       {"grains/v_z", &s.v_z},
                                                                       {"grains/radius", &s.radius}};
  for (const auto& [name, values] : arrays) out.add(name, std::span<const double>(*values));
  if (!s.spin.empty()) out.add("grains/spin", std::span<const double>(s.spin));
  if (!s.id.empty()) out.add("grains/id", std::span<const std::int64_t>(s.id));
  if (!s.mass.empty()) out.add("grains/mass", std::span<const double>(s.mass));
  if (!s.displacement_x.empty()) {
    out.add("grains/displacement_x", std::span<const double>(s.displacement_x));
    out.add("grains/displacement_z", std::span<const double>(s.displacement_z));
  }
  if (!s.wall_pose_angle.empty()) {
    out.add("walls/angle", std::span<const double>(s.wall_pose_angle));
    out.add("walls/x", std::span<const double>(s.wall_pose_x));
    out.add("walls/z", std::span<const double>(s.wall_pose_z));
  }
  if (!s.wall_open.empty()) out.add("walls/open", std::span<const std::int32_t>(s.wall_open));
  if (s.cell)
    each_number_of_cell(*s.cell, [&out](const char* name, double number) { out.add_number(name, number); });
  if (s.contacts_known) add_snapshot_contacts(s, out);
}

}  // namespace drumlin::particles
