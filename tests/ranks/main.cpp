// GoogleTest on the ranks that mpirun starts: each runs all tests, the first speaks, a failure of one is one
// of all.
#include <gtest/gtest.h>

#include <memory>

#include "particles/distributed/ranks.hpp"

// OpenMPI and the libraries behind deal.II keep memory until the process ends; the leak check would count it
// as ours. All other checks of the sanitizers stay.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

namespace {

/// Failures of other ranks than the first, which stay silent otherwise.
class FailuresAlone : public testing::EmptyTestEventListener {
 public:
  explicit FailuresAlone(int rank) : rank_(rank) {}
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed())
      std::cerr << "rank " << rank_ << ": " << result.file_name() << ":" << result.line_number() << "\n"
                << result.summary() << "\n";
  }

 private:
  int rank_;
};

}  // namespace

int main(int argc, char** argv) {
  const drumlin::particles::RankRuntime runtime(argc, argv);
  const drumlin::particles::Ranks ranks;
  testing::InitGoogleTest(&argc, argv);
  auto& listeners = testing::UnitTest::GetInstance()->listeners();
  if (ranks.rank() != 0) {
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresAlone(ranks.rank()));  // GoogleTest takes it over
  }
  return ranks.any(RUN_ALL_TESTS() != 0) ? 1 : 0;
}
