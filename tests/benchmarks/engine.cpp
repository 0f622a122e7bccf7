// What the contact solvers cost, on steps of a flowing drum that every solver is given alike.
//
// usage: benchmark_engine SCENE.toml RESULT.json CACHE_FOLDER
//
// All that is compared is measured in one run, turn by turn, after a warm-up; a step counts with the least
// time of its repetitions, a solver with the median over the steps.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/json/json_file.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/lab/any_solver.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/benchmarks/flow_steps.hpp"

namespace {

using namespace drumlin;
using namespace drumlin::particles;
using namespace drumlin::benchmark;
using Json = nlohmann::ordered_json;

constexpr int few_sweeps = 20, many_sweeps = 120;  // the difference is free of what is done once per solve
constexpr double never = 1e-300;                   // a tolerance that no solver meets

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

StoppingRule fixed_sweeps(int sweeps) {
  StoppingRule rule;
  rule.tolerance = never;
  rule.max_sweeps = rule.check_every = sweeps;
  return rule;
}

/// One way to solve, with the best time for each step so far.
struct Contestant {
  Contestant(const Flow& flow, std::string name, int threads_, const StoppingRule& rule)
      : solver(std::move(name)),
        threads(threads_),
        replay(flow, solver, threads_, rule),
        best(flow.steps.size()) {}
  void solve(const Flow& flow, std::size_t step, bool first) {
    const StepReport report = replay(flow.steps[step]);
    if (first || report.solve.seconds < best[step].solve.seconds) best[step] = report;
  }
  std::string solver;
  int threads;
  Replay replay;
  std::vector<StepReport> best;
};

using Contestants = std::vector<Contestant>;

/// The engine's own solver with `many_sweeps`, on one thread and on two.
Contestants on_threads(const Flow& flow) {
  Contestants contestants;
  contestants.reserve(2);
  for (const int threads : {1, 2})
    contestants.emplace_back(flow, "accelerated", threads, fixed_sweeps(many_sweeps));
  return contestants;
}

/// Solvers with few sweeps and with many, on one thread.
Contestants of_sweeps(const Flow& flow, const std::vector<std::string>& solvers) {
  Contestants contestants;
  contestants.reserve(2 * solvers.size());
  for (const auto& solver : solvers)
    for (const int sweeps : {few_sweeps, many_sweeps})
      contestants.emplace_back(flow, solver, 1, fixed_sweeps(sweeps));
  return contestants;
}

/// Each contestant on each step, in turn, `repetitions` times after one that is not counted.
Contestants raced(const Flow& flow, Contestants contestants, int repetitions) {
  for (Contestant& contestant : contestants) (void)contestant.replay(flow.steps[0]);
  for (int repetition = 0; repetition < repetitions; ++repetition)
    for (std::size_t step = 0; step < flow.steps.size(); ++step)
      for (Contestant& contestant : contestants) contestant.solve(flow, step, repetition == 0);
  return contestants;
}

double ns_per_contact_and_sweep(const Contestant& few, const Contestant& many) {
  std::vector<double> values;
  for (std::size_t step = 0; step < few.best.size(); ++step) {
    const auto &a = few.best[step], &b = many.best[step];
    values.push_back(1e9 * (b.solve.seconds - a.solve.seconds) /
                     (static_cast<double>(b.contacts) * (b.solve.sweeps - a.solve.sweeps)));
  }
  return median(values);
}

double mean_contacts(const Contestant& contestant) {
  double sum = 0;
  for (const StepReport& report : contestant.best) sum += report.contacts;
  return sum / static_cast<double>(contestant.best.size());
}

/// {solver: ns}, one thread.
Json sweep_costs(const Flow& flow, const std::vector<std::string>& solvers, int repetitions) {
  const Contestants contestants = raced(flow, of_sweeps(flow, solvers), repetitions);
  Json result;
  for (std::size_t k = 0; k < solvers.size(); ++k)
    result[solvers[k]] = ns_per_contact_and_sweep(contestants[2 * k], contestants[2 * k + 1]);
  return result;
}

Json times_to_residual(const Flow& flow, double tolerance, int repetitions) {
  StoppingRule rule;
  rule.tolerance = tolerance;
  rule.max_sweeps = 20000;
  rule.max_seconds = 1;  // per solve; what takes longer counts as missed
  Contestants contestants;
  contestants.reserve(any_solver_names().size());
  for (const auto& solver : any_solver_names()) contestants.emplace_back(flow, solver, 1, rule);
  contestants = raced(flow, std::move(contestants), repetitions);
  const auto plain = std::find_if(contestants.begin(), contestants.end(),
                                  [](const Contestant& c) { return c.solver == "nlgs-scalar"; });
  Json result;
  for (const Contestant& contestant : contestants) {
    std::vector<double> ms, sweeps, ratios;
    int missed = 0;
    for (std::size_t step = 0; step < flow.steps.size(); ++step) {
      const SolveReport& solve = contestant.best[step].solve;
      missed += solve.status != Status::converged;
      ms.push_back(1e3 * solve.seconds), sweeps.push_back(solve.sweeps);
      ratios.push_back(plain->best[step].solve.seconds / solve.seconds);
    }
    result[contestant.solver] = {{"ms", median(ms)},
                                 {"sweeps", median(sweeps)},
                                 {"missed", missed},
                                 {"speed_against_nlgs_scalar", median(ratios)}};
  }
  return result;
}

/// Time of `many_sweeps` sweeps with packing and one residual, on one thread over that on two.
Json two_threads(const Flow& flow, int repetitions) {
  const Contestants contestants = raced(flow, on_threads(flow), repetitions);
  std::vector<double> ratios, one, two;
  for (std::size_t step = 0; step < flow.steps.size(); ++step) {
    one.push_back(1e3 * contestants[0].best[step].solve.seconds);
    two.push_back(1e3 * contestants[1].best[step].solve.seconds);
    ratios.push_back(one.back() / two.back());
  }
  return {{"discs", flow.discs},           {"contacts", mean_contacts(contestants[0])},
          {"sweeps", many_sweeps},         {"ms_one_thread", median(one)},
          {"ms_two_threads", median(two)}, {"speed", median(ratios)}};
}

/// Threads that never rest, as of other processes.
class BusyLoops {
 public:
  explicit BusyLoops(int count) {
    for (int k = 0; k < count; ++k)
      loops_.emplace_back([this] {
        while (!over_.load(std::memory_order_relaxed)) {
        }
      });
  }
  ~BusyLoops() {
    over_ = true;
    for (std::thread& loop : loops_) loop.join();
  }

 private:
  std::atomic<bool> over_{false};
  std::vector<std::thread> loops_;
};

/// Time of the steps on two threads over that on one, in turn, beside busy loops.
Json beside_busy_loops(const Flow& flow, int count) {
  Contestants contestants = on_threads(flow);
  const BusyLoops busy(count);
  std::array<double, 2> seconds{};
  for (const FlowStep& step : flow.steps)
    for (std::size_t k = 0; k < 2; ++k) seconds[k] += contestants[k].replay(step).solve.seconds;
  return {{"busy_loops", count}, {"two_threads_over_one", seconds[1] / seconds[0]}};
}

Json cost_of_size(const Flow& flow, int repetitions) {
  const Contestants contestants = raced(flow, of_sweeps(flow, {"accelerated"}), repetitions);
  const double ns = ns_per_contact_and_sweep(contestants[0], contestants[1]),
               contacts = mean_contacts(contestants[0]);
  std::vector<double> detection;
  for (const StepReport& report : contestants[1].best)
    detection.push_back(1e9 * report.detection_seconds / flow.discs);
  return {{"discs", flow.discs},
          {"contacts_per_disc", contacts / flow.discs},
          {"ns_per_disc_and_sweep", ns * contacts / flow.discs},
          {"ns_per_contact_and_sweep", ns},
          {"detection_ns_per_disc_and_step", median(detection)}};
}

/// Fills `result`; `keep` is called after each part, for the last ones take long.
template <class Keep>
void measure(Json& result, const Scene& scene, const std::filesystem::path& cache, Keep keep) {
  const int standard = 7183, repetitions = 2;
  result["memory"] = {{"discs", standard}, {"peak_mb", peak_memory_mb(scene, standard, cache)}};
  const Flow flow = flow_of(scene, standard, 30, cache);
  result["flow"] = {{"discs", standard}, {"steps", flow.steps.size()}, {"repetitions", repetitions}};
  std::vector<std::string> sweeping = any_solver_names();
  std::erase(sweeping, "reference");  // a sweep of it is a factorisation
  result["ns_per_contact_and_sweep"] = sweep_costs(flow, sweeping, repetitions);
  keep("sweeps");
  const double tolerance = 1e-2;
  result["to_residual"] = {{"residual", tolerance}, {"solvers", times_to_residual(flow, tolerance, 1)}};
  keep("solves");
  result["threads"] = {two_threads(flow, repetitions + 1),
                       two_threads(flow_of(scene, 30000, 10, cache), repetitions + 1)};
  for (const int loops : {1, 4}) result["beside"].push_back(beside_busy_loops(flow, loops));
  keep("threads");
  for (const int discs : {2000, 7183, 30000, 100000}) {
    result["sizes"].push_back(cost_of_size(flow_of(scene, discs, 6, cache), repetitions));
    keep("a size");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: benchmark_engine SCENE.toml RESULT.json CACHE_FOLDER\n");
    return static_cast<int>(ExitCode::wrong_input);
  }
  try {
    Json result{{"format", "drumlin-engine-cost-1"},
                {"command", "benchmark_engine SCENE RESULT CACHE"},
                {"reduced", false}};
    const Scene scene = read_scene(argv[1]);
    result["scene"] = scene.title;
    result["load_before"] = load_average();
    result["provenance"] = provenance();
    measure(result, scene, argv[3], [&](const char* what) {
      result["load_after"] = load_average();
      apps::write_json(argv[2], result);
      fmt::print(stderr, "{} measured\n", what);
    });
    fmt::print("{}\n", result.dump(2));
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return static_cast<int>(ExitCode::wrong_input);
  }
}
