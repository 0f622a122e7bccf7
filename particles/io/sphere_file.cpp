#include "particles/io/sphere_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"

namespace drumlin::particles {
namespace {

const std::string sphere_format = "drumlin-spheres-1";

/// The axes of the file that are x, z and y of the view.
std::array<std::string, 3> axes_of(SeenAlong along) {
  if (along == SeenAlong::y) return {"x", "z", "y"};
  return along == SeenAlong::x ? std::array<std::string, 3>{"y", "z", "x"}
                               : std::array<std::string, 3>{"x", "y", "z"};
}

void read_contacts(const H5Reader& in, const std::array<std::string, 3>& axes, std::size_t grains,
                   SphereSlab& slab) {
  const auto i = in.ints("contacts/i"), j = in.ints("contacts/j");
  slab.contacts.resize(i.size());
  for (std::size_t c = 0; c < i.size(); ++c) {
    const auto bodies = static_cast<std::int32_t>(grains);
    if (j.size() != i.size() || i[c] < 0 || i[c] >= bodies || j[c] >= bodies)
      in.refuse("contacts", "names a grain that does not exist");
    slab.contacts[c].i = i[c], slab.contacts[c].j = j[c];
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const auto normal = in.doubles("contacts/normal_" + axes[a], H5Range::finite);
    const auto force = in.doubles("contacts/force_" + axes[a], H5Range::finite);
    if (normal.size() != i.size() || force.size() != i.size())
      in.refuse("contacts", "arrays of unequal length");
    for (std::size_t c = 0; c < i.size(); ++c)
      slab.contacts[c].normal[a] = normal[c], slab.contacts[c].force[a] = force[c];
  }
  // Normals are stored in single precision; here they are of length 1.
  for (SphereContact& contact : slab.contacts) {
    const auto& n = contact.normal;
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& component : contact.normal) component /= length;
  }
}

/// Depth of the slab, and which grains are not in it.
void cut_slab(const SphereView& view, double period, const std::vector<double>& radius, SphereSlab& slab) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = 0; i < radius.size(); ++i)
    low = std::min(low, slab.y[i] - radius[i]), high = std::max(high, slab.y[i] + radius[i]);
  slab.depth = period > 0 ? period : high - low;
  if (!view.slab) return;
  const auto [from, to] = *view.slab;
  if (period > 0 && to - from > period)
    throw InputError("--slab: is thicker than the period along its axis (allowed: a part of it)");
  slab.depth = to - from;
  for (const double y : slab.y) {
    const double above = period > 0 ? y - from - period * std::floor((y - from) / period) : y - from;
    slab.outside.push_back(above >= 0 && above < to - from ? 0 : 1);
  }
}

}  // namespace

bool holds_spheres(const std::filesystem::path& snapshot) {
  return H5Reader(snapshot).text("format") == sphere_format;
}

Snapshot read_spheres(const std::filesystem::path& snapshot, const SphereView& view) {
  const H5Reader in(snapshot);
  in.require_format(sphere_format);
  const auto axes = axes_of(view.along);
  Snapshot s;
  SphereSlab& slab = s.spheres.emplace();
  s.step = in.integer("step", 0);
  s.time = in.number("time", H5Range::finite);
  s.scales = in.scales();
  s.time_step = 1;  // forces are stored, not impulses
  const auto gravity = [&](const std::string& axis) {
    return axis == "y" ? 0 : in.number("gravity_" + axis, H5Range::finite);
  };
  s.gravity_x = gravity(axes[0]), s.gravity_z = gravity(axes[1]);
  s.period_x = in.number("period_" + axes[0], H5Range::from_0);
  if (in.number("period_" + axes[1], H5Range::from_0) > 0)
    in.refuse("period_" + axes[1], "is above 0, along the height of the view",
              "a box that is periodic across layers is not measured");
  s.radius = in.doubles("grains/radius", H5Range::above_0);
  const auto grains = [&](const std::string& name) {
    std::vector<double> values = in.doubles("grains/" + name, H5Range::finite);
    if (values.size() != s.radius.size()) in.refuse("grains/" + name, "not one entry per grain");
    return values;
  };
  s.x = grains(axes[0]), s.z = grains(axes[1]), slab.y = grains(axes[2]);
  s.v_x = grains("v_" + axes[0]), s.v_z = grains("v_" + axes[1]), slab.v_y = grains("v_" + axes[2]);
  if (in.has("grains/omega_" + axes[2])) {
    s.spin = grains("omega_" + axes[2]);
    // x, z and y of the view are right-handed with y away from the onlooker, where clockwise is positive.
    if (view.along != SeenAlong::y)
      for (double& spin : s.spin) spin = -spin;
  }
  cut_slab(view, in.number("period_" + axes[2], H5Range::from_0), s.radius, slab);
  s.contacts_known = in.has("contacts");
  if (s.contacts_known) read_contacts(in, axes, s.x.size(), slab);
  return s;
}

}  // namespace drumlin::particles
