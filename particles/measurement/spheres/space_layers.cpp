#include "particles/measurement/spheres/space_layers.hpp"

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "coupling/core/basics/inertial_number.hpp"
#include "particles/measurement/frame/accumulate.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/frame/sphere_branches.hpp"

namespace drumlin::particles {
namespace {

enum { X, Z, Y };

/// Pairs of components in the order of the columns; of stresses a is the force's, b the branch's.
struct Pair {
  const char* name;
  int a, b;
};
constexpr Pair pairs[] = {{"xx", X, X}, {"yy", Y, Y}, {"zz", Z, Z}, {"xz", X, Z}, {"xy", X, Y}, {"yz", Y, Z}};

/// What is known of one layer.
struct SpaceValues {
  double z = no_value, count = 0, shear_rate = no_value, temperature = no_value, omega = no_value;
  std::array<double, 3> velocity{no_value, no_value, no_value};
  Fields<3> fields;
  bool with_contacts = false;

  Tensor<3> stress() const { return fields.pressure(); }
  double p() const { return trace<3>(stress()) / 3; }
  double over_p(int a, int b) const { return (stress()[a][a] - stress()[b][b]) / p(); }
  /// |s|/p, s the deviator of the symmetric part and |s| the root of s:s/2.
  double mu_invariant() const {
    const Tensor<3> sigma = stress();
    double square = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const double s = (sigma[a][b] + sigma[b][a]) / 2 - (a == b ? p() : 0);
        square += s * s / 2;
      }
    return std::sqrt(square) / p();
  }
  double I_invariant() const { return p() > 0 ? inertial_number(shear_rate, p()) : no_value; }
};

using SpaceProfile = std::vector<SpaceValues>;

SpaceProfile profile_of(const LayerGrid& grid, const SpaceSums& sums, double surface_z) {
  SpaceProfile profile(sums.layers.size());
  for (std::size_t l = 0; l < profile.size(); ++l) {
    const SpaceSum& sum = sums.layers[l];
    profile[l].z = grid.z_of(l) - surface_z;
    profile[l].count = sum.grains;
    profile[l].with_contacts = sums.with_contacts == sums.snapshots;
    for (int a = 0; a < 3; ++a) profile[l].velocity[a] = sum.motion.mean(a);
  }
  for (std::size_t l = 1; l + 1 < profile.size(); ++l)
    profile[l].shear_rate = (profile[l + 1].velocity[X] - profile[l - 1].velocity[X]) / (2 * grid.thickness);
  for (std::size_t l = 0; l < profile.size(); ++l) {
    const SpaceSum& sum = sums.layers[l];
    Background<3> background{sums.volume, {}, sum.solid / sums.volume};
    if (std::isfinite(profile[l].shear_rate)) background.gradient[X][Z] = profile[l].shear_rate;
    profile[l].fields = derive(sum, background);
    if (sum.grains > 1)
      profile[l].temperature = trace<3>(profile[l].fields.kinetic) / (3 * profile[l].fields.nu);
  }
  return profile;
}

/// Columns by their names, and how each is read off a layer; xz is turned to the traction of what is above on
/// what is below, as in the view.
template <class Add>
void each_column(const Add& add, bool with_contacts) {
  add("nu", [](const SpaceValues& v) { return v.fields.nu; });
  for (const auto& [name, a] : {std::pair("v_x", X), {"v_y", Y}, {"v_z", Z}})
    add(name, [a = a](const SpaceValues& v) { return v.velocity[a]; });
  add("shear_rate", [](const SpaceValues& v) { return v.shear_rate; });
  add("temperature", [](const SpaceValues& v) { return v.temperature; });
  const auto tensor = [&](const std::string& before, const std::string& behind, auto of, bool turned) {
    for (const Pair& pair : pairs) {
      const double sign = turned && pair.a != pair.b && (pair.a == Z || pair.b == Z) ? -1 : 1;
      add(before + pair.name + behind, [=](const SpaceValues& v) {
        const Tensor<3> t = of(v);
        return sign * t[pair.a][pair.b];
      });
    }
  };
  tensor(
      "sigma_", "_kinetic", [](const SpaceValues& v) { return v.fields.kinetic; }, true);
  add("count", [](const SpaceValues& v) { return v.count; });
  if (!with_contacts) return;
  tensor(
      "sigma_", "", [](const SpaceValues& v) { return v.stress(); }, true);
  tensor(
      "fabric_", "", [](const SpaceValues& v) { return v.fields.fabric; }, false);
  add("coordination", [](const SpaceValues& v) { return v.fields.coordination; });
  add("p_space", [](const SpaceValues& v) { return v.p(); });
  add("I_invariant", [](const SpaceValues& v) { return v.I_invariant(); });
  add("mu_invariant", [](const SpaceValues& v) { return v.mu_invariant(); });
  add("N1_over_p", [](const SpaceValues& v) { return v.over_p(X, Z); });
  add("N2_over_p", [](const SpaceValues& v) { return v.over_p(Z, Y); });
}

std::span<const SpaceSum> non_empty(const SpaceSums& sums) {
  std::size_t end = sums.layers.size();
  while (end > 0 && !(sums.layers[end - 1].solid > 0)) --end;
  return {sums.layers.data(), end};
}

}  // namespace

void SpaceSum::add_centre(double weight, const GrainSample<3>& grain) {
  Moments::add_centre(weight, grain);
  motion.add(weight * grain.density, {grain.velocity[X], grain.velocity[Z], grain.velocity[Y], grain.at[X],
                                      grain.at[Z], grain.at[Y]});
}

void SpaceSum::add_share(double share, const HalfBranch<3>& branch) {
  Moments::add_share(share, branch);
  add_end(share, branch);  // a side lies where its branch lies
}

void add_times(double factor, const SpaceSums& from, SpaceSums& to) {
  for (std::size_t l = 0; l < to.layers.size(); ++l) add_times(factor, from.layers[l], to.layers[l]);
  to.volume += factor * from.volume;
  to.snapshots += factor * from.snapshots;
  to.with_contacts += factor * from.with_contacts;
}

SpaceLayers empty_space_layers(LayerGrid grid, std::size_t batches) {
  const SpaceSums empty{std::vector<SpaceSum>(grid.layers())};
  return {std::move(grid), std::vector<SpaceSums>(batches, empty)};
}

void add_snapshot(const LayerGrid& grid, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  SpaceSums& sums) {
  const SphereSlab& slab = *snapshot.spheres;
  LayerBinning binning(grid);
  for (std::size_t i = 0; i < in_frame.x.size(); ++i)
    if (in_frame.shows(i))
      add_grain(GrainSample<3>{i,
                               {in_frame.x[i], in_frame.z[i], slab.y[i]},
                               {in_frame.v_x[i], in_frame.v_z[i], slab.v_y[i]},
                               in_frame.radius[i],
                               1,
                               static_cast<double>(in_frame.coordination[i]),
                               in_frame.spin.empty() ? 0 : in_frame.spin[i]},
                binning, sums.layers);
  each_sphere_branch(grid.frame, snapshot, in_frame,
                     [&](const HalfBranch<3>& half) { add_branch(half, binning, sums.layers); });
  sums.volume += grid.area.empty() ? 0 : grid.area.front() * slab.depth;
  sums.snapshots += 1;
  sums.with_contacts += snapshot.contacts_known ? 1 : 0;
}

ProfileSet space_profiles(const SpaceLayers& layers, double surface_z) {
  const LeaveOneOut<SpaceSums> sums = leave_one_out(layers.batches);
  const auto profiles =
      each_of([&](const SpaceSums& some) { return profile_of(layers.grid, some, surface_z); }, sums);
  const std::size_t count = non_empty(sums.whole).size();
  ProfileSet table;
  for (std::size_t l = 0; l < count; ++l) table.z.push_back(profiles.whole[l].z);
  each_column(
      [&](const std::string& name, const auto& value_of) {
        ProfileColumn& column = table.columns.emplace_back(ProfileColumn{name, {}, {}});
        for (std::size_t l = 0; l < count; ++l) {
          column.value.push_back(value_of(profiles.whole[l]));
          if (name != "count")
            column.ci99.push_back(
                ci99_of(profiles, [&](const SpaceProfile& one) { return value_of(one[l]); }));
        }
      },
      sums.whole.with_contacts == sums.whole.snapshots);
  return table;
}

}  // namespace drumlin::particles
