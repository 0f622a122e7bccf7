// Fuzz target: a contact problem, described by lines (h5_recipe.hpp), and some sweeps over what was accepted.
#include "particles/lab/any_solver.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "tests/fuzz/h5_recipe.hpp"
#include "tests/fuzz/one_input.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace drumlin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const testing::TemporaryFolder folder;
  const std::string text = fuzz::text_of(data, size);
  if (text.starts_with("raw")) return 0;  // carries no checksum: that would be HDF5 itself
  fuzz::write_described(folder / "p.h5", text);
  return fuzz::read_or_refused([&] {
    const auto read = particles::read_contact_problem_file(folder / "p.h5");
    particles::Solution<particles::BlockProblem> solution;
    particles::SolverWorkspace<particles::BlockProblem> work;
    particles::StoppingRule rule;
    rule.max_sweeps = 20;
    (void)particles::any_solver<particles::BlockProblem>("nlgs")(read.problem, rule, work, solution);
  });
}
