// drumlin run: a particle run from a scene to snapshots, log and run.json; interruptible, and continued bit
// for bit.
#include "apps/commands/run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/commands/accuracy_statement.hpp"
#include "apps/commands/expected_output.hpp"
#include "apps/commands/followers.hpp"
#include "apps/commands/region_table.hpp"
#include "apps/commands/run_accuracy.hpp"
#include "apps/commands/run_files.hpp"
#include "apps/commands/run_log.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/commands/run_resume.hpp"
#include "apps/commands/start_grains.hpp"
#include "apps/commands/wall_table.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/next_step.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/progress.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/lab/block_problem.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "particles/parallel/large_arrays.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

class ParticleRun {
 public:
  ParticleRun(const RunOptions& options, GrowingOutput& output, const particles::Scene& scene,
              std::string resolved, std::optional<particles::Checkpoint> from,
              nlohmann::ordered_json started_from, const Followers& followers)
      : options_(options),
        output_(output),
        followers_(followers),
        goes_on_(from.has_value()),
        scene_(scene),
        resolved_(std::move(resolved)),
        started_from_(std::move(started_from)),
        totals_(from ? from->totals : particles::RunTotals{}),
        simulation_(
            from ? particles::Simulation(scene, std::move(from->state), options.threads, followers.world())
                 : particles::Simulation(scene, options.threads, followers.world())),
        log_(options.output / log_name, log_header, from ? from->log_bytes : 0),
        energy_bytes_(from ? from->energy_bytes : 0),
        walls_bytes_(from ? from->walls_bytes : 0),
        regions_bytes_(from ? from->regions_bytes : 0),
        writer_(options.threads > 1) {}

  int execute() {
    start_ = Clock::now();
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    cpu_before_ = own_cpu_seconds();
    steps_before_ = simulation_.state().step;
    followers_.begin(options_.output, goes_on_, options_.threads, simulation_);
    write_report(RunStatus::running);
    while (!simulation_.finished()) {
      advance();
      if (simulated_seconds() >= next_checkpoint_s_) save_checkpoint();
      if (progress_.due()) progress_.show(line_of_progress());
      if (const int signal = interruption()) return stop_for(signal);
    }
    save_checkpoint();
    writer_.wait();
    if (options_.accuracy_seconds) {
      try {
        tell_accuracy();
      } catch (const Interrupted& by) {
        return stop_for(by.signal);
      }
    }
    write_report(RunStatus::finished);
    fs::remove(options_.output / passed_over_checkpoint_name);
    output_.finish();
    progress_.show(line_of_progress());
    progress_.finish();
    print_out(run_summary(progress_now()) + accuracy_text() + next_text());
    return static_cast<int>(exit_code_of_missed(totals_.unconverged_steps, simulation_.state().step));
  }

 private:
  /// A signal that came while accuracy was told.
  struct Interrupted {
    int signal;
  };

  std::string next_text() const {
    const bool in_a_drum = std::ranges::any_of(scene_.walls, [](const particles::Wall& wall) {
      return std::holds_alternative<particles::ContainerShape>(wall.shape);
    });
    return next_step("run",
                     in_a_drum           ? Flowing::drum
                     : scene_.periodic_x ? Flowing::layers
                                         : Flowing::open,
                     simulation_.state().snapshots > 0 ? Verdict::done : Verdict::no_snapshots,
                     options_.output.string());
  }

  void tell_accuracy() {
    stretches_ = to_json(particles::paired_stretches(
        scene_, simulation_.state(), *options_.accuracy_seconds, options_.threads, [&] {
          if (progress_.due()) progress_.show("run finished; stretches for its accuracy");
          if (const int signal = interruption()) throw Interrupted{signal};
        }));
  }

  double simulated_seconds() const { return simulation_.state().time() * simulation_.scales().time_s; }

  void advance() {
    try {
      last_ = followers_.step(simulation_);
    } catch (const NotConvergedError& error) {  // the step could not be taken, or leaves no state
      fail(RunStatus::not_converged, error.what(), simulation_.state().step + 1);
    }
    const auto& state = simulation_.state();
    const bool converged = particles::is_converged(last_);
    add_up(last_, simulation_, converged, totals_);
    if (state.step % scene_.output.log_every_steps == 0 || simulation_.finished() || last_.lost)
      log_step(converged);
    const bool fatal = !converged && (scene_.solver.stop_when_unconverged ||
                                      last_.solve.status == particles::Status::not_finite);
    if (!converged && (totals_.unconverged_steps <= scene_.solver.capture_unconverged ||
                       (fatal && scene_.solver.capture_unconverged > 0)))
      capture_problem();
    if (const auto fault = particles::fault_of(last_, scene_.solver))
      fail(fault->status, fault->why, state.step);
    if (simulation_.wall_loads_due()) write_wall_loads();
    if (simulation_.snapshot_due()) save_snapshot();
  }

  void log_step(bool converged) {
    const auto& state = simulation_.state();
    log_.write(log_line(last_, state.step, simulated_seconds(), scene_.stages[state.stage].name,
                        kinetic_energy(state.bodies), converged));
    if (state.energy) log_energy(*state.energy);
    if (state.traffic) {
      if (!regions_)
        regions_.emplace(options_.output / region_table_name, region_table_header, regions_bytes_);
      regions_->write(region_lines(scene_, simulation_));
    }
  }

  void log_energy(const particles::EnergyLedger& energy) {
    std::string header = "step,time_s,kinetic,potential", line;
    line =
        fmt::format("{},{:.9g},{:.15g},{:.15g}", simulation_.state().step, simulated_seconds(),
                    energy.kinetic - energy.kinetic_at_start, energy.potential - energy.potential_at_start);
    for (const auto& [name, work] : particles::exchanges(energy)) {
      header += "," + name;
      line += fmt::format(",{:.15g}", work);
    }
    if (!energy_) energy_.emplace(options_.output / energy_name, header + ",closing_error\n", energy_bytes_);
    energy_->write(line + fmt::format(",{:.3g}\n", particles::closing_error(energy)));
  }

  void write_wall_loads() {
    if (!walls_) walls_.emplace(options_.output / wall_table_name, wall_table_header, walls_bytes_);
    walls_->write(wall_lines(simulation_));
  }

  /// The problem of the last step, for `drumlin solve-contacts`.
  void capture_problem() {
    const auto begin = Clock::now();
    const auto problem = particles::block_problem(simulation_.stepper().last_problem());
    const auto step = simulation_.state().step;
    const std::string name = fmt::format("problems/step-{:06}.h5", step);
    const fs::path file = options_.output / name;
    make_folders(file.parent_path());
    particles::write_contact_problem(file, problem.value(), simulation_.last_places(),
                                     fmt::format("{}, step {}, {} to residual {:.3g}", scene_.title, step,
                                                 scene_.solver.name, last_.solve.residual.rms));
    writer_.wait();  // it lists files too
    output_.list(name);
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  void save_snapshot() {
    const auto begin = Clock::now();
    simulation_.release_memory();
    std::string image = particles::snapshot_image(simulation_.take_snapshot());
    const std::string name = snapshot_name(simulation_.state().snapshots);
    writer_.write([this, name, image = std::move(image)]() mutable {
      replace_file(options_.output / name, std::exchange(image, {}));
      output_.list(name);
    });
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  void save_checkpoint() {
    const auto begin = Clock::now();
    simulation_.release_memory();
    particles::Checkpoint checkpoint;
    checkpoint.scene = resolved_;
    checkpoint.log_bytes = log_.flush();
    checkpoint.energy_bytes = energy_ ? energy_->flush() : energy_bytes_;
    checkpoint.walls_bytes = walls_ ? walls_->flush() : walls_bytes_;
    checkpoint.regions_bytes = regions_ ? regions_->flush() : regions_bytes_;
    costs_ = followers_.costs();
    checkpoint.totals = totals_now();
    checkpoint.state = simulation_.state();
    std::map<std::string, ManifestEntry> tables{{log_name, log_.entry()}};
    if (energy_) tables[energy_name] = energy_->entry();
    if (walls_) tables[wall_table_name] = walls_->entry();
    if (regions_) tables[region_table_name] = regions_->entry();
    // The manifest first: what a checkpoint builds on is listed.
    writer_.write(
        [this, tables = std::move(tables), image = particles::checkpoint_image(checkpoint)]() mutable {
          for (const auto& [name, entry] : tables) output_.manifest().files[name] = entry;
          output_.save();
          particles::keep_checkpoint(options_.output, std::exchange(image, {}));
        });
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  particles::RunTotals totals_now() const {
    particles::RunTotals totals = totals_;
    totals.wall_seconds += seconds_between(start_, Clock::now());
    totals.cpu_seconds += own_cpu_seconds() - cpu_before_;
    for (std::size_t rank = 1; rank < costs_.size(); ++rank) totals.cpu_seconds += costs_[rank].cpu_seconds;
    return totals;
  }

  RunProgress progress_now() const { return {scene_, simulation_, totals_now(), options_.threads}; }

  void write_report(RunStatus status) {
    costs_ = followers_.costs();
    RunRecord record = run_report(progress_now(), status);
    if (!stretches_.is_null()) record.accuracy.json["stretches"] = stretches_;
    record.started_from.json = started_from_;
    if (!costs_.empty()) record.ranks.json = costs_;
    write_json(options_.output / "run.json", record);
  }

  std::string line_of_progress() const {
    const auto& state = simulation_.state();
    const RunPosition at{scene_,
                         steps_before_,
                         state.step,
                         simulation_.plan().steps,
                         state.stage,
                         simulated_seconds(),
                         seconds_between(start_, Clock::now()),
                         totals_.unconverged_steps};
    const std::string run =
        followers_.world() ? fmt::format("run on {} ranks", followers_.world()->ranks()) : "run";
    return progress_line(run, at, last_);
  }

  int stop_for(int signal) {
    save_checkpoint();
    writer_.wait();
    write_report(RunStatus::interrupted);
    progress_.finish();
    print_error(fmt::format("interrupted after step {}; continue with --resume\n", simulation_.state().step));
    return exit_code_of(signal);
  }

  /// What the settings leave of error; averages have no interval before they are measured.
  std::string accuracy_text() const {
    const auto record = accuracy_record(options_.accuracy, scene_);
    const RunCost cost{.cpu_seconds = totals_now().cpu_seconds, .simulated_seconds = simulated_seconds()};
    if (!stretches_.is_null()) return text_of_stretches(stretches_, cost.cpu_seconds);
    return text_of(accuracy_statement(scene_, record, {}, cost), {}) +
           (record ? "" : price_of_stretches(cost.cpu_seconds, cost.simulated_seconds));
  }

  /// The last step must not be built upon: no checkpoint of it is written.
  [[noreturn]] void fail(RunStatus status, const std::string& why, std::int64_t step) {
    writer_.wait();
    log_.flush();
    if (energy_) energy_->flush();
    if (walls_) walls_->flush();
    if (regions_) regions_->flush();
    write_report(status);
    progress_.finish();
    throw NotConvergedError(fmt::format("step {}: {}", step, why));
  }

  RunOptions options_;
  GrowingOutput& output_;
  Followers followers_;
  bool goes_on_;  // from a checkpoint
  particles::Scene scene_;
  std::string resolved_;
  nlohmann::ordered_json started_from_;  // null where the grains are those of the scene alone
  particles::RunTotals totals_;
  particles::Simulation simulation_;
  RunTable log_;
  std::optional<RunTable> energy_;   // opened with the first step: its columns depend on the scene
  std::int64_t energy_bytes_ = 0;    // of energy.csv at the checkpoint that the run continues
  std::optional<RunTable> walls_;    // opened with the first interval
  std::int64_t walls_bytes_ = 0;     // as energy_bytes_
  std::optional<RunTable> regions_;  // opened with the first line of the log
  std::int64_t regions_bytes_ = 0;
  BackgroundWriter writer_;
  std::vector<RankCosts> costs_;  // of all ranks, when they were last asked
  Progress progress_;
  particles::StepReport last_;
  Clock::time_point start_;
  double cpu_before_ = 0;
  double next_checkpoint_s_ = 0;
  std::int64_t steps_before_ = 0;
  nlohmann::ordered_json stretches_;  ///< accuracy.stretches of run.json; null: none were asked for
};

/// Lets the lists of grains that are in memory be those that stand in the run folder.
void read_lists_from(const fs::path& folder, particles::Scene& scene) {
  const auto names = particles::grain_list_names(scene);
  const auto lists = lists_of(scene);
  for (std::size_t k = 0; k < lists.size(); ++k)
    if (lists[k]->text) lists[k]->file = folder / names[k], lists[k]->text.reset();
}

/// Stretches are cut into blocks of whole steps, and must come to an end.
void check_stretches(std::optional<double> requested, const particles::Scene& scene) {
  if (!requested) return;
  constexpr double most_steps = 1e9;
  const double seconds = *requested, h = scene.stages.back().time_step_s, steps = seconds / h;
  if (steps >= particles::stretch_blocks && steps <= most_steps) return;
  throw InputError(
      {InputProblem{"", 0, 0, "--accuracy-seconds", fmt::format("is {:g} s, {:.3g} steps", seconds, steps),
                    fmt::format("{:g} to {:g} s", particles::stretch_blocks * h, most_steps * h)}});
}

}  // namespace

int run(const RunOptions& options, particles::World* world) {
  if (world != nullptr && options.ranks)
    throw InputError({InputProblem{"", 0, 0, "--ranks", "not here: mpirun says how many ranks there are",
                                   "mpirun -n N drumlin-run"}});
  particles::release_large_arrays(1 << 18);
  particles::Scene scene = particles::read_scene(options.scene, options.overrides);
  const nlohmann::ordered_json started_from = take_over_grains(scene);
  // What only shows when grains are placed must show before anything is written or removed.
  const std::size_t grains = particles::Simulation(scene).state().bodies.count();
  if (options.accuracy) (void)accuracy_record(options.accuracy, scene);
  check_stretches(options.accuracy_seconds, scene);
  std::vector<fs::path> inputs{options.scene};
  for (const auto* list : lists_of(scene)) inputs.push_back(list->file);
  const CaughtInterruptions caught;
  const bool longer = options.extend_seconds.has_value();
  const ExistingOutput existing = longer ? ExistingOutput::resume : options.existing;
  std::string resolved = particles::scene_text(particles::as_recorded(scene));
  if (options.existing == ExistingOutput::resume && !longer && is_finished(options.output, scene, resolved))
    return static_cast<int>(ExitCode::done);
  GrowingOutput output({options.output, existing, "run", inputs}, run_file_names());
  std::optional<particles::Checkpoint> from;
  if (existing == ExistingOutput::resume) {
    same_run_or_refuse(options.output, scene, resolved);
    from = checkpoint_in(options.output, resolved);
  }
  if (longer) {
    extend(output, *options.extend_seconds, scene, from);
    resolved = from->scene;
  }
  cut_back(output, from);
  make_folders(options.output / "snapshots");
  for (const auto& [name, text] : list_texts(scene)) {
    replace_file(options.output / name, text);
    output.list(name);
  }
  replace_file(options.output / "scene.toml", resolved);
  output.list("scene.toml");
  output.save();
  if (!from) {
    const particles::TimePlan plan = particles::time_plan(scene, scales_of(scene));
    const ExpectedOutput expected = expected_output(scene, grains, plan.snapshot_steps.size(), plan.steps);
    if (const std::string warning = room_warning(expected, options.output); !warning.empty())
      print_error(fmt::format("warning: {}\n", warning));
  }
  read_lists_from(options.output, scene);
  return ParticleRun(options, output, scene, resolved, std::move(from), started_from, Followers(world))
      .execute();
}

Command run_command() {
  return command<RunOptions>("run", "Runs a particle scene", [](const RunOptions& options) {
    return options.ranks ? run_by_mpirun(options) : run(options);
  });
}

}  // namespace drumlin::apps
