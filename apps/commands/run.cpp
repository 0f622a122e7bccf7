// drumlin run: a particle run from a scene to snapshots, log and run.json; interruptible, and continued bit
// for bit.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/progress.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// log.csv, one line per logged step; cut back to a checkpoint's length on resuming.
class RunLog {
 public:
  RunLog(const fs::path& file, std::int64_t keep_bytes) : file_(file) {
    if (keep_bytes > 0) {
      if (!fs::exists(file) || fs::file_size(file) < static_cast<std::uintmax_t>(keep_bytes))
        throw InputError(file.string() +
                         ": is missing or shorter than the checkpoint says; start over with --overwrite");
      fs::resize_file(file, static_cast<std::uintmax_t>(keep_bytes));
    }
    out_.open(file, keep_bytes > 0 ? std::ios::app : std::ios::trunc);
    if (keep_bytes == 0)
      write(
          "step,time_s,stage,contacts,sweeps,residual,residual_max,penetration,overlap_mean,overlap_max,"
          "kinetic_energy,converged\n");
    bytes_ += keep_bytes;
  }
  void write(const std::string& line) {
    out_ << line;
    bytes_ += static_cast<std::int64_t>(line.size());
  }
  /// Everything so far reaches the file; returns its length.
  std::int64_t flush() {
    out_.flush();
    if (!out_) throw IoError(file_.string() + ": cannot write");
    // A checkpoint that outlives a power cut must not speak of lines that did not.
    const int descriptor = ::open(file_.c_str(), O_WRONLY);
    const bool synced = descriptor >= 0 && ::fsync(descriptor) == 0;
    if (descriptor >= 0) ::close(descriptor);
    if (!synced) throw IoError(file_.string() + ": cannot sync");
    return bytes_;
  }

 private:
  fs::path file_;
  std::ofstream out_;
  std::int64_t bytes_ = 0;
};

/// HDF5 files of a run, one at a time; with more than one thread beside the computation.
class BackgroundWriter {
 public:
  explicit BackgroundWriter(bool in_background)
      : policy_(in_background ? std::launch::async : std::launch::deferred) {}
  template <class Job>
  void write(Job job) {
    wait();
    pending_ = std::async(policy_, std::move(job));
    if (policy_ == std::launch::deferred) wait();
  }
  /// Rethrows what the last job threw.
  void wait() {
    if (pending_.valid()) pending_.get();
  }

 private:
  std::launch policy_;
  std::future<void> pending_;
};

class ParticleRun {
 public:
  ParticleRun(const RunOptions& options, const Scene& scene, std::string resolved,
              std::optional<Checkpoint> from)
      : options_(options),
        scene_(scene),
        resolved_(std::move(resolved)),
        totals_(from ? from->totals : RunTotals{}),
        simulation_(from ? Simulation(scene, std::move(from->state), options.threads)
                         : Simulation(scene, options.threads)),
        log_(options.output / "log.csv", from ? from->log_bytes : 0),
        writer_(options.threads > 1) {}

  int execute() {
    start_ = Clock::now();
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    cpu_before_ = cpu_seconds();
    steps_before_ = simulation_.state().step;
    write_report("running");
    while (!simulation_.finished()) {
      advance();
      if (simulated_seconds() >= next_checkpoint_s_) save_checkpoint();
      if (progress_.due()) progress_.show(progress_line());
      if (const int signal = interruption()) return stop_for(signal);
    }
    save_checkpoint();
    writer_.wait();
    write_report("finished");
    progress_.show(progress_line());
    progress_.finish();
    print_summary();
    return static_cast<int>(ExitCode::done);
  }

 private:
  double simulated_seconds() const { return simulation_.state().time() * simulation_.scales().time_s; }

  void advance() {
    last_ = simulation_.step();
    const auto& state = simulation_.state();
    const bool converged = last_.solve.status == Status::converged || last_.contacts == 0;
    totals_.unconverged_steps += !converged;
    totals_.sweeps += last_.solve.sweeps;
    totals_.contacts += last_.contacts;
    totals_.contact_sweeps += static_cast<double>(last_.contacts) * last_.solve.sweeps;
    totals_.residual_sum += last_.solve.judgement.residual;
    totals_.residual_max = std::max(totals_.residual_max, last_.solve.judgement.residual);
    totals_.overlap_sum += last_.overlap.mean;
    totals_.overlap_max = std::max(totals_.overlap_max, last_.overlap.max);
    totals_.detection_seconds += last_.detection_seconds;
    totals_.solver_seconds += last_.solve.seconds;
    if (state.step % scene_.output.log_every_steps == 0 || simulation_.finished()) log_step(converged);
    if (simulation_.snapshot_due()) save_snapshot();
    if (!converged && (scene_.solver.stop_when_unconverged || last_.solve.status == Status::not_finite))
      fail();
  }

  void log_step(bool converged) {
    const auto& state = simulation_.state();
    const auto& judged = last_.solve.judgement;
    log_.write(fmt::format("{},{:.9g},{},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.9g},{}\n", state.step,
                           simulated_seconds(), scene_.stages[state.stage].name, last_.contacts,
                           last_.solve.sweeps, judged.residual, judged.residual_max, judged.penetration,
                           last_.overlap.mean, last_.overlap.max, kinetic_energy(state.bodies),
                           converged ? 1 : 0));
  }

  void save_snapshot() {
    const auto begin = Clock::now();
    Snapshot snapshot = simulation_.take_snapshot();
    const fs::path file =
        options_.output / "snapshots" / fmt::format("{:06}.h5", simulation_.state().snapshots);
    writer_.write([file, snapshot = std::move(snapshot)] { write_snapshot(file, snapshot); });
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  void save_checkpoint() {
    const auto begin = Clock::now();
    Checkpoint checkpoint;
    checkpoint.scene = resolved_;
    checkpoint.log_bytes = log_.flush();
    checkpoint.totals = totals_now();
    checkpoint.state = simulation_.state();
    const fs::path file = options_.output / "checkpoint.h5";
    writer_.write([file, checkpoint = std::move(checkpoint)] { write_checkpoint(file, checkpoint); });
    next_checkpoint_s_ = simulated_seconds() + scene_.output.checkpoint_every_s;
    totals_.output_seconds += seconds_between(begin, Clock::now());
  }

  RunTotals totals_now() const {
    RunTotals totals = totals_;
    totals.wall_seconds += seconds_between(start_, Clock::now());
    totals.cpu_seconds += cpu_seconds() - cpu_before_;
    return totals;
  }

  void write_report(const std::string& status) const {
    const RunTotals t = totals_now();
    const auto& state = simulation_.state();
    const double steps = std::max<double>(1, static_cast<double>(state.step));
    nlohmann::ordered_json report;
    report["format"] = "drumlin-run-1";
    report["title"] = scene_.title;
    report["reduced"] = scene_.reduced;
    report["status"] = status;
    report["wall_seconds"] = t.wall_seconds;
    report["cpu_seconds"] = t.cpu_seconds;
    report["peak_memory_mb"] = peak_memory_mb();
    report["steps"] = state.step;
    report["steps_planned"] = simulation_.plan().steps;
    report["unconverged_steps"] = t.unconverged_steps;
    report["revision"] = provenance().revision;
    report["seed"] = scene_.seed;
    report["threads"] = options_.threads;
    report["grains"] = state.bodies.count();
    report["simulated_seconds"] = simulated_seconds();
    report["snapshots"] = state.snapshots;
    report["accuracy"] = {{"solver", scene_.solver.name},
                          {"tolerance", scene_.solver.tolerance},
                          {"residual_mean", t.residual_sum / steps},
                          {"residual_max", t.residual_max},
                          {"overlap_mean", t.overlap_sum / steps},
                          {"overlap_max", t.overlap_max}};
    report["cost"] = {
        {"contacts_mean", static_cast<double>(t.contacts) / steps},
        {"sweeps_mean", static_cast<double>(t.sweeps) / steps},
        {"ns_per_contact_and_sweep", t.contact_sweeps > 0 ? 1e9 * t.solver_seconds / t.contact_sweeps : 0},
        {"detection_seconds", t.detection_seconds},
        {"solver_seconds", t.solver_seconds},
        {"output_seconds", t.output_seconds},
        {"unknowns_per_contact", simulation_.stepper().unknowns_per_contact()},
        {"velocities_per_body", simulation_.stepper().velocities_per_body()}};
    report["scales"] = to_json(simulation_.scales());
    report["provenance"] = to_json(provenance());
    write_json(options_.output / "run.json", report);
  }

  std::string progress_line() const {
    const auto& state = simulation_.state();
    const auto total = simulation_.plan().steps;
    const double spent = seconds_between(start_, Clock::now());
    const double done = static_cast<double>(state.step - steps_before_);
    const double left = done > 0 ? spent / done * static_cast<double>(total - state.step) : 0;
    return fmt::format(
        "{}run {:5.1f} %  {}  t = {:.2f} s  contacts {}  sweeps {}  residual {:.1e}  overlap {:.1e} d  "
        "missed {}  left {}",
        scene_.reduced ? "reduced " : "",
        100.0 * static_cast<double>(state.step) / static_cast<double>(total), scene_.stages[state.stage].name,
        simulated_seconds(), last_.contacts, last_.solve.sweeps, last_.solve.judgement.residual,
        last_.overlap.mean, totals_.unconverged_steps, duration_text(left));
  }

  void print_summary() const {
    const RunTotals t = totals_now();
    const double steps = static_cast<double>(simulation_.state().step);
    fmt::print(
        "{}{} steps, {} snapshots in {} ({:.0f} s of processor time); {} steps missed a tolerance (residual "
        "{:g}, penetration {:g} d)\n"
        "mean residual {:.2g}, mean overlap {:.2g} d, largest {:.2g} d\n",
        scene_.reduced ? "reduced: " : "", simulation_.state().step, simulation_.state().snapshots,
        duration_text(t.wall_seconds), t.cpu_seconds, t.unconverged_steps, scene_.solver.tolerance,
        scene_.solver.penetration_tolerance, t.residual_sum / steps, t.overlap_sum / steps, t.overlap_max);
  }

  int stop_for(int signal) {
    save_checkpoint();
    writer_.wait();
    write_report("interrupted");
    progress_.finish();
    fmt::print(stderr, "interrupted after step {}; continue with --resume\n", simulation_.state().step);
    return static_cast<int>(signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted);
  }

  [[noreturn]] void fail() {
    writer_.wait();
    log_.flush();
    write_report("not converged");
    progress_.finish();
    const auto& judged = last_.solve.judgement;
    throw NotConvergedError(fmt::format(
        "step {}: contact solver {} ({}) after {} sweeps: residual {:.3g} (tolerance {:g}), penetration "
        "{:.3g} d (tolerance {:g})",
        simulation_.state().step, scene_.solver.name, to_string(last_.solve.status), last_.solve.sweeps,
        judged.residual, scene_.solver.tolerance, judged.penetration, scene_.solver.penetration_tolerance));
  }

  RunOptions options_;
  Scene scene_;
  std::string resolved_;
  RunTotals totals_;
  Simulation simulation_;
  RunLog log_;
  BackgroundWriter writer_;
  Progress progress_;
  StepReport last_;
  Clock::time_point start_;
  double cpu_before_ = 0;
  double next_checkpoint_s_ = 0;
  std::int64_t steps_before_ = 0;
};

bool is_finished(const fs::path& output) {
  return fs::exists(output / "run.json") &&
         read_json(output / "run.json", "drumlin-run-1").value("status", "") == "finished";
}

/// A folder continues only the scene that it was made from.
void same_scene_or_refuse(const fs::path& output, const std::string& theirs, const std::string& ours) {
  if (theirs != ours)
    throw InputError(output.string() +
                     ": was made from another scene (compare its scene.toml with `drumlin scene show`); "
                     "use --overwrite to start over");
}

const char* const grain_list = "grains.csv";

/// The scene as it stands in the run folder, which holds a copy of a grain list of its own.
Scene recorded(Scene scene) {
  if (auto* listed = std::get_if<ListedGrains>(&scene.grains.source)) listed->file = grain_list;
  return scene;
}

}  // namespace

int run(const RunOptions& options) {
  const Scene scene = read_scene(options.scene, options.overrides);
  // What only shows when grains are placed must show before anything is written or removed.
  (void)Simulation(scene);
  const auto* listed = std::get_if<ListedGrains>(&scene.grains.source);
  std::vector<fs::path> inputs{options.scene};
  if (listed != nullptr) inputs.push_back(listed->file);
  prepare_output(options.output, options.existing, {"run.json"}, inputs);
  const std::string resolved = scene_text(recorded(scene));
  std::optional<Checkpoint> from;
  if (options.existing == ExistingOutput::resume) {
    if (fs::exists(options.output / "scene.toml"))
      same_scene_or_refuse(options.output, file_text(options.output / "scene.toml"), resolved);
    if (listed != nullptr && fs::exists(options.output / grain_list))
      same_scene_or_refuse(options.output, file_text(options.output / grain_list), file_text(listed->file));
    if (is_finished(options.output)) {
      fmt::print("{}: already finished, nothing to do\n", options.output.string());
      return static_cast<int>(ExitCode::done);
    }
    if (fs::exists(options.output / "checkpoint.h5")) {
      from = read_checkpoint(options.output / "checkpoint.h5");
      same_scene_or_refuse(options.output, from->scene, resolved);
    }
  }
  fs::create_directories(options.output / "snapshots");
  if (listed != nullptr) replace_file(options.output / grain_list, file_text(listed->file));
  replace_file(options.output / "scene.toml", resolved);
  catch_interruptions();
  return ParticleRun(options, scene, resolved, std::move(from)).execute();
}

}  // namespace drumlin::apps
