#include "particles/stepping/moreau_jean.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "particles/detection/contact_list.hpp"
#include "particles/detection/contact_order.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/stepping/assembly.hpp"
#include "particles/stepping/attract.hpp"
#include "particles/stepping/cell_step.hpp"
#include "particles/stepping/contact_work.hpp"
#include "particles/stepping/impacts.hpp"
#include "particles/stepping/lone_contact.hpp"
#include "particles/stepping/meeting.hpp"
#include "particles/stepping/position_projection.hpp"
#include "particles/stepping/set_free_motion.hpp"
#include "particles/stepping/snapshot_of_state.hpp"
#include "particles/stepping/step_end.hpp"
#include "particles/stepping/stopwatch.hpp"
#include "particles/stepping/wall_crossing.hpp"

namespace drumlin::particles {
namespace {

// Rounds of impacts within a step, which may throw grains into pairs that no search has found.
constexpr int most_searches = 5;
// Of the impulse on a grain: what may come from other contacts if it counts as the only one.
constexpr double alone = 1e-9;

template <class Problem>
class MoreauJean final : public Stepper {
  static constexpr int dim = Problem::dim;
  static constexpr bool with_spin = Problem::Delassus::spin;

 public:
  MoreauJean(const StepLaws& laws, const StepSolver& solver, const ContactSolvers& solvers)
      : laws_(laws),
        solver_(solver),
        solve_(std::get<ContactSolver<Problem>>(solvers)),
        team_(solver.threads) {
    work_.team = &team_, work_.memory = &memory_, work_.world = solver.world;
    projection_.use(solver.world);
    const auto share = [this](auto&... users) {
      (users.use(&team_), ...);
      (users.use(&memory_), ...);
    };
    share(detection_, recollection_, impacts_, order_, overlaps_, projection_);
    crossings_.use(&team_);
    if (laws.energy_ledger) step_energy_.emplace(laws.gravity);
  }

  StepReport advance(const MovingState& state, WallStep& walls, double time_step) override {
    Bodies& bodies = state.bodies;
    crossings_.begin(bodies, walls.before);
    if (state.cell) laws_.period = period_of(state.cell->state);
    const CellResponse cell = state.cell ? state.cell->response : CellResponse{};
    const StepInput step{laws_, bodies, walls, state.driven, free_, time_step, cell};
    StepReport report;
    Stopwatch watch;
    if (step_energy_) step_energy_->open(bodies, state.energy);
    if (step_energy_ && state.cell && !state.energy->cell) state.energy->cell = 0;
    detect(step, state, watch, report);
    turn_freely(laws_, time_step, bodies);
    report.setup_seconds += watch.lap();
    solve(step, report, watch);
    const FreeMotion& searched = laws_.restitution ? searched_ : free_;
    while (missed_.find(end_of(step), searched, detection_, contacts_.pairs)) {
      take_in(step, missed_.pairs());
      solve(step, report, watch);
    }
    find_lone_steps(step, state.memory);
    remember_in(state.memory, time_step);
    move(step, bodies);
    if (step_energy_) step_energy_->move(bodies, time_step, *state.energy);
    if (step_energy_) add_contact_work(step, contacts_, problem_, solution_, *step_energy_, *state.energy);
    if (state.cell) deform(step, state);
    move_driven_walls(free_, time_step, walls, state.driven);
    (void)watch.lap();
    report.overlap = project(state, walls, report.lost);
    report.projection_seconds = watch.lap();
    if (step_energy_) step_energy_->close(bodies, *state.energy);
    return report;
  }

  void follow(const StepLaws& laws) override { laws_ = laws; }

  std::vector<WallContact> wall_contacts() const override {
    std::vector<WallContact> at_walls;
    const auto& r = solution_.impulses;
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) {
      const Candidate& pair = contacts_.pairs[a];
      if (pair.j >= 0) continue;
      at_walls.push_back({pair.i, -1 - pair.j, pair.n_x, pair.n_z, r[dim * a] - contacts_.attraction_of(a),
                          dim >= 2 ? r[dim * a + 1 % dim] : 0, dim == 3 ? r[dim * a + 2 % dim] : 0});
    }
    for (const Strike& strike : contacts_.strikes)
      if (strike.j < 0)
        at_walls.push_back(
            {strike.i, -1 - strike.j, strike.n_x, strike.n_z, strike.normal, strike.tangential, 0});
    return at_walls;
  }

  std::vector<SnapshotContact> loaded_contacts() const override {
    std::vector<SnapshotContact> loaded;
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) {
      const Candidate& pair = contacts_.pairs[a];
      const auto& r = solution_.impulses;
      const double r_n = r[dim * a] - contacts_.attraction_of(a), r_t = dim >= 2 ? r[dim * a + 1 % dim] : 0;
      if (r_n != 0)
        loaded.push_back(
            {pair.i, pair.j, static_cast<float>(pair.n_x), static_cast<float>(pair.n_z), r_n, r_t});
    }
    for (const Strike& strike : contacts_.strikes)
      loaded.push_back({strike.i, strike.j, static_cast<float>(strike.n_x), static_cast<float>(strike.n_z),
                        strike.normal, strike.tangential});
    return one_for_each_pair(std::move(loaded));
  }

  DiscProblem last_problem() const override { return &problem_; }

  std::span<const Candidate> last_pairs() const override { return contacts_.pairs; }

  void release_memory() override { memory_.release(); }
  StepMemory memory() const override {
    const auto& W = problem_.W;
    const std::size_t problem = bytes_of(W.i) + bytes_of(W.j) + bytes_of(W.n_x) + bytes_of(W.n_z) +
                                bytes_of(W.inverse_mass) + bytes_of(problem_.q) + bytes_of(problem_.mu);
    const std::size_t solution = bytes_of(solution_.impulses) + bytes_of(solution_.velocities.bodies) +
                                 bytes_of(solution_.velocities.contacts);
    const std::size_t grains =
        bytes_of(free_.x) + bytes_of(free_.z) + bytes_of(searched_.x) + bytes_of(searched_.z);
    return {detection_.bytes() + bytes_of(contacts_.pairs) + order_.bytes() + problem + solution + grains +
                projection_.bytes(),
            memory_.bytes()};
  }

  int unknowns_per_contact() const override { return dim; }
  int velocities_per_body() const override { return with_spin ? 3 : 2; }

 private:
  TeamLoops loops() { return TeamLoops(&team_); }

  /// Velocities without contacts, attractions aside: their pairs are not known yet.
  void move_freely(const StepInput& step) {
    set_free_motion(step.bodies, laws_, step.time_step, loops(), free_);
    free_.driven.clear();
    for (std::size_t k = 0; k < step.driven.size(); ++k)
      free_.driven.push_back(free_velocity(step.walls.driven[k], step.driven[k], step.time_step) +
                             contacts_.wall_jumps[k]);
  }

  /// The pairs that may touch once the impacts of the step are over.
  void detect(const StepInput& step, const MovingState& state, Stopwatch& watch, StepReport& report) {
    const WorkMemory::Frame frame(&memory_);
    contacts_.strikes.clear();
    free_.shift.clear();
    contacts_.wall_jumps.assign(step.driven.size(), 0.0);
    move_freely(step);
    detection_.find(step.bodies, free_.x, free_.z, detection_input(step));
    recollection_.find(state.memory, detection_.candidates());
    report.detection_seconds += watch.lap();
    if (laws_.restitution) strike(step, state, watch, report);
    // In solve order only now: impacts may have brought more pairs together.
    order_.find(detection_.candidates(), step.bodies, laws_.period, problem_.W.plan);
    take_candidates(step, order_.order());
    recollection_.warm_start(state.memory, dim, step.time_step, order_.order(), solution_.impulses);
    report.detection_seconds += watch.lap();
  }

  /// The pairs found, in the order of the solve, with the normals of the time at which they meet.
  void take_candidates(const StepInput& step, std::span<const std::int32_t> order) {
    const auto found = detection_.candidates();
    beside_.assign(step.bodies.count(), 0);
    for (std::size_t a = 0; a < found.size(); ++a)
      if (const std::int32_t i = order_.i()[a], j = order_.j()[a]; j >= 0) beside_[i] = beside_[j] = 1;
    shifted_.assign(step.bodies.count(), 0);
    for (std::size_t b = 0; b < free_.shift.size(); ++b)
      shifted_[b] = free_.shift[b].x != 0 || free_.shift[b].z != 0;
    resize_closely(contacts_.pairs, found.size());
    loops().each(found.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t a = begin; a < end; ++a) contacts_.pairs[a] = found[order[a]];
      place_pairs(step, beside_, shifted_, std::span(contacts_.pairs).subspan(begin, end - begin));
    });
  }

  /// Assembles the contact problem of the pairs and solves it from the impulses at hand.
  void solve(const StepInput& step, StepReport& report, Stopwatch& watch) {
    attract(step, free_, contacts_);
    assemble(step, contacts_, loops(), problem_);
    report.setup_seconds += watch.lap();
    report.contacts = problem_.contacts();
    const bool open = laws_.period.open() && laws_.period.open_z();  // else positions are those of images
    work_.places = open ? BodyPlaces{step.bodies.x, step.bodies.z} : BodyPlaces{};
    const int sweeps = report.solve.sweeps;
    report.solve = solve_(problem_, solver_.rule, work_, solution_);
    report.solve.sweeps += sweeps;
    (void)watch.lap();
  }

  void remember_in(ContactMemory& memory, double time_step) {
    remember(order_.i(), order_.j(), order_.order(), solution_.impulses, time_step, loops(), memory);
  }

  /// Takes pairs in that solved contacts have brought together, with the impulses so far.
  void take_in(const StepInput& step, std::span<const Candidate> missed) {
    const WorkMemory::Frame frame(&memory_);
    const auto order = order_.order();
    ContactMemory solved;
    remember_in(solved, step.time_step);
    std::vector<Candidate> pairs(contacts_.pairs.size() + missed.size());
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) pairs[order[a]] = contacts_.pairs[a];
    const auto added = std::span(pairs).last(missed.size());
    std::copy(missed.begin(), missed.end(), added.begin());
    place_pairs(step, beside_, shifted_, added);
    std::inplace_merge(
        pairs.begin(), pairs.end() - missed.size(), pairs.end(),
        [](const Candidate& a, const Candidate& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
    order_.find(pairs, step.bodies, laws_.period, problem_.W.plan);
    contacts_.pairs.resize(pairs.size());
    for (std::size_t a = 0; a < pairs.size(); ++a) contacts_.pairs[a] = pairs[order_.order()[a]];
    recollection_.find(solved, pairs);
    recollection_.warm_start(solved, dim, step.time_step, order_.order(), solution_.impulses);
    move_freely(step);
  }

  /// The impacts of the step, on pairs in the order in which they are found.
  void strike(const StepInput& step, const MovingState& state, Stopwatch& watch, StepReport& report) {
    searched_.x = free_.x, searched_.z = free_.z;
    for (int searches = 1;; ++searches) {
      const auto loads = recollection_.loads(state.memory, dim, step.time_step);
      const ImpactInput input{step, detection_.candidates(), loads, contacts_.wall_jumps};
      if (searches > 1 && !impacts_.go_on(input)) return;
      impacts_.resolve(input, {state.bodies, free_.shift, contacts_});
      if (step_energy_) step_energy_->strike(impacts_.struck(), impacts_.work(), *state.energy);
      report.impacts += impacts_.count();
      report.impacts_unresolved += impacts_.unresolved();
      report.setup_seconds += watch.lap();
      if (impacts_.count() == 0) return;
      move_freely(step);
      if (searches == most_searches || !find_struck(step)) return;
      if (detection_.find_around(struck_, step.bodies, free_.x, free_.z, detection_input(step)))
        recollect_more(state.memory);
      report.detection_seconds += watch.lap();
    }
  }

  /// Finds the pairs in the memory that a search around grains has added.
  void recollect_more(const ContactMemory& memory) {
    const auto found = detection_.candidates();
    if (detection_.added().empty()) return recollection_.find(memory, found);
    std::vector<Candidate> added;
    for (const std::int32_t a : detection_.added()) added.push_back(found[a]);
    recollection_.find_added(memory, detection_.added(), added);
  }

  /// The grains that impacts have struck harder than the search for pairs allowed for; false if none.
  bool find_struck(const StepInput& step) {
    struck_.clear();
    for (const StruckGrain& struck : impacts_.struck()) {
      const std::int32_t b = struck.grain;
      const double displacement =
          2 * step.time_step * std::hypot(free_.x[b] - searched_.x[b], free_.z[b] - searched_.z[b]);
      if (displacement <= detection_.displacement_bound(b) + laws_.detection_margin) continue;
      struck_.push_back({b, displacement});
      searched_.x[b] = free_.x[b], searched_.z[b] = free_.z[b];
    }
    return !struck_.empty();
  }

  DetectionInput detection_input(const StepInput& step) const {
    return {step.walls.before, step.walls.displacement, step.time_step, laws_.detection_margin, laws_.period};
  }

  /// Replaces the impulses on grains that touch nothing but a wall, and did in the last step, by those of the
  /// midpoint rule (lone_contact.hpp), where neither an attraction nor a couple acts there.
  void find_lone_steps(const StepInput& step, const ContactMemory& memory) {
    lone_.clear();
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) {
      Candidate& pair = contacts_.pairs[a];
      if (problem_.W.j[a] != problem_.W.fixed() || solution_.impulses[dim * a] == 0 || beside_[pair.i])
        continue;
      if constexpr (dim == 3)
        if (problem_.mu[2 * a + 1] > 0) continue;
      if (contacts_.attraction_of(a) > 0) continue;
      const double w = step.inverse_mass()[pair.i];
      double r_n = solution_.impulses[dim * a], r_t = dim >= 2 ? solution_.impulses[dim * a + 1 % dim] : 0;
      auto& change = solution_.velocities.bodies[pair.i];
      const Point other{change.x - w * (pair.n_x * r_n + pair.n_z * r_t),
                        change.z - w * (pair.n_z * r_n - pair.n_x * r_t)};
      if (std::hypot(other.x, other.z) > alone * w * r_n || !was_loaded(memory, pair)) continue;
      double mu = 0;
      if constexpr (dim >= 2) mu = problem_.mu[(dim - 1) * a];
      const auto lone = lone_step(step, pair, mu);
      if (!lone) continue;
      r_n = lone->normal / w, r_t = lone->tangential / w;
      solution_.impulses[dim * a] = r_n;
      if (dim >= 2) solution_.impulses[dim * a + 1 % dim] = r_t;
      if (r_n > 0) {
        pair.n_x = lone->n_x, pair.n_z = lone->n_z;
        pair.wall_v_x = lone->wall_velocity.x, pair.wall_v_z = lone->wall_velocity.z;
      }
      change.x = w * (pair.n_x * r_n + pair.n_z * r_t), change.z = w * (pair.n_z * r_n - pair.n_x * r_t);
      if constexpr (with_spin) change.s = -2 * w * r_t;
      if (r_n > 0) lone_.push_back({pair.i, lone->end});
    }
  }

  PairBodies pair_bodies() const { return {problem_.W.i, problem_.W.j, problem_.W.fixed()}; }

  StepEnd end_of(const StepInput& step) const {
    const auto& changes = solution_.velocities.bodies;
    return {step, problem_.contacts() > 0 ? std::span<const BodyVelocity>(changes)
                                          : std::span<const BodyVelocity>()};
  }

  /// New velocities from the solution, then new positions. Of driven walls the velocities alone.
  void move(const StepInput& step, Bodies& bodies) {
    const StepEnd end = end_of(step);
    const bool loaded = !end.changes.empty();
    const auto& changes = solution_.velocities.bodies;
    find_flights(end, contacts_.pairs, pair_bodies(), flies_);
    loops().each(bodies.count(), [&](std::size_t begin, std::size_t stop) {
      for (std::size_t b = begin; b < stop; ++b) {
        const Point shift = end.shift(b), d = end.displacement(b, flies_[b]), v = end.velocity(b);
        if constexpr (with_spin)
          if (end.is_pushed(b)) spin_up(bodies, b, changes[b].s);
        bodies.v_x[b] = v.x, bodies.v_z[b] = v.z;
        bodies.x[b] += shift.x + d.x, bodies.z[b] += shift.z + d.z;
      }
    });
    for (const auto& [grain, place] : lone_) bodies.x[grain] = place.x, bodies.z[grain] = place.z;
    for (std::size_t k = 0; loaded && k < free_.driven.size(); ++k) {
      const auto& wall = problem_.W.driven[k];
      const auto& change = changes[problem_.W.fixed() + 1 + k];
      free_.driven[k] += change.x * wall.e_x + change.z * wall.e_z;
    }
  }

  /// Ends the step of a cell: its rates as contacts leave them, which the grains follow, and its new lengths.
  void deform(const StepInput& step, const MovingState& state) {
    CellState& cell = state.cell->state;
    if (step.cell.pressed()) {
      set_struck(contacts_.strikes, state.bodies, cell);
      const Point change = cell_answer(problem_, solution_.velocities.bodies);
      const double before = step_energy_ ? kinetic_energy(state.bodies) : 0;
      change_rates_in_step(change, step.time_step, cell, state.bodies);
      if (step_energy_) add_cell_work(kinetic_energy(state.bodies) - before, *state.energy);
    }
    move_cell(step.time_step, cell);
    laws_.period = period_of(cell);
  }

  /// The overlap that is left, which is then removed on positions alone. No grain ends beyond a segment.
  Overlap project(const MovingState& state, WallStep& walls, std::optional<LostGrain>& lost) {
    const WorkMemory::Frame frame(&memory_);
    const MovedContacts contacts{contacts_.pairs, pair_bodies(), solution_.impulses, dim, problem_.W.plan};
    const Crossings moved = crossings_.undo(walls, laws_.period, state.bodies);
    Overlap overlap =
        overlaps_.find(contacts, state.bodies, walls, laws_.period, laws_.detection_margin, lost);
    Crossings pushed;
    if (solver_.projection.sweeps > 0) {
      projection_.apply({state.bodies, walls, state.driven, state.cell ? &*state.cell : nullptr},
                        overlaps_.close(), overlaps_.plan(), solver_.projection);
      pushed = crossings_.undo(walls, laws_.period, state.bodies);
    }
    if (const double crossed = std::max(moved.deepest, pushed.deepest); crossed > overlap.max)
      overlap = {overlap.mean, crossed, overlap.loaded};
    if (!lost) lost = moved.lost ? moved.lost : pushed.lost;
    return overlap;
  }

  StepLaws laws_;
  StepSolver solver_;
  ContactSolver<Problem> solve_;
  ThreadTeam team_;
  WorkMemory memory_;  // of one phase of a step after the other
  FreeMotion free_;
  std::vector<char> flies_;    // of each grain: no contact acts
  std::vector<char> beside_;   // of each grain: it has a pair with another
  std::vector<char> shifted_;  // of each grain: an impact moved the beginning of its path
  MissedPairs missed_;
  std::vector<std::pair<std::int32_t, Point>> lone_;  // grains on one wall, and where their step ends
  FreeMotion searched_;             // velocities by which pairs were last looked for, grain by grain
  std::vector<StruckDisc> struck_;  // since then
  ContactDetection detection_;
  ContactOrder order_;
  StepContacts contacts_;
  Impacts impacts_;
  Recollection recollection_;
  Problem problem_;
  SolverWorkspace<Problem> work_;
  Solution<Problem> solution_;
  OverlapSearch overlaps_;
  PositionProjection projection_;
  WallCrossings crossings_;
  std::optional<StepEnergy> step_energy_;  // only with an energy ledger
};

}  // namespace

std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver,
                                      const ContactSolvers& solvers) {
  const bool spin = laws.unknowns > 1 && laws.spin;
#define DRUMLIN_MAKE(Problem, dim, with_spin)        \
  if (laws.unknowns == (dim) && spin == (with_spin)) \
    return std::make_unique<MoreauJean<Problem>>(laws, solver, solvers);
  DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_MAKE)
#undef DRUMLIN_MAKE
  throw std::logic_error("no contact problem for these effects");
}

std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver) {
  return make_stepper(laws, solver, contact_solvers(solver.name));
}

}  // namespace drumlin::particles
