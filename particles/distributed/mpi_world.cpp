#include "particles/distributed/mpi_world.hpp"

#include <mpi.h>

#include <chrono>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "coupling/core/machine/library_words.hpp"

namespace drumlin::particles {
namespace {

/// MPI 3 counts in int. So many bytes are five million discs.
int counted(std::size_t bytes) {
  if (bytes > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("more than 2 GiB in one message between ranks");
  return static_cast<int>(bytes);
}

/// Adds the time that it lives.
class Waiting {
 public:
  explicit Waiting(double& seconds) : seconds_(seconds) {}
  ~Waiting() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

MpiWorld::MpiWorld() {
  prepare_libraries();
  int given = MPI_THREAD_SINGLE;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
}

MpiWorld::~MpiWorld() { MPI_Finalize(); }

void MpiWorld::bytes_of_first(std::span<std::byte> bytes) {
  const Waiting waiting(waiting_);
  MPI_Bcast(bytes.data(), counted(bytes.size()), MPI_BYTE, 0, MPI_COMM_WORLD);
}

void MpiWorld::gather_bytes(std::byte* all, std::span<const std::size_t> first) {
  const Waiting waiting(waiting_);
  std::vector<int> places, counts;
  for (int r = 0; r < ranks_; ++r) {
    places.push_back(counted(first[r]));
    counts.push_back(counted(first[r + 1] - first[r]));
  }
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all, counts.data(), places.data(), MPI_BYTE,
                 MPI_COMM_WORLD);
}

void MpiWorld::pass_bytes(std::span<const std::byte> sent, int to, std::span<std::byte> received, int from) {
  const Waiting waiting(waiting_);
  constexpr int tag = 0;
  const auto rank = [](int r) { return r < 0 ? MPI_PROC_NULL : r; };
  MPI_Sendrecv(sent.data(), counted(sent.size()), MPI_BYTE, rank(to), tag, received.data(),
               counted(received.size()), MPI_BYTE, rank(from), tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void MpiWorld::end_all(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();
}

}  // namespace drumlin::particles
