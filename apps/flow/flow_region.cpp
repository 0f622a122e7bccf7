#include "apps/flow/flow_region.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "apps/flow/flow_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/next_step.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/request_sum.hpp"
#include "apps/process/standard_streams.hpp"
#include "continuum/fem/scene_options.hpp"
#include "continuum/io/region_state_file.hpp"
#include "continuum/time_stepping/region_run.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/frames_file.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using continuum::KeptRegion;
using continuum::RegionStep;
using Json = nlohmann::ordered_json;

constexpr const char *series_file = "series.csv", *result_file = "flow.json";

struct RegionRequest {
  continuum::FlowScene scene;
  RheologyFit law;
  continuum::RegionFlow flow;
  std::string scene_text, law_text, sum;
  Scales scales;
};

std::string frame_file(std::size_t number) { return fmt::format("frames/{:04}.h5", number); }

RegionRequest region_request(const FlowOptions& options) {
  RegionRequest asked;
  asked.scene = continuum::read_flow_scene(options.scene, options.overrides);
  asked.law = read_rheology(options.rheology);
  asked.scales = scales_of(asked.scene);
  const auto refuse = [&](const char* key, const char* what) {
    throw InputError({InputProblem{
        .file = options.scene.string(), .key = key, .what = what, .allowed = "absent for a region"}});
  };
  if (options.from) refuse("--from", "starts no flow of a region, which starts from its fill");
  if (options.law_draws > 0) refuse("--law-draws", "knows no flow of a region");
  asked.flow = continuum::region_flow(asked.scene, asked.law);
  asked.scene_text = continuum::flow_scene_text(asked.scene);
  asked.law_text = file_text(options.rheology);
  asked.sum = requested_sum(described(options), {asked.scene_text});
  return asked;
}

std::string series_line(const RegionStep& step, const Scales& scales) {
  const auto& s = step.sums;
  return fmt::format(
      "{},{:.10g},{:.10g},{:.6g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{:.3e}\n",
      step.step, step.time, step.time * scales.time_s, step.time_step, step.area, step.discharged,
      step.discharge_rate, step.fastest, s.kinetic_energy, s.weight_power, s.dissipation, step.energy_error,
      step.cells, step.iterations, step.residual);
}
constexpr const char* series_head =
    "# "
    "drumlin-flow-series-1\nstep,time,time_s,time_step,area,discharged,discharge_rate,fastest,kinetic_energy,"
    "weight_power,dissipation,energy_error,cells,iterations,residual\n";

void print_step(const RegionStep& step, double end, const Scales& scales) {
  print_out(
      fmt::format("step {:4}  {:.4g} of {:.4g} s  fastest {:.3g}  {} cells  it {:2}  residual {:.1e}{}\n",
                  step.step, step.time * scales.time_s, end * scales.time_s, step.fastest, step.cells,
                  step.iterations, step.residual, step.remeshed ? "  meshed anew" : ""));
  flush_out();
}

// A flow of a region on its way through its frames.
class RegionRun {
 public:
  RegionRun(const RegionRequest& asked, double coarsening)
      : march_(continuum::region_march(asked.flow, coarsening)),
        request_(continuum::frame_request(asked.flow)),
        times_(continuum::frame_times(asked.flow)),
        options_(continuum::solver_options(asked.scene)) {
    kept_.state = continuum::filled(march_);
    kept_.scene = asked.scene_text;
    kept_.law = asked.law_text;
  }

  /// Goes on behind the frames that are there.
  void take_over(const KeptRegion& kept) {
    kept_ = kept;
    add_frame(field());
  }
  /// From the last frame to the end; `kept` sees each new frame, `stepped` each step.
  void march(const std::function<void(const KeptRegion&, std::size_t number)>& kept,
             const std::function<void(const RegionStep&)>& stepped) {
    if (frames_.empty()) {
      add_frame(field());
      if (kept) kept(kept_, 0);
    }
    while (frames_.size() < times_.size()) {
      continuum::RegionMarch march = march_;
      march.end = times_[frames_.size()];
      continuum::RegionObserver observer;
      observer.interrupted = [] { return interruption() != 0; };
      observer.stepped = [&](const RegionStep& step) {
        kept_.step = step;
        if (stepped) stepped(step);
      };
      observer.ended = [&](const continuum::FlowField& field) { add_frame(field); };
      const continuum::FlowReport report = continuum::march_region(march, kept_.state, options_, observer);
      cells_ = std::max(cells_, kept_.step.cells);
      if (report.interrupted) return;
      if (!report.converged) throw NotConvergedError("the flow did not converge: " + report.failure);
      if (kept) kept(kept_, frames_.size() - 1);
    }
  }
  const std::vector<Frame>& frames() const { return frames_; }
  const std::vector<double>& times() const { return times_; }
  const continuum::FrameRequest& request() const { return request_; }
  const KeptRegion& last() const { return kept_; }
  int most_cells() const { return cells_; }
  continuum::FlowField field() const { return continuum::flow_of(march_, kept_.state); }

 private:
  void add_frame(const continuum::FlowField& field) {
    frames_.push_back(continuum::region_frame(request_, march_.region, kept_.state, kept_.step, field));
  }

  continuum::RegionMarch march_;
  continuum::FrameRequest request_;
  std::vector<double> times_;
  continuum::FlowSolverOptions options_;
  KeptRegion kept_;
  std::vector<Frame> frames_;
  int cells_ = 0;
};

// The frames that an interrupted run has left, up to the first that is missing.
void take_over_frames(const fs::path& folder, const RegionRequest& asked, RegionRun& run) {
  for (std::size_t k = 0; k < run.times().size() && fs::exists(folder / frame_file(k)); ++k) {
    const KeptRegion kept = continuum::read_region_state(folder / frame_file(k));
    if (kept.scene != asked.scene_text || kept.law != asked.law_text)
      throw InputError(folder.string() + ": was left by another scene or law; --overwrite starts over");
    run.take_over(kept);
  }
}

// Lines of the steps up to the one that the run goes on from.
std::string series_up_to(const fs::path& folder, int steps) {
  if (steps == 0 || !fs::exists(folder / series_file)) return series_head;
  std::string kept;
  std::istringstream lines(file_text(folder / series_file));
  for (std::string line; std::getline(lines, line);)
    if (line.empty() || line.front() < '0' || line.front() > '9' || std::stoi(line) <= steps)
      kept += line + "\n";
  return kept;
}

Frames frames_of(const RegionRequest& asked, const RegionRun& run) {
  Frames frames;
  frames.grid = run.request().grid;
  frames.header.side = RunSide::continuum;
  frames.header.title = asked.scene.title;
  frames.header.reduced = asked.scene.reduced || asked.law.reduced;
  frames.header.revision = provenance().revision;
  frames.header.diameter_m = asked.scales.length_m;
  frames.header.kernel_width = run.request().kernel_width;
  frames.scales = asked.scales;
  frames.nu_bulk = asked.flow.nu;
  frames.runs = {"continuum"};
  frames.times = run.times();
  frames.frames = run.frames();
  return frames;
}

double relative_energy_error(const continuum::RegionTotals& totals) {
  return totals.weight_work != 0 ? std::abs(totals.energy_error / totals.weight_work) : 0;
}

Json or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// What twice the cells and twice the step change, and what the error then is at the order that is found.
Json accuracy_json(const RegionRun& run, const RegionRun& coarser, const std::optional<RegionRun>& coarsest,
                   double cpu_seconds) {
  Json list = Json::array();
  double worst = 0;
  const auto twice = continuum::differences(run.frames(), coarser.frames(), run.times());
  std::vector<continuum::FrameDifference> four_times;
  if (coarsest) four_times = continuum::differences(coarser.frames(), coarsest->frames(), run.times());
  const auto accuracy = continuum::region_accuracy(twice, four_times);
  for (const auto& d : twice) {
    worst = std::max(worst, d.height_rms);
    list.push_back({{"time", d.time},
                    {"height_rms", d.height_rms},
                    {"centre_x", d.centre_x},
                    {"centre_z", d.centre_z},
                    {"discharged", d.discharged}});
  }
  return {{"twice_cells_and_step", list},
          {"height_rms_largest", worst},
          {"height_rms", accuracy.change},
          {"order", or_null(accuracy.order)},
          {"height_error", or_null(accuracy.error)},
          {"cpu_seconds", cpu_seconds}};
}

double cpu_seconds_since(std::clock_t begun) {
  return static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
}

Json region_json(const RegionRequest& asked, const RegionRun& run, double cpu_seconds, const Json& accuracy) {
  const continuum::RegionState& state = run.last().state;
  const continuum::RegionTotals& totals = state.totals;
  const Frame& last = run.frames().back();
  Json content{{"format", FlowRecord::format},
               {"reduced", asked.scene.reduced || asked.law.reduced},
               {"geometry", "region"}};
  for (const auto& [name, value] : last.scalars) content[name] = value;
  content["nu"] = asked.law.nu;
  content["steps"] = state.steps;
  content["iterations"] = totals.iterations;
  content["cells"] = run.most_cells();
  content["checks"] = {{"mass", totals.mass_error}, {"energy", relative_energy_error(totals)}};
  content["missed"] = Json::array();
  content["cpu_seconds"] = cpu_seconds;
  content["accuracy"] = accuracy;
  content["settings"] = {
      {"title", asked.scene.title}, {"law", law_json(asked.law)}, {"scales", asked.scales}};
  content["provenance"] = provenance();
  return content;
}

void begin_region_folder(const FlowOptions& options, const RegionRequest& asked, GrowingOutput& output) {
  replace_file(options.output / "flow_scene.toml", asked.scene_text);
  replace_file(options.output / "rheology.toml", asked.law_text);
  for (const char* name : {"flow_scene.toml", "rheology.toml"}) output.list(name);
  output.save();
  fs::create_directories(options.output / "frames");
  print_out(fmt::format("{}: a region with a free surface, nu = {:.3f}, {}\n", asked.scene.title,
                        asked.law.nu, described(asked.law.mu)));
}

std::string accuracy_text(const Json& accuracy) {
  std::string text =
      fmt::format("twice the cells and the step change the height by {:.2g} of the fill's (rms)",
                  accuracy["height_rms"].get<double>());
  if (!accuracy["order"].is_null()) text += fmt::format(", order {:.2g}", accuracy["order"].get<double>());
  if (!accuracy["height_error"].is_null())
    text += fmt::format(", error {:.2g}", accuracy["height_error"].get<double>());
  return text + "\n";
}

std::string finished_region_text(const fs::path& folder, const Json& content) {
  const Json& checks = content["checks"];
  std::string text = fmt::format(
      "{}: {} steps, {} iterations, {:.1f} processor seconds; mass to {:.1e}, energy to {:.1e} of the "
      "weight's work\n",
      folder.string(), content["steps"].get<int>(), content["iterations"].get<int>(),
      content["cpu_seconds"].get<double>(), checks["mass"].get<double>(), checks["energy"].get<double>());
  if (!content["accuracy"].is_null()) text += accuracy_text(content["accuracy"]);
  return text;
}

}  // namespace

int solve_region_scene(const FlowOptions& options, const continuum::FemRuntime& runtime) {
  if (runtime.ranks() > 1) throw InputError("a flow of a region runs on one rank");
  const RegionRequest asked = region_request(options);
  const continuum::FlowScene& scene = asked.scene;
  const fs::path& folder = options.output;
  if (options.existing == ExistingOutput::resume && holds_results(folder, result_file)) {
    refuse_other(folder, asked.sum);
    print_out(fmt::format("{}: done already\n", folder.string()));
    return static_cast<int>(ExitCode::done);
  }
  GrowingOutput output({folder, options.existing, "flow", {options.scene, options.rheology}, {}, asked.sum},
                       {"flow_scene.toml", "rheology.toml", series_file, "frames/*.h5", "frames.h5",
                        "flow.vtu", result_file, "frames.png", "series.png"});
  RegionRun run(asked, 1);
  if (options.existing == ExistingOutput::resume) take_over_frames(folder, asked, run);
  begin_region_folder(options, asked, output);
  std::string series = series_up_to(folder, run.last().state.steps);
  const std::clock_t begun = std::clock();
  {
    const CaughtInterruptions caught;
    run.march(
        [&](const KeptRegion& kept, std::size_t number) {
          continuum::write_region_state(folder / frame_file(number), kept);
          replace_file(folder / series_file, series);
          for (const std::string& name : {frame_file(number), std::string(series_file)}) output.list(name);
          output.manifest().files.at(series_file).grows = true;
          output.save();
        },
        [&](const RegionStep& step) {
          series += series_line(step, asked.scales);
          print_step(step, asked.flow.end, asked.scales);
        });
    if (const int signal = interruption(); signal != 0) return exit_code_of(signal);
  }
  const double cpu_seconds = cpu_seconds_since(begun);
  Json accuracy = nullptr;
  if (scene.solver.sensitivity) {
    const std::clock_t coarser_begun = std::clock();
    RegionRun coarser(asked, 2);
    const CaughtInterruptions caught;
    coarser.march({}, {});
    std::optional<RegionRun> coarsest(std::in_place, asked, 4);
    try {
      coarsest->march({}, {});
    } catch (const NotConvergedError&) {  // cells too large for the flow: no order
      coarsest.reset();
    }
    if (const int signal = interruption(); signal != 0) return exit_code_of(signal);
    accuracy = accuracy_json(run, coarser, coarsest, cpu_seconds_since(coarser_begun));
  }
  write_frames(folder / "frames.h5", frames_of(asked, run));
  run.field().write_vtu(folder / "flow.vtu", asked.scales);
  const Json content = region_json(asked, run, cpu_seconds, accuracy);
  if (std::get<continuum::FlowRegion>(scene.geometry).output.figures)
    draw_figures("region_figures.py", {folder.string()});
  write_json(folder / result_file, content);
  output.finish();
  print_out(finished_region_text(folder, content) +
            next_step("flow", Flowing::open, Verdict::done, folder.string()));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
