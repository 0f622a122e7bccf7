// What validate() finds: parts of a scene that do not fit together, each with the key to change
// (contradictions.json).
#include <map>
#include <nlohmann/json.hpp>

#include "coupling/core/files/text_file.hpp"
#include "tests/scene/example.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace testing;
namespace {

/// A cell of 20 mm that is periodic in x and z, a tube or a strip where one of the periods is left out.
std::string cell(const std::string& periods) {
  return "format = \"drumlin-scene-1\"\n" + periods +
         test::generated_grains(8, "{ shape = \"rectangle\", min_mm = [0, 0], max_mm = [20, 20] }") +
         "[[stages]]\nname = \"shear\"\nduration_s = 0.1\ntime_step_s = 1e-3\ncell = { shear_rate_per_s = 1 "
         "}\n";
}

TEST(Contradiction, IsTheOnlyProblemAndNamesItsKey) {
  const std::string x = "periodic_x = { x_min_mm = 0, x_max_mm = 20 }\n",
                    z = "periodic_z = { z_min_mm = 0, z_max_mm = 20 }\n";
  const std::map<std::string, std::string> scenes{
      {"example", example_scene}, {"cell", cell(x + z)}, {"open", cell(x)}, {"tube", cell(z)}};
  const auto table = nlohmann::json::parse(
      file_text(test::data_folder().parent_path() / "tests/scene/contradictions.json"), nullptr, true, true);
  for (const auto& [scene, rows] : table.items())
    for (const auto& row : rows) {
      SCOPED_TRACE(row.dump());
      if (row.size() == 1) {
        EXPECT_TRUE(scene_problems(scenes.at(scene), row[0]).empty());
        continue;
      }
      const std::string problem = only_scene_problem(scenes.at(scene), row[0]);
      expect_has(problem, row[1].get<std::string>() + ": ");
      expect_has(problem, row[2].get<std::string>());
    }
}

TEST(Contradiction, AbsurdNumbersEndInAMessage) {
  // None of these may hang, overflow or allocate without end.
  for (const char* wild :
       {"grains.generated.diameter_max_mm=1e-300", "grains.generated.region.radius_mm=1e300",
        "stages.0.duration_s=1e300", "stages.0.time_step_s=5e-324", "stages.1.motions.0.speed_rpm=1e-300",
        "grains.generated.region={shape=\"rectangle\", min_mm=[0,-1e6], max_mm=[1e-9,1e6]}",
        "grains.generated.count=1000000"})
    EXPECT_FALSE(scene_problems(example_scene, {wild}).empty()) << wild;
}

}  // namespace
}  // namespace drumlin
