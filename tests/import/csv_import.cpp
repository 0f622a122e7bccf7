// Snapshots in CSV files: units, order, and what is refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/import/imported.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::imported;
using testing::refusal;
using testing::TemporaryFolder;

constexpr const char* head = "format = \"drumlin-import-1\"\n[grains]\ndensity_kg_m3 = 2000\n";
constexpr const char* one_file = "[csv]\ngrains = [\"grains.csv\"]\n";
constexpr const char* names = "time_s,id,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n";

std::string with_contacts() {
  return std::string(head) + "[csv]\ngrains = [\"grains.csv\"]\ncontacts = [\"contacts.csv\"]\n";
}

TEST(CsvImport, BringsSiIntoTheUnitsOfTheGrains) {
  const TemporaryFolder folder;
  folder.with("grains.csv",
              "time_s,id,x_m,z_m,v_x_m_s,v_z_m_s,radius_m,spin_anticlockwise_rad_s\n"
              "0.5,9,0.03,0.01,0.2,0,0.004,-3\n0.5,4,0.01,0.02,0,-0.1,0.006,5\n1,4,0.01,0.02,0,0,0.006,0\n"
              "1,9,0.03,0.01,0,0,0.004,0\n");
  const auto result = imported(folder, std::string(head) + one_file);
  const double d = 0.01, t = std::sqrt(d / 9.81);
  EXPECT_NEAR(result.report.scales.length_m, d, 1e-15);  // mean of 8 and 12 mm
  EXPECT_NEAR(result.report.scales.time_s, t, 1e-15);
  ASSERT_EQ(result.snapshots.size(), 2u);
  const Snapshot& s = result.snapshots.front();
  EXPECT_NEAR(s.time, 0.5 / t, 1e-12);
  ASSERT_EQ(s.x.size(), 2u);
  EXPECT_NEAR(s.x[0], 1, 1e-12);  // grain 4 before grain 9
  EXPECT_NEAR(s.z[0], 2, 1e-12);
  EXPECT_NEAR(s.v_z[0], -0.1 * t / d, 1e-12);
  EXPECT_NEAR(s.radius[1], 0.4, 1e-12);
  EXPECT_NEAR(s.spin[0], -5 * t, 1e-12);  // positive clockwise inside
  EXPECT_NEAR(s.gravity_z, -1, 1e-12);
  EXPECT_TRUE(s.displacement_x.empty());
  EXPECT_FALSE(s.contacts_known);
  EXPECT_EQ(s.step, 1);
}

TEST(CsvImport, TakesDimensionlessColumnsAsTheyAre) {
  const TemporaryFolder folder;
  folder.with("grains.csv", "time,x,z,v_x,v_z,radius\n2,1,2,0.5,0,0.5\n");
  const auto result = imported(folder, std::string(head) + "mean_diameter_m = 0.003\n" + one_file);
  EXPECT_EQ(result.snapshots.at(0).x.at(0), 1);
  EXPECT_EQ(result.snapshots.at(0).time, 2);
  EXPECT_EQ(result.report.scales.length_m, 0.003);
  EXPECT_FALSE(result.report.with_spin);
  expect_has(refusal(folder, std::string(head) + one_file), "mean_diameter_m");
}

TEST(CsvImport, DrumTurnsWithTheTime) {
  const TemporaryFolder folder;
  folder.with("grains.csv", std::string(names) + "2,0,0,0,0,0,0.005\n3,0,0,0,0,0,0.005\n");
  const std::string drum = "[drum]\ncenter_m = [0.01, 0]\nradius_m = 0.1\nspeed_rpm = 6\n";
  const auto result = imported(folder, std::string(head) + one_file + drum);
  EXPECT_NEAR(result.snapshots[0].wall_angle, 0, 1e-12);
  EXPECT_NEAR(result.snapshots[1].wall_angle, 0.2 * std::numbers::pi, 1e-12);
  const auto later = imported(folder, std::string(head) + one_file + drum + "turns_before = 1.5\n");
  EXPECT_NEAR(later.snapshots[1].wall_angle, 3.2 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(result.snapshots[0].container_radius, 10, 1e-12);
  EXPECT_NEAR(result.snapshots[0].container_x, 1, 1e-12);
  folder.with("grains.csv", std::string(names) + "2,0,0.2,0,0,0,0.005\n");
  expect_has(refusal(folder, std::string(head) + one_file + drum),
             "grains.csv:2: x_m, z_m: the grain lies outside of the drum");
}

TEST(CsvImport, FilesFollowEachOtherByTheirNumbers) {
  const TemporaryFolder folder;
  for (const int number : {9, 10, 100})
    folder.with("g" + std::to_string(number) + ".csv",
                "x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0," + std::to_string(number) + ",0,0,0.5\n");
  const auto result = imported(folder, std::string(head) + "[csv]\ngrains = [\"g*.csv\"]\ninterval_s = 2\n");
  ASSERT_EQ(result.snapshots.size(), 3u);
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_EQ(result.snapshots[s].z[0], (std::vector<double>{9, 10, 100})[s]);
  EXPECT_NEAR(result.snapshots[2].time * result.report.scales.time_s, 4, 1e-12);
}

TEST(CsvImport, ContactsHaveTheirForcesInNormalAndTangent) {
  const TemporaryFolder folder;
  folder.with(
      "grains.csv",
      std::string(names) + "1,1,0,0,0,0,0.5\n1,2,0.6,0.8,0,0,0.5\n2,1,0,0,0,0,0.5\n2,2,0.6,0.8,0,0,0.5\n");
  folder.with("contacts.csv", "time_s,i,j,f_x_N_m,f_z_N_m\n2,2,1,6,8\n2,1,-3,0,0\n");
  const std::string floor = with_contacts();
  const auto result = imported(folder, floor + "[drum]\nradius_m = 2\n");
  EXPECT_TRUE(result.snapshots[0].contacts_known);
  EXPECT_TRUE(result.snapshots[0].contacts.empty());   // none at that time
  ASSERT_EQ(result.snapshots[1].contacts.size(), 1u);  // what carries nothing is left out
  const SnapshotContact& contact = result.snapshots[1].contacts[0];
  EXPECT_EQ(contact.i, 1);
  EXPECT_EQ(contact.j, 0);
  EXPECT_NEAR(contact.normal_x, 0.6, 1e-6);     // along the centres, towards i
  const double newton_per_metre = 2000 * 9.81;  // rho g d2
  EXPECT_NEAR(contact.impulse_n / result.snapshots[1].time_step, 10 / newton_per_metre, 1e-12);
  EXPECT_NEAR(contact.impulse_t, 0, 1e-12);
  folder.with("contacts.csv", "time_s,i,j,f_x_N_m,f_z_N_m\n2,2,1,-6,-8\n");
  expect_has(refusal(folder, floor), "contacts.csv:2: contacts: the contacts of this snapshot pull");
  folder.with("contacts.csv", "time_s,i,j,f_x_N_m,f_z_N_m\n2,2,-1,1,1\n");
  expect_has(refusal(folder, floor), "contacts.csv:2: normal_x");
  folder.with("contacts.csv", "time_s,i,j,f_x_N_m,f_z_N_m\n2,2,5,1,1\n");
  expect_has(refusal(folder, floor), "contacts.csv:2: i, j: there is no grain 5");
  folder.with("contacts.csv", "time_s,i,j,f_x_N_m,f_z_N_m\n1.5,2,1,6,8\n");
  expect_has(refusal(folder, floor), "no snapshot of grains at this time");
  folder.with("contacts.csv", "time_s,i,j,normal_x,normal_z,f_n_N_m,f_t_N_m\n2,2,1,0.6,0.9,1,1\n");
  expect_has(refusal(folder, floor), "contacts.csv:2: normal_x: the normal has the length 1.08");
}

TEST(CsvImport, DrumPushesTowardsItsAxis) {
  const TemporaryFolder folder;
  folder.with("grains.csv", std::string(names) + "1,1,-0.3,0.1,0,0,0.05\n");
  folder.with("contacts.csv", "time_s,i,j,f_n_N_m,f_t_N_m\n1,1,-1,5,2\n");
  const auto result = imported(folder, with_contacts() + "[drum]\nradius_m = 0.35\ncenter_m = [0, 0.1]\n");
  const SnapshotContact& contact = result.snapshots.at(0).contacts.at(0);
  EXPECT_NEAR(contact.normal_x, 1, 1e-6);
  EXPECT_EQ(contact.j, -1);
  EXPECT_NEAR(contact.impulse_t / contact.impulse_n, 0.4, 1e-12);
}

TEST(CsvImport, RefusesWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string description = std::string(head) + one_file;
  const auto refused = [&](const std::string& rows) {
    folder.with("grains.csv", rows);
    return refusal(folder, description);
  };
  const std::string good = std::string(names) + "# a comment\n1,1,0,0,0,0,0.5\n";
  for (const auto& [rows, message] : std::vector<std::pair<std::string, std::string>>{
           {good + "1,2,0,0,0,0\n", "grains.csv:4: holds 6 fields (allowed: 7"},
           {good + "1,2,0,0,abc,0,1\n", "grains.csv:4: v_x_m_s: \"abc\" is no number"},
           {good + "1,2,0,0,inf,0,1\n", "grains.csv:4: v_x_m_s: \"inf\" is no number"},
           {good + "1,1,0,0,0,0,0.5\n", "grains.csv:4: id: 1 appears twice"},
           {good + "1,2.5,0,0,0,0,0.5\n", "grains.csv:4: id: 2.5 is no id"},
           {good + "1,2,0,0,0,0,-0.1\n", "grains.csv:4: radius_m: is not above 0"},
           {good + "0.5,1,0,0,0,0,0.5\n",
            "grains.csv:4: time_s: 0.5 s does not go on from 1 s (allowed: times that ascend)"},
           {good + "2,2,0,0,0,0,0.5\n", "grains.csv:4: id: grain 1 is gone"},
           {good + "2,1,0,0,0,0,0.5\n2,2,1,0,0,0,0.5\n", "grain 2 was not there before"},
           {"x_m,z_m,v_x_m_s,v_z_m_s\n0,0,0,0\n",
            "radius_m: no such column among x_m, z_m, v_x_m_s, v_z_m_s"},
           {"x_m;z_m;radius_m\n0,5;0;1\n",
            "grains.csv:1: the name \"x_m;z_m;radius_m\" holds a semicolon or a tab (allowed: commas"},
           {"time_s,x_m,x,z_m\n", "grains.csv:1: x: appears twice"},
           {"x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n0,0,0,0,1\n", "the time is not known"},
           {good + "1,2,1,0,1e308,0,0.5\n", "grains.csv:4: v_x_m_s: is 3.19e+307 of the unit"},
           {"time_s,x_m,z_m,v_x_m_s,v_z_m_s,radius_m\n1e200,0,0,0,0,0.5\n", "time_s: is 3.13e+200 sqrt(d/g)"},
           {good + "1,2,0,0,0,0,0.5\n", "grains.csv:4: x_m, z_m: grains 1 and 2 are in one place"},
           {"x_m,z_m,radius_m\n0,0,1\n", "the time is not known"},
           {"time_s,x_m,z_m,radius_m\n0,0,0,1\n",
            "v_x_m_s: no such column (allowed: one, or grains.velocities"},
           {"\x1f\x8b\x08", "grains.csv: is compressed"},
           {"# nothing\n", "holds no line of column names"},
           {names, "hold no snapshot"}}) {
    const std::string said = refused(rows);
    expect_has(said, message);
  }
  expect_has(refusal(folder, std::string(head) + "[csv]\ngrains = [\"none-*.csv\"]\n"),
             "no file of such a name");
  // Found by fuzzing.
  expect_has(refusal(folder, std::string(head) + "[csv]\ngrains = [\"" + std::string(300, 'x') + "\"]\n"),
             "has too long a name");
  std::filesystem::create_symlink("round-1", folder / "round-1");
  expect_has(refusal(folder, std::string(head) + "[csv]\ngrains = [\"round-*\"]\n"),
             "is a link that leads back to itself");
  folder.with("grains.csv", good + "2,2,0,0,0,0,0.5\n");
  EXPECT_EQ(imported(folder, std::string(head) + "may_change = true\n" + one_file).snapshots.size(), 2u);
}

// Two snapshots of MercuryDPM: number and time above each, then x y z, v, radius, angles, omega, species.
TEST(CsvImport, TakesPlainColumnsWithAHeadingAboveEachSnapshot) {
  const TemporaryFolder folder;
  const std::string description = std::string(head) +
                                  "[csv]\ngrains = [\"drum.data\"]\nheading = [\"count\", \"time_s\"]\n"
                                  "columns = [\"x_m\", \"y\", \"z_m\", \"v_x_m_s\", \"v_y\", \"v_z_m_s\", "
                                  "\"radius_m\", \"a\", \"b\", \"c\", "
                                  "\"omega_x\", \"spin_clockwise_rad_s\"]\n";
  const std::string
      first =
          "2 0.5 0 0 0 1 1 1 \n0.1 0 0.2 3 0 4 0.005 0 0 0 nan 7 0 1\n0.3 0 0.2 0 0 0 0.005 0 0 0 0 0 0 1\n",
      second =
          "2 0.75 0 0 0 1 1 1 \n0.1 0 0.2 3 0 4 0.005 0 0 0 0 7 0 1\n0.3 0 0.2 0 0 0 0.005 0 0 0 0 0 0 1\n";
  folder.with("drum.data", first + second);
  const auto result = imported(folder, description);
  ASSERT_EQ(result.snapshots.size(), 2u);
  const double d = 0.01, t = std::sqrt(d / 9.81);
  EXPECT_NEAR(result.snapshots[1].time, 0.75 / t, 1e-12);
  EXPECT_NEAR(result.snapshots[0].x[0], 10, 1e-12);
  EXPECT_NEAR(result.snapshots[0].z[0], 20, 1e-12);
  EXPECT_NEAR(result.snapshots[0].v_z[0], 4 * t / d, 1e-9);
  EXPECT_NEAR(result.snapshots[0].spin[0], 7 * t, 1e-12);
  // Cut off anywhere, by a line or within one: the first is there, and what happened is said.
  for (std::size_t kept = 1; kept + 1 < second.size(); ++kept) {
    folder.with("drum.data", first + second.substr(0, kept));
    const auto cut = imported(folder, description);
    EXPECT_EQ(cut.snapshots.size(), 1u) << kept;
    ASSERT_EQ(cut.report.left_out.size(), 1u) << kept;
    expect_has(cut.report.left_out[0], "is cut off");
  }
  folder.with("drum.data", first.substr(0, 30));
  expect_has(refusal(folder, description), "drum.data:2: holds 4 fields (allowed: 12");
  expect_has(refusal(folder, std::string(head) + "[csv]\ngrains = [\"drum.data\"]\nheading = [\"time_s\"]\n"),
             "csv.heading");
}

TEST(CsvImport, LeavesOutALastSnapshotThatEndsWithinALine) {
  const TemporaryFolder folder;
  const std::string whole = std::string(names) + "1,1,0,0,0,0,0.5\n1,2,1,0,0,0,0.5\n2,1,0,0,0,0,0.5\n";
  folder.with("grains.csv", whole + "2,2,1,0,");
  const auto result = imported(folder, std::string(head) + one_file);
  EXPECT_EQ(result.snapshots.size(), 1u);
  ASSERT_EQ(result.report.left_out.size(), 1u);
  expect_has(result.report.left_out[0], "grains.csv:5: is cut off");
  folder.with("grains.csv", whole + "2,2,1,0,\n");  // a line with its end is whole, and wrong
  expect_has(refusal(folder, std::string(head) + one_file), "grains.csv:5: holds 5 fields");
}

TEST(CsvImport, TakesVelocitiesFromDisplacements) {
  const TemporaryFolder folder;
  folder.with(
      "grains.csv",
      "time_s,id,x_m,z_m,radius_m\n1,1,0.9,0,0.05\n1,2,0.5,0,0.05\n3,1,0.1,0.2,0.05\n3,2,0.5,0,0.05\n");
  const auto result = imported(folder, std::string(head) + "velocities = \"displacements\"\n" + one_file +
                                           "[periodic_x]\nlength_m = 1\n");
  ASSERT_EQ(result.snapshots.size(), 1u);
  const double d = 0.1, t = std::sqrt(d / 9.81);
  const Snapshot& s = result.snapshots[0];
  EXPECT_EQ(s.step, 1);
  EXPECT_NEAR(s.time, 3 / t, 1e-12);
  EXPECT_NEAR(s.velocity_window, 2 / t, 1e-12);
  EXPECT_NEAR(s.displacement_x[0], 2, 1e-12);  // across the seam: 0.2 m
  EXPECT_NEAR(s.v_x[0], 0.1 * t / d, 1e-12);
  EXPECT_NEAR(s.v_z[0], 0.1 * t / d, 1e-12);
  EXPECT_EQ(s.v_x[1], 0);
  expect_has(result.report.left_out.at(0), "no snapshot before");
  EXPECT_NEAR(result.report.first_time_s, 3, 1e-12);
  expect_has(
      refusal(folder, std::string(head) + "velocities = \"displacements\"\nmay_change = true\n" + one_file),
      "grains.velocities");
}

TEST(ImportDescriptions, AreRefusedWithLineKeyAndRange) {
  const TemporaryFolder folder;
  const std::string said = refusal(folder,
                                   "format = \"drumlin-import-1\"\n[lammps]\ngrains = [\"a\"]\nplane = "
                                   "\"yz\"\nstep_s = 0\n[grains]\ncolour = 1\n");
  for (const char* part :
       {"import.toml:4:", "lammps.plane", "lammps.step_s", "grains.density_kg_m3", "grains.colour"})
    expect_has(said, part);
  const std::string contacts =
      refusal(folder,
              "format = \"drumlin-import-1\"\n[lammps]\ngrains = [\"a\"]\nstep_s = 1\ncontacts = "
              "[\"b\"]\n[grains]\ndensity_kg_m3 = 1\n");
  for (const char* part : {"lammps.contact_ids", "lammps.contact_forces", "lammps.depth_m"})
    expect_has(contacts, part);
}

}  // namespace
}  // namespace drumlin
