#include "particles/stepping/moreau_jean.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "particles/contact/block_problem.hpp"
#include "particles/contact/problems.hpp"
#include "particles/detection/contact_order.hpp"
#include "particles/parallel/crew.hpp"
#include "particles/stepping/position_projection.hpp"
#include "particles/stepping/wall_crossing.hpp"

namespace drumlin {
namespace {

/// A remembered approach means an impact whatever the sign of the tiny gap that the solver's error left.
struct Impact {
  double shift = 0;  ///< of u_n
  bool bounces = false;
};

Impact impact_of(double gap, double u_before, double remembered, double e, double slowest, double time_step) {
  double approach = remembered;
  if (gap <= 0) approach = std::min(approach, u_before);
  if (approach < -slowest) return {e * approach, true};
  return {gap > 0 ? gap / time_step : 0, false};
}

/// Speed at which a pair with a gap arrives, from the speeds at the beginning and (without contact) the end
/// of the step.
double arrival_speed(double gap, double u_before, double u_free, double time_step) {
  if (u_free >= 0) return u_before;
  const double fraction = std::min(1.0, gap / (-u_free * time_step));
  return u_before + fraction * (u_free - u_before);
}

class Stopwatch {
 public:
  /// Seconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

template <class Problem>
constexpr bool drives_walls = requires {
  requires Problem::Delassus::has_driven;
};

template <class Problem, bool with_spin>
class MoreauJean final : public Stepper {
  static constexpr int dim = Problem::dim;
  static constexpr bool drives = drives_walls<Problem>;

 public:
  MoreauJean(const StepLaws& laws, const StepSolver& solver)
      : laws_(laws),
        solver_(solver),
        solve_(contact_solver<Problem>(solver.name)),
        team_(solver.threads),
        crew_(&team_) {
    scratch_.team = &team_;
    projection_.use(&team_);
    detection_.use(&team_);
    if (laws.energy_ledger)
      books_.emplace(laws.gravity ? std::optional<Point>({laws.gravity->x, laws.gravity->z}) : std::nullopt);
  }

  StepReport advance(Bodies& bodies, ContactMemory& memory, WallStep& walls, double time_step,
                     std::optional<EnergyLedger>& energy) override {
    StepReport report;
    Stopwatch watch;
    if (books_) books_->open(bodies, energy);
    free_velocities(bodies, time_step);
    const DetectionInput input{walls.before, walls.displacement, time_step, laws_.detection_margin,
                               laws_.period};
    if constexpr (drives) detected_ = walls.driven;
    auto& found = detection_.find(bodies, free_x_, free_z_, input);
    order_.sort(found, bodies, laws_.period, problem_.W.plan);
    pairs_.swap(found);
    report.detection_seconds = watch.lap();
    if (laws_.cohesion) attract(bodies, walls, time_step);
    recall(memory, bodies.count(), time_step);
    pose(bodies, walls, time_step);
    report.setup_seconds = watch.lap();
    report.contacts = problem_.contacts();
    report.solve = solve_(problem_, solver_.rule, scratch_, impulses_);
    remember(memory, time_step);
    move(bodies, time_step);
    if constexpr (drives) move_driven(walls, time_step);
    if (books_) book(bodies, walls, time_step, *energy);
    (void)watch.lap();
    report.overlap = overlap_and_projection(bodies, walls, time_step, report.lost);
    report.projection_seconds = watch.lap();
    if (books_) books_->close(bodies, time_step, *energy);
    return report;
  }

  std::vector<SnapshotContact> loaded_contacts() const override {
    std::vector<SnapshotContact> loaded;
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      const double pull = laws_.cohesion ? attraction_[a] : 0;
      const double r_n = impulses_[dim * a] - pull, r_t = dim >= 2 ? impulses_[dim * a + 1 % dim] : 0;
      if (r_n != 0)
        loaded.push_back({pairs_[a].i, pairs_[a].j, static_cast<float>(pairs_[a].n_x),
                          static_cast<float>(pairs_[a].n_z), r_n, r_t});
    }
    std::sort(loaded.begin(), loaded.end(), [](const SnapshotContact& a, const SnapshotContact& b) {
      return a.i != b.i ? a.i < b.i : a.j < b.j;
    });
    return loaded;
  }

  std::optional<BlockProblem> last_problem() const override {
    if constexpr (requires(const Problem& p) { block_problem(p); })
      return block_problem(problem_);
    else
      return std::nullopt;
  }

  int unknowns_per_contact() const override { return dim; }
  int velocities_per_body() const override { return with_spin ? 3 : 2; }

 private:
  void free_velocities(const Bodies& bodies, double h) {
    free_x_ = bodies.v_x;
    free_z_ = bodies.v_z;
    if (!laws_.gravity) return;
    for (std::size_t b = 0; b < bodies.count(); ++b)
      free_x_[b] += h * laws_.gravity->x, free_z_[b] += h * laws_.gravity->z;
  }

  /// The attraction c acts on the bodies before the solve; the solver's normal unknown is then r_n + c h >=
  /// 0, which it bounds friction by. q changes by W (-c h) through the free velocities.
  void attract(const Bodies& bodies, WallStep& walls, double h) {
    attraction_.resize(pairs_.size());
    const MaterialsOf materials{bodies.material, laws_.material_of_shape};
    for (std::size_t p = 0; p < pairs_.size(); ++p) {
      const Candidate& pair = pairs_[p];
      const double pull = pair.gap < laws_.cohesion->range
                              ? h * value_of(laws_.cohesion->force, pair.i, pair.j, materials)
                              : 0;
      attraction_[p] = pull;
      const double change = pull * bodies.inverse_mass[pair.i];
      free_x_[pair.i] -= change * pair.n_x, free_z_[pair.i] -= change * pair.n_z;
      if constexpr (drives)
        if (DrivenStep* wall = driven_at(walls, pair))
          wall->velocity +=
              pull * wall->inverse_mass * (pair.n_x * wall->direction.x + pair.n_z * wall->direction.z);
      if (pair.j < 0) continue;
      const double back = pull * bodies.inverse_mass[pair.j];
      free_x_[pair.j] += back * pair.n_x, free_z_[pair.j] += back * pair.n_z;
    }
  }

  /// Warm start and remembered approach speeds, by identity (i, j).
  void recall(const ContactMemory& memory, std::size_t bodies, double h) {
    impulses_.assign(dim * pairs_.size(), 0.0);
    if (laws_.restitution) approach_.assign(pairs_.size(), 0.0);
    first_of_body_.assign(bodies, -1);
    next_of_body_.resize(memory.i.size());
    for (std::size_t m = 0; m < memory.i.size(); ++m) {
      next_of_body_[m] = first_of_body_[memory.i[m]];
      first_of_body_[memory.i[m]] = static_cast<std::int32_t>(m);
    }
    const double scale = memory.time_step > 0 ? h / memory.time_step : 1;
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      std::int32_t m = first_of_body_[pairs_[a].i];
      while (m >= 0 && memory.j[m] != pairs_[a].j) m = next_of_body_[m];
      if (m < 0) continue;
      for (int c = 0; c < dim; ++c) impulses_[dim * a + c] = scale * memory.impulse[dim * m + c];
      if (laws_.restitution) approach_[a] = memory.approach[m];
    }
  }

  /// Writes the contact problem in solve order: W through normals and masses, q from the free velocities.
  void pose(const Bodies& bodies, const WallStep& walls, double h) {
    const auto fixed = static_cast<std::int32_t>(bodies.count());
    auto& W = problem_.W;
    W.clear();
    W.inverse_mass.assign(bodies.inverse_mass.begin(), bodies.inverse_mass.end());
    W.inverse_mass.push_back(0);
    if constexpr (drives) {
      W.driven.clear();
      for (const DrivenStep& wall : walls.driven)
        W.driven.push_back({wall.direction.x, wall.direction.z, wall.inverse_mass});
      W.inverse_mass.resize(W.inverse_mass.size() + walls.driven.size(), 0.0);
    }
    problem_.q.resize(dim * pairs_.size());
    problem_.mu.resize((dim - 1) * pairs_.size());
    problem_.time_step = h;
    if (books_) bounces_.resize(pairs_.size());
    const MaterialsOf materials{bodies.material, laws_.material_of_shape};
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      const Candidate& pair = pairs_[a];
      const bool wall = pair.j < 0;
      std::int32_t other = wall ? fixed : pair.j;
      Point wall_v{pair.wall_v_x, pair.wall_v_z}, wall_v_before = wall_v;
      if constexpr (drives)
        if (const DrivenStep* pushed = driven_at(walls, pair)) {
          const auto k = pushed - walls.driven.data();
          other = fixed + 1 + static_cast<std::int32_t>(k);
          const double detected = detected_[k].velocity;
          wall_v = along(wall_v, *pushed, pushed->velocity - detected);
          wall_v_before = along(wall_v_before, *pushed, pushed->velocity_before - detected);
        }
      if constexpr (dim == 3)
        W.add(pair.i, other, pair.n_x, pair.n_z, lever_of(pair, bodies));
      else
        W.add(pair.i, other, pair.n_x, pair.n_z);
      const double u_x = free_x_[pair.i] - (wall ? wall_v.x : free_x_[pair.j]);
      const double u_z = free_z_[pair.i] - (wall ? wall_v.z : free_z_[pair.j]);
      const double u_n = pair.n_x * u_x + pair.n_z * u_z;
      const double shift = normal_shift(a, pair, bodies, wall_v_before, u_n, h);
      problem_.q[dim * a] = u_n + shift;
      if (books_) bounces_[a] = shift < 0;
      if constexpr (dim == 3) pose_rolling(a, pair, bodies, walls, h);
      if constexpr (dim >= 2) {
        double u_t = pair.n_z * u_x - pair.n_x * u_z;
        if constexpr (with_spin) {
          u_t -= bodies.radius[pair.i] * bodies.spin[pair.i];
          if (!wall) u_t -= bodies.radius[pair.j] * bodies.spin[pair.j];
        }
        problem_.q[dim * a + 1] = u_t;
        problem_.mu[(dim - 1) * a] = value_of(*laws_.friction, pair.i, pair.j, materials);
      }
    }
  }

  /// R_eff / r_i of a pair; a wall counts as flat.
  static double lever_of(const Candidate& pair, const Bodies& bodies) {
    return pair.j < 0 ? 1 : bodies.radius[pair.j] / (bodies.radius[pair.i] + bodies.radius[pair.j]);
  }

  /// The rolling row of contact a. The turning of a wall is that of its shape over the step.
  void pose_rolling(std::size_t a, const Candidate& pair, const Bodies& bodies, const WallStep& walls,
                    double h) {
    const double r_i = bodies.radius[pair.i], r_j = pair.j < 0 ? 0 : bodies.radius[pair.j];
    const double lever = problem_.W.lever[a];
    const double rim_j = pair.j < 0 ? r_i * walls.displacement[-1 - pair.j].angle / h
                                    : (1 - lever) * r_j * bodies.spin[pair.j];
    problem_.q[dim * a + 2] = lever * r_i * bodies.spin[pair.i] - rim_j;
    problem_.mu[(dim - 1) * a + 1] =
        value_of(*laws_.rolling, pair.i, pair.j, {bodies.material, laws_.material_of_shape});
  }

  /// The driven wall of a pair, if it has one.
  template <class Step>
  static auto driven_at(Step& walls, const Candidate& pair) -> decltype(walls.driven.data()) {
    if (pair.j >= 0 || walls.driven_of_shape.empty() || walls.driven_of_shape[-1 - pair.j] < 0)
      return nullptr;
    return &walls.driven[walls.driven_of_shape[-1 - pair.j]];
  }
  static Point along(const Point& v, const DrivenStep& wall, double change) {
    return {v.x + change * wall.direction.x, v.z + change * wall.direction.z};
  }

  /// Gives driven walls the velocities that contacts left them, and their shapes the places at the end of the
  /// step.
  void move_driven(WallStep& walls, double h) {
    for (std::size_t k = 0; k < walls.driven.size(); ++k) {
      DrivenStep& wall = walls.driven[k];
      if (problem_.contacts() > 0) {
        const auto& change = scratch_.judge.state[problem_.W.fixed() + 1 + k];
        wall.velocity += change.x * wall.direction.x + change.z * wall.direction.z;
      }
      const Point shift = along({}, wall, h * (wall.velocity - detected_[k].velocity));
      for (std::size_t s = 0; s < walls.after.size(); ++s) {
        if (walls.driven_of_shape[s] != static_cast<std::int32_t>(k)) continue;
        walls.after[s] = moved(Rigid({0, shift.x, shift.z}), walls.after[s]);
        walls.displacement[s].x += shift.x, walls.displacement[s].z += shift.z;
      }
    }
  }

  /// The work of the contacts of this step.
  void book(const Bodies& bodies, const WallStep& walls, double h, EnergyLedger& ledger) {
    if (dim == 3 && !ledger.rolling) ledger.rolling = 0;
    if (laws_.cohesion && !ledger.cohesion) ledger.cohesion = 0;
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      const Candidate& pair = pairs_[a];
      WorkingContact contact;
      contact.i = pair.i, contact.j = pair.j, contact.n_x = pair.n_x, contact.n_z = pair.n_z;
      contact.normal = impulses_[dim * a];
      if constexpr (dim >= 2) contact.tangential = impulses_[dim * a + 1];
      if constexpr (dim == 3) {
        contact.rolling = impulses_[dim * a + 2];
        contact.lever = problem_.W.lever[a];
        if (pair.j < 0) contact.wall_spin = walls.displacement[-1 - pair.j].angle / h;
      }
      if (laws_.cohesion) contact.attraction = attraction_[a];
      if (pair.j < 0) {
        contact.wall_velocity = {pair.wall_v_x, pair.wall_v_z};
        if constexpr (drives)
          if (const DrivenStep* pushed = driven_at(walls, pair)) {
            const double mean = (pushed->velocity_before + pushed->velocity) / 2;
            contact.wall_velocity = along(contact.wall_velocity, *pushed,
                                          mean - detected_[pushed - walls.driven.data()].velocity);
          }
      }
      contact.impact = bounces_[a] || (laws_.restitution && approach_[a] != 0);
      books_->add(contact, bodies, h, ledger);
    }
  }

  /// What Signorini's law acts on beside u_n: predicted gap or restitution. Also turns approach_ into what
  /// the next step must know if this contact acts.
  double normal_shift(std::size_t a, const Candidate& pair, const Bodies& bodies, const Point& wall_v,
                      double u_free, double h) {
    if (!laws_.restitution) return pair.gap > 0 ? pair.gap / h : 0;
    const bool wall = pair.j < 0;
    const double u_before = pair.n_x * (bodies.v_x[pair.i] - (wall ? wall_v.x : bodies.v_x[pair.j])) +
                            pair.n_z * (bodies.v_z[pair.i] - (wall ? wall_v.z : bodies.v_z[pair.j]));
    const auto& law = *laws_.restitution;
    const double e = value_of(law.e, pair.i, pair.j, {bodies.material, laws_.material_of_shape});
    const double slowest = 2 * law.gravity * h;
    const Impact impact = impact_of(pair.gap, u_before, approach_[a], e, slowest, h);
    const double arrives = pair.gap > 0 && !impact.bounces ? arrival_speed(pair.gap, u_before, u_free, h) : 0;
    approach_[a] = arrives < -slowest ? arrives : 0;
    return impact.shift;
  }

  void remember(ContactMemory& memory, double h) {
    memory.time_step = h;
    memory.i.resize(pairs_.size());
    memory.j.resize(pairs_.size());
    for (std::size_t a = 0; a < pairs_.size(); ++a) memory.i[a] = pairs_[a].i, memory.j[a] = pairs_[a].j;
    memory.impulse = impulses_;
    if (!laws_.restitution) return;
    for (std::size_t a = 0; a < pairs_.size(); ++a)
      if (impulses_[dim * a] == 0) approach_[a] = 0;  // it did not act: nothing was slowed
    memory.approach = approach_;
  }

  /// New velocities from the impulses, then new positions. The judge's state is M^-1 H^T r of the impulses
  /// returned.
  void move(Bodies& bodies, double h) {
    const bool loaded = problem_.contacts() > 0;
    for (std::size_t b = 0; b < bodies.count(); ++b) {
      bodies.v_x[b] = free_x_[b];
      bodies.v_z[b] = free_z_[b];
      if (loaded) {
        const auto& change = scratch_.judge.state[b];
        bodies.v_x[b] += change.x;
        bodies.v_z[b] += change.z;
        if constexpr (with_spin) bodies.spin[b] += change.s / bodies.radius[b];
      }
      bodies.x[b] += h * bodies.v_x[b];
      bodies.z[b] += h * bodies.v_z[b];
    }
  }

  Overlap overlap_and_projection(Bodies& bodies, const WallStep& walls, double h,
                                 std::optional<LostGrain>& lost) {
    Overlap overlap;
    close_.clear();
    const SweepPlan& plan = problem_.W.plan;
    close_plan_ = plan;  // of those contacts that are still close
    std::size_t group = 0;
    double sum = 0;
    for (const Candidate& pair : pairs_) {
      if (pair.j >= 0) continue;
      const std::size_t s = -1 - pair.j;
      overlap.max = std::max(
          overlap.max, undo_crossing(walls.before[s], walls.after[s], laws_.period, h, bodies, pair.i));
    }
    now_.resize(pairs_.size());
    crew_.each(pairs_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) {
        now_[a] = {pairs_[a].i, pairs_[a].j, 0, 0, 0};
        now_[a].gap = gap_now(pairs_[a], bodies, walls.after, laws_.period, now_[a].n_x, now_[a].n_z);
      }
    });
    for (std::size_t a = 0; a < pairs_.size(); ++a) {
      for (; plan.group_start[group] == static_cast<std::int32_t>(a); ++group)
        close_plan_.group_start[group] = static_cast<std::int32_t>(close_.size());
      const ClosePair& now = now_[a];
      if (now.j < 0 && !lost && has_left(walls.after[-1 - now.j], bodies.radius[now.i], now.gap))
        lost = LostGrain{now.i, bodies.x[now.i], bodies.z[now.i], LostGrain::How::left_container};
      if (impulses_[dim * a] > 0) {
        const double depth = std::max(0.0, -now.gap);
        sum += depth;
        overlap.max = std::max(overlap.max, depth);
        ++overlap.loaded;
      }
      if (now.gap < laws_.detection_margin) close_.push_back(now);
    }
    if (!pairs_.empty()) close_plan_.group_start.back() = static_cast<std::int32_t>(close_.size());
    if (overlap.loaded > 0) overlap.mean = sum / overlap.loaded;
    if (solver_.projection_sweeps > 0)
      projection_.apply(bodies, close_, close_plan_, solver_.projection_sweeps);
    return overlap;
  }

  StepLaws laws_;
  StepSolver solver_;
  ContactSolver<Problem> solve_;
  ThreadTeam team_;
  Crew crew_;
  ContactDetection detection_;
  ContactOrder order_;
  Problem problem_;
  SolverScratch<Problem> scratch_;
  std::vector<Candidate> pairs_;      // in solve order
  std::vector<DrivenStep> detected_;  // driven walls as detection saw them
  std::vector<double> free_x_, free_z_;
  std::vector<double> impulses_, approach_;
  std::vector<double> attraction_;                          // cohesive force times h
  std::vector<std::int32_t> first_of_body_, next_of_body_;  // places in the memory, linked by their i
  std::vector<ClosePair> now_, close_;  // all pairs at the end of the step, and those that are close
  SweepPlan close_plan_;
  PositionProjection projection_;
  std::optional<EnergyBooks> books_;  // only with an energy ledger
  std::vector<char> bounces_;         // contacts that give back a speed; for the books
};

}  // namespace

namespace {

/// Driven walls as they would move without contacts.
void add_driven(const Walls& walls, double time_step, WallStep& step) {
  std::vector<std::int32_t> driven_of_wall(walls.names.size(), -1);
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    if (const auto* driven = std::get_if<Driven>(&walls.motion[w])) {
      driven_of_wall[w] = static_cast<std::int32_t>(step.driven.size());
      step.driven.push_back({driven->direction, driven->inverse_mass, driven->velocity,
                             driven->velocity + time_step * driven->force * driven->inverse_mass});
    }
  if (step.driven.empty()) return;
  for (std::size_t s = 0; s < walls.wall_of_shape.size(); ++s) {
    step.driven_of_shape.push_back(driven_of_wall[walls.wall_of_shape[s]]);
    if (step.driven_of_shape[s] < 0) continue;
    const DrivenStep& wall = step.driven[step.driven_of_shape[s]];
    const double way = time_step * wall.velocity;
    const Pose free{0, way * wall.direction.x, way * wall.direction.z};
    step.after[s] = moved(Rigid(free), step.after[s]);
    step.displacement[s] = after(free, step.displacement[s]);
  }
}

}  // namespace

WallStep wall_step(const Walls& walls, double time_in_stage, double time_step) {
  WallStep step;
  step.before = walls.shapes_at(time_in_stage);
  step.after = walls.shapes_at(time_in_stage + time_step);
  std::vector<Pose> moves;
  for (int wall = 0; wall < static_cast<int>(walls.names.size()); ++wall)
    moves.push_back(
        after(walls.pose(wall, time_in_stage + time_step), inverse(walls.pose(wall, time_in_stage))));
  for (const int wall : walls.wall_of_shape) step.displacement.push_back(moves[wall]);
  add_driven(walls, time_step, step);
  return step;
}

std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver) {
  if (laws.driven_walls) {
    if (laws.rolling) return std::make_unique<MoreauJean<DrivenRollingProblem, true>>(laws, solver);
    if (!laws.friction) return std::make_unique<MoreauJean<DrivenFrictionlessProblem, false>>(laws, solver);
    if (!laws.spin) return std::make_unique<MoreauJean<DrivenCoulombProblem, false>>(laws, solver);
    return std::make_unique<MoreauJean<DrivenCoulombSpinProblem, true>>(laws, solver);
  }
  if (laws.rolling) return std::make_unique<MoreauJean<CoulombRollingProblem, true>>(laws, solver);
  if (!laws.friction) return std::make_unique<MoreauJean<FrictionlessProblem, false>>(laws, solver);
  if (!laws.spin) return std::make_unique<MoreauJean<CoulombProblem, false>>(laws, solver);
  return std::make_unique<MoreauJean<CoulombSpinProblem, true>>(laws, solver);
}

}  // namespace drumlin
