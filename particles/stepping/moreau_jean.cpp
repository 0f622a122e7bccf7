#include "particles/stepping/moreau_jean.hpp"

#include <stdexcept>
#include <utility>

#include "particles/stepping/lone_steps.hpp"
#include "particles/stepping/snapshot_of_state.hpp"
#include "particles/stepping/step_motion.hpp"
#include "particles/stepping/step_solve.hpp"

namespace drumlin::particles {
namespace {

template <class Problem>
class MoreauJean final : public Stepper {
 public:
  MoreauJean(const StepLaws& laws, const StepSolver& solver, const ContactSolvers& solvers)
      : s_(laws, solver), solver_(std::get<ContactSolver<Problem>>(solvers)) {}

  StepReport advance(const MovingState& state, WallStep& walls, double time_step) override {
    s_.crossings.begin(state.bodies, walls.before);
    if (state.cell) state.laws.period = period_of(state.cell->state);
    const CellResponse cell = state.cell ? state.cell->response : CellResponse{};
    const StepInput step{state.laws, state.bodies, walls, state.driven, s_.free, time_step, cell};
    StepReport report;
    Stopwatch watch;
    if (s_.energy) s_.energy->open(state.bodies, state.energy);
    if (s_.energy && state.cell && !state.energy->cell) state.energy->cell = 0;
    search(step, state, watch, report, s_);
    solve(step, solver_, watch, report, s_);
    take_lone_steps(step, state.memory, s_);
    save_contacts(time_step, s_, state.memory);
    move(step, state, walls, s_);
    (void)watch.lap();
    report.overlap = project(state, walls, report.lost, s_);
    report.projection_seconds = watch.lap();
    if (s_.energy) s_.energy->close(state.bodies, *state.energy);
    return report;
  }

  std::vector<WallContact> wall_contacts() const override {
    std::vector<WallContact> at_walls;
    for (std::size_t a = 0; a < s_.contacts.pairs.size(); ++a) {
      const Candidate& pair = s_.contacts.pairs[a];
      if (pair.j >= 0) continue;
      const ContactParts r = parts_of<Problem>(s_.solution.impulses, a);
      at_walls.push_back({pair.i, -1 - pair.j, pair.n_x, pair.n_z, r.normal - s_.contacts.attraction_of(a),
                          r.tangential, r.couple});
    }
    for (const ImpactImpulse& impact : s_.contacts.impacts)
      if (impact.j < 0)
        at_walls.push_back(
            {impact.i, -1 - impact.j, impact.n_x, impact.n_z, impact.normal, impact.tangential, 0});
    return at_walls;
  }

  std::vector<SnapshotContact> loaded_contacts() const override {
    std::vector<SnapshotContact> loaded;
    const auto add = [&loaded](const auto& at, double r_n, double r_t) {
      loaded.push_back({at.i, at.j, static_cast<float>(at.n_x), static_cast<float>(at.n_z), r_n, r_t});
    };
    for (std::size_t a = 0; a < s_.contacts.pairs.size(); ++a) {
      const ContactParts r = parts_of<Problem>(s_.solution.impulses, a);
      const double r_n = r.normal - s_.contacts.attraction_of(a);
      if (r_n != 0) add(s_.contacts.pairs[a], r_n, r.tangential);
    }
    for (const ImpactImpulse& impact : s_.contacts.impacts) add(impact, impact.normal, impact.tangential);
    return one_for_each_pair(std::move(loaded));
  }

  DiscProblem last_problem() const override { return &s_.problem; }
  std::span<const Candidate> last_pairs() const override { return s_.contacts.pairs; }
  void release_memory() override { s_.memory.release(); }
  StepMemory memory() const override { return s_.bytes(); }
  int unknowns_per_contact() const override { return Problem::dim; }
  int velocities_per_body() const override { return StepState<Problem>::spin ? 3 : 2; }

 private:
  StepState<Problem> s_;
  ContactSolver<Problem> solver_;
};

}  // namespace

std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver,
                                      const ContactSolvers& solvers) {
  const bool spin = !std::holds_alternative<Frictionless>(laws.contact_law) && laws.spin;
#define DRUMLIN_MAKE(Problem, Law, with_spin)                               \
  if (std::holds_alternative<Law>(laws.contact_law) && spin == (with_spin)) \
    return std::make_unique<MoreauJean<Problem>>(laws, solver, solvers);
  DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_MAKE)
#undef DRUMLIN_MAKE
  throw std::logic_error("no contact problem for these effects");
}

std::unique_ptr<Stepper> make_stepper(const StepLaws& laws, const StepSolver& solver) {
  return make_stepper(laws, solver, contact_solvers(solver.name));
}

}  // namespace drumlin::particles
