#include "apps/commands/cost/flow_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/child_process.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/machine_load.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/documents/csv.hpp"
#include "coupling/documents/document.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "coupling/documents/toml_text.hpp"
#include "coupling/exchange/measured_run.hpp"
#include "coupling/exchange/profile_set.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Unknowns summed over the assemblies: one before the first iteration of a phase, one after each.
double assembled_unknowns(const fs::path& iterations, const Json& meshes) {
  const std::string text = file_text(iterations);
  std::vector<std::pair<int, int>> rows;  // mesh, iteration
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const auto fields = csv_fields(std::string_view(text).substr(from, end - from));
    from = end + 1;
    if (fields.size() < 4) continue;
    const auto mesh = finite_number(fields[0]), iteration = finite_number(fields[3]);
    if (mesh && iteration) rows.emplace_back(static_cast<int>(*mesh), static_cast<int>(*iteration));
  }
  if (rows.empty()) return 0;
  // The last meshes, where a neighbour made the first superfluous.
  const int first = rows.back().first - static_cast<int>(meshes.size()) + 1;
  double sum = 0;
  for (const auto& [mesh, iteration] : rows) {
    if (mesh < first) continue;
    sum += meshes.at(static_cast<std::size_t>(mesh - first)).at("unknowns").get<double>() *
           (iteration == 1 ? 2 : 1);
  }
  return sum;
}

Json results_of(const fs::path& folder) {
  const Json flow = read_json(folder / "flow.json", "drumlin-flow-run-2");
  Json point;
  for (const char* key :
       {"geometry", "unknowns", "iterations", "seconds", "cpu_seconds", "start", "settings", "phases"})
    point[key] = flow.at(key);
  point["assembled_unknowns"] = assembled_unknowns(folder / "iterations.csv", flow.at("meshes"));
  Json scalars = Json::object();
  for (const auto& [key, value] : flow.at("meshes").back().items())
    if (key != "cells" && key != "unknowns") scalars[key] = value;
  point["scalars"] = scalars;
  if (flow.at("closed_form").is_object()) {
    point["closed_form"] = {{"v_x", flow.at("closed_form").at("closed_form_error")},
                            {"v_x_mesh", flow.at("closed_form").at("mesh_error")},
                            {"scalars", flow.at("closed_form").at("scalars")}};
  }
  const ProfileSet profiles = read_profiles(folder / "profiles.csv");
  point["profile"] = {{"z", profiles.z}, {"v_x", numbers_or_null(profiles.column("v_x").value)}};
  return point;
}

/// Errors of the flow against measured runs, by `drumlin compare --study`: targets, verdict, scalars of both.
Json compared(const fs::path& flow, const std::vector<fs::path>& runs) {
  const fs::path study = flow / "study";
  ProcessRequest request{.program = program_beside("drumlin"),
                         .words = {"compare", "-o", study.string(), "--study"}};
  for (const fs::path& run : runs) request.words.push_back(run.string());
  request.words.push_back(flow.string());
  request.output = ProcessOutput::with_errors;
  request.pass_signals_on = true;
  std::string said;
  request.line = [&](const std::string& line) { said += line + "\n"; };
  const ProcessEnd end = run_process(request);
  stop_if_interrupted();
  if (end.shell_code() == static_cast<int>(ExitCode::wrong_input))
    throw InputError("--against: the flow and the runs cannot be compared:\n" + said);
  if (!end.succeeded())
    throw IoError(
        fmt::format("drumlin compare --study ended with exit code {}:\n{}", end.shell_code(), said));
  const Json speeds = read_json(study / "study.json", "drumlin-comparison-study-1").at("speeds");
  if (speeds.size() != 1) throw InputError("--against: the runs are not all of the flow's speed of rotation");
  Json found;
  for (const char* key : {"scalars", "targets", "verdict"}) found[key] = speeds[0].at(key);
  return found;
}

ProcessRequest request_for(const FlowToSolve& flow, const fs::path& folder) {
  const std::string program = program_beside("drumlin-flow").string();
  ProcessRequest request{.program = program};
  if (flow.ranks > 1) {
    request.program = "mpirun";
    request.words = {"-n", std::to_string(flow.ranks), program};
    request.end_signal = SIGTERM;  // it ends its ranks
    request.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  }
  request.words.insert(request.words.end(), {flow.scene.string(), "--rheology", flow.rheology.string(),
                                             "--law-draws", "0", "-o", folder.string()});
  if (flow.from) request.words.insert(request.words.end(), {"--from", flow.from->string()});
  for (const char* change : {"solver.sensitivity=false", "output.figures=false"})
    request.words.insert(request.words.end(), {"--set", change});
  for (const std::string& change : flow.changes) request.words.insert(request.words.end(), {"--set", change});
  request.output = ProcessOutput::standard;
  request.pass_signals_on = true;
  request.time_limit_s = flow.time_limit_s;
  return request;
}

Json failure(const std::string& what) { return {{"failure", what}, {"cpu_seconds", nullptr}}; }

/// Solves the flow into the folder; its results, or why there are none.
Json solved_into(const fs::path& folder, const FlowToSolve& flow) {
  const ProcessEnd end = run_process(request_for(flow, folder));
  stop_if_interrupted();
  if (end.timed_out) return failure(fmt::format("the flow was not found within {:g} s", *flow.time_limit_s));
  const auto results = [&] {
    Json found = results_of(folder);
    found["peak_memory_mb"] = end.peak_memory_mb;
    return found;
  };
  switch (end.shell_code()) {
    case static_cast<int>(ExitCode::done):
      return results();
    case static_cast<int>(ExitCode::not_converged):
      if (!fs::exists(folder / "flow.json")) return failure("the flow did not converge");
      // How far a mesh or an eps is off is what a sweep measures; nobody compares such a flow with runs.
      return flow.against.empty() ? results() : failure(limits_missed_by(folder).front());
    case static_cast<int>(ExitCode::wrong_input):
      throw InputError(flow.name + ": drumlin-flow refused the scene or the law");
    case exit_code_of(SIGINT):
    case exit_code_of(SIGTERM):
    case exit_code_of(SIGHUP):
      throw Interrupted{end.shell_code()};
    default:
      throw IoError(fmt::format("{}: drumlin-flow ended with exit code {}", flow.name, end.shell_code()));
  }
}

/// The numbers of an entry of the repetitions of one solve.
Json entry_of(const std::vector<Json>& repetitions, const FlowToSolve& flow) {
  Json entry{{"ranks", flow.ranks}, {"start", flow.from ? "neighbour" : "cold"}};
  for (const Json& one : repetitions)
    if (one.contains("failure")) {
      entry["failure"] = one.at("failure");
      return entry;
    }
  const auto spread_of = [&](const auto& number) {
    std::vector<double> values;
    for (const Json& one : repetitions) values.push_back(number(one).template get<double>());
    const coupling::Spread found = coupling::spread(values);
    return Json{{"least", found.least}, {"median", found.median}};
  };
  const Json& first = repetitions.front();
  for (const char* key : {"unknowns", "iterations", "assembled_unknowns"}) entry[key] = first.at(key);
  for (const Json& one : repetitions) entry["load_before"].push_back(one.at("load_before"));
  for (const char* key : {"seconds", "cpu_seconds"})
    entry[key] = spread_of([&](const Json& one) { return one.at(key); });
  for (const auto& [name, found] : first.at("phases").items()) {
    const std::string& phase = name;  // clang 14 captures no structured binding
    entry["phases"][phase] = {
        {"times", found.at("times")},
        {"seconds", spread_of([&](const Json& one) { return one.at("phases").at(phase).at("seconds"); })}};
  }
  double memory = 0;
  for (const Json& one : repetitions) memory = std::max(memory, one.at("peak_memory_mb").get<double>());
  entry["peak_memory_mb"] = memory;
  return entry;
}

std::vector<Json> repeated(const PointStore& store, const FlowToSolve& flow, int repeats) {
  std::vector<Json> repetitions;
  for (int again = 1; again <= repeats; ++again) {
    FlowToSolve once = flow;
    if (again > 1) once.name += fmt::format("-again-{}", again);
    repetitions.push_back(solved_point(store, once));
  }
  return repetitions;
}

/// The neighbour's folder, which other flows can start from; solved now if it is not there.
fs::path neighbour_of(const PointStore& store, const FlowToSolve& flow, const CostOptions& options) {
  FlowToSolve neighbour = flow;
  neighbour.name += "-neighbour";
  neighbour.changes.insert(neighbour.changes.end(), options.neighbour.begin(), options.neighbour.end());
  const fs::path folder = store.beside(neighbour.name);
  if (holds_results(folder, "flow.json")) return folder;
  fs::remove_all(folder);  // of a call that was cut off
  if (const Json found = solved_into(folder, neighbour); found.contains("failure"))
    throw NotConvergedError("--neighbour: " + found.at("failure").get<std::string>());
  return folder;
}

void print_work(const Json& entry) {
  const std::string name =
      fmt::format("{} rank{}, {}", entry.at("ranks").get<int>(), entry.at("ranks") == 1 ? "" : "s",
                  entry.at("start") == "cold" ? "cold" : "from a neighbour");
  if (entry.contains("failure")) {
    print_out(fmt::format("    {}: {}\n", name, entry.at("failure").get<std::string>()));
    return;
  }
  print_out(fmt::format(
      "    {}: {} iterations, {:.1f} s least, {:.1f} s median, {:.1f} s of processors, {:.0f} MB\n", name,
      entry.at("iterations").get<int>(), entry.at("seconds").at("least").get<double>(),
      entry.at("seconds").at("median").get<double>(), entry.at("cpu_seconds").at("least").get<double>(),
      entry.at("peak_memory_mb").get<double>()));
  flush_out();
}

coupling::NamedNumbers named_numbers(const Json& object) {
  coupling::NamedNumbers numbers;
  for (const auto& [key, value] : object.items())
    if (value.is_number()) numbers.emplace_back(key, value.get<double>());
  return numbers;
}

}  // namespace

Json solved_point(const PointStore& store, const FlowToSolve& flow) {
  if (const auto done = store.finished(flow.name)) return *done;
  stop_if_interrupted();
  const fs::path folder = store.beside(flow.name);
  fs::remove_all(folder);  // of a call that was cut off
  Json point{{"changes", flow.changes}, {"load_before", load_average()}};
  point.update(solved_into(folder, flow));
  if (!flow.against.empty() && !point.contains("failure")) point["against"] = compared(folder, flow.against);
  store.keep(flow.name, point);
  fs::remove_all(folder);
  return store.finished(flow.name).value();
}

bool asks_for_work(const CostOptions& options) {
  return options.repeats > 1 || !options.neighbour.empty() || options.ranks != std::vector<int>{1};
}

Json work_of(const PointStore& store, const FlowToSolve& flow, const Json& once, const CostOptions& options) {
  Json work = Json::array();
  if (once.contains("failure")) return work;
  FlowToSolve plain = flow;
  plain.against.clear();
  for (const int ranks : options.ranks) {
    for (const bool cold : {true, false}) {
      if (!cold && options.neighbour.empty()) continue;
      FlowToSolve one = plain;
      one.ranks = ranks;
      if (ranks > 1) one.name += fmt::format("-ranks-{}", ranks);
      if (!cold) {
        one.from = neighbour_of(store, plain, options);
        one.name += "-from-neighbour";
      }
      work.push_back(entry_of(repeated(store, one, options.repeats), one));
      print_work(work.back());
    }
  }
  return work;
}

Json shared_by_flows(const std::string& kind, const CostOptions& options) {
  Json shared{{"kind", kind},
              {"scene", toml_text(read_toml(options.scene, options.overrides).root)},
              {"rheology", file_text(*options.rheology)}};
  if (!options.neighbour.empty()) shared["neighbour"] = options.neighbour;
  if (options.time_limit_s) shared["time_limit_s"] = *options.time_limit_s;
  for (const fs::path& run : options.against) shared["against"].push_back(run.string());
  return shared;
}

coupling::FlowNumbers numbers_of_point(const Json& point) {
  coupling::FlowNumbers numbers{named_numbers(point.at("scalars")), {}, {}};
  for (const Json& value : point.at("profile").at("v_x")) numbers.v_x.push_back(number_or_nan(value).value());
  if (point.contains("closed_form")) {
    const Json& closed = point.at("closed_form");
    numbers.closed_form = coupling::ClosedFormErrors{number_or_nan(closed.at("v_x")).value(),
                                                     number_or_nan(closed.at("v_x_mesh")).value(),
                                                     named_numbers(closed.at("scalars"))};
  }
  return numbers;
}

}  // namespace drumlin::apps
