#pragma once
// Points and bodies against one another.
#include <gtest/gtest.h>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::test {

inline void expect_near(const particles::Point& a, const particles::Point& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

/// To the last bit.
inline void expect_same(const particles::Bodies& a, const particles::Bodies& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.v_x, b.v_x);
  EXPECT_EQ(a.v_z, b.v_z);
  EXPECT_EQ(a.spin, b.spin);
}

/// Places to a tolerance, spins to ten times as much.
inline void expect_near(const particles::Bodies& a, const particles::Bodies& b, double tolerance) {
  ASSERT_EQ(a.count(), b.count());
  for (std::size_t k = 0; k < a.count(); ++k) {
    EXPECT_NEAR(a.x[k], b.x[k], tolerance) << k;
    EXPECT_NEAR(a.z[k], b.z[k], tolerance) << k;
    if (!a.spin.empty()) {
      EXPECT_NEAR(a.spin[k], b.spin[k], 10 * tolerance) << k;
    }
  }
}

}  // namespace drumlin::test
