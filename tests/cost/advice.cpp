#include "apps/commands/cost/advice.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

Json point(const std::string& name, bool of_the_scene, double seconds, double H, double theta) {
  return {{"name", name},
          {"default", of_the_scene},
          {"cpu_seconds", seconds},
          {"errors", {{"H", H}, {"theta", theta}}}};
}

std::string lines_of(const Json& made) { return "--set " + made.at("name").get<std::string>(); }

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Advice, NamesTheCheapestPointOfEachErrorAndWhatToPaste) {
  const Json points = {point("fine", false, 40, 0.004, 0.001), point("scene", true, 10, 0.015, 0.002),
                       point("coarse", false, 2, 0.04, 0.06)};
  const std::string text = advice_text(points, {"H", "theta"}, lines_of);
  EXPECT_TRUE(holds(text,
                    "H: 5 %: coarse (0.2 times the scene's); 2 %: scene (the scene as it is); 1 %: fine (4 "
                    "times the scene's)"))
      << text;
  EXPECT_TRUE(holds(text, "theta: 5 %: scene (the scene as it is); 2 %: scene")) << text;
  EXPECT_TRUE(holds(text, "coarse:  --set coarse")) << text;
  EXPECT_TRUE(holds(text, "fine:  --set fine")) << text;
  EXPECT_FALSE(holds(text, "wastes")) << text;
}

TEST(Advice, SaysWhatTheSceneWastesAndLacks) {
  const Json points = {point("scene", true, 10, 0.08, 0.002), point("other", false, 3, 0.07, 0.002)};
  const std::string text = advice_text(points, {"H", "theta"}, lines_of);
  EXPECT_TRUE(holds(text, "H: 5 %: none; 2 %: none; 1 %: none")) << text;
  EXPECT_TRUE(holds(text, "the scene as it is leaves 8 %")) << text;
  EXPECT_TRUE(holds(text, "other is as exact in all of these at 0.3 of its cost")) << text;
}

TEST(Advice, KeepsAwayFromWhatIsNotKnown) {
  Json points = {point("scene", true, 10, 0.01, 0.01), point("failed", false, 1, 0, 0)};
  points[1]["cpu_seconds"] = nullptr;
  points[1]["errors"] = Json::object();
  const std::string text = advice_text(points, {"H", "theta"}, lines_of);
  EXPECT_FALSE(holds(text, "failed")) << text;
  EXPECT_EQ(advice_text(Json::array(), {"H"}, lines_of), "");
}

}  // namespace
}  // namespace drumlin::apps
