#include "particles/distributed/ranks.hpp"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <string>
#include <thread>

#include "coupling/common/first_rank.hpp"
#include "coupling/common/library_words.hpp"
#include "coupling/common/system_limits.hpp"
#include "particles/distributed/processor_time.hpp"
#include "particles/parallel/large_arrays.hpp"

namespace drumlin::particles {
namespace {

// Of this process, which is one rank.
std::int64_t rounds_so_far = 0;
double waited = 0;

// Arrays of so many bytes go back to the system: of smaller ones new pages cost more than holes.
constexpr int large_array = 1 << 22;

// MPI 3 counts the bytes of a message in int: longer ones go in parts.
std::size_t most_at_once = std::size_t{1} << 30;

/// Calls work(first, count) for the parts of so many bytes.
template <class Work>
void in_parts(std::size_t bytes, Work work) {
  for (std::size_t first = 0; first < bytes; first += most_at_once)
    work(first, static_cast<int>(std::min(most_at_once, bytes - first)));
}

}  // namespace

struct RankRuntime::Libraries {
  explicit Libraries(char** argv) : words(argv[0]), mpi(words.count, words.first, 1) {}
  LibraryWords words;                            // not ours: PETSc would tell of those that it does not know
  dealii::Utilities::MPI::MPI_InitFinalize mpi;  // starts p4est as well
};

RankRuntime::RankRuntime(int&, char**& argv) {
  prepare_libraries();
  require_memory(mpi_mebibytes);
  libraries_ = std::make_unique<Libraries>(argv);
  give_large_arrays_back(large_array);
}

RankRuntime::~RankRuntime() = default;

int Ranks::rank() const {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

int Ranks::count() const {
  int count = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  return count;
}

std::int64_t Ranks::rounds() { return rounds_so_far; }
double Ranks::waiting_seconds() { return waited; }

void Ranks::cut_messages(std::size_t bytes) { most_at_once = bytes; }

namespace {

/// Each rank sends its bytes to rank `on`, one rank after the other, so that none waits in a buffer there.
void gather_in_parts(std::span<const std::byte> own, std::span<const std::int64_t> counts, int on,
                     std::byte* all) {
  constexpr int tag = 2;
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != on)
    return in_parts(own.size(), [&](std::size_t first, int some) {
      MPI_Send(own.data() + first, some, MPI_BYTE, on, tag, MPI_COMM_WORLD);
    });
  for (int r = 0; r < static_cast<int>(counts.size()); all += counts[r++])
    if (r == on)
      std::copy(own.begin(), own.end(), all);
    else
      in_parts(counts[r], [&](std::size_t first, int some) {
        MPI_Recv(all + first, some, MPI_BYTE, r, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
}

}  // namespace

std::vector<std::vector<std::byte>> Ranks::exchange_bytes(
    const std::vector<std::vector<std::byte>>& to_rank) const {
  if (count() == 1) return to_rank;
  const WaitingTime waiting(waited);
  const auto ranks = static_cast<std::size_t>(count()), own = static_cast<std::size_t>(rank());
  std::vector<std::int64_t> sent(ranks), arriving(ranks);
  for (std::size_t r = 0; r < ranks; ++r) sent[r] = static_cast<std::int64_t>(to_rank[r].size());
  MPI_Alltoall(sent.data(), 1, MPI_INT64_T, arriving.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
  std::vector<std::vector<std::byte>> received(ranks);
  std::vector<MPI_Request> requests;
  constexpr int tag = 1;
  for (std::size_t r = 0; r < ranks; ++r) {
    received[r].resize(arriving[r]);
    if (r == own) continue;
    in_parts(received[r].size(), [&](std::size_t first, int some) {
      requests.emplace_back();
      MPI_Irecv(received[r].data() + first, some, MPI_BYTE, static_cast<int>(r), tag, MPI_COMM_WORLD,
                &requests.back());
    });
  }
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == own) continue;
    in_parts(to_rank[r].size(), [&](std::size_t first, int some) {
      requests.emplace_back();
      MPI_Isend(to_rank[r].data() + first, some, MPI_BYTE, static_cast<int>(r), tag, MPI_COMM_WORLD,
                &requests.back());
    });
  }
  received[own] = to_rank[own];
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  rounds_so_far += 2;
  return received;
}

void Ranks::gather_bytes(std::span<const std::byte> own, int on,
                         const std::function<std::byte*(std::size_t)>& place_for) const {
  if (count() == 1) {
    std::copy(own.begin(), own.end(), place_for(own.size()));
    return;
  }
  const WaitingTime waiting(waited);
  const auto mine = static_cast<std::int64_t>(own.size());
  std::vector<std::int64_t> counts(count());
  MPI_Allgather(&mine, 1, MPI_INT64_T, counts.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
  const std::size_t total = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  std::byte* const all = rank() == on ? place_for(total) : nullptr;
  if (total <= most_at_once) {
    const std::vector<int> at_once(counts.begin(), counts.end());
    std::vector<int> first(counts.size(), 0);
    std::partial_sum(at_once.begin(), at_once.end() - 1, first.begin() + 1);
    MPI_Gatherv(own.data(), at_once[rank()], MPI_BYTE, all, at_once.data(), first.data(), MPI_BYTE, on,
                MPI_COMM_WORLD);
  } else {
    gather_in_parts(own, counts, on, all);
  }
  rounds_so_far += 2;
}

std::size_t Ranks::broadcast_count(std::size_t own, int from) const {
  if (count() == 1) return own;
  const WaitingTime waiting(waited);
  auto of_one = static_cast<std::int64_t>(own);
  MPI_Bcast(&of_one, 1, MPI_INT64_T, from, MPI_COMM_WORLD);
  ++rounds_so_far;
  return static_cast<std::size_t>(of_one);
}

void Ranks::broadcast_bytes(std::span<std::byte> bytes, int from) const {
  if (count() == 1) return;
  const WaitingTime waiting(waited);
  in_parts(bytes.size(), [&](std::size_t first, int some) {
    MPI_Bcast(bytes.data() + first, some, MPI_BYTE, from, MPI_COMM_WORLD);
  });
  ++rounds_so_far;
}

void Ranks::largest(std::span<double> values) const {
  if (count() == 1) return;
  const WaitingTime waiting(waited);
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                MPI_COMM_WORLD);
  ++rounds_so_far;
}

void Ranks::add(std::span<std::int64_t> values) const {
  if (count() == 1) return;
  const WaitingTime waiting(waited);
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                MPI_COMM_WORLD);
  ++rounds_so_far;
}

std::int64_t Ranks::add(std::span<ExactSum> sums, std::int64_t count) const {
  std::vector<std::int64_t> numbers{count};
  for (ExactSum& sum : sums) numbers.insert(numbers.end(), sum.numbers().begin(), sum.numbers().end());
  add(numbers);
  for (std::size_t k = 0; k < sums.size(); ++k)
    std::copy_n(numbers.begin() + 1 + k * ExactSum::size(), ExactSum::size(), sums[k].numbers().begin());
  return numbers[0];
}

std::int64_t Ranks::least(std::int64_t value) const {
  if (count() == 1) return value;
  const WaitingTime waiting(waited);
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_MIN, MPI_COMM_WORLD);
  ++rounds_so_far;
  return value;
}

bool Ranks::any(bool value) const { return least(value ? 0 : 1) == 0; }

void Ranks::require_same(const std::string& text, const std::string& what) const {
  require_same_on_ranks(rank(), dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, text), what);
}

void Ranks::on_first(const std::function<void()>& action) const {
  do_on_first_rank(rank() == 0, action, [](int code) {
    MPI_Bcast(&code, 1, MPI_INT, 0, MPI_COMM_WORLD);
    ++rounds_so_far;
    return code;
  });
}

namespace {

std::string text_of(int mpi_error) {
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(mpi_error, text, &length);
  return {text, text + length};
}

/// What went wrong; empty: nothing. Of one rank for itself: were the file opened by all together, Open MPI
/// would wait for ever for those that cannot.
std::string write_own_pieces(const std::filesystem::path& file, std::span<const Ranks::FilePiece> pieces) {
  constexpr int tries = 20;  // the name of a new file may come a moment later to another machine
  MPI_File out = MPI_FILE_NULL;
  int error = MPI_SUCCESS;
  for (int k = 0; k < tries; ++k) {
    if (k > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    error = MPI_File_open(MPI_COMM_SELF, file.c_str(), MPI_MODE_WRONLY, MPI_INFO_NULL, &out);
    if (error == MPI_SUCCESS) break;
  }
  if (error != MPI_SUCCESS) return text_of(error);
  std::string wrong;
  for (const Ranks::FilePiece& piece : pieces)
    in_parts(piece.bytes.size(), [&](std::size_t done, int some) {
      if (!wrong.empty()) return;
      MPI_Status status;
      int written = 0;
      error = MPI_File_write_at(out, static_cast<MPI_Offset>(piece.place + done), piece.bytes.data() + done,
                                some, MPI_BYTE, &status);
      if (error == MPI_SUCCESS) error = MPI_Get_count(&status, MPI_BYTE, &written);
      if (error != MPI_SUCCESS) wrong = text_of(error);
      if (wrong.empty() && written != some) wrong = "not all could be written";
    });
  if (error = MPI_File_sync(out); error != MPI_SUCCESS && wrong.empty()) wrong = text_of(error);
  if (error = MPI_File_close(&out); error != MPI_SUCCESS && wrong.empty()) wrong = text_of(error);
  return wrong;
}

}  // namespace

std::string Ranks::write_pieces(const std::filesystem::path& file, std::span<const FilePiece> pieces) const {
  const std::string wrong = write_own_pieces(file, pieces);
  const std::int64_t first = least(wrong.empty() ? count() : rank());
  if (first == count()) return {};
  const std::string own = "rank " + std::to_string(rank()) + " could not write its part: " + wrong;
  std::vector<char> letters(own.begin(), own.end());
  broadcast(letters, static_cast<int>(first));
  return {letters.begin(), letters.end()};
}

void Ranks::end_all(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();
}

}  // namespace drumlin::particles
