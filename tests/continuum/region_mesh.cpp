#include "continuum/model/region_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "continuum/model/outline.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin {
using namespace continuum;
namespace region_mesh_tests {
namespace {

using Size = std::function<double(Vec2)>;

Size equal(double size) {
  return [=](Vec2) { return size; };
}

// Sides between corners, each of its own part, divided evenly by the size at their middles.
Outline divided(const std::vector<Vec2>& corners, const Size& size) {
  Outline outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i], side = corners[(i + 1) % corners.size()] - a;
    for (double done = 0; done < 1 - 1e-9;) {
      outline.points.push_back(a + done * side);
      outline.part.push_back(static_cast<int>(i));
      const double step = size(a + done * side) / length(side);
      const double rest = 1 - done;
      done += rest / std::max(1.0, std::round(rest / step));
    }
  }
  return outline;
}

std::vector<Vec2> disc_segment() {
  std::vector<Vec2> points;
  for (int i = 0; i <= 20; ++i) {
    const double angle = std::numbers::pi * (1.15 + 0.7 * i / 20);
    points.push_back({12 * std::cos(angle), 12 * std::sin(angle)});
  }
  return points;
}

struct Case {
  const char* name;
  std::vector<Vec2> corners;
  Size size;
  double least;  // quality
};

const double slope = std::tan(10 * std::numbers::pi / 180);
const Size slot = [](Vec2 p) { return std::min(2.0, 0.5 + 0.25 * std::hypot(std::max(0.0, p.x - 4), p.z)); };

const Case cases[] = {
    {"square", {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, equal(1), 0.3},
    {"one triangle", {{0, 0}, {1, 0}, {0.5, 0.8}}, equal(1), 0.4},
    {"L", {{0, 0}, {20, 0}, {20, 4}, {6, 4}, {6, 14}, {0, 14}}, equal(1.3), 0.25},
    {"wedge of 10 deg", {{0, 0}, {20, 0}, {20, 20 * slope}}, equal(1), 0.1},
    {"film", {{0, 0}, {40, 0}, {40, 0.3}, {0, 0.3}}, equal(1), 0.1},
    {"disc segment", disc_segment(), equal(1.8), 0.25},
    {"silo", {{0, 0}, {4, 0}, {20, 0}, {20, 40}, {0, 40}}, slot, 0.25},
};

void expect_boundary_of(const Outline& outline, const RegionMesh& mesh) {
  const std::size_t n = outline.points.size();
  ASSERT_EQ(mesh.boundary.size(), n);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(mesh.boundary[i].from, i);
    EXPECT_EQ(mesh.boundary[i].to, (i + 1) % n);
    EXPECT_EQ(mesh.boundary[i].part, outline.part[i]);
    EXPECT_EQ(mesh.vertices[i].x, outline.points[i].x);
    EXPECT_EQ(mesh.vertices[i].z, outline.points[i].z);
  }
}

TEST(RegionMesh, FillsTheOutlineWithGoodTriangles) {
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Outline outline = divided(c.corners, c.size);
    const RegionMesh mesh = mesh_of(outline, c.size);
    expect_boundary_of(outline, mesh);
    double sum = 0, wanted = 0;  // as many as equilateral ones of that size would be
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec2 a = mesh.vertices[i], b = mesh.vertices[j], c0 = mesh.vertices[k];
      const double here = 0.5 * cross(b - a, c0 - a);
      sum += here;
      wanted += here * 4 / std::sqrt(3) / std::pow(c.size((1.0 / 3) * (a + b + c0)), 2);
    }
    EXPECT_NEAR(sum, area(outline), 1e-12 * sum);
    EXPECT_GT(quality(mesh), c.least);
    const auto triangles = static_cast<double>(mesh.triangles.size());
    EXPECT_GE(triangles, wanted);
    EXPECT_TRUE(triangles < 1.2 * wanted || c.least == 0.1);  // thin ones have one row all the same
  }
}

TEST(RegionMesh, IsTheSameEachTime) {
  const Outline outline = divided(cases[6].corners, slot);
  const RegionMesh one = mesh_of(outline, slot), two = mesh_of(outline, slot);
  EXPECT_EQ(one.triangles, two.triangles);
  ASSERT_EQ(one.vertices.size(), two.vertices.size());
  EXPECT_EQ(0, std::memcmp(one.vertices.data(), two.vertices.data(), sizeof(Vec2) * one.vertices.size()));
}

TEST(RegionMesh, RefusesAnOutlineThatCrossesItselfOrRunsClockwise) {
  const auto refused = [](const std::vector<Vec2>& corners) {
    EXPECT_THROW(mesh_of(divided(corners, equal(1)), equal(1)), NotConvergedError);
  };
  refused({{0, 0}, {10, 0}, {0, 10}, {10, 10}});
  refused({{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}});  // touches
  refused({{0, 0}, {0, 10}, {10, 10}, {10, 0}});
}

}  // namespace
}  // namespace region_mesh_tests
}  // namespace drumlin
