// drumlin cost: what accuracy costs, and what each effect. The scripts of apps/costs plan, compare and print;
// this process does what they ask for, and answers for the results folder.
#include "apps/commands/cost/cost.hpp"

#include <fmt/format.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "apps/json/records.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/document.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/files/unfinished_file.hpp"
#include "coupling/core/machine/child_process.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* sweep_format = "drumlin-cost-sweep-1";

bool is_flow_scene(const fs::path& file) {
  const Document document = read_toml(file);
  const Node* format = document.root.find("format");
  const auto* text = format != nullptr ? std::get_if<std::string>(&format->value) : nullptr;
  if (text != nullptr && text->starts_with("drumlin-flow-scene-")) return true;
  if (text != nullptr && text->starts_with("drumlin-scene-")) return false;
  throw InputError({InputProblem{.file = file.string(),
                                 .line = format != nullptr ? format->line : 0,
                                 .key = "format",
                                 .what = "is no scene that can be priced",
                                 .allowed = "drumlin-scene-1, drumlin-flow-scene-1"}});
}

/// The folder of a sweep or a price list, and what its points share.
class CostFolder {
 public:
  explicit CostFolder(const CostOptions& options) : options_(options) {}

  /// `shared`: of all points, kept in sweep.json; null: there are no points. Throws InputError if the folder
  /// holds points that share something else.
  void claim(const Json& shared, const std::vector<fs::path>& inputs) {
    const OutputRequest request{*options_.output, options_.existing, "cost", inputs};
    if (shared.is_null()) {
      staged_.emplace(request);
      return;
    }
    growing_.emplace(
        request, std::vector<std::string>{"sweep.json", "cost.json", "cost.json.part", "start.h5",
                                          "work_precision.png", "statistics.png", "prices.png", "effects.png",
                                          "points/*.json", "points/*.h5", "points/*/scene.toml"});
    Json said{{"format", sweep_format}};
    said.update(shared);
    const fs::path file = growing_->folder() / "sweep.json";
    if (fs::exists(file)) {
      const Json before = read_json(file, sweep_format);
      for (const auto& [key, value] : said.items())
        if (!before.contains(key) || before.at(key) != value)
          throw InputError(fmt::format(
              "{}: its points were made with another '{}'; name another folder or give --overwrite",
              growing_->folder().string(), key));
    }
    make_folders(growing_->folder() / "points");
    growing_->forget("*");  // what is written anew beside the points
    growing_->save();
    write_json(file, said);
  }

  /// The point of this name as an earlier call left it; null if it is still to be done.
  Json kept(const std::string& name) const {
    const std::string file = "points/" + name + ".json";
    if (!growing_->manifest().files.contains(file)) return {};
    return read_json<CostPointRecord>(growing_->folder() / file);
  }

  void keep(const std::string& name, const Json& point) {
    Json content{{"format", CostPointRecord::format}, {"name", name}};
    content.update(point);
    write_json(growing_->folder() / "points" / (name + ".json"), content);
    growing_->list("points/" + name + ".json");
    growing_->save();
  }

  /// cost.json comes last: each of `drawings`, a script and what it draws into, draws from a part of it.
  void finish(Json content, const Json& drawings) {
    content["provenance"] = provenance();
    const fs::path folder = staged_ ? staged_->folder() : growing_->folder();
    {
      const UnfinishedFile unfinished(folder / "cost.json.part");
      write_json(unfinished.path(), content);
      for (const auto& [script, picture] : drawings.items())
        draw_figures(script, {unfinished.path().string(), (folder / picture.get<std::string>()).string()});
    }
    write_json(folder / "cost.json", content);
    staged_ ? staged_->publish() : growing_->finish();
  }

 private:
  const CostOptions& options_;
  std::optional<StagedOutput> staged_;
  std::optional<GrowingOutput> growing_;
};

[[noreturn]] void fail(int code, const std::string& text) {
  if (code == static_cast<int>(ExitCode::wrong_input)) throw InputError(text);
  if (code == static_cast<int>(ExitCode::not_converged)) throw NotConvergedError(text);
  throw IoError(text);
}

/// Runs a program of ours: on `ranks`, up to `time_limit_s`; what it prints is shown, dropped or, with its
/// errors, told ("output": show, drop, tell).
Json start(const Json& wish) {
  flush_out();
  const std::string program = program_beside(wish.at("program")).string();
  ProcessRequest request{.program = program};
  if (const int ranks = wish.value("ranks", 1); ranks > 1) {
    request.program = "mpirun";
    request.words = {"-n", std::to_string(ranks), program};
    request.end_signal = SIGTERM;  // it ends its ranks
    request.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1"};
  }
  for (const std::string word : wish.at("words")) request.words.push_back(word);
  if (const Json limit = wish.value("time_limit_s", Json()); !limit.is_null())
    request.time_limit_s = limit.get<double>();
  const std::string output = wish.at("output");
  request.output = output == "show"   ? ProcessOutput::inherited
                   : output == "drop" ? ProcessOutput::standard
                                      : ProcessOutput::with_errors;
  std::string said;
  request.line = [&](const std::string& line) { said += line + "\n"; };
  request.caught = interruption;
  const ProcessEnd end = run_process(request);
  stop_if_interrupted();
  const int code = end.shell_code();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!end.timed_out && code == exit_code_of(signal)) throw Interrupted{code};
  return {
      {"code", code}, {"timed_out", end.timed_out}, {"peak_memory_mb", end.peak_memory_mb}, {"said", said}};
}

int cost(const CostOptions& options) {
  const bool flow = is_flow_scene(options.scene);
  if (flow && !options.rheology)
    throw InputError(options.scene.string() + ": a flow scene needs --rheology RHEOLOGY.toml");
  Json facts;
  std::optional<ParticleWork> particles;
  if (flow)
    facts = flow_facts(options);
  else
    facts = particles.emplace(options).facts();
  CostFolder folder(options);
  work_for_script("../costs/cost.py", [&](const Json& wish) -> Json {
    const std::string what = wish.at("what");
    if (what == "facts") return {{"options", json_of(described(options))}, {"facts", facts}};
    if (what == "start") return start(wish);
    if (what == "stretch") return particles.value().stretch(wish);
    if (what == "lay down") return particles.value().lay_down(wish);
    if (what == "price") return particles.value().price(wish);
    if (what == "kept") return folder.kept(wish.at("name"));
    if (what == "holds results") return holds_results(wish.at("folder").get<std::string>(), wish.at("file"));
    if (what == "say") {
      print_out(wish.at("text").get<std::string>());
      flush_out();
    } else if (what == "claim") {
      folder.claim(wish.at("shared"), wish.at("inputs").get<std::vector<fs::path>>());
    } else if (what == "begin") {
      particles.value().begin(*options.output / "start.h5");
    } else if (what == "keep") {
      folder.keep(wish.at("name"), wish.at("point"));
    } else if (what == "finish") {
      folder.finish(wish.at("content"), wish.at("drawings"));
    } else {
      fail(wish.at("code"), wish.at("text"));
    }
    return {};
  });
  return static_cast<int>(ExitCode::done);
}

}  // namespace

void CostOptions::describe(Description& d) {
  d.scene(scene, "Scene of particles or of a flow");
  d.add("--sweep", sweep, "NAME[=VALUE:...],...",
        "What is varied, each with its values or standard ones, e.g. tolerance=1e-2:1e-3,step; particles: "
        "solver, tolerance, step; flows: mesh, eps, tolerance [all]");
  d.add("--horizon", horizon_s, "s", above(0),
        "Particles: longest stretch after which velocities are compared; half or a quarter of it where the "
        "finest point leaves the reference earlier; standard: 16 steps of the scene");
  d.add("--statistics", statistics_s, "s", above(0),
        "Particles: compares the measured numbers of runs of this length as well");
  d.add(
      "--from", from, "RUN",
      "Particles: finished run of the scene to start from; standard: the beginning of the last stage, which "
      "is run up to first");
  d.add("--rheology", rheology, "RHEOLOGY.toml", "Flows: law, from calibrate or data/rheology");
  d.add("--ranks", ranks, "N,N,...", at_least(1, 1024),
        "Flows: numbers of MPI processes on which each is solved, its times listed; standard: 1");
  d.add("--neighbour", neighbour, "KEY=VALUE",
        "Flows: each is also solved from the flow with this change, e.g. drum.rotation_rpm=5; repeatable")
      .repeated();
  d.add("--repeats", repeats, "", at_least(1, 100),
        "Flows: solves of each, of which the least and the median time are listed");
  d.add("--time-limit", time_limit_s, "s", above(0), "Flows: wall time after which one is given up");
  d.add("--effects", effects,
        "In place of a sweep: the scene with each of its effects removed and each absent one added; seconds, "
        "unknowns and results of each");
  d.add("--variants", variants, "LIST",
        "With --effects, flows: which effects together, e.g. inertia,inertia+k; standard: each alone");
  d.add("--against", against, "RUN",
        "With --effects, flows of a drum: measured runs of its speed; the errors of each variant against "
        "them");
  d.output(output, "COST",
           "Folder for cost.json, its points and figures; --effects of particles can do without");
  d.changes(overrides);
  d.add("--seconds", seconds, "s", above(0),
        "With --effects, particles: simulated time from the start of the scene");
  d.add("--threads", threads, "", at_least(1, most_threads), "Threads; the results do not depend on it");
  d.existing(existing, "Keeps the points that an earlier call has finished");
}

Command cost_command() {
  return command("cost", "What accuracy costs in a scene, or its effects (docs/cost.md)", cost);
}

}  // namespace drumlin::apps
