// The laws of one contact: what solves it meets them, and the projection is the nearest impulse.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "particles/contact_law/local_block.hpp"
#include "particles/scene/random.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// W_aa of contacts of discs: W_nt = 0, W_tt = 3 W_nn, and the share l of the first in the radius_ratio.
LocalMatrix block_of_discs(double w_i, double w_j, double l) {
  return {w_i + w_j, 0, 3 * (w_i + w_j), 2 * ((1 - l) * w_j - l * w_i),
          2 * (l * l * w_i + (1 - l) * (1 - l) * w_j)};
}

template <int dim>
ContactNumbers<dim> times(const LocalMatrix& W, const ContactNumbers<dim>& r, const ContactNumbers<dim>& q) {
  const double rows[3][3] = {{W.nn, W.nt, 0}, {W.nt, W.tt, W.tr}, {0, W.tr, W.rr}};
  ContactNumbers<dim> u = q;
  for (int row = 0; row < dim; ++row)
    for (int e = 0; e < dim; ++e) u[row] += rows[row][e] * r[e];
  return u;
}

/// One solution, from any impulses, leaves no residual: the local problem is solved exactly. Steep friction
/// takes parts of its steps, and needs some solutions.
template <class Law>
void expect_solved(double largest_mu, int solutions) {
  constexpr int dim = Law::unknowns;
  RandomStream random(dim, "law");
  for (int k = 0; k < 2000; ++k) {
    const bool wall = k % 3 == 0;
    const LocalBlock<dim> W(block_of_discs(random.uniform(0.1, 10), wall ? 0 : random.uniform(0.1, 10),
                                           wall ? 1 : random.uniform(0.05, 0.95)));
    contact_law::Coefficients<double, Law> mu{};
    for (double& own : mu) own = k % 7 == 0 ? 0 : random.uniform(0, largest_mu);
    ContactNumbers<dim> q{}, r{};
    for (int e = 0; e < dim; ++e) q[e] = random.uniform(-1, 1), r[e] = random.uniform(-0.3, 0.3);
    r = contact_law::bounded(Law{}, mu, r);
    for (int s = 0; s < solutions; ++s) r = solved(Law{}, W, mu, times<dim>(W.matrix, r, q), r);
    const double rho = 1 / largest_eigenvalue<dim>(W.matrix);
    const auto u = times<dim>(W.matrix, r, q);
    ASSERT_LE(contact_law::squared_natural_residual(Law{}, rho, mu, r, u), 1e-26) << k;
    ASSERT_EQ(r, contact_law::bounded(Law{}, mu, r)) << k;
    ASSERT_EQ(r[0] > 0, q[0] < 0) << k;
  }
}

TEST(ContactLaw, SolvedContactsMeetIt) {
  expect_solved<Frictionless>(1, 1);
  expect_solved<Coulomb>(1, 1);
  expect_solved<CoulombRolling>(1, 1);
}

TEST(ContactLaw, SteepFrictionIsSolvedInSomeSteps) { expect_solved<Coulomb>(4, 120); }

TEST(ContactLaw, SteepFrictionThatSlidesTakesOneMuthOfItsStep) {
  // r_n would go from 1 to 2; the contact slides before and after.
  EXPECT_EQ(contact_law::step_fraction(4.0, 1.0, 4.0, 2.0, 9.0), 0.25);
  EXPECT_EQ(contact_law::step_fraction(4.0, 1.0, 0.5, 2.0, 0.5), 1);  // sticks
  EXPECT_EQ(contact_law::step_fraction(0.9, 1.0, 0.9, 2.0, 9.0), 1);  // not steep
}

TEST(ContactLaw, IsTheSameInSinglePrecision) {
  const std::array mu{0.4F};
  const contact_law::InverseBlock<float, 2> W{0.5F, 0.25F};
  const auto r = contact_law::solved(Coulomb{}, W, mu, std::array{-2.0F, 8.0F}, std::array{0.0F, 0.0F});
  EXPECT_EQ(r[0], 1.0F);
  EXPECT_EQ(r[1], -0.4F);  // free: -2
}

void project(double mu, double& n, double& t) {
  const auto nearest = contact_law::projected(Coulomb{}, {mu}, std::array{n, t});
  n = nearest[0], t = nearest[1];
}

TEST(Cone, ProjectionIsTheNearestPoint) {
  // p - P(p) stands upright on P(p), and lies in the polar cone mu |t| <= -n.
  for (const double mu : {0.0, 0.4, 2.0})
    for (int a = -8; a <= 8; ++a)
      for (int b = -8; b <= 8; ++b) {
        double n = 0.25 * a, t = 0.25 * b;
        project(mu, n, t);
        const double left_n = 0.25 * a - n, left_t = 0.25 * b - t;
        EXPECT_GE(n, 0);
        EXPECT_LE(std::abs(t), mu * n + 1e-15);
        EXPECT_NEAR(left_n * n + left_t * t, 0, 1e-14) << mu << ", " << a << ", " << b;
        EXPECT_LE(mu * std::abs(left_t), -left_n + 1e-14) << mu << ", " << a << ", " << b;
      }
}

TEST(Cone, ANotANumberStaysOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  double n = nan, t = 0.1;
  project(0.4, n, t);
  EXPECT_TRUE(std::isnan(n));
  n = 1, t = nan;
  project(0.4, n, t);
  EXPECT_TRUE(std::isnan(n) && std::isnan(t));
}

TEST(Cone, ProjectionWithRollingIsTheNearestPoint) {
  RandomStream random(1, "cone");
  for (int k = 0; k < 2000; ++k) {
    const double mu = random.uniform(0, 2), mu_r = k % 5 == 0 ? 0 : random.uniform(0, 1);
    const double n0 = random.uniform(-2, 2), t0 = random.uniform(-2, 2), r0 = random.uniform(-2, 2);
    const auto [n, t, r] = contact_law::projected(CoulombRolling{}, {mu, mu_r}, std::array{n0, t0, r0});
    ASSERT_LE(std::abs(t), mu * n + 1e-14);
    ASSERT_LE(std::abs(r), mu_r * n + 1e-14);
    // What is cut off is normal to the point and points away from every edge of the cone.
    const double d_n = n0 - n, d_t = t0 - t, d_r = r0 - r;
    ASSERT_NEAR(n * d_n + t * d_t + r * d_r, 0, 1e-13);
    for (const double s : {-1.0, 1.0})
      for (const double p : {-1.0, 1.0}) ASSERT_LE(d_n + s * mu * d_t + p * mu_r * d_r, 1e-13);
  }
}

}  // namespace
}  // namespace drumlin
