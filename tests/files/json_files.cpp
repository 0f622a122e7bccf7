#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/json/json_file.hpp"
#include "apps/json/records.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/results/run_records.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::apps {
namespace {

using drumlin::testing::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(JsonFile, WhatWasNotComputedIsNull) {
  EXPECT_EQ(to_json(Scalar{"H", nan, nan}).dump(), R"({"value":null,"ci99":null})");
  EXPECT_EQ(to_json(Scalar{"Q", 21.5, std::nullopt}).dump(), "21.5");
  EXPECT_EQ(to_json(Scalar{"Q", nan, std::nullopt}).dump(), "null");
}

TEST(JsonNumbers, AreNullWhereThereIsNone) {
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

TEST(JsonFile, ValuesOfAnotherTypeAreRefusedWithFileKeyAndWhatIsAllowed) {
  const TemporaryFolder folder;
  const auto refused = [&]<class T>(T, const std::string& rest) {
    const auto file = folder.with("x.json", std::string("{\"format\": \"") + T::format + "\", " + rest + "}");
    return drumlin::message_of<InputError>([&] { (void)read_json<T>(file); });
  };
  const auto expect = [&](auto record, const std::string& rest, const std::string& said) {
    expect_has(refused(record, rest), "x.json: " + said);
  };
  expect(RunRecord(), R"("cpu_seconds": null)", "cpu_seconds: is null (allowed: a number)");
  expect(RunRecord(), R"("title": "a\nb")", "title: is \"a\\nb\" (allowed: a text of one line)");
  expect(RunRecord(), R"("imported": "yes")", "imported: is \"yes\" (allowed: true or false)");
  expect(RunRecord(), R"("status": {})", "status: is {} (allowed: a text)");
  expect(RunRecord(), R"("cost": {"sweeps_mean": []})",
         "cost.sweeps_mean: is [] (allowed: a number or null)");
  expect(MeasuredRecord(), R"("reduced": {})", "reduced: is {} (allowed: true or false)");
  expect(MeasuredRecord(), R"("settings": [1])", "settings: is [1] (allowed: a table)");
  expect(FlowRecord(), R"("settings": {"law": [1, "a"]})", "settings.law: is [1,\"a\"] (allowed: a table)");
  expect(FlowRecord(), R"("meshes": [{"unknowns": 3}, {}])", "meshes.1.unknowns: is missing");
  expect(FlowRecord(), R"("settings": {"scales": {"time_s": "1"}})", "settings.scales.time_s: is \"1\"");
  expect(CostRecord(), R"("points": {"a": 1})", "points: is {\"a\":1} (allowed: an array)");
  expect(PlotsRecord(), R"("title": 3)", "figures: is missing (allowed: a table)");
  // All of them at once.
  const std::string both = refused(RunRecord(), R"("steps": "3", "grains": true)");
  expect_has(both, "steps:");
  expect_has(both, "grains:");
}

TEST(JsonFile, WhatWouldExhaustStackOrTimeIsRefused) {
  std::string keys = "{\"a\": 0";
  for (int k = 0; k < 10000; ++k) keys += ", \"k" + std::to_string(k) + "\": 0";
  EXPECT_THROW((void)parse_json(keys + "}", "k.json"), InputError);
  EXPECT_THROW((void)parse_json(std::string(100000, '['), "d.json"), InputError);
  EXPECT_THROW((void)parse_json("[1e999]", "n.json"), InputError);
  const std::string deep = std::string(31, '[') + std::string(31, ']');
  EXPECT_EQ(parse_json(deep, "d.json").dump(), deep);
}

}  // namespace
}  // namespace drumlin::apps
