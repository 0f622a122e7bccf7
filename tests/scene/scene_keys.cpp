// What the list of keys says.
#include <gtest/gtest.h>

#include "particles/scene/scene_file.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(SceneKeys, SayAnUnitInEveryKeyThatHasOne) {
  for (const auto& row : scene_keys()) {
    EXPECT_FALSE(row.sentence.empty()) << row.path;
    // Dimensionless counts (turns, mean diameters) need none.
    if (row.unit.empty() || row.unit == "turns" || row.unit == "d") continue;
    const std::string suffix = row.unit == "turns/min" ? "rpm"
                               : row.unit == "kg/m3"   ? "kg_m3"
                               : row.unit == "m/s2"    ? "m_s2"
                               : row.unit == "mm/s"    ? "mm_s"
                               : row.unit == "Hz"      ? "hz"
                               : row.unit == "N/m"     ? "n_m"
                               : row.unit == "kg/m"    ? "kg_m"
                               : row.unit == "N/m2"    ? "n_m2"
                               : row.unit == "1/s"     ? "per_s"
                                                       : row.unit;
    EXPECT_TRUE(row.path.ends_with("_" + suffix)) << row.path;
  }
}

}  // namespace
}  // namespace drumlin
