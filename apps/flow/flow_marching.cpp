#include "apps/flow/flow_marching.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* series_name = "series.csv";

std::string first_lines(const ScalarSet& scalars) {
  std::string text = "# drumlin-flow-series-1\nstep,time,time_s,rotation_rpm";
  for (const Scalar& scalar : scalars.scalars) text += "," + scalar.name;
  return text + ",iterations,residual\n";
}

std::string line_of(const continuum::MarchStep& step) {
  std::string line =
      fmt::format("{},{:.10g},{:.10g},{:.10g}", step.step, step.time, step.time_s, step.rotation_rpm);
  for (const Scalar& scalar : step.scalars.scalars) line += "," + csv_number(scalar.value, 10);
  return line + fmt::format(",{},{:.3e}\n", step.iterations, step.residual);
}

// What an interrupted march has left, up to the step that it goes on from.
std::string lines_up_to(const fs::path& file, int steps) {
  std::istringstream lines(file_text(file));
  std::string kept;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const bool is_step = !line.empty() && line.front() >= '0' && line.front() <= '9';
    const std::string step = line.substr(0, line.find(','));
    if (!is_step || checked_count(step, {file.string(), number, "step"}) <= steps) kept += line + "\n";
  }
  return kept;
}

void print_step(const continuum::MarchStep& step, int steps) {
  print_out(
      fmt::format("step {}/{}  {:.4g} s  {:.4g} rpm", step.step, steps, step.time_s, step.rotation_rpm));
  for (const Scalar& scalar : step.scalars.scalars)
    print_out(fmt::format("  {} {:.4g}", scalar.name, scalar.value));
  print_out(fmt::format("  it {}  residual {:.1e}\n", step.iterations, step.residual));
  flush_out();
}

double rotation_rpm_of(const fs::path& flow_json, double time_unit_s) {
  const auto rotation = read_record<FlowRecord>(flow_json).settings.rotation.value;
  if (!rotation) throw InputError(flow_json.string() + ": settings.rotation is missing: no drum");
  return *rotation / time_unit_s * 30 / std::numbers::pi;
}

continuum::MarchState start_from(const fs::path& flow_run, const continuum::DrumMarch& march) {
  continuum::MarchState start;
  start.state = continuum::read_flow_state(flow_run);
  if (!start.state.surface.empty())
    throw InputError((flow_run / "state.h5").string() +
                     ": its surface has moved; steps in time hold it to the chord");
  start.start_share = rotation_rpm_of(flow_run / "flow.json", march.time_unit_s) / march.rotation_rpm;
  return start;
}

}  // namespace

FlowMarching read_marching(const FlowOptions& options, const FlowRequest& asked) {
  FlowMarching marching{.march = continuum::drum_march(asked.scene, asked.law),
                        .scene_text = continuum::flow_scene_text(asked.scene),
                        .law_text = file_text(options.rheology)};
  continuum::DrumMarch& march = marching.march;
  if (options.from) march.start_name = options.from->string();
  std::optional<LastWhole<continuum::FlowCheckpoint>> kept;
  if (options.existing == ExistingOutput::resume && has_manifest(options.output)) {
    check_all_files(open_result_folder(options.output));
    kept = last_whole_checkpoint(options.output, continuum::read_flow_checkpoint);
  }
  if (kept) {
    if (kept->content.scene != marching.scene_text || kept->content.law != marching.law_text)
      throw InputError(options.output.string() +
                       ": was left by another scene or law; --overwrite starts over");
    march.start = kept->content.at;
    marching.passed_over = kept->passed_over;
  } else if (options.from) {
    march.start = start_from(*options.from, march);
  }
  return marching;
}

continuum::FlowSolution march_scene(const FlowMarching& marching, GrowingOutput* output,
                                    const continuum::FemRuntime& runtime) {
  const bool speaks = output != nullptr;
  const int steps = marching.march.time.steps;
  std::string lines;
  if (speaks && !marching.passed_over.empty()) {
    print_error(fmt::format("{}\ngoes on from {} instead\n", marching.passed_over, previous_checkpoint_name));
    set_aside_passed_over_checkpoint(output->folder());
  }
  if (marching.march.start.steps > 0 && speaks)
    lines = lines_up_to(output->folder() / series_name, marching.march.start.steps);
  continuum::MarchObserver observer;
  observer.interrupted = [] { return interruption() != 0; };
  observer.stepped = [&](const continuum::MarchStep& step) {
    if (!speaks) return;
    if (lines.empty()) lines = first_lines(step.scalars);
    lines += line_of(step);
    print_step(step, steps);
  };
  observer.kept = [&](const continuum::MarchState& state) {
    runtime.on_first_rank([&] {
      replace_file(output->folder() / series_name, lines);
      output->list(series_name);
      output->manifest().files.at(series_name).grows = true;
      output->save();
      // The last step has to be done by whoever writes the results: they hold its acceleration too.
      if (state.steps < steps)
        continuum::keep_flow_checkpoint(output->folder(), {state, marching.scene_text, marching.law_text});
    });
  };
  return continuum::march_drum(marching.march, observer);
}

}  // namespace drumlin::apps
