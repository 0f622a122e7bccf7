#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

using testing::expect_same;
using testing::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ProfileSet example() {
  ProfileSet set;
  set.z = {-2.5, -1.5, -0.5};
  set.columns = {{"v_x", {0.1, 1.0 / 3.0, 2e-300}, {0.01, 0.02, nan}}, {"k", {nan, 1.0, -0.0}, {}}};
  set.header.theta_deg = 19.7;
  set.header.title = "a text, with = and # in it";
  return set;
}

TEST(ProfileFile, RoundTripKeepsEveryBit) {
  const TemporaryFolder folder;
  const ProfileSet written = example();
  write_profiles(folder / "profiles.csv", written);
  const ProfileSet read = read_profiles(folder / "profiles.csv");
  EXPECT_EQ(read.z, written.z);
  EXPECT_EQ(read.header, written.header);
  ASSERT_EQ(read.columns.size(), written.columns.size());
  for (std::size_t i = 0; i < read.columns.size(); ++i) {
    EXPECT_EQ(read.columns[i].name, written.columns[i].name);
    expect_same(written.columns[i].value, read.columns[i].value);
    expect_same(written.columns[i].ci99, read.columns[i].ci99);
  }
}

TEST(ProfileFile, EmptyFieldIsNotZero) {
  const TemporaryFolder folder;
  const auto read = read_profiles(folder.with("p.csv", "# drumlin-profiles-1\nz,mu\n-1,\n0,0\n"));
  EXPECT_TRUE(std::isnan(read.column("mu").value[0]));
  EXPECT_EQ(read.column("mu").value[1], 0);
}

TEST(ProfileFile, MissingColumnIsNamed) {
  EXPECT_EQ(example().find("nu"), nullptr);
  expect_has(message_of<InputError>([] { example().column("nu"); }), "nu");
}

struct Refusal {
  std::string name;
  std::string text;
  std::string part_of_message;  ///< the line among others
};
std::ostream& operator<<(std::ostream& stream, const Refusal& refusal) { return stream << refusal.name; }

class ProfileRefusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(ProfileRefusals, NameFileAndLine) {
  const TemporaryFolder folder;
  const auto file = folder.with("p.csv", GetParam().text);
  const auto message = message_of<InputError>([&] { read_profiles(file); });
  expect_has(message, file.string());
  expect_has(message, GetParam().part_of_message);
}

INSTANTIATE_TEST_SUITE_P(
    ProfileFile, ProfileRefusals,
    ::testing::Values(Refusal{"NextVersion", "# drumlin-profiles-2\nz,nu\n0,0.8\n", "drumlin-profiles-1"},
                      Refusal{"Empty", "", "drumlin-profiles-1"},
                      Refusal{"NoNames", "# drumlin-profiles-1\n# a = b\n", "column names"},
                      Refusal{"HeaderWithoutValue", "# drumlin-profiles-1\n# remark\nz\n", ":2"},
                      Refusal{"ZNotFirst", "# drumlin-profiles-1\nnu,z\n", ":2"},
                      Refusal{"ColumnTwice", "# drumlin-profiles-1\nz,nu,nu\n", ":2"},
                      Refusal{"IntervalWithoutColumn", "# drumlin-profiles-1\nz,nu_ci99\n", ":2"},
                      Refusal{"IntervalOfZ", "# drumlin-profiles-1\nz,z_ci99\n", ":2"},
                      Refusal{"TooFewFields", "# drumlin-profiles-1\nz,nu\n0,0.8\n1\n", ":4"},
                      Refusal{"TooManyFields", "# drumlin-profiles-1\nz,nu\n0,0.8,1\n", ":3"},
                      Refusal{"NoNumber", "# drumlin-profiles-1\nz,nu\n0,high\n", ":3"},
                      Refusal{"Infinity", "# drumlin-profiles-1\nz,nu\n0,inf\n", ":3"},
                      Refusal{"TooLarge", "# drumlin-profiles-1\nz,nu\n0,1e300\n",
                              ":3: nu: \"1e300\" does not do (allowed: a number of at most 1e+100 from 0"},
                      Refusal{"DescendingZ", "# drumlin-profiles-1\nz,nu\n0,0.8\n-1,0.8\n", ":4"},
                      Refusal{"EmptyZ", "# drumlin-profiles-1\nz,nu\n,0.8\n", ":3"}),
    [](const auto& test) { return test.param.name; });

TEST(ProfileFile, RefusesToWriteWhatItCouldNotRead) {
  const TemporaryFolder folder;
  const auto refused = [&](auto change) {
    ProfileSet set = example();
    change(set);
    EXPECT_THROW(write_profiles(folder / "p.csv", set), InputError);
    EXPECT_FALSE(std::filesystem::exists(folder / "p.csv"));
  };
  refused([](ProfileSet& set) { set.columns[0].value.pop_back(); });
  refused([](ProfileSet& set) { set.columns[0].ci99.pop_back(); });
  refused([](ProfileSet& set) { set.columns[0].name = "a,b"; });
  refused([](ProfileSet& set) { set.columns[1].name = "v_x"; });
  refused([](ProfileSet& set) { set.columns[0].name = "v_x_ci99"; });
  refused([](ProfileSet& set) { std::swap(set.z[0], set.z[1]); });
  refused([](ProfileSet& set) { set.header.title = "two\nlines"; });
}

}  // namespace
}  // namespace drumlin
