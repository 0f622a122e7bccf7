// Text dumps of LAMMPS: axes, units, boxes, walls made of atoms, contacts, and what is refused.
#include <gtest/gtest.h>

#include <tuple>

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

std::string tilted(const std::string& columns, const std::string& row) {
  return "ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 3 1\n0 2 0\n0 1 "
         "0\n"
         "ITEM: ATOMS " +
         columns + "\n" + row + "\n";
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
  EXPECT_EQ(result.report.unused_columns, (std::vector<std::string>{"type", "vz"}));
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

TEST(LammpsImport, ABoxThatIsPeriodicAlongXHasThePeriodOfTheDescriptionInEachFrame) {
  const TemporaryFolder folder;
  const std::string row = "1 0 0 5 0 0", columns = "id x y radius vx vy";
  const std::string told = description("[periodic_x]\nlength_m = 20\n");
  folder.with("dump.a", frame(1, columns, {row}));
  EXPECT_NEAR(imported(folder, told).snapshots.at(0).period_x * 9.81, 20, 1e-12);
  EXPECT_NEAR(imported(folder, description("")).report.unused_period_m.value(), 20, 1e-12);
  EXPECT_FALSE(imported(folder, told).report.unused_period_m);
  EXPECT_FALSE(imported(folder, description("[drum]\nradius_m = 40\n")).report.unused_period_m);
  expect_has(refusal(folder, description("[periodic_x]\nlength_m = 30\n")),
             "dump.a:1: BOX BOUNDS: are periodic over 20 m along x (allowed: 30 m, periodic_x.length_m");
  std::string wider = frame(2, columns, {row});
  folder.with("dump.a", frame(1, columns, {row}) + wider.replace(wider.find("-10 10"), 6, "-10 11"));
  expect_has(refusal(folder, told), "dump.a:11: BOX BOUNDS: are periodic over 21 m along x (allowed: 20 m");
  folder.with("dump.a", wider.replace(wider.find("pp ff"), 5, "ff pp"));
  EXPECT_EQ(imported(folder, told).snapshots.size(), 1u) << "walls along x may lie anywhere";
}

TEST(LammpsImport, APourBeginsWithItsFirstGrain) {
  const TemporaryFolder folder;
  const std::string columns = "id x y radius vx vy";
  folder.with("dump.a", frame(0, columns, {}) + frame(1, columns, {"1 0 0 5 0 0"}));
  folder.with("contacts", frame(0, "a b fx fy", {}, "ENTRIES") + frame(1, "a b fx fy", {}, "ENTRIES"));
  const auto result = imported(
      folder,
      description("contacts = [\"contacts\"]\ncontact_ids = [\"a\", \"b\"]\ncontact_forces = [\"fx\", "
                  "\"fy\"]\ndepth_m = 1\n"));
  ASSERT_EQ(result.snapshots.size(), 1u);
  ASSERT_EQ(result.report.left_out.size(), 1u);
  expect_has(result.report.left_out[0], "dump.a:1: has no grains yet");
}

TEST(LammpsImport, RefusesWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string columns = "id x y radius vx vy";
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {frame(1, columns, {"1 0 0 1 0 0", "2 0 0 1 0"}), "dump.a:11: holds 5 fields (allowed: 6"},
           {frame(1, columns, {"1 0 0 1 nan 0"}), "dump.a:10: vx: \"nan\" is no number"},
           {frame(1, columns, {"1 0 0 0 0 0"}), "dump.a:10: radius: is not above 0"},
           {frame(1, "id x y radius diameter vx vy", {"1 0 0 1 2 0 0", "2 5 0 1 1 0 0"}),
            "dump.a:11: radius, diameter: say that the radius is 1 m and 0.5 m"},
           {frame(1, columns, {"1 0 0 1 0 0", "1 2 0 1 0 0"}), "dump.a:11: id: 1 appears twice"},
           {frame(1, "id x y vx vy", {"1 0 0 0 0"}), "radius or diameter: no such column"},
           {frame(1, "id x y radius vx", {"1 0 0 1 0"}), "vy: no such column"},
           {frame(1, "id x y diameter vx vy", {"1 0 0 0 0 0"}), "dump.a:10: diameter: is not above 0"},
           {frame(1, columns, {"1 0 0 1 0 0", "2 0 0 1 1 0"}),
            "dump.a:11: x, y: grains 1 and 2 are in one place"},
           {tilted("id xs ys radius vx vy", "1 0 0 1 0 0"), "dump.a:9: xs: is scaled by a tilted box"},
           {frame(2, columns, {"1 0 0 1 0 0"}) + frame(1, columns, {"1 0 0 1 0 0"}), "times that ascend"},
           {frame(1, "id x y z radius vx vy", {"1 0 0 0 0.1 0 0", "2 0 0 5 0.1 0 0"}), "lie in space"},
           {frame(1, columns, {"1 0 0 1 0 0"}).substr(0, 60), "ends within a frame"},
           {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id xs ys radius vx vy\n1 0.5 0.5 1 0 "
            "0\n",
            "dump.a:5: xs: is scaled by a box that this frame does not give"},
           {"ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n2.7\n",
            "dump.a:4: NUMBER OF ...: is 2.7 (allowed: a whole number"},
           {"ITEM: TIMESTEP\n1.5\n", "dump.a:2: TIMESTEP: is 1.5 (allowed: a whole number"},
           {"ITEM: TIMESTEP\n1\nITEM: TIMESTEP\n2\n", "dump.a:3: TIMESTEP: appears a second time"},
           {"ITEM: TIMESTEP\n1\nITEM: BOX BOUNDS pp ff pp\n10 -10\n",
            "dump.a:4: BOX BOUNDS: are not in their order"},
           {"ITEM: TIMESTEP\n" + std::string(2 << 20, '1'), "dump.a:2: is longer than 1 MiB"},
           {"hello\n", "dump.a:1: \"hello\" is not expected here"},
           {"", "hold no snapshot"}}) {
    folder.with("dump.a", text);
    const std::string said = refusal(folder, description());
    expect_has(said, message);
  }
}

TEST(LammpsImport, ReadsTheUnitsAndTimesThatTheDumpNames) {
  const TemporaryFolder folder;
  const std::string head =
      "format = \"drumlin-import-1\"\n[grains]\ndensity_kg_m3 = 2000\n[lammps]\ngrains = [\"dump.*\"]\n";
  const auto dump = [](const std::string& units, const std::string& rows, double time) {
    return "ITEM: UNITS\n" + units + "\nITEM: TIME\n" + std::to_string(time) + "\n" +
           frame(1000, "id x y radius vx vy", {rows}) + "ITEM: TIME\n" + std::to_string(1.2 * time) + "\n" +
           frame(2000, "id x y radius vx vy", {rows});
  };
  // A disc of 2 mm at 20 mm, 0.1 m/s, at 0.025 s.
  for (const auto& [units, rows, time] :
       std::vector<std::tuple<std::string, std::string, double>>{{"si", "1 0.02 0 0.001 0.1 0", 0.025},
                                                                 {"cgs", "1 2 0 0.1 10 0", 0.025},
                                                                 {"micro", "1 2e4 0 1e3 0.1 0", 2.5e4},
                                                                 {"nano", "1 2e7 0 1e6 0.1 0", 2.5e7}}) {
    folder.with("dump.a", dump(units, rows, time));
    const auto result = imported(folder, head + "step_s = 1\n");
    ASSERT_EQ(result.snapshots.size(), 2u) << units;
    EXPECT_NEAR(result.report.scales.length_m, 0.002, 1e-15) << units;
    EXPECT_NEAR(result.report.first_time_s, 0.025, 1e-12) << units;
    EXPECT_NEAR(result.report.last_time_s, 0.03, 1e-12) << units;
    EXPECT_NEAR(result.snapshots[1].x[0], 10, 1e-9) << units;
    EXPECT_NEAR(result.snapshots[1].v_x[0] * result.report.scales.velocity_m_s(), 0.1, 1e-12) << units;
  }
  const auto refused = [&](const std::string& units, const std::string& more) {
    folder.with("dump.a", dump(units, "1 2 0 0.1 10 0", 1));
    return refusal(folder, head + more);
  };
  expect_has(refused("cgs", "length_unit_m = 1\n"),
             "UNITS: is \"cgs\", a unit of 0.01; lammps.length_unit_m is 1");
  expect_has(refused("real", ""), "dump.a:2: UNITS: is \"real\" (allowed: si, cgs, micro, nano, lj)");
  expect_has(refused("lj", "length_unit_m = 0.01\n"), "lammps.time_unit_s in the description");
  EXPECT_NEAR(imported(folder, head + "length_unit_m = 0.01\ntime_unit_s = 0.5\n").report.last_time_s, 0.6,
              1e-12);
  folder.with("dump.a", frame(1, "id x y radius vx vy", {"1 0 0 1 0 0"}));
  expect_has(refusal(folder, head), "TIMESTEP: counts steps whose length is not known");
}

TEST(LammpsImport, ReadsOnlyWhatItNeeds) {
  const TemporaryFolder folder;
  folder.with("dump.a", frame(4, "id type x xu y x radius diameter vx vy mol",
                              {"1 sand 9.81 7 0 8 4.9 9.8 0 0 water"}));
  const auto result = imported(folder, description());
  EXPECT_NEAR(result.snapshots.at(0).x.at(0), 1, 1e-12);  // the first that gives x
  EXPECT_NEAR(result.snapshots[0].radius[0] * 9.81, 4.9, 1e-12);
  EXPECT_EQ(result.report.unused_columns, (std::vector<std::string>{"mol", "type", "x", "xu"}));
  expect_has(refusal(folder, description("wall_types = [2]\n")), "dump.a:10: type: \"sand\" is no number");
  folder.with("dump.a", tilted("id x y radius vx vy", "1 2.5 1.5 4.9 0 0"));
  EXPECT_NEAR(imported(folder, description()).snapshots.at(0).x.at(0) * 9.81, 2.5, 1e-12);
}

TEST(LammpsImport, LeavesOutWhatIsWrittenTwiceOrCutOff) {
  const TemporaryFolder folder;
  const std::string columns = "id x y radius vx vy";
  const auto at = [&](int step) { return frame(step, columns, {"1 0 0 5 0 0", "2 9 0 5 0 1"}); };
  const std::string swapped = frame(2, columns, {"2 9 0 5 0 1", "1 0 0 5 0 0"});
  const auto contacts = [](int step) { return frame(step, "a b fx fy", {"1 2 -3 0"}, "ENTRIES"); };
  const std::string both = description(
      "contacts = [\"contacts\"]\ncontact_ids = [\"a\", \"b\"]\ncontact_forces = [\"fx\", \"fy\"]\ndepth_m = "
      "1\n");
  // A run that was started again writes the frame at which it starts once more, in any order.
  folder.with("dump.a", at(1) + at(2) + swapped + at(3));
  folder.with("contacts", contacts(1) + contacts(2) + contacts(2) + contacts(3));
  const auto again = imported(folder, both);
  ASSERT_EQ(again.snapshots.size(), 3u);
  EXPECT_EQ(again.report.contacts, 3u);
  ASSERT_EQ(again.report.left_out.size(), 1u);
  expect_has(again.report.left_out[0], "dump.a:23: is the snapshot before once more");
  folder.with("dump.a", at(1) + at(2) + frame(2, columns, {"1 0 0 5 0 0", "2 8 0 5 0 1"}));
  expect_has(refusal(folder, description()), "dump.a:23: TIMESTEP: 1 s does not go on from 1 s");
  // Cut off after any letter; the others are there, and what happened is said.
  const std::string last = at(3);
  for (std::size_t kept = 1; kept < last.size(); ++kept) {
    folder.with("dump.a", at(1) + at(2) + last.substr(0, kept));
    const auto cut = imported(folder, description());
    EXPECT_EQ(cut.snapshots.size(), 2u) << kept;
    ASSERT_EQ(cut.report.left_out.size(), 1u) << kept;
    expect_has(cut.report.left_out[0], "dump.a:23: is cut off");
  }
  // Grains whose contacts are cut off have no stress, and are left out too; contacts of such grains likewise.
  folder.with("dump.a", at(1) + at(2) + at(3));
  folder.with("contacts", contacts(1) + contacts(2) + contacts(3).substr(0, 70));
  EXPECT_EQ(imported(folder, both).snapshots.size(), 2u);
  folder.with("dump.a", at(1) + at(2) + at(3).substr(0, 70));
  folder.with("contacts", contacts(1) + contacts(2) + contacts(3));
  EXPECT_EQ(imported(folder, both).report.left_out.size(), 1u);
  // Anywhere else it is a fault.
  folder.with("dump.b", at(4));
  expect_has(refusal(folder, description()), "dump.a");
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
  expect_has(refusal(folder, named(stars)), "no file of such a name");
  EXPECT_EQ(imported(folder, named(stars + "*b")).snapshots.size(), 1u);
  EXPECT_EQ(imported(folder, named("*aab*")).snapshots.size(), 1u);
  expect_has(refusal(folder, named("*ab*b")), "no file of such a name");
}

}  // namespace
}  // namespace drumlin
