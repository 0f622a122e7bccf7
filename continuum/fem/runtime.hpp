#pragma once
// Starts and ends MPI and PETSc, once per program; runs actions on the first rank.
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace drumlin::continuum {

/// Keeps MPI and PETSc alive while it lives: made first thing in main. Libraries run on one thread unless
/// OMP_NUM_THREADS says otherwise: on meshes of this size threads only cost.
class FemRuntime {
 public:
  FemRuntime(int& argc, char**& argv);
  ~FemRuntime();
  FemRuntime(const FemRuntime&) = delete;
  FemRuntime& operator=(const FemRuntime&) = delete;

  static int rank();
  static int ranks();
  static std::vector<double> of_ranks(double value);  ///< that of each rank; collective
  /// What one rank has to do for all: files and messages. All ranks call it and wait for the first. What
  /// `action` throws there is thrown there, and FailedOnFirstRank on the others.
  void on_first_rank(const std::function<void()>& action) const;
  /// Does `action` on all ranks, which may see other files; throws on all where one throws (do_on_all_ranks).
  static void on_all_ranks(const std::function<void()>& action,
                           const std::function<void(const std::string&)>& say);
  /// Throws on all ranks where `text` is not the same on all (require_same_on_ranks).
  static void require_same(const std::string& text, const std::string& what);

 private:
  struct Libraries;
  std::unique_ptr<Libraries> libraries_;
};

}  // namespace drumlin::continuum
