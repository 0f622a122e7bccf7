#include "particles/stepping/impacts.hpp"

#include <algorithm>
#include <cmath>

#include "particles/effects/driven_walls.hpp"
#include "particles/effects/friction.hpp"

namespace drumlin::particles {
namespace {

// Pairs closer than this, in d, touch: an impact on one of the two is one on both. About what overlap the
// projection leaves.
constexpr double touching = 1e-4;
// Of the largest closing speed: no impact but rounding.
constexpr double rounding = 1e-9;
// More impacts of one pair within a step are a collapse, in which each takes part of the speed: what is left
// of it is lost in the contact problem.
constexpr int most_passes = 200;

std::int32_t grains_of(const StepInput& step) { return static_cast<std::int32_t>(step.bodies.count()); }

/// The body of the second side of a pair: a grain, a wall moved by a force (after the grains), or -1.
std::int32_t second_body_of(const StepInput& step, const Candidate& pair) {
  if (pair.j >= 0) return pair.j;
  const std::int32_t wall = driven_wall_of(step.walls, pair);
  return wall < 0 ? -1 : grains_of(step) + wall;
}

/// What forces add to the velocity of a body within the step.
Point gain_of(const StepInput& step, std::int32_t body) {
  Point a = step.laws.gravity.value_or(Point{});
  if (body >= grains_of(step)) {
    const Driven& wall = step.walls.driven[body - grains_of(step)];
    a = along({}, wall, wall.force * wall.inverse_mass);
  }
  return {a.x * step.time_step, a.z * step.time_step};
}

/// Pairs that pieces of a loop found, in the order of the pieces.
struct PairList {
  std::vector<std::int32_t> pairs;
  void add(const PairList& more) { pairs.insert(pairs.end(), more.pairs.begin(), more.pairs.end()); }
};

/// Velocity of the wall of a pair, or of the image of j, but for what its own body has.
Point prescribed_velocity(const StepInput& step, const Candidate& pair) {
  const Point seen{pair.wall_v_x, pair.wall_v_z};
  const std::int32_t k = driven_wall_of(step.walls, pair);
  if (k < 0) return seen;
  return along(seen, step.walls.driven[k],
               -free_velocity(step.walls.driven[k], step.driven[k], step.time_step));
}

/// Whether a pair whose surfaces close at u_n, and in the end of the step with `gain` more, meets within it.
bool meets(const Candidate& pair, double u_n, double gain, double slowest, double time_step) {
  return u_n < -slowest && (pair.gap <= 0 || pair.gap + time_step * (u_n + gain) < 0);
}

/// The part of it that is not common to both sides.
double gain_on_wall(const StepInput& step, const Candidate& pair) {
  Point gain = gain_of(step, pair.i);
  if (const std::int32_t wall = second_body_of(step, pair); wall >= 0) {
    const Point other = gain_of(step, wall);
    gain.x -= other.x, gain.z -= other.z;
  }
  return normal_part(pair, gain);
}

}  // namespace

Point Impacts::velocity_before(const StepInput& step, std::int32_t body) const {
  if (body < grains_of(step)) return {step.bodies.v_x[body], step.bodies.v_z[body]};
  const std::int32_t wall = body - grains_of(step);
  return along({}, step.walls.driven[wall], step.driven[wall].velocity + wall_jumps_[wall]);
}

bool Impacts::find_closings(const StepInput& step, const StepContacts& contacts) {
  slowest_ = slowest_impact(*step.laws.restitution, step.time_step);
  const auto& v_x = step.bodies.v_x;
  const auto& v_z = step.bodies.v_z;
  const auto among = [&](std::size_t begin, std::size_t end) {
    PairList list;
    for (auto a = static_cast<std::int32_t>(begin); a < static_cast<std::int32_t>(end); ++a) {
      const Candidate& pair = contacts.pairs[a];
      if (pair.j >= 0) {  // nearly all of them: no more than the velocities
        const double u_n = pair.n_x * (v_x[pair.i] - v_x[pair.j] - pair.wall_v_x) +
                           pair.n_z * (v_z[pair.i] - v_z[pair.j] - pair.wall_v_z);
        if (meets(pair, u_n, 0, slowest_, step.time_step) && !rests(step, pair, a, u_n))
          list.pairs.push_back(a);
      } else if (closes(step, contacts, a)) {
        list.pairs.push_back(a);
      }
    }
    return list;
  };
  closings_ = loops_.combined<PairList>(contacts.pairs.size(), among).pairs;
  return !closings_.empty();
}

void Impacts::link(const StepInput& step, const StepContacts& contacts) {
  const std::size_t bodies = place_.size();
  in_pass_.assign(contacts.pairs.size(), -1);
  first_.assign(bodies, -1);
  next_.renew(2 * contacts.pairs.size());
  const auto enter = [this](std::int32_t body, std::int32_t entry) {
    next_[entry] = first_[body];
    first_[body] = entry;
  };
  for (auto a = static_cast<std::int32_t>(contacts.pairs.size()) - 1; a >= 0; --a) {
    enter(contacts.pairs[a].i, 2 * a);
    if (const std::int32_t j = second_body_of(step, contacts.pairs[a]); j >= 0) enter(j, 2 * a + 1);
  }
}

std::int32_t Impacts::take_up(const StepInput& step, std::int32_t body) {
  if (place_[body] >= 0) return place_[body];
  if (!whole_.empty() && !whole_[body]) missing_.push_back(body);
  ImpactBody taken;
  taken.body = body;
  const Point v = velocity_before(step, body);
  taken.v_x = taken.before_x = v.x, taken.v_z = taken.before_z = v.z;
  if (body < grains_of(step)) {
    taken.inverse_mass = step.bodies.inverse_mass[body];
    taken.spins = step.laws.friction && step.laws.spin;
    if (taken.spins) taken.rim = taken.before_rim = step.bodies.radius[body] * step.bodies.spin[body];
  } else {
    const Driven& wall = step.walls.driven[body - grains_of(step)];
    taken.along = wall.direction;
    taken.inverse_mass = wall.inverse_mass;
  }
  place_[body] = static_cast<std::int32_t>(pass_.bodies.size());
  pass_.bodies.push_back(taken);
  return place_[body];
}

void Impacts::add(const StepInput& step, const Candidate& pair, std::int32_t index) {
  ImpactContact contact;
  contact.pair = index;
  contact.i = take_up(step, pair.i);
  const std::int32_t second = second_body_of(step, pair);
  contact.j = second < 0 ? -1 : take_up(step, second);
  contact.n_x = pair.n_x, contact.n_z = pair.n_z;
  contact.wall = prescribed_velocity(step, pair);
  contact.e = value_of(step.laws.restitution->e, pair.i, pair.j, step.materials());
  if (step.laws.friction) contact.mu = friction_bound(*step.laws.friction, pair, step.materials());
  pass_.add(contact);
  in_pass_[index] = pass_number_;
}

Point Impacts::velocity(const StepInput& step, std::int32_t body) const {
  if (place_[body] < 0) return velocity_before(step, body);
  const ImpactBody& taken = pass_.bodies[place_[body]];
  return {taken.v_x, taken.v_z};
}

bool Impacts::rests(const StepInput& step, const Candidate& pair, std::int32_t a, double u_n) const {
  const double load = loads_.of(static_cast<std::size_t>(a));
  if (load <= 0) return false;
  double W_nn = step.bodies.inverse_mass[pair.i];
  if (pair.j >= 0) W_nn += step.bodies.inverse_mass[pair.j];
  return -u_n <= 2 * load * W_nn;
}

bool Impacts::closes(const StepInput& step, const StepContacts& contacts, std::int32_t a) const {
  const Candidate& pair = contacts.pairs[a];
  Point u = velocity(step, pair.i);
  if (const std::int32_t second = second_body_of(step, pair); second >= 0) {
    const Point v = velocity(step, second);
    u.x -= v.x, u.z -= v.z;
  }
  const Point wall = prescribed_velocity(step, pair);
  u.x -= wall.x, u.z -= wall.z;
  const double gain = pair.j < 0 ? gain_on_wall(step, pair) : 0;
  const double u_n = normal_part(pair, u);
  return meets(pair, u_n, gain, slowest_, step.time_step) && !rests(step, pair, a, u_n);
}

bool Impacts::take_in_neighbours(const StepInput& step, const StepContacts& contacts) {
  const std::size_t before = pass_.contacts.size();
  for (std::size_t c = 0; c < before; ++c)
    for (const std::int32_t place : {pass_.contacts[c].i, pass_.contacts[c].j}) {
      if (place < 0) continue;
      each_pair_of(pass_.bodies[place].body, [&](std::int32_t a) {
        const Candidate& pair = contacts.pairs[a];
        if (in_pass_[a] != pass_number_ && pair.gap <= touching && closes(step, contacts, a))
          add(step, pair, a);
      });
    }
  return pass_.contacts.size() > before;
}

void Impacts::compress(const StepInput& step, const StepContacts& contacts) {
  do {
    do pass_.compress_roughly();
    while (take_in_neighbours(step, contacts));
    pass_.compress();
  } while (take_in_neighbours(step, contacts));
}

void Impacts::find_next_closings(const StepInput& step, const StepContacts& contacts) {
  closings_.clear();
  ++pass_number_;
  for (const ImpactContact& c : pass_.contacts)
    for (const std::int32_t place : {c.i, c.j}) {
      if (place < 0) continue;
      each_pair_of(pass_.bodies[place].body, [&](std::int32_t a) {
        if (in_pass_[a] == pass_number_ || !closes(step, contacts, a)) return;
        in_pass_[a] = pass_number_;
        closings_.push_back(a);
      });
    }
}

void Impacts::list_strikes(StepContacts& contacts) {
  for (const ImpactContact& c : pass_.contacts) {
    if (c.normal == 0) continue;
    ++count_;
    const Candidate& pair = contacts.pairs[c.pair];
    contacts.strikes.push_back({pair.i, pair.j, pair.n_x, pair.n_z, c.normal, c.tangential});
  }
}

void Impacts::give_back(const StepInput& step, Bodies& bodies, StepContacts& contacts) {
  for (const ImpactBody& body : pass_.bodies) {
    place_[body.body] = -1;
    const Point before = velocity_before(step, body.body);
    const Point change{body.v_x - before.x, body.v_z - before.z};
    if (const std::int32_t k = body.body - grains_of(step); k >= 0) {
      contacts.wall_jumps[k] += change.x * body.along.x + change.z * body.along.z;
      continue;
    }
    const std::int32_t b = body.body;
    StruckGrain struck{b, change.x, change.z, 0, before};
    bodies.v_x[b] = body.v_x, bodies.v_z[b] = body.v_z;
    if (body.spins) {
      const double spin = body.rim / bodies.radius[b];
      struck.spin = spin - bodies.spin[b];
      bodies.spin[b] = spin;
    }
    struck_.push_back(struck);
  }
}

bool Impacts::any(const StepInput& step, const RememberedLoads& loads, const StepContacts& contacts) {
  loads_ = loads;
  wall_jumps_ = contacts.wall_jumps;
  place_.resize(step.bodies.count() + step.walls.driven.size(), -1);
  return find_closings(step, contacts);
}

void Impacts::give_up(StepContacts& contacts, std::size_t strikes) {
  for (const ImpactBody& body : pass_.bodies) place_[body.body] = -1;
  contacts.strikes.resize(strikes);
  count_ = 0;
}

void Impacts::resolve(const StepInput& step, const RememberedLoads& loads, Bodies& bodies,
                      StepContacts& contacts) {
  (void)resolve_part(step, loads, {}, bodies, contacts);
}

bool Impacts::resolve_part(const StepInput& step, const RememberedLoads& loads, std::span<const char> whole,
                           Bodies& bodies, StepContacts& contacts) {
  loads_ = loads;
  whole_ = whole;
  struck_.clear(), missing_.clear();
  work_ = {};
  count_ = pass_number_ = 0;
  wall_jumps_ = contacts.wall_jumps;
  place_.resize(step.bodies.count() + step.walls.driven.size(), -1);
  if (!find_closings(step, contacts)) return true;
  link(step, contacts);
  pass_.bodies.clear();
  const std::size_t strikes_before = contacts.strikes.size();
  for (int passes = 0; !closings_.empty() && passes < most_passes; ++passes) {
    pass_.begin();
    for (const std::int32_t a : closings_) add(step, contacts.pairs[a], a);
    if (passes == 0)
      for (const ImpactContact& c : pass_.contacts) slowest_ = std::max(slowest_, -rounding * c.u_n);
    compress(step, contacts);
    if (!missing_.empty()) {
      give_up(contacts, strikes_before);
      return false;
    }
    pass_.expand(work_);
    list_strikes(contacts);
    find_next_closings(step, contacts);
  }
  give_back(step, bodies, contacts);
  return true;
}

}  // namespace drumlin::particles
