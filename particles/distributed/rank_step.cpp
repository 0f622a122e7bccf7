#include "particles/distributed/rank_step.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "particles/distributed/processor_time.hpp"
#include "particles/distributed/rank_grains.hpp"
#include "particles/distributed/rank_projection.hpp"
#include "particles/distributed/rank_search.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/coarse_loads.hpp"
#include "particles/stepping/assembly.hpp"
#include "particles/stepping/meeting.hpp"
#include "particles/stepping/set_free_motion.hpp"
#include "particles/stepping/snapshot_of_state.hpp"
#include "particles/stepping/stopwatch.hpp"
#include "particles/stepping/wall_crossing.hpp"

namespace drumlin::particles {
namespace {

// From so many contacts of a rank on a phase of the step gives back what the next one does not need: to ask
// for it again takes some hundredths of the step.
constexpr std::size_t many_contacts = 400'000;

/// A lost grain as ranks tell each other.
struct LostRecord {
  std::int64_t id = 0;
  double x = 0, z = 0;
  int how = 0;
};

RankGrain record_of(const Bodies& bodies, std::int32_t b) {
  const double spin = bodies.spin.empty() ? 0 : bodies.spin[b];
  return {bodies.id[b],  bodies.x[b], bodies.z[b],      bodies.v_x[b],
          bodies.v_z[b], spin,        bodies.radius[b], bodies.inverse_mass[b]};
}

template <class Problem, bool with_spin>
class RankMoreauJean final : public RankStepper {
  static constexpr int dim = Problem::dim;

 public:
  RankMoreauJean(const StepLaws& laws, const StepSolver& solver, const Domain& domain, const Ranks& ranks)
      : laws_(laws),
        settings_(solver),
        domain_(domain),
        ranks_(ranks),
        team_(solver.threads),
        grains_(ranks, domain, with_spin, dim, laws.detection_margin),
        search_(laws_, ranks, domain.grains, dim, grains_, &team_, &memory_),
        solver_(ranks, &team_, least_contacts_of_coarse_loads),
        overlaps_(ranks),
        projection_(ranks, &team_) {
    crossings_.use(&team_);
    if (laws.gravity) gravity_ = *laws.gravity;
    if (solver.name == "accelerated-double") method_ = TileMethod::accelerated_double;
    if (solver.name == "nlgs") method_ = TileMethod::nlgs;
  }

  StepReport advance(RankState& state, WallStep& walls, double time_step) override {
    StepReport report;
    Stopwatch watch;
    const double begin = processor_seconds(), waited = waiting_seconds();
    const Point gain{time_step * gravity_.x, time_step * gravity_.z};
    grains_.settle(state, walls, time_step, gain);
    std::optional<WorkMemory::Frame> of_search(&memory_);
    const ImpactCounts impacts = search_.find(state, walls, time_step, gain);
    report.impacts = impacts.met, report.impacts_unresolved = impacts.unresolved;
    find_rank_pairs(grains_.seen(), search_.candidates(), search_.homed(), grains_.tiles(), ranks_.rank(),
                    own_);
    halo_.follow(own_.halo);
    take_used(state, time_step);
    report.detection_seconds = watch.lap();
    const StepInput step{laws_, bodies_, walls, {}, free_, time_step};
    std::swap(contacts_.pairs, own_.pairs);
    const bool large = contacts_.pairs.size() > many_contacts;
    place_pairs(step, contacts_.pairs);
    search_.recollection().warm_start(grains_.memory(), dim, time_step, own_.order, solution_.impulses);
    of_search.reset();
    if (large) {
      search_.release(), memory_.release(), free_memory_of(own_.pairs);
      grains_.release_memory(), free_memory_of(state.memory);  // the step ends with others
    }
    assemble<Problem, with_spin>(step, contacts_, TeamLoops(&team_), problem_);
    report.setup_seconds = watch.lap();
    const TiledContacts tiled{own_.tiles, own_.tile_order, counts_here_, bodies_.x, bodies_.z};
    report.solve = solver_.solve(problem_, tiled, halo_, settings_.rule, method_, solution_);
    if (large) solver_.release();
    std::vector<std::int64_t> count{problem_.contacts()};
    ranks_.add(count);
    report.contacts = count[0];
    (void)watch.lap();
    crossings_.begin(bodies_, walls.before, domain_.largest / 2);
    move(time_step);
    const int projected = project(walls, time_step, report);
    remember(state, time_step);
    give_back(state);
    report.projection_seconds = watch.lap();
    add_up(state, report, projected);
    counts_.step_seconds += processor_seconds() - begin;
    counts_.waiting_seconds += waiting_seconds() - waited;
    return report;
  }

  std::vector<SnapshotContact> loaded_contacts() override {
    std::vector<SnapshotContact> loaded;
    const auto& r = solution_.impulses;
    std::size_t count = 0;
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) count += r[dim * a] != 0;
    loaded.reserve(count);
    for (std::size_t a = 0; a < contacts_.pairs.size(); ++a) {
      const Candidate& pair = contacts_.pairs[a];
      if (r[dim * a] == 0) continue;
      loaded.push_back({static_cast<std::int32_t>(bodies_.id[pair.i]),
                        pair.j < 0 ? pair.j : static_cast<std::int32_t>(bodies_.id[pair.j]),
                        static_cast<float>(pair.n_x), static_cast<float>(pair.n_z), r[dim * a],
                        dim >= 2 ? r[dim * a + 1 % dim] : 0});
    }
    release_memory();  // as much goes to the ranks that write it
    return loaded;
  }

  std::vector<SnapshotContact> strikes() const override {
    std::vector<SnapshotContact> all;
    for (const Strike& strike : search_.impacts().strikes())
      all.push_back({strike.i, strike.j, static_cast<float>(strike.n_x), static_cast<float>(strike.n_z),
                     strike.normal, strike.tangential});
    return all;
  }

  void release_memory() override {
    if (contacts_.pairs.size() <= many_contacts) return;
    contacts_ = {}, problem_ = {}, solution_ = {}, own_ = {}, bodies_ = {}, free_ = {};
    free_memory_of(counts_here_), free_memory_of(place_in_order_);
    projection_.release(), overlaps_.release();
  }
  const RankCounts& counts() const override { return counts_; }

 private:
  double waiting_seconds() const { return halo_.waiting_seconds() + Ranks::waiting_seconds(); }

  /// From here on the bodies are those that this rank's contacts touch, and its own.
  void take_used(const RankState& state, double time_step) {
    const SeenGrains& seen = grains_.seen();
    const std::size_t count = own_.used.size();
    for (auto* values :
         {&bodies_.x, &bodies_.z, &bodies_.v_x, &bodies_.v_z, &bodies_.radius, &bodies_.inverse_mass})
      resize_closely(*values, count);
    if constexpr (with_spin) resize_closely(bodies_.spin, count);
    resize_closely(bodies_.id, count), resize_closely(counts_here_, count);
    for (std::size_t b = 0; b < count; ++b) {
      const std::int32_t s = own_.used[b], place = seen.place[s];
      counts_here_[b] = place >= 0;
      // Of an own grain the state has all numbers in one record.
      const RankGrain grain = place >= 0 ? state.grains[place] : record_of(seen.bodies, s);
      bodies_.x[b] = grain.x, bodies_.z[b] = grain.z;
      bodies_.v_x[b] = grain.v_x, bodies_.v_z[b] = grain.v_z;
      if constexpr (with_spin) bodies_.spin[b] = grain.spin;
      bodies_.radius[b] = grain.radius, bodies_.inverse_mass[b] = grain.inverse_mass;
      bodies_.id[b] = grain.id;
    }
    set_free_motion(bodies_, laws_, time_step, TeamLoops(&team_), free_);
    free_.shift.clear();
    if (search_.shift().empty()) return;
    for (const std::int32_t s : own_.used) free_.shift.push_back(search_.shift()[s]);
  }

  /// New velocities from the solution, then new positions, as in one process but for grains alone on a wall.
  void move(double time_step) {
    const auto& changes = solution_.velocities.bodies;
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
      const Point v{free_.x[b] + changes[b].x, free_.z[b] + changes[b].z};
      if constexpr (with_spin) spin_up(bodies_, b, changes[b].s);
      const bool pushed = !(changes[b].x == 0 && changes[b].z == 0);
      const Point way = way_within_step(free_, b, {bodies_.v_x[b], bodies_.v_z[b]}, v, pushed, time_step);
      bodies_.v_x[b] = v.x, bodies_.v_z[b] = v.z;
      bodies_.x[b] += way.x, bodies_.z[b] += way.z;
    }
  }

  /// The overlap that is left, which is then removed on positions alone. Returns the sweeps of that.
  int project(WallStep& walls, double time_step, StepReport& report) {
    const Period open;
    const Crossings moved = crossings_.undo(walls, open, bodies_);
    std::optional<LostGrain> lost;
    report.overlap = overlaps_.find({contacts_.pairs, own_.tiles, solution_.impulses, dim}, bodies_, walls,
                                    laws_.detection_margin, lost);
    Crossings pushed;
    int sweeps = 0;
    if (settings_.projection.sweeps > 0) {
      sweeps =
          projection_.apply(overlaps_, own_.tile_order, counts_here_, halo_, settings_.projection, bodies_);
      pushed = crossings_.undo(walls, open, bodies_);
    }
    std::array<double, 1> deepest{std::max({report.overlap.max, moved.deepest, pushed.deepest})};
    ranks_.largest(deepest);
    report.overlap.max = deepest[0];
    if (!lost) lost = moved.lost ? moved.lost : pushed.lost;
    if (!lost) lost = grain_that_is_not_finite(bodies_);
    if (!lost) lost = grain_too_fast(bodies_, time_step);
    report.lost = first_lost(lost);
    return sweeps;
  }

  /// Of those that ranks have lost the one of least identity.
  std::optional<LostGrain> first_lost(const std::optional<LostGrain>& own) const {
    if (!ranks_.any(own.has_value())) return std::nullopt;
    std::vector<LostRecord> mine;
    if (own) mine.push_back({bodies_.id[own->grain], own->x, own->z, static_cast<int>(own->how)});
    const auto all = ranks_.gather_everywhere<LostRecord>(mine);
    const auto& first = *std::min_element(
        all.begin(), all.end(), [](const LostRecord& a, const LostRecord& b) { return a.id < b.id; });
    return LostGrain{static_cast<int>(first.id), first.x, first.z, static_cast<LostGrain::How>(first.how)};
  }

  void remember(RankState& state, double time_step) {
    const auto& r = solution_.impulses;
    std::size_t loaded = 0;
    resize_closely(place_in_order_, own_.order.size());
    for (std::size_t a = 0; a < own_.order.size(); ++a) {
      loaded += r[dim * a] != 0;
      place_in_order_[own_.order[a]] = static_cast<std::int32_t>(a);
    }
    state.memory.clear();
    state.memory_time_step = time_step;
    // At first one rank has had those of all.
    if (state.memory.capacity() > 2 * loaded) free_memory_of(state.memory);
    state.memory.reserve(loaded + loaded / 16);
    const bool alone = ranks_.count() == 1;  // then nobody asks where a pair is
    // By identities, so that the next step need not sort what stays on this rank.
    for (const std::int32_t a : place_in_order_) {
      const Candidate& pair = contacts_.pairs[a];
      RememberedContact contact;
      for (int c = 0; c < dim; ++c) contact.impulse[c] = r[dim * a + c];
      if (contact.impulse == std::array<double, 2>{}) continue;
      const Point place = alone ? Point{} : middle_of(pair, bodies_);
      contact.i = bodies_.id[pair.i], contact.j = pair.j < 0 ? pair.j : bodies_.id[pair.j];
      contact.x = place.x, contact.z = place.z;
      state.memory.push_back(contact);
    }
  }

  void give_back(RankState& state) {
    const SeenGrains& seen = grains_.seen();
    for (std::size_t b = 0; b < own_.used.size(); ++b) {
      const std::int32_t place = seen.place[own_.used[b]];
      if (place < 0) continue;
      RankGrain& grain = state.grains[place];
      grain.x = bodies_.x[b], grain.z = bodies_.z[b];
      grain.v_x = bodies_.v_x[b], grain.v_z = bodies_.v_z[b];
      if constexpr (with_spin) grain.spin = bodies_.spin[b];
    }
  }

  void add_up(const RankState& state, const StepReport& report, int projected) {
    ++counts_.steps;
    counts_.sweeps += report.solve.sweeps + projected;
    counts_.contacts += problem_.contacts();
    counts_.grains += static_cast<std::int64_t>(state.grains.size());
    counts_.ghosts += static_cast<std::int64_t>(grains_.ghosts());
    counts_.shared_bytes_per_sweep += halo_.bytes_per_sweep();
    counts_.halo_rounds = halo_.rounds(), counts_.halo_bytes = halo_.bytes();
    counts_.rounds = Ranks::rounds();
    counts_.forests = grains_.forests();
    counts_.sorts = grains_.sorts();
    counts_.corrections = solver_.corrections();
    counts_.impacts = search_.impacts().counts();
  }

  StepLaws laws_;
  StepSolver settings_;
  Domain domain_;
  Ranks ranks_;
  ThreadTeam team_;
  WorkMemory memory_;  // of the search
  Point gravity_;
  TileMethod method_ = TileMethod::accelerated;
  RankGrains grains_;
  RankSearch search_;
  RankPairs own_;
  Halo halo_;
  Bodies bodies_;                  // used ones
  FreeMotion free_;                // of the used ones
  std::vector<char> counts_here_;  // of each used grain: its own
  StepContacts contacts_;
  std::vector<std::int32_t> place_in_order_;  // of each pair as it was found: its place in contacts_
  Problem problem_;
  Solution<Problem> solution_;
  TileSolver<Problem> solver_;
  RankOverlap overlaps_;
  RankProjection projection_;
  WallCrossings crossings_;
  RankCounts counts_;
};

}  // namespace

std::unique_ptr<RankStepper> make_rank_stepper(const StepLaws& laws, const StepSolver& solver,
                                               const Domain& domain, const Ranks& ranks) {
  if (!laws.friction)
    return std::make_unique<RankMoreauJean<FrictionlessProblem, false>>(laws, solver, domain, ranks);
  if (!laws.spin) return std::make_unique<RankMoreauJean<CoulombProblem, false>>(laws, solver, domain, ranks);
  return std::make_unique<RankMoreauJean<CoulombSpinProblem, true>>(laws, solver, domain, ranks);
}

}  // namespace drumlin::particles
