#pragma once
// The ranks that mpirun has started. MPI is seen in this room alone.
#include "particles/parallel/world.hpp"

namespace drumlin::particles {

/// All ranks of the program. MPI lives as long as it: made first thing in main, and once.
class MpiWorld final : public World {
 public:
  /// Throws IoError where MPI lacks memory or files.
  MpiWorld();
  ~MpiWorld() override;
  MpiWorld(const MpiWorld&) = delete;
  MpiWorld& operator=(const MpiWorld&) = delete;

  int rank() const override { return rank_; }
  int ranks() const override { return ranks_; }
  double waiting_seconds() const override { return waiting_; }
  void bytes_of_first(std::span<std::byte> bytes) override;
  /// Ends all ranks at once with an exit code: for an error that one of them meets alone.
  [[noreturn]] void end_all(int exit_code) override;

 private:
  void gather_bytes(std::byte* all, std::span<const std::size_t> first) override;
  void pass_bytes(std::span<const std::byte> sent, int to, std::span<std::byte> received, int from) override;

  int rank_ = 0, ranks_ = 1;
  double waiting_ = 0;
};

}  // namespace drumlin::particles
