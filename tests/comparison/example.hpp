#pragma once
// A drum flow in closed form: a linear layer over an exponential tail, hydrostatic stresses.
#include <cmath>

#include "coupling/comparison/comparison.hpp"
#include "tests/support/headers.hpp"

namespace drumlin::testing {

inline constexpr double example_H = 15, example_rate = 0.15, example_lambda = 3.5, example_nu = 0.8;

inline double example_shear_rate(double z) {
  return z > -example_H ? example_rate : example_rate * std::exp((z + example_H) / example_lambda);
}

/// Layers of 1 d from z = -60 to the surface, each column with an interval of 1 % of its value.
inline ProfileSet example_profiles() {
  ProfileSet set;
  set.header = header_from({{"rotation", "0.0115"},
                            {"drum_radius", "68.18"},
                            {"diameter_m", "0.0033"},
                            {"reduced", "false"},
                            {"side", "particles"},
                            {"theta_deg", "19.7"},
                            {"axis_depth", "4"},
                            {"wall_z", "-60"},
                            {"position", "0"},
                            {"layer_thickness", "1"},
                            {"slice_width", "20"}});
  set.columns = {{"v_x", {}, {}},      {"shear_rate", {}, {}}, {"nu", {}, {}},
                 {"sigma_xx", {}, {}}, {"sigma_zz", {}, {}},   {"sigma_xz", {}, {}},
                 {"I", {}, {}},        {"v_z", {}, {}},        {"half_vorticity", {}, {}},
                 {"mu", {}, {}},       {"k", {}, {}}};
  for (double z = -59.5; z < 0; z += 1) {
    const double rate = example_shear_rate(z);
    const double v = z > -example_H ? example_rate * (z + example_H + example_lambda) : rate * example_lambda;
    const double values[] = {
        v,    rate,     example_nu, -0.78 * z, -0.75 * z, -0.27 * z, rate / std::sqrt(-0.75 * z),
        1e-3, rate / 2, 0.36,       1.04};
    set.z.push_back(z);
    for (std::size_t i = 0; i < set.columns.size(); ++i) {
      set.columns[i].value.push_back(values[i]);
      set.columns[i].ci99.push_back(0.01 * values[i]);
    }
  }
  return set;
}

inline coupling::ComparedSide example_side() {
  return {example_profiles(),
          {{{"theta_deg", 19.7, 0.3}, {"Q", 21.8, 0.2}, {"H", example_H, 0.4}, {"lambda", 3.5, 0.3}}},
          {}};
}

/// The same numbers as a continuum has them: without intervals, and whatever it shears counts.
inline ProfileSet continuum_profiles() {
  ProfileSet set = example_profiles();
  set.header.side = RunSide::continuum;
  for (auto& column : set.columns) column.ci99.clear();
  return set;
}

inline coupling::ComparedSide continuum_side() {
  coupling::ComparedSide side = example_side();
  side.profiles = continuum_profiles();
  for (Scalar& scalar : side.scalars.scalars) scalar.ci99.reset();
  return side;
}

/// A side of a scalar of a comparison.
template <class Compared>
double scalar_of(const Compared& comparison, const std::string& name, double coupling::ScalarPair::*side) {
  for (const coupling::ScalarPair& pair : comparison.scalars)
    if (pair.name == name) return pair.*side;
  throw std::runtime_error(name);
}
inline ProfileColumn& column_of(ProfileSet& set, const std::string& name) {
  for (auto& column : set.columns)
    if (column.name == name) return column;
  throw std::runtime_error(name);
}
/// With the values of a column multiplied.
inline ProfileSet scaled(ProfileSet set, const std::string& column, double factor) {
  for (double& value : column_of(set, column).value) value *= factor;
  return set;
}
inline coupling::ComparedSide scaled(coupling::ComparedSide side, const std::string& column, double factor) {
  side.profiles = scaled(std::move(side.profiles), column, factor);
  return side;
}

}  // namespace drumlin::testing
