#pragma once
// Arrays of numbers from Python.
#include <pybind11/numpy.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "coupling/calibration/log_friction.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::python {

using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

using FrictionArrays = std::array<Numbers, 4>;  ///< I, mu and their standard errors

/// Throws InputError with the name where they are no points.
inline std::vector<coupling::FrictionPoint> points_of(const std::string& name, const FrictionArrays& arrays) {
  for (const Numbers& numbers : arrays)
    if (numbers.size() != arrays[0].size())
      throw InputError(name + ": I, mu and their errors are not of one length");
  std::vector<coupling::FrictionPoint> points;
  for (pybind11::ssize_t k = 0; k < arrays[0].size(); ++k) {
    const coupling::FrictionPoint point{arrays[0].data()[k], arrays[1].data()[k], arrays[2].data()[k],
                                        arrays[3].data()[k]};
    if (!(point.I > 0 && std::isfinite(point.I) && std::isfinite(point.mu)))
      throw InputError(name + ": point " + std::to_string(k) + " has no I above 0, or no mu");
    points.push_back(point);
  }
  return points;
}

}  // namespace drumlin::python
