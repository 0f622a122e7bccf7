// Leaves the contact problem of one step of a flow as a file for `drumlin solve-contacts`.
//
// usage: benchmark_problem SCENE.toml SNAPSHOT.h5 STEPS PROBLEM.h5
//
// The last stage of the scene goes on from the snapshot; the problem is that of the step after STEPS - 1
// others, as it is posed to the solver, without its warm start.
#include <fmt/format.h>

#include "apps/output/program.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/lab/block_problem.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/benchmarks/flow_from_snapshot.hpp"

namespace {

using namespace drumlin;
using namespace drumlin::particles;

void capture(const std::vector<std::string>& words) {
  const Scene scene = benchmark::last_stage_of(read_scene(words[0]));
  Simulation simulation(scene, benchmark::state_at(scene, read_snapshot(words[1])));
  const int steps = checked_count(words[2], {"command line", 0, "STEPS"});
  if (steps == 0) throw InputError("STEPS: at least 1");
  for (int k = 0; k < steps && !simulation.finished(); ++k) (void)simulation.step();
  const auto problem = block_problem(simulation.stepper().last_problem());
  if (!problem) throw InputError("a file cannot hold the contact problems of this scene");
  write_contact_problem(words[3], *problem, simulation.last_places(),
                        fmt::format("{}: step {} of its flow", scene.title, steps));
}

}  // namespace

int main(int argc, char** argv) {
  return apps::run_program([&] {
    if (argc != 5)
      throw InputError(fmt::format("usage: {} SCENE.toml SNAPSHOT.h5 STEPS PROBLEM.h5", argv[0]));
    capture({argv + 1, argv + argc});
    return static_cast<int>(ExitCode::done);
  });
}
