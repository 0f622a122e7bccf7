#pragma once
// What tests of files share.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/says.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin::testing {
using drumlin::message_of;

/// The same values, NaN where NaN is.
inline void expect_same(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isnan(a[i]))
      EXPECT_TRUE(std::isnan(b[i]));
    else
      EXPECT_EQ(a[i], b[i]);
}

}  // namespace drumlin::testing
