#include "apps/flow/flow_marching.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "apps/support/json_file.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

double share_at(const MarchPlan& plan, double time_s) {
  const double ramp = plan.time.ramp_s, begun = plan.start.start_share;
  return time_s < ramp ? begun + (1 - begun) * time_s / ramp : 1;
}

std::string first_lines(const ScalarSet& scalars) {
  std::string text = "# drumlin-flow-series-1\nstep,time,time_s,rotation_rpm";
  for (const Scalar& scalar : scalars.scalars) text += "," + scalar.name;
  return text + ",iterations,residual\n";
}

/// What an interrupted march has left, up to the step that it goes on from.
std::string lines_up_to(const fs::path& file, int steps) {
  std::istringstream lines(file_text(file));
  std::string kept;
  for (std::string line; std::getline(lines, line);) {
    const bool is_step = !line.empty() && line.front() >= '0' && line.front() <= '9';
    if (!is_step || std::stoi(line) <= steps) kept += line + "\n";
  }
  return kept;
}

void add(FlowReport part, FlowReport& whole) {
  for (IterationReport& line : part.history) line.seconds += whole.seconds;
  whole.converged = part.converged;
  whole.failure = part.failure;
  whole.residual = part.residual;
  whole.iterations += part.iterations;
  whole.seconds += part.seconds;
  whole.history.insert(whole.history.end(), part.history.begin(), part.history.end());
  if (whole.phases.empty()) {
    whole.phases = part.phases;
    return;
  }
  for (std::size_t i = 0; i < whole.phases.size(); ++i) {
    whole.phases[i].seconds += part.phases[i].seconds;
    whole.phases[i].times += part.phases[i].times;
  }
}

FlowField first_field(const MarchPlan& plan, const FlowProblem& problem) {
  const bool rests = plan.start.steps == 0 && plan.start.state.cells.empty();
  return rests ? flow_at_rest(problem, plan.options) : flow_of_state(plan.start.state, problem, plan.options);
}

}  // namespace

FlowCheckpoint march_start(const FlowOptions& options, const FlowScene& scene, const std::string& scene_text,
                           const std::string& law_text) {
  const fs::path kept = options.output / "checkpoint.h5";
  if (options.existing == ExistingOutput::resume && fs::exists(kept)) {
    FlowCheckpoint checkpoint = read_flow_checkpoint(kept);
    if (checkpoint.scene != scene_text || checkpoint.law != law_text)
      throw InputError(kept.string() + ": was left by another scene or law; --overwrite starts over");
    return checkpoint;
  }
  FlowCheckpoint start;
  start.scene = scene_text;
  start.law = law_text;
  if (!options.from) return start;
  start.state = read_flow_state(*options.from);
  if (!start.state.surface.empty())
    throw InputError((*options.from / "state.h5").string() +
                     ": its surface has moved; steps in time hold it to the chord");
  const auto flow = read_json(*options.from / "flow.json", "drumlin-flow-run-1");
  const auto settings = flow.value("settings", nlohmann::ordered_json::object());
  if (!settings.contains("rotation") || !settings["rotation"].is_number())
    throw InputError((*options.from / "flow.json").string() + ": settings.rotation is missing: no drum");
  const double rotation_rpm =
      settings["rotation"].get<double>() / scales_of(scene).time_s * 30 / std::numbers::pi;
  start.start_share = rotation_rpm / std::get<FlowDrum>(scene.geometry).rotation_rpm;
  return start;
}

FlowSolution march_scene(const MarchPlan& plan, const FemRuntime& runtime, const FlowObserver& observer) {
  const bool speaks = runtime.rank() == 0;
  const FlowCase last = plan.case_at(1);
  const fs::path series = plan.folder / "series.csv", checkpoint = plan.folder / "checkpoint.h5";
  FlowCheckpoint kept = plan.start;
  int iterations = 0, step = kept.steps;
  double residual = 0;
  FlowObserver watching = observer;
  watching.iteration = [&](const IterationReport& line) {
    ++iterations;
    residual = line.residual;
  };
  std::string lines;
  if (kept.steps > 0 && speaks) lines = lines_up_to(series, kept.steps);

  FlowMarch march{.time_step = plan.time.step_s / plan.time_unit_s};
  march.boundary = [&](double time) {
    return plan.case_at(share_at(plan, time * plan.time_unit_s)).problem.boundary;
  };
  march.stepped = [&](double time, const FlowField& field) {
    ++step;
    const double time_s = time * plan.time_unit_s, share = share_at(plan, time_s);
    const ScalarSet scalars = plan.case_at(share).scalars(field);
    if (speaks) {
      if (lines.empty()) lines = first_lines(scalars);
      lines += fmt::format("{},{:.10g},{:.10g},{:.10g}", step, time, time_s, share * plan.rotation_rpm);
      for (const Scalar& scalar : scalars.scalars)
        lines += std::isfinite(scalar.value) ? fmt::format(",{:.10g}", scalar.value) : ",";
      lines += fmt::format(",{},{:.3e}\n", iterations, residual);
      fmt::print("step {}/{}  {:.4g} s  {:.4g} rpm", step, plan.time.steps, time_s,
                 share * plan.rotation_rpm);
      for (const Scalar& scalar : scalars.scalars) fmt::print("  {} {:.4g}", scalar.name, scalar.value);
      fmt::print("  it {}  residual {:.1e}\n", iterations, residual);
      std::fflush(stdout);
    }
    iterations = 0;
  };

  FlowSolution whole{FlowReport{}, first_field(plan, last.problem)};
  whole.report.start = "march from " + plan.said;
  while (kept.steps < plan.time.steps) {
    march.first = kept.steps;
    march.steps = std::min(plan.time.every, plan.time.steps - kept.steps);
    FlowSolution part = march_flow(whole.field, last.problem, march, plan.options, watching);
    whole.field = part.field;
    add(part.report, whole.report);
    if (!part.report.converged) {
      whole.report.failure =
          fmt::format("step {}, {:.4g} s: {}", step + 1, (step + 1) * plan.time.step_s, part.report.failure);
      return whole;
    }
    kept.steps += march.steps;
    kept.state = whole.field.state();
    runtime.on_first_rank([&] {
      replace_file(series, lines);
      // The last step has to be done by whoever writes the results: they hold its acceleration too.
      if (kept.steps < plan.time.steps) write_flow_checkpoint(checkpoint, kept);
    });
  }
  return whole;
}

}  // namespace drumlin::apps
