#include "particles/stepping/impact_pass.hpp"

#include <algorithm>
#include <cmath>

#include "particles/bodies/disc_inertia.hpp"
#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {
namespace {

// Of the largest speed: changes that count no more, and those that do not yet count.
constexpr double tolerance = 1e-13, rough_tolerance = 3e-2;
constexpr int rough_sweeps = 10;
// An impact is swept at least so often, and until so many contacts have been solved. Small ones, which a gas
// has, are then compressed exactly; large ones, in a packing that falls, leave some of the closing speed to
// the next.
constexpr int fewest_sweeps = 20, solved_contacts = 4000;

/// Gives a body an impulse; `tangential` is its part that turns a grain.
void move(ImpactBody& body, double p_x, double p_z, double tangential) {
  if (body.along.x != 0 || body.along.z != 0) {
    const double along = (p_x * body.along.x + p_z * body.along.z) * body.inverse_mass;
    p_x = along * body.along.x, p_z = along * body.along.z;
  } else {
    p_x *= body.inverse_mass, p_z *= body.inverse_mass;
  }
  body.v_x += p_x, body.v_z += p_z;
  if (body.spins) body.rim -= surface_gain * body.inverse_mass * tangential;
}

}  // namespace

Point ImpactPass::velocity(const ImpactContact& c) const {
  const ImpactBody& I = bodies[c.i];
  double x = I.v_x - c.wall.x + c.gain.x, z = I.v_z - c.wall.z + c.gain.z, rims = I.rim;
  if (c.j >= 0) x -= bodies[c.j].v_x, z -= bodies[c.j].v_z, rims += bodies[c.j].rim;
  return {c.n_x * x + c.n_z * z, c.n_z * x - c.n_x * z - rims};
}

void ImpactPass::add(ImpactContact c) {
  const ImpactBody& I = bodies[c.i];
  double x = I.before_x - c.wall.x + c.gain.x, z = I.before_z - c.wall.z + c.gain.z, rims = I.before_rim;
  c.W_nn = c.W_tt = I.inverse_mass;
  bool spins = I.spins;
  if (c.j >= 0) {
    const ImpactBody& J = bodies[c.j];
    x -= J.before_x, z -= J.before_z, rims += J.before_rim;
    spins = spins || J.spins;
    if (J.along.x == 0 && J.along.z == 0) c.W_nn += J.inverse_mass, c.W_tt += J.inverse_mass;
  }
  if (spins) c.W_tt *= tangential_gain<true>;
  if (c.j >= 0) {
    const ImpactBody& J = bodies[c.j];
    const double n = J.along.x * c.n_x + J.along.z * c.n_z, t = J.along.x * c.n_z - J.along.z * c.n_x;
    c.W_nn += n * n * J.inverse_mass;
    c.W_nt += n * t * J.inverse_mass;
    c.W_tt += t * t * J.inverse_mass;
  }
  c.u_n = c.n_x * x + c.n_z * z;
  c.u_t = c.n_z * x - c.n_x * z - rims;
  contacts.push_back(c);
}

void ImpactPass::push(const ImpactContact& c, double normal, double tangential) {
  const double p_x = c.n_x * normal + c.n_z * tangential, p_z = c.n_z * normal - c.n_x * tangential;
  move(bodies[c.i], p_x, p_z, tangential);
  if (c.j >= 0) move(bodies[c.j], -p_x, -p_z, tangential);
}

/// Returns the largest change of a velocity by the impulse of its own contact.
double ImpactPass::sweep() {
  double largest = 0;
  for (ImpactContact& c : contacts) {
    const Point u = velocity(c);
    const double normal = contact_law::positive_part(c.normal - u.x / c.W_nn), d_n = normal - c.normal;
    const double free = c.tangential - (u.z + c.W_nt * d_n) / c.W_tt;
    const double d_t =
        c.mu > 0 ? contact_law::bounded(Coulomb{}, {c.mu}, std::array{normal, free})[1] - c.tangential : 0;
    push(c, d_n, d_t);
    c.normal = normal, c.tangential += d_t;
    largest = std::max({largest, std::abs(d_n) * c.W_nn, std::abs(d_t) * c.W_tt});
  }
  return largest;
}

double ImpactPass::fastest() const {
  double speed = 0;
  for (const ImpactContact& c : contacts) speed = std::max(speed, -c.u_n);
  return speed;
}

/// Of one contact a sweep is exact.
bool ImpactPass::is_exact() const { return contacts.size() == 1 && contacts[0].W_nt == 0; }

void ImpactPass::compress_roughly() {
  complete_ = is_exact();
  if (complete_) return void(sweep());
  const double enough = rough_tolerance * fastest();
  for (int k = 0; k < rough_sweeps; ++k)
    if (sweep() <= enough) return;
}

void ImpactPass::compress() {
  if (is_exact()) return;  // compress_roughly() has done it
  const double enough = tolerance * fastest();
  const int sweeps = std::max(fewest_sweeps, solved_contacts / static_cast<int>(contacts.size()));
  complete_ = false;
  for (int k = 0; k < sweeps && !complete_; ++k) complete_ = sweep() <= enough;
}

/// With e of its own at each contact, or a compression that is not complete, the expansion can give back more
/// than the compression took, or less; the energy after a share s of it is E + s B + s^2 A / 2. Without
/// friction one e gives back e^2 of E, else no more than E.
double ImpactPass::share_of_expansion() {
  const double e = contacts[0].e;
  const auto all = [this](auto is) { return std::all_of(contacts.begin(), contacts.end(), is); };
  const bool one_e = all([e](const auto& c) { return c.e == e; });
  if (complete_ && one_e) return 1;
  const bool smooth = one_e && all([](const auto& c) { return c.mu <= 0; });
  double E = 0, B = 0, A = 0;
  std::vector<Point> compressed;
  for (const ImpactContact& c : contacts) {
    const Point u = velocity(c);
    E += (c.normal * (c.u_n + u.x) + c.tangential * (c.u_t + u.z)) / 2;
    B += c.e * (c.normal * u.x + c.tangential * u.z);
    compressed.push_back(u);
  }
  const std::vector<ImpactBody> kept = bodies;
  for (const ImpactContact& c : contacts) push(c, c.e * c.normal, c.e * c.tangential);
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const ImpactContact& c = contacts[a];
    const Point u = velocity(c);
    A += c.e * (c.normal * (u.x - compressed[a].x) + c.tangential * (u.z - compressed[a].z));
  }
  bodies = kept;
  E = std::min(0.0, E);
  if (smooth && A > 0) return (-B + std::sqrt(B * B - 2 * A * e * e * E)) / A;
  return A > 0 && E + B + A / 2 > 0 ? std::clamp((-B + std::sqrt(B * B - 2 * A * E)) / A, 0.0, 1.0) : 1;
}

/// Coulomb's bound of the expansion alone: mu times the normal impulse that it gives, which stays. Each move
/// takes energy.
void ImpactPass::apply_friction(double share) {
  double speed = 0;
  for (const ImpactContact& c : contacts) speed = std::max({speed, -c.u_n, std::abs(c.u_t)});
  const int sweeps = std::max(fewest_sweeps, solved_contacts / static_cast<int>(contacts.size()));
  for (int k = 0; k < sweeps; ++k) {
    double largest = 0;
    for (std::size_t a = 0; a < contacts.size(); ++a) {
      const ImpactContact& c = contacts[a];
      const double mu = c.mu * share * c.e;  // of the normal impulse of the compression
      if (mu * c.normal <= 0) continue;
      const double now = friction_[a], free = now - velocity(c).z / c.W_tt;
      friction_[a] = contact_law::bounded(Coulomb{}, {mu}, std::array{c.normal, free})[1];
      push(c, 0, friction_[a] - now);
      largest = std::max(largest, std::abs(friction_[a] - now) * c.W_tt);
    }
    if (largest <= tolerance * speed || is_exact()) return;
  }
}

void ImpactPass::expand(ImpactWork& work) {
  const double share = share_of_expansion();
  friction_.clear();
  for (ImpactContact& c : contacts) {
    c.compression = c.normal;
    friction_.push_back(share * c.e * c.tangential);
    push(c, share * c.e * c.normal, share * c.e * c.tangential);
  }
  apply_friction(share);
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    ImpactContact& c = contacts[a];
    c.normal += share * c.e * c.compression;
    c.tangential += friction_[a];
  }
  add_work(work);
}

void ImpactPass::add_work(ImpactWork& work) const {
  for (const ImpactContact& c : contacts) {
    const Point u = velocity(c);
    work.normal += c.normal * (c.u_n + u.x) / 2;
    work.tangential += c.tangential * (c.u_t + u.z) / 2;
    Point wall = c.wall;
    if (c.j >= 0) {
      const ImpactBody& J = bodies[c.j];
      if (J.along.x != 0 || J.along.z != 0)
        wall.x += (J.before_x + J.v_x) / 2, wall.z += (J.before_z + J.v_z) / 2;
    }
    if (wall.x == 0 && wall.z == 0) continue;
    const double p_x = c.n_x * c.normal + c.n_z * c.tangential;
    const double p_z = c.n_z * c.normal - c.n_x * c.tangential;
    work.walls += p_x * wall.x + p_z * wall.z;
  }
}

}  // namespace drumlin::particles
