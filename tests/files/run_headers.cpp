// The header of profiles.csv and maps.h5: round trip, and one rule for all that is damaged.
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/run_header.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/headers.hpp"

namespace drumlin::run_headers_test {
namespace {

using testing::header_from;
using testing::TemporaryFolder;

/// Every key that a file can have.
const std::map<std::string, std::string> every_key{{"H", "14.6"},
                                                   {"axis_depth", "3.0000000000000004"},
                                                   {"band", "law, 8 draws"},
                                                   {"batches", "20"},
                                                   {"diameter_m", "0.0033"},
                                                   {"drum_radius", "68.18"},
                                                   {"gap", "1e-300"},
                                                   {"geometry", "drum"},
                                                   {"inner_radius", "10"},
                                                   {"interval_factor", "nan"},
                                                   {"kernel", "product of cubic B-splines"},
                                                   {"kernel_width", "1"},
                                                   {"layer_thickness", "1"},
                                                   {"outer_radius", "20"},
                                                   {"position", "-0"},
                                                   {"reduced", "false"},
                                                   {"revision", "0123456789ab-dirty"},
                                                   {"rotation", "0.0115"},
                                                   {"side", "continuum"},
                                                   {"slice_width", "20"},
                                                   {"snapshots", "400"},
                                                   {"theta_deg", "19.7"},
                                                   {"title", "a text, with = and # in it"},
                                                   {"wall_z", "-60"},
                                                   {"written_by", "somebody else"}};

TEST(RunHeader, RoundTripKeepsEveryKeyAndEveryText) {
  const RunHeader header = header_from(every_key);
  EXPECT_EQ(header_texts(header), every_key);
  EXPECT_EQ(header.side, RunSide::continuum);
  EXPECT_EQ(header.axis_depth, 3.0000000000000004);
  EXPECT_EQ(header.snapshots, 400u);
  EXPECT_TRUE(std::isnan(header.interval_factor.value()));
  EXPECT_EQ(header.further, (std::map<std::string, std::string>{{"written_by", "somebody else"}}));
  EXPECT_EQ(header_from(header_texts(header)).position, header.position);
}

TEST(RunHeader, LinesStandInTheOrderOfTheKeys) {
  RunHeader header;
  header.theta_deg = 19.5;
  header.H = 14;
  header.reduced = true;
  header.further["also"] = "this";
  EXPECT_EQ(header_lines(header, "# "), "# H = 14\n# also = this\n# reduced = true\n# theta_deg = 19.5\n");
}

TEST(RunHeader, WhatIsNotThereIsEmptyAndIsNotWritten) {
  const RunHeader header = header_from({});
  EXPECT_TRUE(header_texts(header).empty());
  EXPECT_TRUE(std::isnan(number_or_nan(header, &RunHeader::wall_z)));
  EXPECT_EQ(key_of(&RunHeader::wall_z), "wall_z");
  const auto message =
      message_of<InputError>([&] { (void)needed_number(header, &RunHeader::wall_z, "maps.h5"); });
  EXPECT_EQ(message, "maps.h5: wall_z: is missing (allowed: a finite number)");
}

struct Damage {
  const char *key, *text, *allowed;
};

class DamagedHeader : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedHeader, IsRefusedWithFileLineKeyValueAndWhatIsAllowed) {
  const TemporaryFolder folder;
  const auto file =
      folder.with("profiles.csv", "# drumlin-profiles-1\n# title = a drum\n# " + std::string(GetParam().key) +
                                      " = " + GetParam().text + "\nz,nu\n0,0.8\n");
  const auto message = message_of<InputError>([&] { (void)read_profiles(file); });
  EXPECT_EQ(message, file.string() + ":3: " + GetParam().key + ": is \"" + GetParam().text +
                         "\" (allowed: " + GetParam().allowed + ")");
}

constexpr const char* number = "a number of at most 1e+100 from 0, or nan where it was not measured";
INSTANTIATE_TEST_SUITE_P(RunHeader, DamagedHeader,
                         ::testing::Values(Damage{"wall_z", "-6o", number}, Damage{"rotation", "", number},
                                           Damage{"interval_factor", "1e999", number},
                                           Damage{"drum_radius", "inf", number}, Damage{"H", "1e300", number},
                                           Damage{"axis_depth", "4 d", number},
                                           Damage{"theta_deg", "19,7", number},
                                           Damage{"snapshots", "-1", "a whole number from 0 up"},
                                           Damage{"batches", "20.5", "a whole number from 0 up"},
                                           Damage{"reduced", "yes", "true, false"},
                                           Damage{"side", "left", "particles, continuum"}));

TEST(DamagedHeaders, NameAllTheirFaultsAtOnce) {
  const TemporaryFolder folder;
  const auto file =
      folder.with("profiles.csv", "# drumlin-profiles-1\n# side = left\n# H = high\n# H = 3\n# remark\nz\n");
  try {
    (void)read_profiles(file);
    FAIL() << "was read";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 4u);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(error.problems()[static_cast<std::size_t>(i)].line, i + 2);
  }
}

TEST(RunHeader, RefusesToBeWrittenWhereItCouldNotBeRead) {
  const auto fault = [](auto spoil) {
    RunHeader header;
    spoil(header);
    return fault_of(header);
  };
  EXPECT_EQ(fault([](RunHeader&) {}), "");
  EXPECT_NE(fault([](RunHeader& header) { header.rotation = HUGE_VAL; }), "");
  EXPECT_NE(fault([](RunHeader& header) { header.title = "two\nlines"; }), "");
  EXPECT_NE(fault([](RunHeader& header) { header.further["a=b"] = "c"; }), "");
  EXPECT_NE(fault([](RunHeader& header) { header.further["wall_z"] = "c"; }), "");
}

TEST(NumberText, IsReadWholeOrRefusedWithItsPlace) {
  EXPECT_EQ(checked_number("-1.5e-3", {}), -1.5e-3);
  EXPECT_EQ(checked_count("12", {}), 12);
  const TextPlace place{"flow.csv", 7, "step"};
  for (const char* text : {"", " 1", "1 ", "nan", "inf", "1e999", "0x1", "one"})
    EXPECT_EQ(message_of<InputError>([&] { (void)checked_number(text, place); }),
              std::string("flow.csv:7: step: is \"") + text + "\" (allowed: a finite number)");
  for (const char* text : {"", "-1", "1.5", "99999999999", "1e3"})
    expect_has(message_of<InputError>([&] { (void)checked_count(text, place); }), "flow.csv:7: step");
}

}  // namespace
}  // namespace drumlin::run_headers_test
