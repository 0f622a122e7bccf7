#include "coupling/comparison/paper_table.hpp"

#include <gtest/gtest.h>

#include "tests/comparison/example.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin::paper_table_test {
using namespace coupling;
namespace {

const std::filesystem::path paper = drumlin::test::data_folder() / "paper";

const PaperRow& row(const std::vector<PaperRow>& rows, const std::string& name) {
  for (const auto& candidate : rows)
    if (candidate.paper.name == name) return candidate;
  throw std::runtime_error(name);
}

TEST(PaperTable, FindsTheSpeedOfThePapersDrum) {
  EXPECT_EQ(paper_speed_rpm(testing::example_profiles(), paper), 6);
  auto faster = testing::example_profiles();
  faster.header.rotation = 0.02881;
  EXPECT_EQ(paper_speed_rpm(faster, paper), 15);
}

TEST(PaperTable, HoldsNothingForAnotherDrum) {
  for (const auto& [key, value] : std::map<std::string, std::string>{
           {"reduced", "true"}, {"drum_radius", "30"}, {"rotation", "0.0134"}, {"diameter_m", "0.001"}}) {
    auto other = testing::example_profiles();
    testing::set_entry(other.header, key, value);
    EXPECT_FALSE(paper_speed_rpm(other, paper).has_value()) << key;
  }
}

TEST(PaperTable, TakesTableOneAtItsSpeed) {
  const double table[][4] = {{2, 8, 18.1, 9},       {4, 15.3, 18.9, 11.5},  {5, 19.5, 19.3, 13.3},
                             {6, 21.8, 19.7, 14.6}, {10, 39.8, 21.2, 17.2}, {15, 57.7, 23.0, 21.0}};
  for (const auto& [rpm, Q, theta, H] : table) {
    const auto numbers = paper_numbers(paper, rpm);
    EXPECT_EQ(numbers[0].value, theta);
    EXPECT_EQ(numbers[1].value, Q);
    EXPECT_EQ(numbers[2].value, H);
  }
}

TEST(PaperTable, PrefersTheNumberOfThisSpeedAndNamesEverySource) {
  const auto lambda = [](double rpm) {
    for (const auto& number : paper_numbers(paper, rpm))
      if (number.name == "lambda") return number.value;
    return 0.0;
  };
  EXPECT_EQ(lambda(6), 3.4);
  EXPECT_EQ(lambda(15), 3.0);
  for (const auto& number : paper_numbers(paper, 6)) EXPECT_FALSE(number.source.empty()) << number.name;
}

TEST(PaperTable, SaysHowFarThePapersOwnNumbersFitALinearLayer) {
  const auto numbers = paper_numbers(paper, 6);
  EXPECT_EQ(numbers.back().name, "linear_layer_share");
  EXPECT_NEAR(numbers.back().value, 0.587, 0.001);
  EXPECT_NE(paper_numbers(paper, 2).back().name, "linear_layer_share") << "it gives no shear rate there";
}

TEST(PaperTable, JudgesBothSidesAndTheAcceptedDifferenceIsStated) {
  const std::vector<ScalarPair> scalars{{"theta_deg", 19.4, 0.3, 18.6}, {"H", 19.3, 0.4, 18.5}};
  const auto rows = paper_table(paper_numbers(paper, 6), scalars);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(row(rows, "theta_deg").particles, Outcome::met);
  EXPECT_EQ(row(rows, "theta_deg").continuum, Outcome::missed);
  EXPECT_EQ(row(rows, "H").particles, Outcome::missed);
  EXPECT_NEAR(row(rows, "H").accepted, 1.46, 1e-12);
}

TEST(PaperTable, EveryMeasuredNumberOfThePaperHasAnAcceptedDifference) {
  std::vector<ScalarPair> scalars;
  for (const auto& pair : compare(testing::example_side(), testing::example_side()).scalars)
    scalars.push_back({pair.name, 1, std::nullopt, 1});
  for (const auto& entry : paper_table(paper_numbers(paper, 6), scalars))
    EXPECT_GT(entry.accepted, 0) << entry.paper.name;
}

}  // namespace
}  // namespace drumlin::paper_table_test
