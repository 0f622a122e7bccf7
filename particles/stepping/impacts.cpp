#include "particles/stepping/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "particles/effects/driven_walls.hpp"
#include "particles/effects/friction.hpp"

namespace drumlin::particles {
namespace {

// Pairs closer than this, in d, touch: an impact on one of the two is one on both. About what overlap the
// projection leaves.
constexpr double touching = 1e-4;
// Of the largest closing speed: no impact but rounding.
constexpr double rounding = 1e-9;
// A pair that meets more often within a step collapses: what is left of its speed is lost in the contact
// problem.
constexpr int most_impacts = 1000;
// Closing speeds up to this many times what gravity gives a pair along its normal within a step are at rest:
// a grain that lies, and neighbours that carry it, arrive with as much. A grain that meets nothing but one
// wall is followed exactly, and rests only when its bounces are shorter than a hundredth of a step.
constexpr double at_rest = 2, at_rest_alone = 0.02;

/// Pairs that pieces of a loop found, in the order of the pieces.
struct PairList {
  std::vector<std::int32_t> pairs;
  void add(const PairList& more) { pairs.insert(pairs.end(), more.pairs.begin(), more.pairs.end()); }
};

}  // namespace

std::int32_t Impacts::grains() const { return static_cast<std::int32_t>(in_->step.bodies.count()); }

/// A grain, a wall moved by a force (after the grains), or -1.
std::int32_t Impacts::second_body_of(const Candidate& pair) const {
  if (pair.j >= 0) return pair.j;
  const std::int32_t wall = driven_wall_of(in_->step.walls, pair);
  return wall < 0 ? -1 : grains() + wall;
}

Point Impacts::acceleration_of(std::int32_t body) const {
  const StepInput& step = in_->step;
  if (body < grains()) return step.laws.gravity.value_or(Point{});
  const Driven& wall = step.walls.driven[body - grains()];
  return along({}, wall, wall.force * wall.inverse_mass);
}

Point Impacts::velocity_before(std::int32_t body) const {
  const StepInput& step = in_->step;
  if (body < grains()) return particles::velocity(step.bodies, body);
  const std::int32_t wall = body - grains();
  return along({}, step.walls.driven[wall], step.driven[wall].velocity + in_->wall_jumps[wall]);
}

Point Impacts::velocity(std::int32_t body) const {
  if (place_[body] < 0) return velocity_before(body);
  const ImpactBody& taken = taken_[place_[body]];
  return (taken.place < 0 ? taken : pass_.bodies[taken.place]).v;
}

int Impacts::passes_of(const Candidate& pair) const {
  const auto of = [this](std::int32_t body) {
    return body < 0 || place_[body] < 0 ? 0 : taken_[place_[body]].passes;
  };
  return of(pair.i) + of(second_body_of(pair));
}

Point Impacts::prescribed_velocity(const Candidate& pair) const {
  const StepInput& step = in_->step;
  const Point seen = wall_velocity(pair);
  const std::int32_t k = driven_wall_of(step.walls, pair);
  if (k < 0) return seen;
  return along(seen, step.walls.driven[k],
               -free_velocity(step.walls.driven[k], step.driven[k], step.time_step));
}

/// Of a body of the impact in hand: that of the path on which it leaves.
PathShift Impacts::shift(std::int32_t body) const {
  if (place_[body] >= 0) {
    const ImpactBody& taken = taken_[place_[body]];
    return taken.place < 0 ? taken.shift : pass_.bodies[taken.place].shift_at(pass_.time);
  }
  return body >= grains() ? PathShift{} : particles::shift(in_->step.free, body);
}

double Impacts::collided_at(const Candidate& pair) const {
  const std::int32_t second = second_body_of(pair);
  return std::max(shift(pair.i).time, second < 0 ? 0 : shift(second).time);
}

/// A wall that a force moves has the velocity of the middle of the step.
PairPath Impacts::path_of(const Candidate& pair) const {
  const Bodies& bodies = in_->step.bodies;
  const Point v_i = velocity(pair.i), of_i = shift(pair.i);
  if (pair.j >= 0) {
    const Point v_j = velocity(pair.j), of_j = shift(pair.j);
    const double reach = bodies.radius[pair.i] + bodies.radius[pair.j];
    return {(reach + pair.gap) * normal(pair) + of_i - of_j, v_i - v_j - wall_velocity(pair), reach};
  }
  Candidate seen = pair;
  if (const std::int32_t wall = second_body_of(pair); wall >= 0) {
    set_wall_velocity(
        seen, prescribed_velocity(pair) + velocity(wall) + (in_->step.time_step / 2) * acceleration_of(wall));
  }
  PairPath path(in_->step, seen, v_i, {});
  path.move(of_i - particles::shift(in_->step.free, pair.i));
  return path;
}

void Impacts::begin(const ImpactInput& input) {
  in_ = &input;
  slowest_ = 0;
  taken_.clear();
  place_.resize(input.step.bodies.count() + input.step.walls.driven.size(), -1);
}

/// A cell that pressures move answers to impacts in the next step alone: between its images discs would
/// bounce as between walls without mass to move them. What meets again is left to the contact problem, which
/// moves the cell.
int Impacts::most() const { return in_->step.cell.pressed() ? 1 : most_impacts; }

bool Impacts::find_closings(std::span<const char> of_bodies) {
  const StepInput& step = in_->step;
  const double h = step.time_step;
  const auto& v_x = step.bodies.v_x;
  const auto& v_z = step.bodies.v_z;
  const Point rest = step.laws.gravity.value_or(Point{});
  const bool shifted = !step.free.shift.empty();
  const auto among = [&](std::size_t begin, std::size_t end) {
    PairList list;
    for (auto a = static_cast<std::int32_t>(begin); a < static_cast<std::int32_t>(end); ++a) {
      const Candidate& pair = in_->pairs[a];
      if (!of_bodies.empty() && (of_bodies[pair.i] | (pair.j >= 0 ? of_bodies[pair.j] : 0)) == 0) continue;
      if (pair.j >= 0 && !shifted) {  // nearly all of them: no more than the velocities
        const double u_n = pair.n_x * (v_x[pair.i] - v_x[pair.j] - pair.wall_v_x) +
                           pair.n_z * (v_z[pair.i] - v_z[pair.j] - pair.wall_v_z);
        const double slowest = at_rest * h * std::abs(pair.n_x * rest.x + pair.n_z * rest.z);
        if (u_n >= -slowest || (pair.gap > 0 && pair.gap + h * u_n >= 0) || rests(a, u_n)) continue;
      } else if (pair.j < 0 && !shifted && driven_wall_of(step.walls, pair) < 0) {
        const double u_n =
            pair.n_x * (v_x[pair.i] - pair.wall_v_x) + pair.n_z * (v_z[pair.i] - pair.wall_v_z);
        const double gain = std::min(0.0, h * (pair.n_x * rest.x + pair.n_z * rest.z));
        if (stays_apart(step, pair) || (pair.gap <= 0 && rests(a, u_n + gain))) continue;
      }
      const PairPath path = path_of(pair);
      const auto time = path.meeting(collided_at(pair), h);
      if (time && collides(a, path, path.at(*time), *time, true)) list.pairs.push_back(a);
    }
    return list;
  };
  closings_ = loops_.combined<PairList>(in_->pairs.size(), among).pairs;
  return !closings_.empty();
}

/// Whether pair a, which closes at u_n, carries what the load of the last step would do within two.
bool Impacts::rests(std::int32_t a, double u_n) const {
  const double load = in_->loads.of(a);
  if (load <= 0) return false;
  const Candidate& pair = in_->pairs[a];
  double W_nn = in_->step.bodies.inverse_mass[pair.i];
  if (pair.j >= 0) W_nn += in_->step.bodies.inverse_mass[pair.j];
  return -u_n <= 2 * load * W_nn;
}

bool Impacts::collides(std::int32_t a, const PairPath& path, const Surfaces& now, double time,
                       bool may_be_alone) {
  const StepInput& step = in_->step;
  const Candidate& pair = in_->pairs[a];
  const Point u = path.velocity(time), g = step.laws.gravity.value_or(Point{});
  const double u_n = dot(now.normal, u);
  if (!(u_n < -slowest_)) return false;
  if (rests(a, u_n)) return false;
  const double gain = step.time_step * std::abs(dot(now.normal, g));
  if (-u_n > at_rest * gain) return true;
  return pair.j < 0 && -u_n > at_rest_alone * gain && (may_be_alone || is_alone(pair.i));
}

bool Impacts::is_alone(std::int32_t body) const { return first_[body] >= 0 && next_[first_[body]] < 0; }

void Impacts::link() {
  const std::span<const Candidate> pairs = in_->pairs;
  met_.assign(pairs.size(), 0);
  in_pass_.assign(pairs.size(), 0);
  first_.assign(place_.size(), -1);
  next_.resize_uninitialized(2 * pairs.size());
  std::int32_t *const first = first_.data(), *const next = next_.data();
  const auto enter = [=](std::int32_t body, std::int32_t entry) {
    next[entry] = first[body];
    first[body] = entry;
  };
  const bool driven = !in_->step.walls.driven.empty();
  for (auto a = static_cast<std::int32_t>(pairs.size()) - 1; a >= 0; --a) {
    enter(pairs[a].i, 2 * a);
    const std::int32_t j = driven ? second_body_of(pairs[a]) : pairs[a].j;
    if (j >= 0) enter(j, 2 * a + 1);
  }
}

double Impacts::restitution_of(const Candidate& pair) const {
  return value_of(in_->step.laws.restitution->e, pair.i, pair.j, in_->step.materials());
}

void Impacts::schedule(std::int32_t a, double from) {
  const Candidate& pair = in_->pairs[a];
  const PairPath path = path_of(pair);
  if (pair.j >= 0 && path.parts(from)) return;
  const auto time = path.meeting(from, in_->step.time_step);
  if (!time || !collides(a, path, path.at(*time), *time, false)) return;
  if (met_[a] >= most()) {
    unresolved_ += met_[a]++ == most_impacts && restitution_of(pair) > 0;  // at 0 nothing of it is lost
    return;
  }
  events_.push_back({*time, a, passes_of(pair)});
  std::push_heap(events_.begin(), events_.end(), std::greater<>());
}

std::int32_t Impacts::enter(std::int32_t body) {
  if (place_[body] < 0) {
    const StepInput& step = in_->step;
    ImpactBody taken;
    taken.body = body;
    taken.v = velocity_before(body);
    if (body < grains()) {
      taken.inverse_mass = step.bodies.inverse_mass[body];
      taken.spins = !step.bodies.spin.empty();
      if (taken.spins) taken.rim = step.bodies.radius[body] * step.bodies.spin[body];
      taken.shift = particles::shift(step.free, body);
    } else {
      const Driven& wall = step.walls.driven[body - grains()];
      taken.inverse_mass = wall.inverse_mass;
      taken.along = wall.direction;
    }
    place_[body] = static_cast<std::int32_t>(taken_.size());
    taken_.push_back(taken);
  }
  ImpactBody& taken = taken_[place_[body]];
  if (taken.place < 0) {
    pass_.bodies.push_back(taken);
    ImpactBody& now = pass_.bodies.back();
    now.before = now.v, now.before_rim = now.rim;
    taken.place = static_cast<std::int32_t>(pass_.bodies.size()) - 1;
  }
  return taken.place;
}

void Impacts::add(std::int32_t a, const Surfaces& now, double time) {
  const StepInput& step = in_->step;
  const Candidate& pair = in_->pairs[a];
  ImpactContact contact;
  contact.pair = a;
  contact.i = enter(pair.i);
  const std::int32_t second = second_body_of(pair);
  contact.j = second < 0 ? -1 : enter(second);
  contact.n = now.normal;
  contact.wall = prescribed_velocity(pair);
  contact.gain = time * (acceleration_of(pair.i) - (second < 0 ? Point{} : acceleration_of(second)));
  contact.e = restitution_of(pair);
  if (step.laws.friction) {
    const auto sliding = [&] {
      const Point v = velocity(pair.i), w = second < 0 ? Point{} : velocity(second);
      const Point u = v - w - contact.wall + contact.gain;
      const double rim_j = contact.j < 0 ? 0 : pass_.bodies[contact.j].rim;
      return across(now.normal, u) - pass_.bodies[contact.i].rim - rim_j;
    };
    contact.mu = step.sliding_friction(step.friction(pair, sliding), pair);
  }
  pass_.add(contact);
  in_pass_[a] = passes_;
  ++met_[a];
}

bool Impacts::take_in_neighbours(double time) {
  const std::size_t before = pass_.contacts.size();
  for (std::size_t c = 0; c < before; ++c)
    for (const std::int32_t place : {pass_.contacts[c].i, pass_.contacts[c].j}) {
      if (place < 0) continue;
      each_pair_of(pass_.bodies[place].body, [&](std::int32_t a) {
        if (in_pass_[a] == passes_ || met_[a] >= most()) return;
        const PairPath path = path_of(in_->pairs[a]);
        if (in_->pairs[a].j >= 0 && path.parts(time)) return;
        const Surfaces now = path.at(time);
        if (now.gap <= touching && collides(a, path, now, time, false)) add(a, now, time);
      });
    }
  return pass_.contacts.size() > before;
}

void Impacts::list_impacts(StepContacts& contacts) {
  for (const ImpactContact& c : pass_.contacts) {
    if (c.normal == 0) continue;
    ++count_;
    const Candidate& pair = in_->pairs[c.pair];
    contacts.impacts.push_back({pair.i, pair.j, c.n.x, c.n.z, c.normal, c.tangential});
  }
}

void Impacts::collide(const Event& event, StepContacts& contacts) {
  pass_.begin(event.time);
  ++passes_;
  add(event.pair, path_of(in_->pairs[event.pair]).at(event.time), event.time);
  do {
    do pass_.compress_roughly();
    while (take_in_neighbours(event.time));
    pass_.compress();
  } while (pass_.contacts.size() > 1 && take_in_neighbours(event.time));
  pass_.expand(work_);
  list_impacts(contacts);
  closings_.clear();
  for (ImpactBody& body : pass_.bodies) {
    body.shift = body.shift_at(event.time);
    ++body.passes;
    taken_[place_[body.body]] = body;  // in no pass
    each_pair_of(body.body, [&](std::int32_t a) { closings_.push_back(a); });
  }
  std::sort(closings_.begin(), closings_.end());
  closings_.erase(std::unique(closings_.begin(), closings_.end()), closings_.end());
  for (const std::int32_t a : closings_) schedule(a, event.time);
}

void Impacts::give_back(const ImpactOutput& output) {
  Bodies& bodies = output.bodies;
  if (output.shift.empty()) output.shift.assign(bodies.count(), {});
  for (const ImpactBody& body : taken_) {
    place_[body.body] = -1;
    const Point before = velocity_before(body.body);
    const Point change = body.v - before;
    if (const std::int32_t k = body.body - grains(); k >= 0) {
      output.contacts.wall_jumps[k] += dot(change, body.along);
      continue;
    }
    const std::int32_t b = body.body;
    PathShift& shift = output.shift[b];
    CollidedGrain collided{b, change.x, change.z, 0, before, body.shift - shift};
    shift = body.shift;
    bodies.v_x[b] = body.v.x, bodies.v_z[b] = body.v.z;
    if (body.spins) {
      const double spin = body.rim / bodies.radius[b];
      collided.spin = spin - bodies.spin[b];
      bodies.spin[b] = spin;
    }
    collided_.push_back(collided);
  }
}

bool Impacts::go_on(const ImpactInput& input) {
  if (!input.step.driven.empty()) return true;  // walls have been hit too
  begin(input);
  has_collided_.assign(input.step.bodies.count(), 0);
  for (const CollidedGrain& collided : collided_) has_collided_[collided.grain] = 1;
  return find_closings(has_collided_);
}

void Impacts::resolve(const ImpactInput& input, const ImpactOutput& output) {
  begin(input);
  collided_.clear(), events_.clear();
  work_ = {};
  count_ = unresolved_ = passes_ = 0;
  if (!find_closings()) return;
  link();
  for (const std::int32_t a : closings_) {
    const Candidate& pair = in_->pairs[a];
    slowest_ = std::max(slowest_, -rounding * normal_part(pair, path_of(pair).velocity(0)));
  }
  for (const std::int32_t a : closings_) schedule(a, collided_at(in_->pairs[a]));
  while (!events_.empty()) {
    std::pop_heap(events_.begin(), events_.end(), std::greater<>());
    const Event event = events_.back();
    events_.pop_back();
    if (event.passes == passes_of(in_->pairs[event.pair])) collide(event, output.contacts);
  }
  give_back(output);
}

}  // namespace drumlin::particles
