// docs/formats/scene.md lists the keys as the program knows them.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "particles/scene/scene_file.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(SceneDocs, HoldTheTableThatTheProgramPrints) {
  std::ifstream page(drumlin::test::docs_folder() / "formats/scene.md");
  std::ostringstream text;
  text << page.rdbuf();
  expect_has(text.str(), keys_as_markdown(scene_keys()));
}

TEST(SceneDocs, SayAnUnitInEveryKeyThatHasOne) {
  for (const auto& row : scene_keys()) {
    EXPECT_FALSE(row.sentence.empty()) << row.path;
    // Dimensionless counts (turns, mean diameters) need none.
    if (row.unit.empty() || row.unit == "turns" || row.unit == "d") continue;
    const std::string suffix = row.unit == "turns/min" ? "rpm"
                               : row.unit == "kg/m3"   ? "kg_m3"
                               : row.unit == "m/s2"    ? "m_s2"
                               : row.unit == "mm/s"    ? "mm_s"
                               : row.unit == "Hz"      ? "hz"
                               : row.unit == "N/m"     ? "n_m"
                               : row.unit == "kg/m"    ? "kg_m"
                               : row.unit == "N/m2"    ? "n_m2"
                               : row.unit == "1/s"     ? "per_s"
                                                       : row.unit;
    EXPECT_TRUE(row.path.ends_with("_" + suffix)) << row.path;
  }
}

}  // namespace
}  // namespace drumlin
