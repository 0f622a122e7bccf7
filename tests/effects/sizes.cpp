// Grains of very different sizes: distributions, placement, detection.
#include "particles/scene/sizes.hpp"

#include <algorithm>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/scene/placement.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

GeneratedGrains one_to_fifty(int count, const Sizes& sizes) {
  return {count, 1, 50, RectangleRegion{{0, 0}, {400, 2000}}, sizes};
}

/// A tenth of the mass below 2 mm, half of it below 10 mm, a fifth above 30 mm.
const SieveSizes sieves{{2, 10, 30}, {0.1, 0.5, 0.8}};

double mass_below(const std::vector<double>& diameters, double opening) {
  double below = 0, all = 0;
  for (const double d : diameters) all += d * d, below += d < opening ? d * d : 0;
  return below / all;
}

std::vector<double> diameters_of(const Sizes& sizes, int count, std::uint64_t seed = 7) {
  RandomStream random(seed, "sizes");
  return diameters_mm(one_to_fifty(count, sizes), random);
}

TEST(Sizes, OfASieveAnalysisPassAsMuchMassAsItSays) {
  const int count = 200000;
  const auto diameters = diameters_of(sieves, count);
  const double bounds[] = {1, 2, 10, 30, 50}, masses[] = {0.1, 0.4, 0.3, 0.2};
  // Mass dm ~ dD/D between two openings a < b, so numbers dm/D^2: m (1/a^2 - 1/b^2) / (2 ln(b/a)).
  double numbers[4], all = 0;
  for (int k = 0; k < 4; ++k) {
    const double a = bounds[k], b = bounds[k + 1];
    all += numbers[k] = masses[k] * (1 / (a * a) - 1 / (b * b)) / (2 * std::log(b / a));
  }
  double passed = 0;
  for (int k = 0; k < 4; ++k) {
    const auto dealt = std::count_if(diameters.begin(), diameters.end(),
                                     [&](double d) { return d >= bounds[k] && d < bounds[k + 1]; });
    EXPECT_NEAR(dealt, count * numbers[k] / all, 1) << k;
    // Of the mass, as drawn: 326 above 30 mm, each D^2 within a third of their mean: 2 % of the fifth.
    EXPECT_NEAR(mass_below(diameters, bounds[k + 1]), passed += masses[k], 0.015) << k;
  }
  EXPECT_EQ(diameters, diameters_of(sieves, count));
  EXPECT_NE(diameters, diameters_of(sieves, count, 8));
}

TEST(Sizes, ByMassAreThoseByNumberTimesTheSquare) {
  // Of 1 and 3 mm nine small ones weigh as much as a large one.
  RandomStream random(7, "sizes");
  const auto two = diameters_mm({1000, 1, 3, RectangleRegion{}, TwoSizes{0.5, CountedBy::mass}}, random);
  EXPECT_EQ(std::count(two.begin(), two.end(), 1.0), 900);
  EXPECT_NEAR(mass_below(two, 2), 0.5, 1e-12);
  EXPECT_EQ(diameters_of(PowerLawSizes{1, CountedBy::mass}, 1000), diameters_of(PowerLawSizes{3}, 1000));
  EXPECT_EQ(diameters_of(TwoSizes{0.9}, 1000), diameters_of(TwoSizes{0.9, CountedBy::number}, 1000));
  // Half of the mass below the median: a bit less than half of what is left between 1 and 50 mm.
  EXPECT_NEAR(mass_below(diameters_of(LognormalSizes{7, 0.4, CountedBy::mass}, 100000), 7), 0.5, 0.01);
}

TEST(Sizes, DrawnDiametersHaveTheMeansOfTheirDistribution) {
  for (const Sizes& sizes :
       {Sizes{TwoSizes{0.8}}, Sizes{PowerLawSizes{2.5}}, Sizes{PowerLawSizes{1}}, Sizes{PowerLawSizes{0}},
        Sizes{LognormalSizes{5, 0.7}}, Sizes{TwoSizes{0.3, CountedBy::mass}},
        Sizes{PowerLawSizes{0.5, CountedBy::mass}}, Sizes{LognormalSizes{5, 0.7, CountedBy::mass}},
        Sizes{LognormalSizes{5, 3, CountedBy::mass}}, Sizes{sieves}}) {
    const GeneratedGrains grains = one_to_fifty(1, sizes);
    RandomStream random(7, "sizes");
    const int draws = 100000;
    double sums[5] = {};
    for (int k = 0; k < draws; ++k) {
      const double d = drawn_diameter_mm(grains, random);
      ASSERT_GE(d, 1);
      ASSERT_LE(d, 50);
      for (int power = 1; power <= 4; ++power) sums[power] += std::pow(d, power) / draws;
    }
    for (const int power : {1, 2}) {
      const double deviation = std::sqrt((sums[2 * power] - sums[power] * sums[power]) / draws);
      EXPECT_NEAR(sums[power], mean_power_mm(grains, power), 5 * deviation) << sizes.index() << ' ' << power;
    }
  }
}

TEST(Sizes, OfTwoAreDealtAndLieAnywhere) {
  for (const auto& [share, small] :
       {std::pair(0.96, 960), std::pair(0.0, 0), std::pair(1.0, 1000), std::pair(0.3333, 333)}) {
    RandomStream random(7, "sizes");
    const auto diameters = diameters_mm(one_to_fifty(1000, TwoSizes{share}), random);
    ASSERT_EQ(diameters.size(), 1000u);
    EXPECT_EQ(std::count(diameters.begin(), diameters.end(), 1.0), small) << share;
    // Of the first half, half of them: binomial without replacement, within five deviations.
    const auto half = std::count(diameters.begin(), diameters.begin() + 500, 1.0);
    EXPECT_NEAR(half, small / 2.0, 5 * std::sqrt(1000 * share * (1 - share)) / 2 + 0.5) << share;
  }
}

Scene box(const GeneratedGrains& grains) { return open_box(grains, 400, 4000); }

TEST(Sizes, PlacedGrainsLieInTheRegionAndNotInEachOther) {
  const Scene scene = box(one_to_fifty(3000, PowerLawSizes{2.5}));
  const Scales scales = scales_of(scene);
  const Bodies bodies = place_grains(scene, scales);
  ASSERT_EQ(bodies.count(), 3000u);
  const double unit = 1e-3 / scales.length_m;
  double smallest = 1e9, largest = 0, area = 0, top = 0;
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    smallest = std::min(smallest, bodies.radius[i]), largest = std::max(largest, bodies.radius[i]);
    area += std::numbers::pi * bodies.radius[i] * bodies.radius[i];
    top = std::max(top, bodies.z[i] + bodies.radius[i]);
    ASSERT_GE(bodies.x[i] - bodies.radius[i], 0);
    ASSERT_LE(bodies.x[i] + bodies.radius[i], 400 * unit);
    ASSERT_GE(bodies.z[i] - bodies.radius[i], 0);
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE(std::hypot(bodies.x[i] - bodies.x[j], bodies.z[i] - bodies.z[j]),
                bodies.radius[i] + bodies.radius[j]);
  }
  EXPECT_GT(largest / smallest, 30);
  // From below, and dense: not scattered over the whole region.
  EXPECT_GT(area / (400 * unit * top), 0.35);
}

TEST(Sizes, AreAbsentUnlessNamed) {
  // The lattice and the streams of uniform diameters are those of before there were distributions.
  Scene scene = turning_drum(3);
  const Bodies bodies = place_grains(scene, scales_of(scene));
  RandomStream sizes(scene.seed, "grains/diameter");
  for (const double radius : bodies.radius) EXPECT_NEAR(2 * radius * 3.3, sizes.uniform(3, 3.6), 1e-12);
}

TEST(Sizes, MoreThanTheRegionHoldsAreRefused) {
  const Scene scene = box(one_to_fifty(200000, TwoSizes{0.1}));
  EXPECT_THROW(place_grains(scene, scales_of(scene)), InputError);
}

}  // namespace
}  // namespace drumlin
