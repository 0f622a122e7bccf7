#include "apps/run/rank_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/commands/run_files.hpp"
#include "apps/commands/run_log.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/commands/run_resume.hpp"
#include "apps/commands/start_grains.hpp"
#include "apps/commands/wall_table.hpp"
#include "apps/run/files_in_parts.hpp"
#include "apps/support/asked.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/progress.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/first_rank.hpp"
#include "coupling/common/last_whole.hpp"
#include "coupling/common/own_costs.hpp"
#include "coupling/common/provenance.hpp"
#include "coupling/common/text_file.hpp"
#include "particles/distributed/rank_simulation.hpp"
#include "particles/distributed/runs_on_ranks.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/placement.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/run_through.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

/// What one rank tells of its share at the end.
struct RankShare {
  particles::RankCounts counts;
  double cpu_seconds = 0, peak_memory_mb = 0;
};

/// Means per step of one rank, for run.json.
nlohmann::ordered_json to_json(const RankShare& share) {
  const particles::RankCounts& c = share.counts;
  const auto steps = static_cast<double>(std::max<std::int64_t>(1, c.steps));
  const auto sweeps = static_cast<double>(std::max<std::int64_t>(1, c.sweeps));
  const auto gathered = static_cast<double>(std::max<std::int64_t>(1, c.impacts.times));
  return {{"grains_mean", static_cast<double>(c.grains) / steps},
          {"ghosts_mean", static_cast<double>(c.ghosts) / steps},
          {"contacts_mean", static_cast<double>(c.contacts) / steps},
          {"halo_rounds_per_sweep", static_cast<double>(c.halo_rounds) / sweeps},
          {"halo_bytes_per_sweep", static_cast<double>(c.halo_bytes) / sweeps},
          {"rounds_per_step", static_cast<double>(c.rounds) / steps},
          {"coarse_corrections", c.corrections},
          {"impacts_gathered", c.impacts.times},
          {"impact_messages_mean", static_cast<double>(c.impacts.rounds) / gathered},
          {"impact_pairs_sent_mean", static_cast<double>(c.impacts.pairs) / gathered},
          {"impact_bytes_sent_mean", static_cast<double>(c.impacts.bytes) / gathered},
          {"forests", c.forests},
          {"sorts", c.sorts},
          {"step_seconds", c.step_seconds / steps},
          {"waiting_seconds", c.waiting_seconds / steps},
          {"cpu_seconds", share.cpu_seconds},
          {"peak_memory_mb", share.peak_memory_mb}};
}

/// What only the first rank has: the folder and what is written there.
struct FirstRank {
  FirstRank(const RunOptions& options, std::int64_t log_bytes)
      : log(options.output / log_name, log_header, log_bytes) {}
  RunTable log;
  Progress progress;
};

class RankRun {
 public:
  RankRun(const RunOptions& options, const particles::Ranks& ranks, GrowingOutput* output,
          const particles::Scene& scene, std::string resolved, std::optional<particles::Checkpoint> from,
          nlohmann::ordered_json started_from)
      : options_(options),
        ranks_(ranks),
        output_(output),
        scene_(scene),
        resolved_(std::move(resolved)),
        started_from_(std::move(started_from)),
        totals_(from ? from->totals : particles::RunTotals{}),
        log_bytes_(from ? from->log_bytes : 0),
        simulation_(from ? particles::RankSimulation(scene, std::move(from->state), ranks, options.threads)
                         : particles::RankSimulation(scene, ranks, options.threads)) {}

  int execute() {
    ranks_.on_first([&] { first_.emplace(options_, log_bytes_); });
    start_ = Clock::now(), cpu_before_ = own_cpu_seconds();
    steps_before_ = simulation_.progress().step;
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    write_report("running");
    while (!simulation_.finished()) {
      advance();
      if (simulated_seconds() >= next_checkpoint_s_) save_checkpoint();
      if (first_ && first_->progress.due()) first_->progress.show(line_of_progress());
      if (ranks_.any(interruption() != 0)) return stop();
    }
    save_checkpoint();
    write_report("finished");
    ranks_.on_first([&] {
      fs::remove(options_.output / passed_over_checkpoint_name);
      output_->finish();
      first_->progress.show(line_of_progress());
      first_->progress.finish();
      print_out(summary_);
    });
    return static_cast<int>(exit_code_of_missed(totals_.unconverged_steps, simulation_.progress().step));
  }

 private:
  double simulated_seconds() const { return simulation_.progress().time() * simulation_.scales().time_s; }

  void advance() {
    try {
      last_ = simulation_.step();
    } catch (const NotConvergedError& error) {  // on all ranks, while grains travel
      fail("grain lost", error.what(), simulation_.progress().step + 1, false);
    }
    const auto& state = simulation_.progress();
    const bool converged = particles::is_converged(last_);
    add_up(last_, state.step, converged, totals_);
    if (state.step % scene_.output.log_every_steps == 0 || simulation_.finished() || last_.lost) {
      const double energy = simulation_.kinetic_energy();
      if (first_)
        first_->log.write(log_line(last_, state.step, simulated_seconds(), scene_.stages[state.stage].name,
                                   energy, converged));
    }
    if (const auto fault = particles::fault_of(last_, scene_.solver)) {
      const bool numbers = !last_.lost || last_.lost->how != particles::LostGrain::How::not_finite;
      fail(fault->kind, fault->why, state.step, numbers);
    }
    if (simulation_.snapshot_due()) save_snapshot();
  }

  bool writes_in_parts() const { return ranks_.count() > 1 && simulation_.all_have_parts(); }

  void save_snapshot() {
    const auto begin = Clock::now();
    const particles::Snapshot part = simulation_.take_part_of_snapshot();
    const std::string name = snapshot_name(simulation_.progress().snapshots);
    if (writes_in_parts()) write_snapshot_in_parts(ranks_, options_.output / name, part);
    ranks_.on_first([&] {
      if (!writes_in_parts()) particles::write_snapshot(options_.output / name, part);
      output_->list(name);
    });
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  void save_checkpoint() {
    const auto begin = Clock::now();
    particles::Checkpoint checkpoint;
    simulation_.release_memory();
    checkpoint.state = simulation_.part_of_state();
    ranks_.on_first([&] {
      checkpoint.scene = resolved_;
      checkpoint.log_bytes = first_->log.flush();
      checkpoint.totals = totals_now();
      output_->manifest().files[log_name] = first_->log.entry();
      output_->save();
      if (!writes_in_parts()) particles::keep_checkpoint(options_.output, checkpoint);
    });
    if (writes_in_parts()) keep_checkpoint_in_parts(ranks_, options_.output, checkpoint);
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  particles::RunTotals totals_now() const {
    particles::RunTotals totals = totals_;
    totals.wall_seconds += seconds_between(start_, Clock::now());
    totals.cpu_seconds += own_cpu_seconds() - cpu_before_;
    return totals;
  }

  /// run.json and, at the end, the summary; the report is that of a run on one process, made of the gathered
  /// state, or, where grains are not whole, of those that the scene begins with.
  void write_report(const std::string& status, bool grains_are_whole = true) {
    particles::SimulationState state =
        grains_are_whole ? simulation_.gathered_state() : simulation_.progress();
    if (!grains_are_whole) state.bodies = particles::place_grains(scene_, simulation_.scales());
    const RankShare own{simulation_.counts(), own_cpu_seconds(), own_peak_memory_mb()};
    const auto shares = ranks_.gather<RankShare>(std::span(&own, 1));
    ranks_.on_first([&] {
      const particles::Simulation as_one(scene_, std::move(state));
      particles::RunTotals totals = totals_now();
      for (std::size_t r = 1; r < shares.size(); ++r) totals.cpu_seconds += shares[r].cpu_seconds;
      const RunProgress progress{scene_, as_one, totals, options_.threads};
      nlohmann::ordered_json report = run_report(progress, status);
      report["ranks"] = nlohmann::ordered_json::array();
      for (const RankShare& share : shares) report["ranks"].push_back(to_json(share));
      if (!started_from_.is_null()) report["started_from"] = started_from_;
      write_json(options_.output / "run.json", report);
      summary_ = run_summary(progress);
    });
  }

  std::string line_of_progress() const {
    const auto& state = simulation_.progress();
    const RunPosition at{scene_,
                         steps_before_,
                         state.step,
                         simulation_.plan().steps,
                         state.stage,
                         simulated_seconds(),
                         seconds_between(start_, Clock::now()),
                         totals_.unconverged_steps};
    return progress_line(fmt::format("run on {} ranks", ranks_.count()), at, last_);
  }

  int stop() {
    save_checkpoint();
    write_report("interrupted");
    const std::int64_t signal = -ranks_.least(-interruption());  // of those that had one
    if (first_) {
      first_->progress.finish();
      print_error(
          fmt::format("interrupted after step {}; continue with --resume\n", simulation_.progress().step));
    }
    return exit_code_of(static_cast<int>(signal));
  }

  /// The last step must not be built upon: no checkpoint of it is written. All ranks come here together.
  /// `grains_are_whole`: a state that is no numbers, or is on its way, makes no simulation to report on.
  [[noreturn]] void fail(const std::string& status, const std::string& why, std::int64_t step,
                         bool grains_are_whole) {
    ranks_.on_first([&] { first_->log.flush(); });
    write_report(status, grains_are_whole);
    throw NotConvergedError(fmt::format("step {}: {}", step, why));
  }

  RunOptions options_;
  particles::Ranks ranks_;
  GrowingOutput* output_;  // of the first rank alone
  particles::Scene scene_;
  std::string resolved_;
  nlohmann::ordered_json started_from_;  // null where the grains are those of the scene alone
  particles::RunTotals totals_;
  std::int64_t log_bytes_ = 0;
  particles::RankSimulation simulation_;
  std::optional<FirstRank> first_;  // of the first rank alone
  particles::StepReport last_;
  Clock::time_point start_;
  double cpu_before_ = 0;
  double next_checkpoint_s_ = 0;
  std::int64_t steps_before_ = 0;
  std::string summary_;
};

void require_known(const RunOptions& options, const particles::Scene& scene) {
  std::vector<InputProblem> problems = particles::not_on_ranks(scene);
  for (InputProblem& problem : problems) problem.file = options.scene.string();
  if (options.extend_seconds > 0)
    problems.push_back({"", 0, 0, "--extend", "not on ranks", "drumlin run, on one process"});
  if (options.accuracy_seconds > 0 || options.accuracy)
    problems.push_back({"", 0, 0, "--accuracy", "not on ranks", "drumlin run, on one process"});
  if (options.ranks)
    problems.push_back(
        {"", 0, 0, "--ranks", "not here: mpirun says how many ranks there are", "mpirun -n N drumlin-run"});
  if (!problems.empty()) throw InputError(problems);
}

/// Claims the folder and says whether a run that stands there is gone on with; nothing where it is finished.
std::optional<bool> goes_on(const RunOptions& options, const particles::Scene& scene,
                            const std::string& resolved, std::optional<GrowingOutput>& output) {
  std::vector<fs::path> inputs{options.scene};
  particles::Scene lists = scene;
  for (const auto* list : lists_of(lists)) inputs.push_back(list->file);
  if (options.existing == ExistingOutput::resume && is_finished(options.output, scene, resolved))
    return std::nullopt;
  output.emplace(OutputRequest{options.output, options.existing, "run", inputs}, run_file_names());
  std::optional<particles::Checkpoint> from;
  if (options.existing == ExistingOutput::resume) {
    same_run_or_refuse(options.output, scene, resolved);
    same_engine_or_refuse(options.output, true);
    from = checkpoint_in(options.output, resolved);
    if (from) (void)particles::Simulation(scene, from->state);  // refuses what does not fit
  }
  cut_back(*output, from);
  make_folders(options.output / "snapshots");
  for (const auto& [name, text] : list_texts(scene)) {
    replace_file(options.output / name, text);
    output->list(name);
  }
  replace_file(options.output / "scene.toml", resolved);
  output->list("scene.toml");
  output->save();
  return from.has_value();
}

}  // namespace

int run_on_ranks(const RunOptions& options, const particles::Ranks& ranks) {
  // One of several machines may not see a file.
  const auto on_all = [&](const std::function<void()>& action) {
    do_on_all_ranks(
        ranks.rank(), action, [&](std::int64_t number) { return ranks.least(number); },
        [](const std::string& what) { print_error(what + "\n"); });
  };
  particles::Scene scene;
  nlohmann::ordered_json started_from;
  on_all([&] {
    scene = particles::read_scene(options.scene, options.overrides);
    started_from = take_over_grains(scene);
    require_known(options, scene);
  });
  const std::string resolved = particles::scene_text(as_recorded(scene));
  ranks.require_same(asked_sum({version_text(), resolved, list_texts(scene), started_from}),
                     "scene, grains or revision are");
  // What only shows when grains are placed must show before anything is written or removed.
  ranks.on_first([&] { (void)particles::Simulation(scene); });
  const CaughtInterruptions caught;
  std::optional<GrowingOutput> output;
  std::vector<int> how(1, 0);  // 0: finished already, 1: from the start, 2: from a checkpoint
  ranks.on_first([&] {
    if (const auto on = goes_on(options, scene, resolved, output)) how[0] = *on ? 2 : 1;
  });
  ranks.broadcast(how);
  if (how[0] == 0) return static_cast<int>(ExitCode::done);
  std::optional<particles::Checkpoint> from;
  if (how[0] == 2) {
    on_all([&] {
      auto last = last_whole_checkpoint(options.output, particles::read_checkpoint);
      if (!last) throw IoError(options.output.string() + ": no checkpoint is to be seen there");
      from = std::move(last->content);
    });
    const std::int64_t step = from->state.step, least = ranks.least(step), most = -ranks.least(-step);
    ranks.on_first([&] {
      if (least != most)
        throw IoError(fmt::format("{}: ranks see checkpoints of different steps, {} and {}",
                                  options.output.string(), least, most));
    });
  }
  return RankRun(options, ranks, output ? &*output : nullptr, scene, resolved, std::move(from), started_from)
      .execute();
}

}  // namespace drumlin::apps
