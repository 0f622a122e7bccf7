// Snapshot, checkpoint and problem files: round trips, and damage that must not pass.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/lab/any_solver.hpp"
#include "particles/lab/contact_problem_file.hpp"
#include "particles/scene/random.hpp"
#include "tests/support/says.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

Snapshot some_snapshot() {
  Snapshot s;
  s.step = 42, s.time = 1.5, s.time_step = 0.05, s.wall_angle = 0.3, s.wall_spin = 0.01,
  s.container_radius = 68;
  s.velocity_window = 0.3;
  s.wall_pose_angle = {0.5, 0}, s.wall_pose_x = {1, 2}, s.wall_pose_z = {3, 4};
  s.scales = {3.3e-3, 0.018, 2700};
  for (int k = 0; k < 5; ++k) {
    s.x.push_back(k), s.z.push_back(-k), s.v_x.push_back(0.1 * k), s.v_z.push_back(0.2),
        s.radius.push_back(0.5);
    s.spin.push_back(-0.1 * k), s.displacement_x.push_back(0.03 * k), s.displacement_z.push_back(0.06);
  }
  s.contacts = {{0, 1, 0.6f, 0.8f, 1.25, -0.5}, {3, -1, 0, 1, 2, 0}};
  return s;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SnapshotFile, RoundTripKeepsEveryNumber) {
  const TemporaryFolder folder;
  const Snapshot s = some_snapshot();
  write_snapshot(folder.path() / "s.h5", s);
  const Snapshot t = read_snapshot(folder.path() / "s.h5");
  EXPECT_EQ(s.step, t.step);
  EXPECT_EQ(s.x, t.x);
  EXPECT_EQ(s.spin, t.spin);
  EXPECT_EQ(s.displacement_z, t.displacement_z);
  EXPECT_EQ(s.wall_spin, t.wall_spin);
  EXPECT_EQ(s.wall_pose_angle, t.wall_pose_angle);
  EXPECT_EQ(s.wall_pose_x, t.wall_pose_x);
  EXPECT_EQ(s.wall_pose_z, t.wall_pose_z);
  EXPECT_EQ(s.scales.time_s, t.scales.time_s);
  ASSERT_EQ(t.contacts.size(), 2u);
  EXPECT_EQ(t.contacts[1].j, -1);
  EXPECT_EQ(t.contacts[0].normal_x, 0.6f);
  EXPECT_EQ(t.contacts[0].impulse_t, -0.5);
}

TEST(SnapshotFile, EveryBitFlipAndEveryCutIsRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.h5", damaged = folder.path() / "d.h5";
  write_snapshot(file, some_snapshot());
  const std::string good = bytes_of(file);
  RandomStream random(3, "damage");
  for (int k = 0; k < 300; ++k) {
    std::string bad = good;
    const auto place = random.bits() % bad.size();
    if (k % 3 == 0)
      bad.resize(place);
    else
      bad[place] = static_cast<char>(bad[place] ^ (1 << (random.bits() % 8)));
    std::ofstream(damaged, std::ios::binary) << bad;
    EXPECT_THROW(read_snapshot(damaged), InputError) << place;
  }
}

// Behind a checksum that holds.
TEST(SnapshotFile, ValuesThatNoStepLeavesAreRefused) {
  const TemporaryFolder folder;
  const double nan = std::nan("");
  const std::vector<std::function<void(Snapshot&)>> spoilt = {
      [&](Snapshot& s) { s.x[2] = nan; },
      [&](Snapshot& s) { s.displacement_z[0] = nan; },
      [&](Snapshot& s) { s.time = HUGE_VAL; },
      [&](Snapshot& s) { s.wall_pose_x[1] = nan; },
      [&](Snapshot& s) { s.contacts[0].impulse_n = HUGE_VAL; },
      [&](Snapshot& s) { s.time_step = 0; },
      [&](Snapshot& s) { s.contacts.clear(), s.time_step = 5e-324; },
      [&](Snapshot& s) { s.radius[1] = -0.5; },
      [&](Snapshot& s) { s.velocity_window = -0.3; },
      [&](Snapshot& s) { s.scales.time_s = 0; },
      [&](Snapshot& s) { s.step = -1; }};
  for (std::size_t k = 0; k < spoilt.size(); ++k) {
    Snapshot s = some_snapshot();
    spoilt[k](s);
    write_snapshot(folder.path() / "s.h5", s);
    EXPECT_THROW(read_snapshot(folder.path() / "s.h5"), InputError) << k;
  }
}

TEST(SnapshotFile, MissingFileFolderAndUnwritablePlaceAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_snapshot(folder.path() / "none.h5"), InputError);
  EXPECT_THROW(read_snapshot(folder.path()), InputError);
  EXPECT_THROW(write_snapshot("/proc/none/s.h5", some_snapshot()), IoError);
}

/// Two contacts on one body and a third contact, W symmetric with one off-diagonal block.
struct SmallProblem {
  std::vector<double> dense = {2, 0.1, 0.5, 0, 0, 0, 0.1, 3, 0, 0.2, 0, 0, 0.5, 0, 2, 0.3, 0, 0,
                               0, 0.2, 0.3, 4, 0, 0, 0,   0, 0, 0,   1, 0, 0,   0, 0, 0,   0, 3};
  std::vector<double> q = {-1, 0.4, -0.5, -2, 0.7, 0.1};
  std::vector<double> mu = {0.3, 0.2, 0.5};
};

void write_fclib(const std::filesystem::path& file, const SmallProblem& p, int storage) {
  std::vector<std::int32_t> first, second;
  std::vector<double> x;
  if (storage < 0) first.push_back(0);
  for (int major = 0; major < 6; ++major) {
    for (int minor = 0; minor < 6; ++minor) {
      const double value = storage == -1 ? p.dense[6 * minor + major] : p.dense[6 * major + minor];
      if (value == 0) continue;
      if (storage >= 0)
        first.push_back(minor), second.push_back(major);  // columns, rows
      else
        second.push_back(minor);
      x.push_back(value);
    }
    if (storage < 0) first.push_back(static_cast<std::int32_t>(x.size()));
  }
  H5Writer out;
  const auto put = [&out](const std::string& name, std::int32_t value) {
    out.add("fclib_local/" + name, std::span<const std::int32_t>(&value, 1));
  };
  put("spacedim", 2), put("W/nzmax", static_cast<std::int32_t>(x.size())), put("W/m", 6), put("W/n", 6);
  put("W/nz", storage >= 0 ? static_cast<std::int32_t>(x.size()) : storage);
  out.add("fclib_local/W/p", std::span<const std::int32_t>(first));
  out.add("fclib_local/W/i", std::span<const std::int32_t>(second));
  out.add("fclib_local/W/x", std::span<const double>(x));
  out.add("fclib_local/vectors/q", std::span<const double>(p.q));
  out.add("fclib_local/vectors/mu", std::span<const double>(p.mu));
  out.save(file);
}

TEST(ContactProblemFile, AllThreeStoragesGiveTheSameProblem) {
  const TemporaryFolder folder;
  const SmallProblem p;
  for (const int storage : {-2, -1, 0}) {
    write_fclib(folder.path() / "p.h5", p, storage);
    const BlockProblem read = read_contact_problem(folder.path() / "p.h5");
    std::vector<double> u, none;
    const std::vector<double> r = {1, 0.2, 0.5, -0.1, 0.3, 0};
    read.W.velocities(r, read.q, none, u);
    for (int row = 0; row < 6; ++row) {
      double expected = p.q[row];
      for (int c = 0; c < 6; ++c) expected += p.dense[6 * row + c] * r[c];
      EXPECT_NEAR(u[row], expected, 1e-15) << storage << ' ' << row;
    }
  }
}

TEST(ContactProblemFile, WrittenProblemReadsBackAndSaysTheTimeStepAndWhereTheContactsAre) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "q.h5";
  write_fclib(file, {}, -1);
  EXPECT_FALSE(read_contact_problem_file(file).time_step);
  BlockProblem problem = read_contact_problem(file);
  problem.time_step = 0.05;
  write_contact_problem(file, problem, {{1, 2, 3}, {4, 5, 6}, {1, 0, 1}, {0, 1, 0}}, "test");
  const ContactProblemFile again = read_contact_problem_file(file);
  EXPECT_EQ(again.time_step, 0.05);
  EXPECT_EQ(again.problem.W.column, problem.W.column);
  EXPECT_EQ(again.problem.q, problem.q);
  EXPECT_EQ(again.problem.mu, problem.mu);
  EXPECT_EQ(H5Reader(file).doubles("drumlin/contacts/z"), (std::vector<double>{4, 5, 6}));
  problem.time_step = 0;
  write_contact_problem(file, problem, {}, "test");
  EXPECT_FALSE(H5Reader(file).has("drumlin/contacts/x"));
  EXPECT_THROW(read_contact_problem(file), InputError);
}

TEST(ContactProblemFile, SolutionsSayStatesWhereTheyAreKnown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.h5";
  const std::vector<double> r{1, 0.5}, u{0, -1};
  write_contact_solution(file, r, u);
  EXPECT_FALSE(H5Reader(file).has("solution/state"));
  write_contact_solution(file, r, u, {{2}, {7}, {1e-3}});
  EXPECT_EQ(H5Reader(file).ints("solution/state"), std::vector<std::int32_t>{2});
  EXPECT_EQ(H5Reader(file).ints("solution/changes"), std::vector<std::int32_t>{7});
  EXPECT_EQ(H5Reader(file).doubles("solution/error"), std::vector<double>{1e-3});
}

TEST(ContactProblemFile, SmallAsymmetryOfADiagonalBlockIsTakenAway) {
  const TemporaryFolder folder;
  SmallProblem rounded;
  rounded.dense[1] += 2e-5;  // W_nt of contact 0, whose trace is 5
  write_fclib(folder.path() / "p.h5", rounded, -1);
  const ContactProblemFile read = read_contact_problem_file(folder.path() / "p.h5");
  EXPECT_NEAR(read.asymmetry, 4e-6, 1e-12);
  EXPECT_NEAR(read.problem.W.diagonal[0](0, 1), 0.1 + 1e-5, 1e-15);
  EXPECT_EQ(read.problem.W.diagonal[0], read.problem.W.diagonal[0].transpose());
  EXPECT_EQ(read.problem.W.block[0], read.problem.W.diagonal[0]);
}

TEST(ContactProblemFile, AsymmetryBetweenContactsIsTakenAwayOrRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "p.h5";
  SmallProblem p;
  p.dense[2] += 2e-5;  // W of contacts 0 and 1, whose traces are 5 and 6
  write_fclib(file, p, -2);
  const ContactProblemFile read = read_contact_problem_file(file);
  EXPECT_NEAR(read.asymmetry, 2e-5 / 5.5, 1e-12);
  const auto& W = read.problem.W;
  ASSERT_EQ(W.column, (std::vector<int>{0, 1, 0, 1, 2}));
  EXPECT_EQ(W.block[1], W.block[2].transpose());
  EXPECT_NEAR(W.block[1](0, 0), 0.5 + 1e-5, 1e-15);
  for (const int entry : {2, 4}) {  // one that differs, and one that stands on one side alone
    SmallProblem wrong;
    wrong.dense[entry] += 0.2;
    write_fclib(file, wrong, -2);
    try {
      (void)read_contact_problem(file);
      ADD_FAILURE() << entry;
    } catch (const InputError& error) {
      expect_has(error.what(), "is not symmetric");
    }
  }
}

TEST(ContactProblemFile, FaultsAreRefused) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "p.h5";
  const auto expect_refused = [&file](int storage, auto spoil) {
    SmallProblem p;
    spoil(p);
    write_fclib(file, p, storage);
    EXPECT_THROW(read_contact_problem(file), InputError);
  };
  for (const double mu : {-0.1, 100.5, 1e308}) expect_refused(-2, [mu](SmallProblem& p) { p.mu[1] = mu; });
  expect_refused(-2, [](SmallProblem& p) { p.q[0] = std::numeric_limits<double>::infinity(); });
  expect_refused(0, [](SmallProblem& p) { p.dense[0] = 0; });           // singular
  expect_refused(-2, [](SmallProblem& p) { p.dense[6] *= 1 + 1e-3; });  // one-sided
  for (const char* text : {"", "not HDF5"}) {
    std::ofstream(file) << text;
    EXPECT_THROW(read_contact_problem(file), InputError);
  }
  EXPECT_THROW(read_contact_problem(folder.path()), InputError);
}

}  // namespace
}  // namespace drumlin
