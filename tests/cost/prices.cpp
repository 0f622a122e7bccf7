// drumlin cost --effects, the command itself, on a drum of a dozen grains.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "apps/support/commands.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/common/errors.hpp"
#include "tests/cost/drum_of_a_dozen.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin {
namespace {

TEST(EffectPrices, AreListedPrintedAndDrawn) {
  const testing::TemporaryFolder folder;
  apps::CostOptions options;
  options.scene = folder.with("scene.toml", testing::drum_of_a_dozen);
  options.effects = true;
  options.output = folder / "cost";
  options.seconds = 0.15;
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(apps::cost(options), 0);
  const std::string printed = ::testing::internal::GetCapturedStdout();
  EXPECT_NE(printed.find("without gravity"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "cost" / "prices.png"));
  const auto report = read_json(folder / "cost" / "cost.json", "drumlin-effect-prices-1");
  std::map<std::string, nlohmann::ordered_json> rows;
  for (const auto& row : report.at("variants")) rows[row.at("name")] = row;
  // The scene once more is the same to the last bit: only the machine's part may differ.
  const auto &base = rows.at("as it is"), &again = rows.at("as it is, again");
  for (const char* key :
       {"contacts", "unknowns", "sweeps", "kinetic_energy_J_kg", "center_of_mass_mm", "overlap_d"})
    EXPECT_EQ(base.at(key), again.at(key)) << key;
  // Without gravity nothing moves, and the centre of mass says so.
  EXPECT_EQ(rows.at("without gravity").at("kinetic_energy_J_kg"), 0);
  EXPECT_GT(base.at("kinetic_energy_J_kg"), 0);
  EXPECT_LT(base.at("center_of_mass_mm")[1], rows.at("without gravity").at("center_of_mass_mm")[1]);
  EXPECT_EQ(base.at("unknowns_per_contact"), 2);
  EXPECT_EQ(rows.at("without friction: and spin, which needs it").at("unknowns_per_contact"), 1);
  EXPECT_EQ(rows.at("with rolling_resistance: 0.1").at("unknowns_per_contact"), 3);
#if !defined(__SANITIZE_ADDRESS__)  // the sanitizer has a heap of its own, which mallinfo2 does not see
  EXPECT_GT(base.at("bytes"), 0);
#endif
}

TEST(EffectPrices, AreNotWrittenOverWhatStandsThere) {
  const testing::TemporaryFolder folder;
  apps::CostOptions options;
  options.scene = folder.with("scene.toml", testing::drum_of_a_dozen);
  options.effects = true;
  options.output = folder / ".";
  EXPECT_THROW(apps::cost(options), InputError);
}

}  // namespace
}  // namespace drumlin
