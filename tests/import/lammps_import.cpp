// Text dumps of LAMMPS: axes, units, boxes, walls made of atoms, contacts, and what is refused.
#include <gtest/gtest.h>

#include "tests/import/imported.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::imported;
using testing::refusal;
using testing::TemporaryFolder;

std::string description(const std::string& more = "") {
  return "format = \"drumlin-import-1\"\n[grains]\ndensity_kg_m3 = 2000\nmean_diameter_m = "
         "9.81\n[lammps]\ngrains = "
         "[\"dump.*\"]\nstep_s = 0.5\n" +
         more;  // d = 9.81 m: the unit of time is 1 s
}

std::string frame(int step, const std::string& columns, const std::vector<std::string>& rows,
                  const std::string& kind = "ATOMS") {
  std::string text = "ITEM: TIMESTEP\n" + std::to_string(step) + "\nITEM: NUMBER OF " + kind + "\n" +
                     std::to_string(rows.size()) +
                     "\nITEM: BOX BOUNDS pp ff pp\n-10 10\n0 40\n-1 1\nITEM: " + kind + " " + columns + "\n";
  for (const std::string& row : rows) text += row + "\n";
  return text;
}

TEST(LammpsImport, SecondAxisOfThePlaneIsUpAndSpinClockwise) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(4, "id type x y z vx vy vz radius omegaz",
                              {"2 1 9.81 19.62 0 3 4 0 4.9 0.7", "1 1 0 0 0 0 0 0 4.9 0"}) +
                            frame(8, "id x y radius vx vy", {"1 0 0 5 0 0", "2 0 9 5 0 0"}));
  const auto result = imported(folder, description());
  ASSERT_EQ(result.snapshots.size(), 2u);
  const Snapshot& s = result.snapshots[0];
  EXPECT_NEAR(s.time, 2, 1e-12);
  EXPECT_NEAR(s.x[1], 1, 1e-12);
  EXPECT_NEAR(s.z[1], 2, 1e-12);
  EXPECT_NEAR(s.v_z[1], 4 / 9.81, 1e-12);
  EXPECT_NEAR(s.spin[1], -0.7, 1e-12);  // omegaz is anticlockwise
  EXPECT_TRUE(result.snapshots[1].spin.empty());
  EXPECT_EQ(result.report.unused_columns, (std::vector<std::string>{"vz"}));
}

TEST(LammpsImport, UprightPlaneTurnsTheOtherWay) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(4, "id x y z vx vz radius omegay", {"1 0 0 9.81 0 1 4 0.7"}));
  const auto result = imported(folder, description("plane = \"xz\"\n"));
  EXPECT_NEAR(result.snapshots[0].z[0], 1, 1e-12);
  EXPECT_NEAR(result.snapshots[0].spin[0], 0.7, 1e-12);  // y points away from the onlooker
}

TEST(LammpsImport, ScaledCoordinatesArePutIntoTheirBox) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(0, "id xs ys diameter vx vy", {"1 0.75 0.5 9.81 0 0"}));
  const auto result = imported(folder, description("length_unit_m = 2\n"));
  EXPECT_NEAR(result.snapshots[0].x[0] * 9.81, 10, 1e-12);  // 5 units of 2 m
  EXPECT_NEAR(result.snapshots[0].z[0] * 9.81, 40, 1e-12);
  EXPECT_NEAR(result.snapshots[0].radius[0], 1, 1e-12);
}

TEST(LammpsImport, AtomsOfAWallAreNoGrainsAndTheirContactsAreTheWalls) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(0, "id type x y radius vx vy",
                              {"7 2 0 0 5 0 0", "3 1 0 9.81 5 0 0", "4 1 9.81 9.81 5 0 0"}));
  // From the wall's side (force on the wall: down), among grains, and wall on wall.
  folder.with("contacts", frame(0, "c_1[1] c_1[2] fx fy", {"7 3 2 -8", "3 4 -6 0", "7 7 1 1"}, "ENTRIES"));
  const auto result = imported(
      folder,
      description("wall_types = [2]\ncontacts = [\"contacts\"]\ncontact_ids = [\"c_1[1]\", \"c_1[2]\"]\n"
                  "contact_forces = [\"fx\", \"fy\"]\ndepth_m = 2\n"));
  const Snapshot& s = result.snapshots[0];
  ASSERT_EQ(s.x.size(), 2u);
  ASSERT_EQ(s.contacts.size(), 2u);
  const double unit = 2000 * 9.81 * 9.81 * 9.81;  // N per metre: rho d3 / s2
  EXPECT_EQ(s.contacts[0].j, -1);
  EXPECT_NEAR(s.contacts[0].normal_z, 1, 1e-6);
  EXPECT_NEAR(s.contacts[0].impulse_n / s.time_step, 4 / unit, 1e-15);   // 8 N over 2 m
  EXPECT_NEAR(s.contacts[0].impulse_t / s.time_step, -1 / unit, 1e-15);  // force on the grain: -2 N along x
  EXPECT_EQ(s.contacts[1].j, 1);
  EXPECT_NEAR(s.contacts[1].normal_x, -1, 1e-6);
  EXPECT_NEAR(s.contacts[1].impulse_n / s.time_step, 3 / unit, 1e-15);
}

TEST(LammpsImport, ContactsReachAcrossTheSeam) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(0, "id x y radius vx vy", {"1 -9.5 5 1 0 0", "2 9.5 5 1 0 0"}));
  folder.with("contacts", frame(0, "a b fx fy", {"1 2 3 0"}, "ENTRIES"));
  const auto result = imported(
      folder,
      description("contacts = [\"contacts\"]\ncontact_ids = [\"a\", \"b\"]\ncontact_forces = [\"fx\", "
                  "\"fy\"]\ndepth_m = 1\n[periodic_x]\nlength_m = 20\n"));
  EXPECT_NEAR(result.snapshots[0].contacts.at(0).normal_x, 1, 1e-6);
  EXPECT_GT(result.snapshots[0].contacts.at(0).impulse_n, 0);
}

TEST(LammpsImport, RefusesWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string columns = "id x y radius vx vy";
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 "
            "0\n0 1 0\n",
            "dump.a:5: BOX BOUNDS: is triclinic"},
           {frame(1, columns, {"1 0 0 1 0 0", "2 0 0 1 0"}), "dump.a:11: holds 5 fields (allowed: 6"},
           {frame(1, columns, {"1 0 0 1 nan 0"}), "dump.a:10: v_x: \"nan\" is no number"},
           {frame(1, columns, {"1 0 0 0 0 0"}), "dump.a:10: radius: is not above 0"},
           {frame(1, columns, {"1 0 0 1 0 0", "1 2 0 1 0 0"}), "dump.a:11: id: 1 stands twice"},
           {frame(1, "id x y vx vy", {"1 0 0 0 0"}), "radius: no such column"},
           {frame(1, "id x xu y radius vx vy", {"1 0 0 0 1 0 0"}), "xu: gives x a second time"},
           {frame(2, columns, {"1 0 0 1 0 0"}) + frame(1, columns, {"1 0 0 1 0 0"}), "times that ascend"},
           {frame(1, "id x y z radius vx vy", {"1 0 0 0 0.1 0 0", "2 0 0 5 0.1 0 0"}), "lie in space"},
           {frame(1, columns, {"1 0 0 1 0 0"}).substr(0, 60), "ends within a frame"},
           {frame(1, columns, {"1 0 0 1 0 0"}) + "ITEM: TIMESTEP\n2\n", "dump.a:12: ends within a frame"},
           {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id xs ys radius vx vy\n1 0.5 0.5 1 0 "
            "0\n",
            "dump.a:5: xs: is scaled by a box that this frame does not give"},
           {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2.7\n",
            "dump.a:4: NUMBER OF ...: is 2.7 (allowed: a whole number"},
           {"ITEM: TIMESTEP\n1.5\n", "dump.a:2: TIMESTEP: is 1.5 (allowed: a whole number"},
           {"ITEM: TIMESTEP\n1\nITEM: TIMESTEP\n2\n", "dump.a:3: TIMESTEP: stands a second time"},
           {"ITEM: TIMESTEP\n1\nITEM: BOX BOUNDS pp ff pp\n10 -10\n",
            "dump.a:4: BOX BOUNDS: are not in their order"},
           {"ITEM: TIMESTEP\n" + std::string(2 << 20, '1'), "dump.a:2: is longer than 1 MiB"},
           {"hello\n", "dump.a:1: \"hello\" is not expected here"},
           {"", "hold no snapshot"}}) {
    folder.with("dump.a", text);
    const std::string said = refusal(folder, description());
    EXPECT_NE(said.find(message), std::string::npos) << said;
  }
}

TEST(LammpsImport, ReadsLinesAcrossThePiecesOfItsFileAndWithoutALastEnd) {
  const TemporaryFolder folder;
  std::vector<std::string> rows;
  for (int k = 0; k < 5000; ++k)
    rows.push_back(std::to_string(k + 1) + " " + std::to_string(20 * k) + " 0 9.81 0 0");
  std::string text = "\xEF\xBB\xBF" + frame(1, "id x y radius vx vy", rows);
  text.pop_back();
  folder.with("dump.a", text);
  const auto result = imported(folder, description());
  ASSERT_EQ(result.snapshots.at(0).x.size(), 5000u);
  EXPECT_NEAR(result.snapshots[0].x[4999], 20 * 4999 / 9.81, 1e-9);
}

// Tried place by place for each star, this one would take longer than the universe is old.
TEST(LammpsImport, PatternOfManyStarsIsMatchedAtOnce) {
  const TemporaryFolder folder;
  folder.with(std::string(200, 'a') + "b", frame(1, "id x y radius vx vy", {"1 0 0 9.81 0 0"}));
  std::string stars;
  for (int k = 0; k < 60; ++k) stars += "*a";
  const auto named = [&](const std::string& pattern) {
    std::string text = description();
    return text.replace(text.find("dump.*"), 6, pattern);
  };
  EXPECT_NE(refusal(folder, named(stars)).find("no file of such a name"), std::string::npos);
  EXPECT_EQ(imported(folder, named(stars + "*b")).snapshots.size(), 1u);
  EXPECT_EQ(imported(folder, named("*aab*")).snapshots.size(), 1u);
  EXPECT_NE(refusal(folder, named("*ab*b")).find("no file of such a name"), std::string::npos);
}

}  // namespace
}  // namespace drumlin
