#pragma once
// Orders of convergence.
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <vector>

namespace drumlin {

/// Errors on meshes of which each halves the cells of the last one, and the order of each halving at least.
inline void expect_orders(const std::vector<double>& errors, std::initializer_list<double> orders) {
  ASSERT_EQ(errors.size(), orders.size() + 1);
  auto error = errors.begin();
  for (const double order : orders) {
    const double coarse = *error, fine = *++error;
    EXPECT_GT(std::log2(coarse / fine), order) << coarse << " to " << fine;
  }
}

}  // namespace drumlin
