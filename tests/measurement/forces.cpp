// Distribution and anisotropy of contact forces on networks whose answer is known.
#include <gtest/gtest.h>

#include <random>

#include "particles/measurement/forces/force_anisotropy.hpp"
#include "particles/measurement/forces/force_distribution.hpp"
#include "particles/measurement/forces/force_statistics.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin {
using namespace particles;
namespace {

constexpr double pi = std::numbers::pi;

struct Network {
  double a_c = 0, a_n = 0, a_t = 0;
  double phi_c = 0, phi_n = 0, phi_t = 0;
};

/// Contacts drawn from the second harmonics of a network; normal forces exponential about their mean
/// `strength`.
ContactForces drawn(const Network& network, std::size_t contacts, double strength, std::mt19937_64& engine,
                    double z = -5) {
  std::uniform_real_distribution<double> share(0, 1);
  std::exponential_distribution<double> spread(1);
  ContactForces forces;
  while (forces.between_grains.size() < contacts) {
    const double phi = pi * share(engine);
    if (share(engine) * (1 + network.a_c) > 1 + network.a_c * std::cos(2 * (phi - network.phi_c))) continue;
    const double mean = strength * (1 + network.a_n * std::cos(2 * (phi - network.phi_n)));
    const double f_t = strength * network.a_t * std::sin(2 * (phi - network.phi_t));
    forces.between_grains.push_back({static_cast<float>(z), static_cast<float>(mean * spread(engine)),
                                     static_cast<float>(f_t), static_cast<float>(phi), 1});
  }
  ++forces.snapshots;
  return forces;
}

LayerGrid grid_of(int layers) {
  LayerGrid grid;
  grid.x_min = -10;
  grid.x_max = 10;
  grid.z_min = -layers;
  grid.area.assign(static_cast<std::size_t>(layers), 20.0);
  return grid;
}

const Scalar& scalar(const ForceZone& zone, const std::string& name) {
  const Scalar* found = zone.scalars.find(name);
  if (!found) throw std::out_of_range(name);
  return *found;
}

ForceZone bulk_of(const std::vector<ContactForces>& batches) {
  ForceSettings settings;
  settings.wall_z = -20;
  return force_statistics(grid_of(20), batches, settings).zones.at(0);
}

TEST(ForceAnisotropy, KnownNetworkGivesItsHarmonicsBack) {
  const Network network{0.3, 0.4, 0.1, 2.4, 2.2, 2.3};
  std::mt19937_64 engine(3);
  std::vector<ContactForces> batches;
  for (int b = 0; b < 20; ++b) batches.push_back(drawn(network, 4000, 5, engine));
  const ForceZone zone = bulk_of(batches);
  EXPECT_EQ(zone.name, "bulk");
  EXPECT_EQ(scalar(zone, "contacts").value, 80000);
  const double degree = 180 / pi;
  for (auto [name, value] : {std::pair("a_c", 0.3),
                             {"a_n", 0.4},
                             {"a_t", 0.1},
                             {"phi_c_deg", 2.4 * degree},
                             {"phi_n_deg", 2.2 * degree},
                             {"phi_t_deg", 2.3 * degree},
                             {"f_n", 5 * (1 + 0.06 * std::cos(0.4))}}) {
    EXPECT_NEAR(scalar(zone, name).value, value, 1.2 * *scalar(zone, name).ci99) << name;
    EXPECT_LT(*scalar(zone, name).ci99, 0.1 * value) << name;  // it is a measurement, not a shrug
  }
  // Branches of one length and nothing but second harmonics: the identity holds but for sampling.
  EXPECT_NEAR(scalar(zone, "stress_ratio_harmonics").value, scalar(zone, "stress_ratio").value, 0.003);
}

TEST(ForceAnisotropy, IsotropicNetworkHasNoneWithinItsInterval) {
  std::mt19937_64 engine(5);
  int inside = 0;
  constexpr int trials = 60;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<ContactForces> batches;
    for (int b = 0; b < 20; ++b) batches.push_back(drawn({}, 300, 1, engine));
    const ForceZone zone = bulk_of(batches);
    for (const char* name : {"a_c", "a_n"})
      inside += scalar(zone, name).value <= *scalar(zone, name).ci99 ? 1 : 0;
    EXPECT_NEAR(scalar(zone, "fabric_xx").value + scalar(zone, "fabric_zz").value, 1, 1e-12);
    EXPECT_EQ(scalar(zone, "a_t").value, 0);
  }
  EXPECT_GE(inside, 2 * trials - 6);  // 1.2 misses expected at 99 %
}

TEST(ForceAnisotropy, TangentialForceLeansTowardsItsDirection) {
  // Greatest pressure along 45 degrees: the force on a contact at 60 degrees is turned back towards it,
  // clockwise.
  DirectionSums sums;
  for (int k = 0; k < 3600; ++k) {
    const double phi = (k + 0.5) * pi / 3600;
    sums.add({0, 1, static_cast<float>(0.2 * std::sin(2 * (phi - pi / 4))), static_cast<float>(phi), 1}, 1);
  }
  const ForceAnisotropy found = force_anisotropy(sums);
  const std::complex<double> along_45(0, 1);  // exp(2 i pi/4)
  EXPECT_NEAR(std::abs(found.tangential - 0.2 * along_45), 0, 1e-4);
  EXPECT_NEAR(std::abs(found.stress - 0.1 * along_45), 0, 1e-4);
  EXPECT_NEAR(std::abs(found.contacts), 0, 1e-4);
}

TEST(ForceAnisotropy, HarmonicsCarryTheStressOfAFabricWithAFourthOne) {
  // E = 1 + 0.3 cos 2(phi - 1) + 0.25 cos 4(phi - 0.5) + 0.2 cos 6 phi by weights, forces with second
  // harmonics in three directions.
  DirectionSums sums;
  for (int k = 0; k < 36000; ++k) {
    const double phi = (k + 0.5) * pi / 36000;
    const double density =
        1 + 0.3 * std::cos(2 * (phi - 1)) + 0.25 * std::cos(4 * (phi - 0.5)) + 0.2 * std::cos(6 * phi);
    const double f_n = 1 + 0.35 * std::cos(2 * (phi - 1.1)), f_t = 0.1 * std::sin(2 * (phi - 0.8));
    DirectionSums one;
    one.add({0, static_cast<float>(f_n), static_cast<float>(f_t), static_cast<float>(phi), 1}, 1);
    for (double* sum :
         {&one.count[static_cast<std::size_t>(phi / pi * 18)],
          &one.normal[static_cast<std::size_t>(phi / pi * 18)],
          &one.tangential[static_cast<std::size_t>(phi / pi * 18)], &one.contacts, &one.pressure})
      *sum *= density;
    one.shear *= density;
    for (auto& sum : one.turned) sum *= density;
    sums += one;
  }
  const ForceAnisotropy found = force_anisotropy(sums);
  EXPECT_NEAR(std::abs(found.contacts_fourth), 0.25, 1e-6);
  EXPECT_NEAR(std::abs(found.contacts_sixth), 0.2, 1e-6);
  // Within a bin of 10 degrees the mean leans to where contacts are many.
  EXPECT_NEAR(stress_ratio_of(found), std::abs(found.stress), 0.01 * std::abs(found.stress));
}

TEST(ForceAnisotropy, ADirectionWithoutContactsHasNoMeanForce) {
  DirectionSums sums;
  sums.add({0, 1, 0, 1, 1}, 1);
  EXPECT_TRUE(std::isnan(std::abs(force_anisotropy(sums).normal)));
  EXPECT_NEAR(std::abs(force_anisotropy(sums).contacts), 2, 1e-6);  // all contacts along one line
}

TEST(ForceDistribution, ExponentialTailIsRecoveredWithItsCoverage) {
  std::mt19937_64 engine(11);
  std::exponential_distribution<double> tail(1.4);
  int inside = 0;
  constexpr int trials = 200, batches = 20, forces = 100;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<DistributionSums> sums(batches);
    DistributionSums total;
    for (DistributionSums& batch : sums) {
      for (int k = 0; k < forces; ++k)
        batch.add({0, static_cast<float>(1 + tail(engine)), 0, 0, 1}, 1, std::nullopt);
      total += batch;
    }
    std::vector<double> rest;
    for (const DistributionSums& batch : sums) {
      DistributionSums one = total;
      one -= batch;
      rest.push_back(distribution_scalars(one, std::nullopt).value("tail_exponent"));
    }
    const double found = distribution_scalars(total, std::nullopt).value("tail_exponent");
    inside += std::abs(found - 1.4) <= jackknife_ci99(rest) ? 1 : 0;
    // The standard error of maximum likelihood is beta/sqrt(n) = 0.031.
    EXPECT_NEAR(found, 1.4, 5 * 0.031);
  }
  EXPECT_GE(inside, trials - 7);  // two misses expected
}

TEST(ForceDistribution, PowerAtWeakForcesIsRecovered) {
  std::mt19937_64 engine(13);
  std::uniform_real_distribution<double> share(0, 1);
  for (const double power : {-0.5, 0.0, 0.7}) {
    double logarithms = 0;
    constexpr int forces = 100000;
    for (int k = 0; k < forces; ++k) {
      const double low = std::pow(0.02, power + 1), high = std::pow(0.5, power + 1);
      logarithms += std::log(low + (high - low) * share(engine)) / (power + 1);
    }
    EXPECT_NEAR(power_of(logarithms / forces, 0.02, 0.5), power, 0.02);
  }
}

TEST(ForceDistribution, EachForceIsCountedInTheBinThatHoldsIt) {
  EXPECT_FALSE(ForceBins::bin_of(0));
  EXPECT_FALSE(ForceBins::bin_of(10.1));
  for (const double force : {1.01e-4, 0.003, 0.0999, 0.1001, 0.5, 1.23, 9.99}) {
    const auto bin = ForceBins::bin_of(force);
    ASSERT_TRUE(bin) << force;
    EXPECT_LE(ForceBins::edge(*bin), force);
    EXPECT_GT(ForceBins::edge(*bin + 1), force);
  }
}

TEST(ForceDistribution, SlidingContactsAreThoseAtTheFrictionCone) {
  DistributionSums sums;
  for (const float f_t : {0.4f, -0.4f, 0.2f, 0.0f}) sums.add({0, 1, f_t, 0, 1}, 1, 0.4);
  const ScalarSet found = distribution_scalars(sums, 0.4);
  EXPECT_NEAR(found.value("sliding_share"), 0.5, 1e-12);
  EXPECT_NEAR(found.value("mobilisation"), 0.625, 1e-6);
  EXPECT_EQ(distribution_scalars(sums, std::nullopt).find("sliding_share"), nullptr);
}

TEST(ForceStatistics, ForcesAreSetAgainstTheMeanAtTheirDepth) {
  // Two depths, ten times the force below: over the local mean one exponential, over the zone's a mixture.
  std::mt19937_64 engine(17);
  std::vector<ContactForces> batches;
  for (int b = 0; b < 20; ++b) {
    batches.push_back(drawn({}, 1000, 1, engine, -4.5));
    const ContactForces deep = drawn({}, 1000, 10, engine, -14.5);
    deep.between_grains.each([&](const ContactForce& c) { batches.back().between_grains.push_back(c); });
  }
  const ForceZone zone = bulk_of(batches);
  EXPECT_NEAR(scalar(zone, "tail_exponent").value, 1, *scalar(zone, "tail_exponent").ci99);
  EXPECT_NEAR(scalar(zone, "f_n").value, 5.5, 0.1);
  // Over 5.5 the deep ones have the mean 1.82, and next to nothing else is above 1.
  EXPECT_NEAR(scalar(zone, "tail_exponent_zone_mean").value, 0.55, 0.02);
}

TEST(ForceStatistics, ZonesFollowTheSurfaceTheInterfaceAndTheWall) {
  std::mt19937_64 engine(19);
  ContactForces forces;
  for (const double z : {-0.5, -3.5, -8.5, -9.5, -14.5, -18.5}) {
    const ContactForces layer = drawn({}, 100, 1, engine, z);
    layer.between_grains.each([&](const ContactForce& c) { forces.between_grains.push_back(c); });
  }
  for (int k = 0; k < 40; ++k) forces.with_walls.push_back({-19.9f, 2, 0.5f, 1, 0.5f});
  ForceSettings settings;
  settings.surface_z = -1;  // everything stands 1 higher over it
  settings.wall_z = -19;
  settings.H = 7;  // frame: -8
  const ForceStatistics found = force_statistics(grid_of(20), {forces}, settings);
  ASSERT_EQ(found.zones.size(), 4u);
  const auto contacts = [&](std::size_t zone) { return scalar(found.zones[zone], "contacts").value; };
  EXPECT_EQ(found.zones[0].name, "flowing");  // frame -8 ... -2
  EXPECT_EQ(contacts(0), 100);
  EXPECT_EQ(found.zones[1].name, "static");  // frame -17 ... -10
  EXPECT_EQ(contacts(1), 100);
  EXPECT_EQ(found.zones[2].name, "bulk");  // frame -17 ... -2
  EXPECT_EQ(contacts(2), 400);
  EXPECT_EQ(found.zones[3].name, "wall");
  EXPECT_EQ(contacts(3), 40);
  EXPECT_EQ(scalar(found.zones[3], "f_n").value, 2);
  EXPECT_NEAR(scalar(found.zones[3], "f_t_over_f_n").value, 0.25, 1e-6);
  EXPECT_EQ(found.layers.z.front(), -17.5);
  EXPECT_EQ(found.layers.column("contacts").value.front(), 100);
  settings.H = std::nan("");
  EXPECT_EQ(force_statistics(grid_of(20), {forces}, settings).zones.size(), 2u);  // bulk and wall
}

TEST(ForceStatistics, DensitiesIntegrateToTheShareInTheirBins) {
  std::mt19937_64 engine(23);
  const ForceZone zone = bulk_of({drawn({0.2, 0.3, 0.1, 1, 1, 1}, 5000, 1, engine)});
  std::map<std::string, double> integral, contacts;
  for (const DistributionRow& row : zone.rows) {
    integral[row.quantity] += row.value * (row.to - row.from);
    contacts[row.quantity] += row.contacts;
  }
  EXPECT_NEAR(integral.at("f_n"), contacts.at("f_n") / 5000, 1e-12);
  EXPECT_GT(contacts.at("f_n"), 4990);  // all but those below 1e-4 and above 10
  EXPECT_NEAR(integral.at("contacts_of_direction") * pi / 180, 0.5, 1e-12);  // half of the circle
}

TEST(ContactForces, ColumnOnASlopeHasItsForceAndDirection) {
  const double slope = 0.3;
  const Snapshot columns = testing::stacked_columns(6, 20, slope);
  for (const double angle : {0.0, 0.8, 2.5}) {
    // The laboratory turns, frame and all: nothing changes. `turned` is anticlockwise, a frame's slope
    // clockwise.
    Snapshot lab = testing::turned(columns, angle);
    lab.period_x = 0;
    LayerGrid grid = grid_of(20);
    grid.z_min = 0;
    grid.x_min = 0;
    grid.frame = FlowFrame{0, 0, std::cos(angle), std::sin(angle)};
    ContactForces forces;
    add_contact_forces(grid, lab, forces);
    ASSERT_EQ(forces.between_grains.size(), 114u);
    ASSERT_EQ(forces.with_walls.size(), 6u);
    forces.between_grains.each([&](const ContactForce& contact) {
      EXPECT_NEAR(contact.direction, pi / 2, 1e-5);
      EXPECT_NEAR(contact.normal, (20 - std::round(contact.z)) * pi / 4 * std::cos(slope), 1e-4);
      EXPECT_NEAR(contact.tangential / contact.normal, -std::tan(slope), 1e-5);
      EXPECT_NEAR(contact.branch, 1, 1e-6);
    });
  }
}

TEST(ContactForces, SliceTakesTheContactsWhosePointItHolds) {
  LayerGrid grid = grid_of(20);
  grid.z_min = 0;
  grid.x_min = 1;
  grid.x_max = 3;  // two of six columns
  ContactForces forces;
  add_contact_forces(grid, testing::stacked_columns(6, 20, 0), forces);
  EXPECT_EQ(forces.between_grains.size(), 38u);
  EXPECT_EQ(forces.with_walls.size(), 2u);
}

TEST(ContactForces, MirrorTurnsDirectionsRound) {
  Snapshot pair;
  pair.time_step = 0.5;
  for (double x : {-0.5, 0.5}) testing::add_grain(pair, x, 0.5 + 0.4 * x, 0.5);
  const float n_x = 1 / std::sqrt(1.16f);
  pair.contacts.push_back({1, 0, n_x, 0.4f * n_x, 1.5, 0.3});
  ContactForces forces;
  LayerGrid grid = grid_of(20);
  grid.z_min = -10;
  add_contact_forces(grid, pair, forces);
  add_contact_forces(grid, mirrored(pair), forces);
  std::vector<ContactForce> found;
  forces.between_grains.each([&](const ContactForce& contact) { found.push_back(contact); });
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].direction + found[1].direction, pi, 1e-6);
  EXPECT_NEAR(found[1].tangential, -0.6, 1e-6);
  EXPECT_NEAR(found[1].normal, 3, 1e-6);
}

}  // namespace
}  // namespace drumlin
