#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/support/json_file.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin::apps {
namespace {

using drumlin::testing::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(JsonFile, ScalarsComeBackAsTheyWere) {
  const TemporaryFolder folder;
  nlohmann::ordered_json content{{"format", "drumlin-measured-1"}};
  add_scalars(content, {{{"theta_deg", 19.7, 0.25}, {"H", nan, nan}, {"unknowns", 9500, std::nullopt}}});
  write_json(folder / "m.json", content);
  const auto set = read_scalars(folder / "m.json", "drumlin-measured-1");
  ASSERT_EQ(set.scalars.size(), 3u);
  EXPECT_EQ(set.scalars[0].name, "theta_deg");
  EXPECT_EQ(set.value("theta_deg"), 19.7);
  EXPECT_EQ(set.find("theta_deg")->ci99, 0.25);
  EXPECT_TRUE(std::isnan(set.value("H")));
  EXPECT_FALSE(set.find("unknowns")->ci99.has_value());
}

TEST(JsonFile, WhatWasNotComputedIsNull) {
  EXPECT_EQ(to_json(Scalar{"H", nan, nan}).dump(), R"({"value":null,"ci99":null})");
  EXPECT_EQ(to_json(Scalar{"Q", 21.5, std::nullopt}).dump(), "21.5");
  EXPECT_EQ(to_json(Scalar{"Q", nan, std::nullopt}).dump(), "null");
}

TEST(JsonNumbers, AreNullWhereThereIsNone) {
  EXPECT_EQ(numbers_or_null(std::vector<double>{1.5, nan}).dump(), "[1.5,null]");
  EXPECT_EQ(number_or_null(std::optional<double>()).dump(), "null");
  EXPECT_EQ(number_or_nan(nlohmann::ordered_json(2)), 2);
  EXPECT_TRUE(std::isnan(number_or_nan(nullptr).value()));
  EXPECT_FALSE(number_or_nan("2"));
}

TEST(JsonFile, AnotherFormatIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_json(folder.with("a.json", R"({"format": "drumlin-run-2"})"), "drumlin-run-1"),
               InputError);
  EXPECT_THROW(read_json(folder.with("b.json", "{"), "drumlin-run-1"), InputError);
  EXPECT_EQ(read_json(folder.with("c.json", R"({"format": "drumlin-run-1", "steps": 3})"),
                      "drumlin-run-1")["steps"],
            3);
}

}  // namespace
}  // namespace drumlin::apps
