#include "particles/measurement/spheres/space_layers.hpp"

#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/frame/space_invariants.hpp"
#include "particles/measurement/frame/spheres_in_frame.hpp"
#include "particles/measurement/layers/layer_motion.hpp"

namespace drumlin::particles {
namespace {

enum { X, Z, Y };

/// Names of what has one component, or two; of stresses a is the force's, b the branch's.
struct Component {
  const char* name;
  int a;
};
struct Pair {
  const char* name;
  int a, b;
};
struct Names {
  std::array<Component, 3> velocities;
  std::array<Pair, 6> pairs;
};
constexpr Names of_layers{
    {{{"v_x", X}, {"v_y", Y}, {"v_z", Z}}},
    {{{"xx", X, X}, {"yy", Y, Y}, {"zz", Z, Z}, {"xz", X, Z}, {"xy", X, Y}, {"yz", Y, Z}}}};
constexpr Names of_rings{
    {{{"v_t", X}, {"v_y", Y}, {"v_r", Z}}},
    {{{"tt", X, X}, {"yy", Y, Y}, {"rr", Z, Z}, {"rt", X, Z}, {"ty", X, Y}, {"ry", Y, Z}}}};

/// What is known of one layer.
struct SpaceValues : SpaceInvariants {
  double z = no_value, count = 0, v_x = no_value, v_z = no_value, v_y = no_value, shear_rate = no_value;
  Fields<3> fields;

  std::array<double, 3> velocity() const { return {v_x, v_z, v_y}; }
};

using SpaceProfile = std::vector<SpaceValues>;

SpaceProfile profile_of(const LayerGrid& grid, const SpaceSums& sums, double surface_z) {
  SpaceProfile profile(sums.layers.size());
  for (std::size_t l = 0; l < profile.size(); ++l) {
    const SpaceSum& sum = sums.layers[l];
    SpaceValues& f = profile[l];
    f.z = grid.z_of(l) - surface_z;
    f.count = sum.grains;
    f.v_x = grid.rings ? angular_velocity(sum.motion, f.z) : sum.motion.mean(X);
    f.v_z = sum.motion.mean(Z), f.v_y = sum.motion.mean(Y);
  }
  set_shear(grid, 0, profile);
  for (std::size_t l = 0; l < profile.size(); ++l) {
    const SpaceSum& sum = sums.layers[l];
    SpaceValues& f = profile[l];
    const double area = grid.area[l] * sums.snapshots.count, slope = slope_within(grid, f);
    Background<3> background{area, {}, sum.solid / area};
    if (std::isfinite(slope)) background.gradient[X][Z] = slope;
    f.fields = derive(sum, background);
    static_cast<SpaceInvariants&>(f) = space_invariants(f.fields, f.shear_rate);
    if (!(sum.grains > 1)) f.temperature = no_value;
  }
  return profile;
}

/// Columns by their names, and how each is read off a layer; xz is turned to the traction of what is above on
/// what is below, as in the view.
template <class Add>
void each_column(const Names& names, const Add& add, bool with_contacts) {
  add("nu", [](const SpaceValues& v) { return v.fields.nu; });
  for (const auto& [name, a] : names.velocities)
    add(name, [a = a](const SpaceValues& v) { return v.velocity()[a]; });
  add("shear_rate", [](const SpaceValues& v) { return v.shear_rate; });
  add("temperature", [](const SpaceValues& v) { return v.temperature; });
  const auto tensor = [&](const std::string& before, const std::string& behind, auto of, bool turned) {
    for (const Pair& pair : names.pairs) {
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
      "sigma_", "", [](const SpaceValues& v) { return v.fields.pressure(); }, true);
  tensor(
      "fabric_", "", [](const SpaceValues& v) { return v.fields.fabric; }, false);
  add("coordination", [](const SpaceValues& v) { return v.fields.coordination; });
  add("p_space", [](const SpaceValues& v) { return v.p_space; });
  add("I_invariant", [](const SpaceValues& v) { return v.I_invariant; });
  add("mu_invariant", [](const SpaceValues& v) { return v.mu_invariant; });
  add("N1_over_p", [](const SpaceValues& v) { return v.N1_over_p; });
  add("N2_over_p", [](const SpaceValues& v) { return v.N2_over_p; });
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
  add_times(factor, from.snapshots, to.snapshots);
}

SpaceLayers empty_space_layers(LayerGrid grid, std::size_t batches) {
  const SpaceSums empty{std::vector<SpaceSum>(grid.layers()), {}};
  return {std::move(grid), std::vector<SpaceSums>(batches, empty)};
}

void add_snapshot(const LayerGrid& grid, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  SpaceSums& sums) {
  sums.snapshots.add(in_frame);
  if (grid.rings)
    accumulate_spheres(grid.frame, snapshot, in_frame, RingBinning(grid), sums.layers);
  else
    accumulate_spheres(grid.frame, snapshot, in_frame, LayerBinning(grid), sums.layers);
}

ProfileSet space_profiles(const SpaceLayers& layers, double surface_z) {
  const LeaveOneOut<SpaceSums> sums = leave_one_out(layers.batches);
  const auto profiles =
      each_of([&](const SpaceSums& some) { return profile_of(layers.grid, some, surface_z); }, sums);
  const std::size_t count = non_empty(sums.whole).size();
  ProfileSet table;
  for (std::size_t l = 0; l < count; ++l) table.z.push_back(profiles.whole[l].z);
  each_column(
      layers.grid.rings ? of_rings : of_layers,
      [&](const std::string& name, const auto& value_of) {
        ProfileColumn& column = table.columns.emplace_back(ProfileColumn{name, {}, {}});
        for (std::size_t l = 0; l < count; ++l) {
          column.value.push_back(value_of(profiles.whole[l]));
          if (name != "count")
            column.ci99.push_back(
                ci99_of(profiles, [&](const SpaceProfile& one) { return value_of(one[l]); }));
        }
      },
      sums.whole.snapshots.contacts == sums.whole.snapshots.count);
  return table;
}

}  // namespace drumlin::particles
