// maps.h5: round trip, refusals, damage.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::map_files {
namespace {

using testing::expect_same;
using testing::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

FieldMap example() {
  FieldMap map;
  map.grid = {-1.5, -0.1, 0.75, 0.5, 3, 2};
  map.fields = {{"nu", {0.1, 1.0 / 3.0, 2e-300, -0.0, nan, 6}, {nan, 1, 2, 3, 4, 5}},
                {"k", {1, 2, 3, 4, 5, 6}, {}}};
  map.header.side = RunSide::particles;
  map.header.kernel = "a text, with = and # in it";
  map.header.further = {{"empty", ""}};
  map.scales = {3.3e-3, 0.018, 2700};
  return map;
}

TEST(MapFile, RoundTripKeepsEveryBit) {
  const TemporaryFolder folder;
  const FieldMap written = example();
  write_field_map(folder / "maps.h5", written);
  const FieldMap read = read_field_map(folder / "maps.h5");
  EXPECT_EQ(read.header, written.header);
  EXPECT_EQ(read.grid.columns, 3u);
  EXPECT_EQ(read.grid.rows, 2u);
  EXPECT_EQ(read.grid.x_first, -1.5);
  EXPECT_EQ(read.grid.spacing_x, 0.75);
  EXPECT_EQ(read.grid.z_first, -0.1);
  EXPECT_EQ(read.grid.spacing_z, 0.5);
  EXPECT_EQ(read.scales.time_s, 0.018);
  ASSERT_EQ(read.fields.size(), 2u);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(read.fields[f].name, written.fields[f].name);
    expect_same(read.fields[f].value, written.fields[f].value);
    expect_same(read.fields[f].ci99, written.fields[f].ci99);
  }
}

TEST(MapFile, FieldsAreTablesWithOneRowPerHeight) {
  const TemporaryFolder folder;
  write_field_map(folder / "maps.h5", example());
  EXPECT_EQ(H5Reader(folder / "maps.h5").shape("fields/nu"), (std::vector<std::size_t>{2, 3}));
}

TEST(MapFile, RowsGivenOneAfterTheOtherMakeTheSameBytes) {
  const TemporaryFolder folder;
  const FieldMap map = example();
  write_field_map(folder / "whole.h5", map);
  FieldMap outline = map;
  outline.fields.clear();
  const auto rows = [&](std::ptrdiff_t from) {
    std::vector<MapField> fields = map.fields;
    for (MapField& field : fields)
      for (auto* values : {&field.value, &field.ci99})
        if (!values->empty()) *values = {values->begin() + from, values->begin() + from + 3};
    return fields;
  };
  FieldMapWriter writer(folder / "rows.h5", outline);
  writer.add(rows(0));
  EXPECT_FALSE(std::filesystem::exists(folder / "rows.h5"));
  EXPECT_THROW(writer.save(), InputError);  // a row is missing
  writer.add(rows(3));
  writer.save();
  EXPECT_EQ(file_text(folder / "rows.h5"), file_text(folder / "whole.h5"));
}

TEST(MapFile, RowsThatAreGivenUpLeaveNothing) {
  const TemporaryFolder folder;
  FieldMap outline = example();
  outline.fields.clear();
  { FieldMapWriter writer(folder / "maps.h5", outline); }
  EXPECT_TRUE(std::filesystem::is_empty(folder / "."));
}

TEST(MapFile, PackedOneKeepsValuesTo3e5AndIntervalsToOnePercent) {
  const TemporaryFolder folder;
  FieldMap map = example();
  map.grid = {0, 0, 1, 1, 300, 100};
  for (MapField& field : map.fields) {
    const bool with_interval = !field.ci99.empty();
    field.value.clear(), field.ci99.clear();
    for (std::size_t node = 0; node < map.grid.nodes(); ++node) {
      const auto k = static_cast<double>(node);
      field.value.push_back(node % 7 == 0 ? nan : std::pow(-1, k) * std::exp(k / 3000 - 9));
      if (with_interval) field.ci99.push_back(node % 7 == 0 ? nan : std::exp(k / 4000 - 12));
    }
  }
  write_field_map(folder / "maps.h5", map, MapStorage::packed);
  const FieldMap read = read_field_map(folder / "maps.h5");
  EXPECT_EQ(read.header, map.header);
  const auto expect_near = [](const std::vector<double>& a, const std::vector<double>& b, double share) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(std::isnan(a[i]), std::isnan(b[i]));
      if (std::isnan(a[i])) continue;
      EXPECT_NEAR(a[i], b[i], share * std::abs(b[i]));
    }
  };
  for (std::size_t f = 0; f < 2; ++f) {
    expect_near(read.fields[f].value, map.fields[f].value, 3.1e-5);
    expect_near(read.fields[f].ci99, map.fields[f].ci99, 0.01);
  }
  write_field_map(folder / "again.h5", map, MapStorage::packed);
  EXPECT_EQ(file_text(folder / "maps.h5"), file_text(folder / "again.h5"));
  write_field_map(folder / "whole.h5", map);
  EXPECT_LT(4 * file_text(folder / "maps.h5").size(), file_text(folder / "whole.h5").size());
}

TEST(MapFile, MissingFieldIsNamed) {
  EXPECT_EQ(example().find("mu"), nullptr);
  expect_has(message_of<InputError>([] { example().field("mu"); }), "mu");
}

TEST(MapFile, WhatCouldNotBeReadBackIsNotWritten) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& part, auto spoil) {
    FieldMap map = example();
    spoil(map);
    const auto message = message_of<InputError>([&] { write_field_map(folder / "maps.h5", map); });
    expect_has(message, part);
    EXPECT_FALSE(std::filesystem::exists(folder / "maps.h5"));
  };
  refused("no nodes", [](FieldMap& map) { map.grid.rows = 0; });
  refused("spacing", [](FieldMap& map) { map.grid.spacing_x = 0; });
  refused("nowhere", [](FieldMap& map) { map.grid.z_first = nan; });
  refused("k has another length", [](FieldMap& map) { map.fields[1].value.pop_back(); });
  refused("nu has another length", [](FieldMap& map) { map.fields[0].ci99.pop_back(); });
  refused("nu appears twice", [](FieldMap& map) { map.fields[1].name = "nu"; });
  refused("\"a/b\"", [](FieldMap& map) { map.fields[0].name = "a/b"; });
  refused("fields/nu: is inf in row 1, column 3", [](FieldMap& map) { map.fields[0].value[2] = HUGE_VAL; });
  refused("header", [](FieldMap& map) { map.header.further["a=b"] = "c"; });
}

/// A file as write_field_map leaves it, with one dataset more, less or changed.
struct Parts {
  std::string format = "drumlin-maps-1", names = "nu\n", header = "side = particles\n";
  std::vector<double> x{0, 1, 2}, z{0, 1}, nu{1, 2, 3, 4, 5, 6};
  std::size_t columns = 3;
};

std::string refusal_of(const Parts& parts) {
  const TemporaryFolder folder;
  H5Writer out;
  out.add_text("format", parts.format);
  out.add_text("header", parts.header);
  out.add_text("names", parts.names);
  for (const char* scale : {"scales/length_m", "scales/time_s", "scales/density_kg_m3"})
    out.add_number(scale, 1.0);
  out.add("x", std::span<const double>(parts.x));
  out.add("z", std::span<const double>(parts.z));
  out.add_table("fields/nu", parts.nu, parts.columns);
  out.save(folder / "maps.h5");
  const auto message = message_of<InputError>([&] { read_field_map(folder / "maps.h5"); });
  expect_has(message, "maps.h5");
  return message;
}

TEST(MapFile, ReaderRefusesWhatItDoesNotUnderstand) {
  expect_has(refusal_of({.format = "drumlin-maps-2"}), "this version reads drumlin-maps-1");
  expect_has(refusal_of({.names = "nu\nmu\n"}), "fields/mu");
  expect_has(refusal_of({.header = "no equals sign\n"}), "header");
  expect_has(refusal_of({.x = {0, 1, 3}}), "equal steps");
  expect_has(refusal_of({.x = {2, 1, 0}}), "equal steps");
  expect_has(refusal_of({.z = {}}), "empty");
  expect_has(refusal_of({.x = {0, 1}}), "fields/nu");
  expect_has(refusal_of({.columns = 2}), "fields/nu");
  expect_has(refusal_of({.x = {0, 1e300, 2e300}}), "x: is 1e+300");
  expect_has(refusal_of({.nu = {1, 2, HUGE_VAL, 4, 5, 6}}), "fields/nu: is inf in row 1, column 3");
  expect_has(refusal_of({.nu = {1, 2, 3, 4, -1e300, 6}}),
             "fields/nu: is -1e+300 in row 2, column 2 (allowed: at most 1e+100 from 0");
}

TEST(MapFile, EveryCutAndEveryByteChangedIsRefused) {
  const TemporaryFolder folder;
  write_field_map(folder / "maps.h5", example());
  const std::string good = file_text(folder / "maps.h5");
  for (std::size_t place = 0; place < good.size(); place += 97) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 1);
    EXPECT_THROW(read_field_map(folder.with("bad.h5", bad)), InputError) << place;
    EXPECT_THROW(read_field_map(folder.with("bad.h5", good.substr(0, place))), InputError) << place;
  }
}

}  // namespace
}  // namespace drumlin::map_files
