// Snapshots and checkpoints that all ranks write together, against those of one process: the same bytes.
#include "apps/run/files_in_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "coupling/common/errors.hpp"
#include "coupling/common/first_rank.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin::apps {
using namespace particles;
namespace {

/// The same on all ranks.
Snapshot some_snapshot(std::size_t grains, std::size_t contacts, bool with_all) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> numbers(-1, 1);
  Snapshot s;
  s.step = 7, s.time = 0.25, s.time_step = 1e-3, s.container_radius = 20;
  std::vector<std::vector<double>*> arrays{&s.x, &s.z, &s.v_x, &s.v_z, &s.radius};
  if (with_all) arrays.insert(arrays.end(), {&s.spin, &s.mass, &s.displacement_x, &s.displacement_z});
  for (auto* values : arrays)
    for (std::size_t b = 0; b < grains; ++b) values->push_back(numbers(random));
  if (with_all) s.wall_open = {0, 1}, s.wall_pose_angle = s.wall_pose_x = s.wall_pose_z = {0.5, 0.25};
  for (std::size_t c = 0; c < contacts; ++c) {
    const auto i = static_cast<std::int32_t>(c * grains / contacts);
    s.contacts.push_back({i, -1, static_cast<float>(numbers(random)), 1, numbers(random), numbers(random)});
  }
  return s;
}

/// Grains from `begin` on, up to `end`, and their contacts.
Snapshot part_of(const Snapshot& all, std::size_t begin, std::size_t end) {
  Snapshot part = all;
  for (auto* values : {&part.x, &part.z, &part.v_x, &part.v_z, &part.radius, &part.spin, &part.mass,
                       &part.displacement_x, &part.displacement_z})
    if (!values->empty()) *values = {values->begin() + begin, values->begin() + end};
  std::erase_if(part.contacts, [&](const SnapshotContact& contact) {
    return static_cast<std::size_t>(contact.i) < begin || static_cast<std::size_t>(contact.i) >= end;
  });
  return part;
}

std::string bytes_of_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A folder that all ranks know, of the first one.
std::filesystem::path folder_of_all(const Ranks& ranks, const testing::TemporaryFolder& own) {
  const std::string name = own.path().string();
  std::vector<char> letters(name.begin(), name.end());
  ranks.broadcast(letters);
  return std::string(letters.begin(), letters.end());
}

TEST(SnapshotInParts, IsTheFileOfOneProcess) {
  const Ranks ranks;
  const testing::TemporaryFolder own;
  const auto folder = folder_of_all(ranks, own);
  const auto rank = static_cast<std::size_t>(ranks.rank()), count = static_cast<std::size_t>(ranks.count());
  for (const bool with_all : {false, true})
    for (const std::size_t grains : {count, std::size_t{1000}})
      for (const std::size_t contacts : {std::size_t{0}, std::size_t{1}, std::size_t{5000}}) {
        const Snapshot all = some_snapshot(grains, contacts, with_all);
        const auto file = folder / "parts.h5";
        write_snapshot_in_parts(ranks, file,
                                part_of(all, grains * rank / count, grains * (rank + 1) / count));
        if (rank == 0) {
          EXPECT_TRUE(bytes_of_file(file) == snapshot_image(all)) << grains << " " << contacts;
        }
      }
  // Nobody's folder ends before all are here.
  (void)ranks.any(true);
}

TEST(CheckpointInParts, IsTheFileOfOneProcessAndLeavesTheOneBefore) {
  const Ranks ranks;
  const testing::TemporaryFolder own;
  const auto folder = folder_of_all(ranks, own);
  const auto rank = static_cast<std::size_t>(ranks.rank()), count = static_cast<std::size_t>(ranks.count());
  const Snapshot grains = some_snapshot(500, 0, true);
  Checkpoint all;
  all.scene = "of ranks", all.log_bytes = 77, all.totals.sweeps = 5;
  SimulationState& state = all.state;
  state.step = 12, state.pose_at_start.push_back({0.5, 1, 2});
  state.bodies.x = grains.x, state.bodies.z = grains.z, state.bodies.v_x = grains.v_x,
  state.bodies.v_z = grains.v_z;
  state.bodies.spin = grains.spin, state.bodies.radius = grains.radius,
  state.bodies.inverse_mass = grains.mass;
  state.memory.time_step = 1e-3;
  for (std::int32_t i = 100; i < 500; ++i) {
    state.memory.i.push_back(i), state.memory.j.push_back(-1);
    state.memory.impulse.insert(state.memory.impulse.end(), {grains.x[i], grains.z[i]});
  }
  state.marks.push_back({20, 0.25, grains.x, grains.z});
  const std::size_t begin = 500 * rank / count, end = 500 * (rank + 1) / count;
  Checkpoint part = all;
  for (auto* values :
       {&part.state.bodies.x, &part.state.bodies.z, &part.state.bodies.v_x, &part.state.bodies.v_z,
        &part.state.bodies.spin, &part.state.bodies.radius, &part.state.bodies.inverse_mass})
    *values = {values->begin() + begin, values->begin() + end};
  // The memory may be cut anywhere, even so that a rank has nothing of it.
  const std::size_t memory_begin = 100 * rank,
                    memory_end = rank + 1 == count ? 400 : std::min<std::size_t>(400, 100 * (rank + 1));
  ContactMemory& memory = part.state.memory;
  memory.i = {memory.i.begin() + memory_begin, memory.i.begin() + memory_end};
  memory.j = {memory.j.begin() + memory_begin, memory.j.begin() + memory_end};
  memory.impulse = {memory.impulse.begin() + 2 * memory_begin, memory.impulse.begin() + 2 * memory_end};
  if (rank > 0) part.state.marks.clear(), part.scene.clear(), part.totals = {};
  keep_checkpoint_in_parts(ranks, folder, part);
  if (rank == 0) {
    EXPECT_TRUE(bytes_of_file(folder / "checkpoint.h5") == checkpoint_image(all));
  }
  part.log_bytes = all.log_bytes = 78;
  const std::string before = bytes_of_file(folder / "checkpoint.h5");
  (void)ranks.any(true);
  keep_checkpoint_in_parts(ranks, folder, part);
  if (rank == 0) {
    EXPECT_TRUE(bytes_of_file(folder / "checkpoint.h5") == checkpoint_image(all));
    EXPECT_TRUE(bytes_of_file(folder / "checkpoint-previous.h5") == before);
  }
  (void)ranks.any(true);
}

TEST(Ranks, SayWhichOneCouldNotWriteItsPieces) {
  const Ranks ranks;
  const testing::TemporaryFolder own;
  const auto folder = folder_of_all(ranks, own);
  if (ranks.rank() == 0) std::ofstream(folder / "all") << "0123456789";
  (void)ranks.any(true);
  const std::string letter(1, static_cast<char>('a' + ranks.rank()));
  const std::array<Ranks::FilePiece, 1> pieces{
      {{static_cast<std::uint64_t>(2 * ranks.rank()), std::as_bytes(std::span(letter))}}};
  EXPECT_EQ(ranks.write_pieces(folder / "all", pieces), "");
  if (ranks.rank() == 0) {
    EXPECT_EQ(bytes_of_file(folder / "all"), std::string("a1b3c5d7e9").substr(0, 2 * ranks.count()) +
                                                 std::string("0123456789").substr(2 * ranks.count()));
  }
  // The last one alone has no such file.
  const bool last = ranks.rank() + 1 == ranks.count();
  const std::string said = ranks.write_pieces(folder / (last ? "missing" : "all"), pieces);
  EXPECT_TRUE(said.starts_with("rank " + std::to_string(ranks.count() - 1) + " could not")) << said;
  (void)ranks.any(true);
}

TEST(SnapshotInParts, SaysOnAllRanksWhereItCannotBeWritten) {
  const Ranks ranks;
  const testing::TemporaryFolder own;
  const auto file = folder_of_all(ranks, own) / "missing" / "parts.h5";
  const Snapshot all = some_snapshot(100, 10, false);
  const auto rank = static_cast<std::size_t>(ranks.rank()), count = static_cast<std::size_t>(ranks.count());
  const Snapshot part = part_of(all, 100 * rank / count, 100 * (rank + 1) / count);
  if (rank == 0)
    EXPECT_THROW(write_snapshot_in_parts(ranks, file, part), IoError);
  else
    EXPECT_THROW(write_snapshot_in_parts(ranks, file, part), FailedOnFirstRank);
  (void)ranks.any(true);
}

}  // namespace
}  // namespace drumlin::apps
