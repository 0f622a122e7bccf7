#include <gtest/gtest.h>

#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/scalar_set.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

using testing::TemporaryFolder;

TEST(ScalarFile, ReadsNumbersWithAndWithoutIntervalAndSkipsTheRest) {
  const TemporaryFolder folder;
  const auto set = read_scalars(folder.with("m.json", R"({"format": "drumlin-measured-1", "reduced": true,
    "theta_deg": {"value": 19.7, "ci99": 0.2}, "H": {"value": null, "ci99": null}, "unknowns": 9500,
    "settings": {"slice_width": 20}, "title": "drum"})"),
                                "drumlin-measured-1");
  ASSERT_EQ(set.scalars.size(), 3u);
  EXPECT_EQ(set.value("theta_deg"), 19.7);
  EXPECT_EQ(set.find("theta_deg")->ci99, 0.2);
  EXPECT_TRUE(std::isnan(set.value("H")));
  EXPECT_EQ(set.value("unknowns"), 9500);
  EXPECT_FALSE(set.find("unknowns")->ci99.has_value());
  expect_has(message_of<InputError>([&] { (void)set.value("Q"); }), "Q");
}

TEST(ScalarFile, RefusesAnotherFormatAndWhatIsNoJson) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto file = folder.with("m.json", text);
    return message_of<InputError>([&] { read_scalars(file, "drumlin-measured-1"); });
  };
  expect_has(refused(R"({"format": "drumlin-measured-2"})"), "drumlin-measured-1");
  expect_has(refused(R"({"Q": 21.8})"), "format");
  expect_has(refused("[1, 2]"), "object");
  expect_has(refused("{"), "m.json");
  expect_has(refused(""), "m.json");
  expect_has(refused(R"({"format": "drumlin-measured-1", "Q": {"value": "21.8"}})"), "Q.value");
  expect_has(refused(R"({"format": "drumlin-measured-1", "Q": {"value": 1, "ci99": "x"}})"), "Q.ci99");
  EXPECT_THROW(read_scalars(folder / "none.json", "drumlin-measured-1"), InputError);
  EXPECT_THROW(read_scalars(folder.path(), "drumlin-measured-1"), InputError);
}

}  // namespace
}  // namespace drumlin
