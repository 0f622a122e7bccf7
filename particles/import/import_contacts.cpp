#include "particles/import/import_contacts.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace drumlin::particles {
namespace {

using Vector = std::array<double, 2>;

constexpr double normal_tolerance = 1e-3;  // of the length of a unit normal in a table of few digits

struct ContactTable {
  explicit ContactTable(const FrameTable& frame, const Scales& scales) : table(frame) {
    i = frame.values("i", scales);
    j = frame.values("j", scales);
    by_components = frame.has("f_x") || !frame.has("f_n");
    first = frame.values(by_components ? "f_x" : "f_n", scales);
    second = frame.values(by_components ? "f_z" : "f_t", scales);
    if (frame.has("normal_x") || frame.has("normal_z")) {
      normal_x = frame.values("normal_x", scales);
      normal_z = frame.values("normal_z", scales);
    }
  }
  const FrameTable& table;
  bool by_components = false;
  std::vector<double> i, j, first, second, normal_x, normal_z;
};

std::int64_t id_of(const FrameTable& table, std::size_t row, double value, const char* key) {
  if (value != std::floor(value) || std::abs(value) > 1e15)
    table.refuse(row, key, fmt::format("{} is no whole number", value), "the id of a grain");
  return static_cast<std::int64_t>(value);
}

/// Where the other end of the contact lies as seen from the grain: the nearest image in a periodic domain.
Vector difference(const Snapshot& s, std::size_t i, const Vector& other) {
  double x = s.x[i] - other[0];
  if (s.period_x > 0) x -= s.period_x * std::round(x / s.period_x);
  return {x, s.z[i] - other[1]};
}

/// Direction from the other body to grain i.
Vector normal_of(const ContactTable& contacts, std::size_t row, const Snapshot& s, std::size_t i,
                 const std::optional<Vector>& other) {
  Vector n{0, 0};
  if (!contacts.normal_x.empty()) {
    n = {contacts.normal_x[row], contacts.normal_z[row]};
    if (std::abs(std::hypot(n[0], n[1]) - 1) > normal_tolerance)
      contacts.table.refuse(row, "normal_x",
                            fmt::format("the normal has the length {}", std::hypot(n[0], n[1])), "1");
  } else if (other) {
    n = difference(s, i, *other);
  } else if (s.container_radius > 0) {
    n = {s.container_x - s.x[i], s.container_z - s.z[i]};
  } else {
    contacts.table.refuse(row, "normal_x", "the normal of a contact with a wall is not given",
                          "columns normal_x, normal_z, or a drum in the description");
  }
  const double length = std::hypot(n[0], n[1]);
  if (!(length > 0)) contacts.table.refuse(row, "", "both bodies are at one place");
  return {n[0] / length, n[1] / length};
}

}  // namespace

void add_contacts(const FrameTable& table, const FrameBodies& bodies, Snapshot& s) {
  const ContactTable contacts(table, s.scales);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    std::int64_t first = id_of(table, row, contacts.i[row], "i");
    std::int64_t second = id_of(table, row, contacts.j[row], "j");
    const auto is_wall = [&](std::int64_t id) { return id < 0 || bodies.wall_atoms.contains(id); };
    double sign = 1;
    if (is_wall(first)) {  // told from the wall's side
      std::swap(first, second);
      sign = -1;
    }
    if (is_wall(first)) continue;  // wall on wall
    const auto grain = [&](std::int64_t id) {
      const auto found = bodies.grain.find(id);
      if (found == bodies.grain.end()) table.refuse(row, "i, j", fmt::format("there is no grain {}", id));
      return found->second;
    };
    if (contacts.first[row] == 0 && contacts.second[row] == 0) continue;
    const std::int32_t i = grain(first);
    std::int32_t j = -1;
    std::optional<Vector> other;
    if (!is_wall(second)) {
      j = grain(second);
      if (j == i) table.refuse(row, "i, j", fmt::format("grain {} touches itself", first));
      other = Vector{s.x[static_cast<std::size_t>(j)], s.z[static_cast<std::size_t>(j)]};
    } else if (second >= 0) {
      other = bodies.wall_atoms.at(second);
    } else {
      j = static_cast<std::int32_t>(second);
    }
    Vector n = normal_of(contacts, row, s, static_cast<std::size_t>(i), other);
    if (sign < 0 && !contacts.normal_x.empty()) n = {-n[0], -n[1]};
    double f_n = contacts.first[row], f_t = contacts.second[row];  // the same seen from either side
    if (contacts.by_components) {
      const double f_x = sign * contacts.first[row], f_z = sign * contacts.second[row];
      f_n = f_x * n[0] + f_z * n[1];
      f_t = f_x * n[1] - f_z * n[0];
    }
    s.contacts.push_back(
        {i, j, static_cast<float>(n[0]), static_cast<float>(n[1]), f_n * s.time_step, f_t * s.time_step});
  }
}

}  // namespace drumlin::particles
