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
void move(ImpactBody& body, const Point& impulse, double tangential) {
  body.v += body.is_wall() ? (dot(impulse, body.along) * body.inverse_mass) * body.along
                           : body.inverse_mass * impulse;
  if (body.spins) body.rim -= surface_gain * body.inverse_mass * tangential;
}

}  // namespace

Point ImpactPass::velocity(const ImpactContact& c) const {
  const ImpactBody& I = bodies[c.i];
  Point u = I.v - c.wall + c.gain;
  double rims = I.rim;
  if (c.j >= 0) u -= bodies[c.j].v, rims += bodies[c.j].rim;
  return {dot(c.n, u), across(c.n, u) - rims};
}

void ImpactPass::add(ImpactContact c) {
  const ImpactBody& I = bodies[c.i];
  Point u = I.before - c.wall + c.gain;
  double rims = I.before_rim;
  c.W_nn = c.W_tt = I.inverse_mass;
  bool spins = I.spins;
  if (c.j >= 0) {
    const ImpactBody& J = bodies[c.j];
    u -= J.before, rims += J.before_rim;
    spins = spins || J.spins;
    if (!J.is_wall()) c.W_nn += J.inverse_mass, c.W_tt += J.inverse_mass;
  }
  if (spins) c.W_tt *= tangential_gain<true>;
  if (c.j >= 0) {
    const ImpactBody& J = bodies[c.j];
    const double n = dot(J.along, c.n), t = across(c.n, J.along);
    c.W_nn += n * n * J.inverse_mass;
    c.W_nt += n * t * J.inverse_mass;
    c.W_tt += t * t * J.inverse_mass;
  }
  c.u_n = dot(c.n, u), c.u_t = across(c.n, u) - rims;
  contacts.push_back(c);
}

void ImpactPass::push(const ImpactContact& c, double normal, double tangential) {
  const Point impulse = with_parts(c.n, normal, tangential);
  move(bodies[c.i], impulse, tangential);
  if (c.j >= 0) move(bodies[c.j], -1 * impulse, tangential);
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
      if (J.is_wall()) wall += 0.5 * (J.before + J.v);
    }
    if (!is_zero(wall)) work.walls += dot(with_parts(c.n, c.normal, c.tangential), wall);
  }
}

}  // namespace drumlin::particles
