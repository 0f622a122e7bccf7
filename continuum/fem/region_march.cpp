#include "continuum/fem/region_march.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/detail/region_fields.hpp"
#include "continuum/fem/detail/time_step.hpp"
#include "continuum/model/mesh_motion.hpp"
#include "continuum/model/outline.hpp"
#include "continuum/model/plane_vector.hpp"
#include "continuum/model/region_mesh.hpp"
#include "continuum/model/touch_down.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

using fem::Discretisation;
using fem::FieldVector;
using fem::SolvedLevel;
using fem::SplitTriangles;
using fem::Work;

constexpr double cells_in_a_step = 0.4;  // that the fastest material passes
constexpr int most_steps_on_a_mesh = 20;
constexpr double poorest_quality = 0.2;

std::map<Side, BoundaryCondition> sides_of(const std::shared_ptr<const Region>& region, double time) {
  std::map<Side, BoundaryCondition> sides;
  for (std::size_t i = 0; i < region->parts.size(); ++i) {
    const RegionPart& part = region->parts[i];
    if (part.kind == RegionPart::Kind::opening && time >= part.begins) continue;
    const auto moves = [region, i, time](Vec2 x) { return wall_velocity(*region, i, time, x); };
    auto& side = sides[side_of_part(static_cast<int>(i))];
    if (part.kind == RegionPart::Kind::friction)
      side = FrictionWall{.velocity = moves, .friction = part.friction};
    else
      side = PrescribedVelocity{moves};
  }
  return sides;
}

// A flow on its way.
class FreeFlow {
 public:
  FreeFlow(const RegionMarch& plan, RegionState& state, const FlowSolverOptions& options,
           const RegionObserver& observer)
      : plan_(plan), state_(state), options_(options), observer_(observer) {
    watching_.interrupted = observer.interrupted;
    watching_.iteration = [this](const IterationReport& line) {
      ++now_.iterations;
      now_.residual = line.residual;
    };
    report_.start = "rest";
  }

  FlowField field() {
    begin();
    return FlowField(level_);
  }

  FlowReport march() {
    begin();
    while (state_.time < plan_.end * (1 - 1e-12)) {
      now_ = {};
      if (!step()) {
        report_.failure =
            fmt::format("time {:.4g}, step {}: {}", state_.time, state_.steps + 1, report_.failure);
        break;
      }
      if (observer_.stepped) observer_.stepped(now_);
    }
    report_.converged = report_.failure.empty();
    if (report_.converged && observer_.ended) observer_.ended(FlowField(level_));
    report_.residual = now_.residual;
    report_.seconds = fem::now() - begun_;
    for (std::size_t i = 0; i < fem::work_names.size(); ++i)
      report_.phases.push_back(
          {fem::work_names[i], clock_.seconds(static_cast<Work>(i)), clock_.times(static_cast<Work>(i))});
    return report_;
  }

 private:
  void begin() {
    discretise();
    auto& solution = level_->state.solution;
    if (!state_.values.empty() && state_.values.size() != solution.size())
      throw InputError("a kept state does not fit its mesh");
    for (std::size_t i = 0; i < state_.values.size(); ++i) solution[i] = state_.values[i];
    solution.update_ghost_values();
    if (!state_.rates.empty()) {
      auto rate = std::make_shared<FieldVector>(d().field());
      for (std::size_t i = 0; i < state_.rates.size(); ++i) (*rate)[i] = state_.rates[i];
      rate->update_ghost_values();
      rate_ = rate;
    }
    (void)d().move_corners(level_->problem, state_.mesh.vertices);
  }

  // The level of the mesh as it is, at rest.
  void discretise() {
    level_ = std::make_shared<SolvedLevel>();
    level_->problem = plan_.problem;
    level_->problem.inertia = Inertia{};
    level_->problem.domain = MeshedDomain{std::make_shared<RegionMesh>(state_.mesh)};
    level_->problem.boundary = sides_of(region_, state_.time);
    level_->discretisation = std::make_shared<Discretisation>(level_->problem);
    level_->state.theta = std::get<FixedSlope>(plan_.problem.slope).theta;
    level_->state.solution = level_->discretisation->field();
    level_->state.solution.update_ghost_values();
    level_->setting = fem::final_setting(level_->problem);
    level_->state.dual =
        fem::dual_of(*level_->discretisation, level_->setting.regularisation, level_->state.solution);
    split_.emplace(state_.mesh);
    rate_ = nullptr;
  }

  Discretisation& d() { return *level_->discretisation; }

  // The longest step: to the next frame or change of a part at most.
  double longest_step(const std::vector<Vec2>& u) {
    double dt = plan_.step;
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double speed = length(u[k]);
      now_.fastest = std::max(now_.fastest, speed);
      dt = std::min(dt, cells_in_a_step * plan_.size(state_.mesh.vertices[k]) / std::max(speed, 1e-12));
    }
    return dt;
  }
  double next_event() const {
    double next = plan_.end;
    const auto consider = [&](double time) {
      if (time > state_.time && time < next) next = time;
    };
    for (const RegionPart& part : plan_.region.parts) consider(part.begins), consider(part.ends);
    return next;
  }

  bool step() {
    const std::vector<Vec2> from = state_.mesh.vertices;
    const double event = next_event();
    double dt = longest_step(fem::velocity_at_corners(d(), from.size(), level_->state.solution));
    const auto left = std::ceil((event - state_.time) / dt - 1e-9);
    dt = (event - state_.time) / std::max(1.0, left);
    bool to_event = left <= 1;
    // No part begins or ends within a step; where one does at its start, what moves does so anew.
    level_->problem.boundary = sides_of(region_, state_.time + 0.5 * dt);
    if (changes_now()) rate_ = nullptr;
    const auto before = std::make_shared<FieldVector>(level_->state.solution);
    before->update_ghost_values();
    const fem::State old = level_->state;
    for (int halving = 0; halving <= plan_.halvings; ++halving, dt *= 0.5, to_event = false) {
      level_->state = old;
      const double to = to_event ? event : state_.time + dt;
      if (attempt(dt, from, *before, to >= plan_.end)) {
        state_.time = to;
        finish(dt);
        return true;
      }
      if (report_.interrupted) return false;
    }
    return false;
  }

  bool changes_now() const {
    return std::ranges::any_of(plan_.region.parts, [&](const RegionPart& part) {
      return part.begins == state_.time || part.ends == state_.time;
    });
  }

  bool attempt(double dt, const std::vector<Vec2>& from, const FieldVector& start, bool is_last) {
    const fem::Stage first = fem::to_middle(dt, rate_ != nullptr), second = fem::to_end(dt);
    if (!placed(from)) return false;
    level_->state.dual = fem::dual_of(d(), level_->setting.regularisation, start);
    // The mesh at the middle by the velocity a quarter of the step ahead, that at the end by that at the
    // middle.
    const FieldVector quarter = from_of(first, start, start, rate_.get());
    const std::vector<Vec2> quarter_places = places_from(first, from, from);
    if (!placed(quarter_places)) return false;
    set(quarter);
    Follows follows = followed(state_.time + 0.25 * dt, quarter_places);
    const std::vector<Vec2> middle_places = moved(from, 0.5 * dt, follows.corners);
    guess(start, from, middle_places);
    if (!reach(first, quarter, quarter_places, middle_places, follows)) return false;
    follows = followed(state_.time + 0.5 * dt, middle_places);
    std::vector<Vec2> to = held_by_walls(plan_.region, state_.time, dt, state_.mesh, plan_.size,
                                         moved(from, dt, follows.corners));
    const FlowIntegrals middle = FlowField(level_).integrals();
    const FieldVector towards_end = from_of(second, start, level_->state.solution, nullptr);
    const std::vector<Vec2> towards_end_places = places_from(second, from, middle_places);
    guess(level_->state.solution, middle_places, to);
    if (!reach(second, towards_end, towards_end_places, to, follows)) return false;
    report_.failure.clear();
    // The first step on a mesh makes the velocities, which were interpolated, solenoidal: no rate of change.
    rate_ = state_.steps_on_mesh > 0 || state_.steps == 0
                ? rate_of(second, towards_end, level_->state.solution)
                : nullptr;
    state_.corner_rates = rate(second, towards_end_places, to);
    state_.mesh.vertices = std::move(to);
    look(dt, middle, is_last);
    return true;
  }

  bool placed(const std::vector<Vec2>& corners) {
    if (d().move_corners(level_->problem, corners)) return true;
    report_.failure = "the mesh turned inside out";
    return false;
  }

  // Where no rate is known, the flow on this mesh taken along with it. Left where it is, a velocity that
  // turns with the mesh would stretch it at the rate rotation^2 dt, far above eps.
  void guess(const FieldVector& flow, const std::vector<Vec2>& here, const std::vector<Vec2>& there) {
    set(rate_ ? flow : fem::displaced(d(), flow, fem::field_of_corners(d(), *split_, ways(here, there))));
  }

  void set(const FieldVector& solution) {
    level_->state.solution = solution;
    level_->state.solution.update_ghost_values();
  }

  // How the mesh follows the material as it flows there, and what then passes through it.
  struct Follows {
    std::vector<Vec2> corners;
    std::shared_ptr<const FieldVector> passing;
  };
  Follows followed(double time, const std::vector<Vec2>& corners) {
    flow_ = fem::boundary_flow(*level_, *split_, corners.size());
    Follows follows{corner_velocities(plan_.region, time, state_.mesh, corners, flow_.motion), nullptr};
    FieldVector passing = fem::field_of_corners(d(), *split_, follows.corners);
    passing.sadd(-1, 1, level_->state.solution);
    passing.update_ghost_values();
    follows.passing = std::make_shared<FieldVector>(std::move(passing));
    return follows;
  }

  // The end of a stage, where the mesh is to be there.
  bool reach(const fem::Stage& stage, const FieldVector& from, const std::vector<Vec2>& from_places,
             const std::vector<Vec2>& corners, const Follows& follows) {
    if (!placed(corners)) return false;
    fem::Newton newton(level_->problem, options_, d(), 0, begun_, clock_, report_, watching_);
    const auto velocity =
        std::make_shared<FieldVector>(fem::field_of_corners(d(), *split_, rate(stage, from_places, corners)));
    return fem::advance_once(newton, options_, stage, from, rate_.get(), {velocity, follows.passing},
                             *level_);
  }

  // The same sums as those of velocities.
  std::vector<Vec2> places_from(const fem::Stage& stage, const std::vector<Vec2>& start,
                                const std::vector<Vec2>& middle) const {
    std::vector<Vec2> sum(start.size());
    for (std::size_t k = 0; k < sum.size(); ++k) {
      sum[k] = stage.start * start[k] + stage.middle * middle[k];
      if (stage.rate != 0) sum[k] = sum[k] + stage.rate * state_.corner_rates[k];
    }
    return sum;
  }
  static std::vector<Vec2> rate(const fem::Stage& stage, const std::vector<Vec2>& from,
                                const std::vector<Vec2>& to) {
    std::vector<Vec2> w(from.size());
    for (std::size_t k = 0; k < w.size(); ++k) w[k] = (1 / stage.length) * (to[k] - from[k]);
    return w;
  }

  // What the step has done, from what holds at its middle.
  void look(double dt, const FlowIntegrals& middle, bool is_last) {
    now_.sums = FlowField(level_).integrals();
    now_.energy_error =
        dt * (middle.weight_power + middle.given_side_power - middle.dissipation - flow_.outflow_energy) -
        (now_.sums.kinetic_energy - state_.kinetic_energy);
    state_.totals.weight_work += dt * middle.weight_power;
    state_.kinetic_energy = now_.sums.kinetic_energy;
    if (is_last) now_.loads = fem::loads_on(plan_.region, state_.time, *level_);
  }

  static std::vector<Vec2> moved(std::vector<Vec2> x, double dt, const std::vector<Vec2>& w) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = x[k] + dt * w[k];
    return x;
  }
  static std::vector<Vec2> ways(const std::vector<Vec2>& from, std::vector<Vec2> to) {
    for (std::size_t k = 0; k < to.size(); ++k) to[k] = to[k] - from[k];
    return to;
  }
  void finish(double dt) {
    ++state_.steps;
    ++state_.steps_on_mesh;
    state_.discharged += flow_.outflow * dt;
    state_.area -= flow_.outflow * dt;
    now_.area = area(outlines_of(state_.mesh));
    RegionTotals& totals = state_.totals;
    totals.mass_error =
        std::max(totals.mass_error, std::abs(now_.area + state_.discharged - totals.fill) / totals.fill);
    remesh_where_needed();
    const auto& solution = level_->state.solution;
    state_.values.assign(solution.begin(), solution.end());
    state_.rates.clear();
    if (rate_)
      state_.rates.assign(rate_->begin(), rate_->end());
    else
      state_.corner_rates.clear();
    report_.iterations += now_.iterations;
    totals.iterations += now_.iterations;
    totals.energy_error += now_.energy_error;
    now_.step = state_.steps;
    now_.time = state_.time;
    now_.time_step = dt;
    now_.discharged = state_.discharged;
    now_.discharge_rate = flow_.outflow;
    now_.cells = static_cast<int>(d().mesh.n_global_active_cells());
  }

  // Walls that are no longer there leave a free surface before anything is laid down on them, and so do those
  // that would pull.
  void remesh_where_needed() {
    const std::vector<Outline> before = outlines_of(state_.mesh);
    std::vector<Outline> after;
    for (const Outline& outline : before) {
      auto [pieces, passed] =
          laid_down(relabelled(outline, plan_.region, state_.time), plan_.region, state_.time, plan_.size);
      state_.discharged += passed;
      state_.area -= passed;
      for (Outline& piece : pieces) {
        let_go(piece);
        after.push_back(std::move(piece));
      }
    }
    const bool same = std::ranges::equal(before, after, {}, &Outline::part, &Outline::part);
    if (!same || state_.steps_on_mesh >= most_steps_on_a_mesh || quality(state_.mesh) <= poorest_quality)
      remesh(std::move(after));
  }

  // From the surface on, as far as a wall that moves away would have to pull the material along.
  void let_go(Outline& outline) const {
    const std::size_t n = outline.points.size();
    for (const std::size_t step : {std::size_t{1}, n - 1})
      for (std::size_t i = 0; i < n; ++i) {
        if (outline.part[i] >= 0) continue;
        for (std::size_t k = (i + step) % n; outline.part[k] >= 0 && pulls(outline, k); k = (k + step) % n)
          outline.part[k] = Outline::free;
      }
  }
  bool pulls(const Outline& outline, std::size_t side) const {
    const RegionPart& part = plan_.region.parts[static_cast<std::size_t>(outline.part[side])];
    const Vec2 moves = wall_motion(part, state_.time);
    const Vec2 a = outline.points[side], b = outline.points[(side + 1) % outline.points.size()];
    const Vec2 n = (1 / length(b - a)) * Vec2{b.z - a.z, a.x - b.x};
    if (!(dot(moves, n) > 0)) return false;
    const std::array<Vec2, 1> middle = {0.5 * (a + b)};
    const PointState at = FlowField(level_).at(middle).front();
    return n.x * n.x * at.sigma_xx + n.z * n.z * at.sigma_zz - 2 * n.x * n.z * at.sigma_xz < 0;
  }

  // Each piece keeps its share of the area.
  void remesh(std::vector<Outline> outlines) {
    clock_(Work::refinement, [&] {
      const std::shared_ptr<SolvedLevel> old = level_;
      const RegionMesh old_mesh = state_.mesh;
      const double scale = state_.area / area(outlines);
      for (Outline& outline : outlines)
        outline = with_area(resampled(outline, plan_.region, state_.time, plan_.size), plan_.region,
                            state_.time, scale * area(outline));
      state_.mesh = mesh_of(outlines, plan_.size);
      discretise();
      fem::transfer(*old, old_mesh, *level_);
      state_.steps_on_mesh = 0;
      now_.remeshed = true;
    });
  }

  const double begun_ = fem::now();
  const RegionMarch& plan_;
  RegionState& state_;
  /// Of the sides of a flow, which may outlive the plan.
  const std::shared_ptr<const Region> region_ = std::make_shared<Region>(plan_.region);
  const FlowSolverOptions& options_;
  const RegionObserver& observer_;
  FlowObserver watching_;
  FlowReport report_;
  fem::WorkClock clock_;
  std::shared_ptr<SolvedLevel> level_;
  std::optional<SplitTriangles> split_;
  RegionStep now_;
  fem::BoundaryFlow flow_;                   // of the last look at the material's motion
  std::shared_ptr<const FieldVector> rate_;  // of the unknowns along the nodes; null: unknown
};

}  // namespace

RegionState filled(const RegionMarch& march) {
  const Outline fill = outline_of(march.region, 0, march.size);
  RegionState state;
  state.area = state.totals.fill = area(fill);
  state.mesh = mesh_of(fill, march.size);
  return state;
}

FlowField flow_of(const RegionMarch& march, const RegionState& state) {
  RegionState copy = state;
  return FreeFlow(march, copy, {}, {}).field();
}

FlowReport march_region(const RegionMarch& march, RegionState& state, const FlowSolverOptions& options,
                        const RegionObserver& observer) {
  return FreeFlow(march, state, options, observer).march();
}

}  // namespace drumlin::continuum
