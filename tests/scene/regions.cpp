#include <gtest/gtest.h>

#include "particles/scene/region.hpp"

namespace drumlin {
using namespace particles;
namespace {

const Region circle = CircleRegion{{1, 2}, 5};
const Region box = RectangleRegion{{-2, 0}, {4, 3}};

TEST(Region, ExtentAndFarthestPoint) {
  EXPECT_EQ(extent_mm(circle, 0), (std::pair{-4.0, 6.0}));
  EXPECT_EQ(extent_mm(circle, 1), (std::pair{-3.0, 7.0}));
  EXPECT_EQ(extent_mm(box, 1), (std::pair{0.0, 3.0}));
  EXPECT_DOUBLE_EQ(farthest_mm(circle, {1, -1}), 8);
  EXPECT_DOUBLE_EQ(farthest_mm(box, {0, 0}), 5);  // the corner (4, 3)
}

TEST(Region, IsNotCrossedByAWallAlongItsBorder) {
  EXPECT_FALSE(crosses(box, SegmentShape{{-10, 0}, {10, 0}}, 1e-9));
  EXPECT_FALSE(crosses(box, SegmentShape{{4, -5}, {4, 5}}, 1e-9));
  EXPECT_FALSE(crosses(circle, SegmentShape{{-10, 7}, {10, 7}}, 1e-9));
  EXPECT_FALSE(crosses(box, DiscShape{{0, -1}, 2}, 1e-9));
  EXPECT_FALSE(crosses(circle, DiscShape{{1, 8}, 2}, 1e-9));
  EXPECT_FALSE(crosses(circle, ContainerShape{{1, 2}, 5}, 1e-9));
}

TEST(Region, IsCrossedByAWallThatReachesIn) {
  EXPECT_TRUE(crosses(box, SegmentShape{{-10, 1}, {10, 1}}, 1e-9)) << "through and through";
  EXPECT_TRUE(crosses(box, SegmentShape{{0, 1}, {1, 2}}, 1e-9)) << "wholly inside";
  EXPECT_TRUE(crosses(box, SegmentShape{{-3, 1}, {-1, 4}}, 1e-9)) << "over a corner";
  EXPECT_FALSE(crosses(box, SegmentShape{{-3, 2}, {-1, 4}}, 1e-9)) << "just past that corner";
  EXPECT_TRUE(crosses(circle, SegmentShape{{-10, 6.9}, {10, 6.9}}, 1e-9));
  EXPECT_FALSE(crosses(circle, SegmentShape{{7, 2}, {10, 2}}, 1e-9)) << "on its line, but beyond";
  EXPECT_TRUE(crosses(box, DiscShape{{0, -1}, 2.1}, 1e-9));
  EXPECT_TRUE(crosses(box, DiscShape{{0, 1}, 0.1}, 1e-9));
}

}  // namespace
}  // namespace drumlin
