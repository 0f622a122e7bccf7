#include "continuum/model/mesh_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace drumlin {
using namespace continuum;
namespace {

std::vector<double> values(double limit, double error, double order, int meshes) {
  std::vector<double> list;
  for (int k = 0; k < meshes; ++k) list.push_back(limit + error * std::exp2(-order * k));
  return list;
}

TEST(MeshLimit, IsExactForAnErrorOfOneOrder) {
  for (const double order : {1.0, 2.0, 3.0, 4.0})
    for (const int meshes : {3, 4, 5}) {
      const auto found = mesh_limit(values(7, 0.3, order, meshes));
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->order, order, 1e-9);
      EXPECT_NEAR(found->value, 7, 1e-9);
    }
}

TEST(MeshLimit, IsNotGivenWhereTheOrderDoesNotAllow) {
  EXPECT_FALSE(mesh_limit(values(7, 0.3, 2, 2)));                    // two meshes show no order
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 2, 1.9}));          // to and fro
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 1.1, 1.19}));       // hardly shrinks
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 2, 2.01}));         // faster than any order
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 1, 1}));            // nothing but rounding
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 1.3, 1.4, 1.41}));  // first 1.6, then 3.3
  EXPECT_FALSE(mesh_limit(std::vector<double>{1, 2, NAN}));
}

}  // namespace
}  // namespace drumlin
