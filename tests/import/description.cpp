// Descriptions of the files of other programs: what is refused with its place, and which files a pattern
// names. What is then read is tested in tests/python/test_importing.py.
#include "particles/import/description.hpp"

#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::TemporaryFolder;

TEST(ImportDescriptions, AreRefusedWithLineKeyAndRange) {
  const TemporaryFolder folder;
  for (const auto& [text, parts] : std::vector<std::pair<std::string, std::vector<const char*>>>{
           {"[lammps]\ngrains = [\"a\"]\nplane = \"yz\"\nstep_s = 0\n[grains]\ncolour = 1\n",
            {"import.toml:4:", "lammps.plane", "lammps.step_s", "grains.density_kg_m3", "grains.colour"}},
           {"[lammps]\ngrains = [\"a\"]\nstep_s = 1\ncontacts = [\"b\"]\n[grains]\ndensity_kg_m3 = 1\n",
            {"lammps.contact_ids", "lammps.contact_forces", "lammps.depth_m"}},
           {"[csv]\ngrains = [\"a\"]\nheading = [\"time_s\"]\n[grains]\ndensity_kg_m3 = 1\n",
            {"csv.heading: appears without columns", "\"count\" once among its names"}},
           {"dimensions = 3\n[files]\ngrains = [\"a\"]\n[grains]\ndensity_kg_m3 = 1\n[drum]\nradius_m = 1\n",
            {"drum: appears beside dimensions = 3"}},
           {"[files]\ngrains = [\"a\"]\ncontacts = [\"b\"]\n[grains]\ndensity_kg_m3 = "
            "1\n[periodic_y]\nlength_m = "
            "1\n",
            {"files.depth_m: is needed", "periodic_y: appears without dimensions = 3"}},
           {"[lammps]\ngrains = [\"a\"]\ncontacts = [\"b\"]\ncontact_ids = [\"i\", \"j\"]\ncontact_forces = "
            "[\"x\", "
            "\"y\", \"z\"]\ndepth_m = 1\n[grains]\ndensity_kg_m3 = 1\n",
            {"lammps.contact_forces: is needed by the contacts", "2 names of columns, or 4 of two parts"}},
           {"[csv]\ngrains = [\"a\"]\n[grains]\ndensity_kg_m3 = 1\nmay_change = true\nvelocities = "
            "\"displacements\"\n",
            {"grains.velocities"}}}) {
    const auto file = folder.with("import.toml", "format = \"drumlin-import-1\"\n" + text);
    const std::string said = message_of<InputError>([&] { read_import_description(file); });
    for (const char* part : parts) expect_has(said, part);
  }
}

TEST(ImportDescriptions, FilesFollowEachOtherByTheirNumbers) {
  const TemporaryFolder folder;
  const std::string many(200, 'a');
  for (const std::string& name :
       {std::string("g9.csv"), std::string("g10.csv"), std::string("g100.csv"), many})
    folder.with(name, "");
  std::filesystem::create_symlink("round-1", folder / "round-1");
  const auto named = [&](const std::string& pattern) { return files_of(folder.path(), {pattern}); };
  EXPECT_EQ(named("g*.csv"),
            (std::vector<std::filesystem::path>{folder / "g9.csv", folder / "g10.csv", folder / "g100.csv"}));
  // Tried place by place for each star, this one would take longer than the universe is old.
  std::string stars;
  for (int k = 0; k < 60; ++k) stars += "*a";
  EXPECT_EQ(named(stars + "*").size(), 1u);
  EXPECT_EQ(named("*aaa*").size(), 1u);
  for (const auto& [pattern, message] : std::vector<std::pair<std::string, std::string>>{
           {stars + "*b", "no file of such a name"},
           {"*ab*b", "no file of such a name"},
           {"none", "no such file"},
           {std::string(300, 'x'), "has too long a name"},
           {"round-*", "is a link that leads back to itself"}})  // found by fuzzing
    expect_has(message_of<InputError>([&] { named(pattern); }), message);
}

}  // namespace
}  // namespace drumlin
