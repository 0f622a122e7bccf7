#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/document.hpp"
#include "coupling/core/documents/json_document.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

using testing::TemporaryFolder;

TEST(InputFile, WhatIsNoRegularFileIsRefusedByEveryReader) {
  const TemporaryFolder folder;
  for (const std::filesystem::path& file : {std::filesystem::path("/dev/zero"), folder.path()}) {
    const auto says_so = [&](const std::string& message) {
      expect_has(message, file.string());
      expect_has(message, file == folder.path() ? "not a file" : "no regular file");
    };
    says_so(message_of<InputError>([&] { (void)input_bytes(file, 1000); }));
    says_so(message_of<InputError>([&] { (void)file_text(file); }));
    says_so(message_of<InputError>([&] { (void)read_toml(file); }));
    says_so(message_of<InputError>([&] { (void)read_json(file, "drumlin-run-1"); }));
    says_so(message_of<InputError>([&] { (void)read_profiles(file); }));
    says_so(message_of<InputError>([&] { const H5Reader in(file); }));
  }
}

TEST(InputFile, NamesWhatCannotBeOpened) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("round", folder / "round");
  const auto message = [&](const std::filesystem::path& file) {
    return message_of<InputError>([&] { (void)input_bytes(file, 10); });
  };
  expect_has(message(folder / "none"), "does not exist");
  expect_has(message(folder / "round"), "leads back to itself");
  expect_has(message(folder / std::string(300, 'x')), "too long a name");
}

// Sparse: nothing of it is on the disk, all of it would be in memory.
TEST(InputFile, LargerThanAllowedIsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  const auto file = folder.with("large", "");
  std::filesystem::resize_file(file, largest_binary_file() + 1);
  const double allowed = static_cast<double>(largest_binary_file()) / (1 << 30);
  EXPECT_GE(allowed, 4);
  expect_has(message_of<InputError>([&] { const H5Reader in(file); }),
             fmt::format("at most {:g} GiB", allowed));
  expect_has(message_of<InputError>([&] { (void)file_text(file); }), "at most 1 GiB");
  expect_has(message_of<InputError>([&] { (void)read_toml(file); }), "at most 1 MiB");
  expect_has(message_of<InputError>([&] { (void)read_json(file, "x"); }), "at most 64 MiB");
  std::filesystem::resize_file(file, 10);
  EXPECT_EQ(input_bytes(file, 10), std::string(10, '\0'));
}

TEST(InputFile, MarkOfUtf8IsSkippedAndThoseOfOthersAreNamed) {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(input_text(folder.with("a", mark + "x,y\n")), "x,y\n");
  EXPECT_EQ(file_text(folder / "a"), mark + "x,y\n");  // the bytes
  EXPECT_EQ(read_toml(folder.with("t.toml", mark + "a = 1\n")).root.find("a")->line, 1);
  EXPECT_EQ(read_json(folder.with("j", mark + R"({"format": "f", "n": 3})"), "f")["n"], 3);
  EXPECT_EQ(
      read_profiles(folder.with("p.csv", mark + "# drumlin-profiles-1\nz,v_x\n-1,2\n")).column("v_x").value,
      std::vector<double>{2});
  for (const std::string& other : {std::string("\xFF\xFEx\0", 4), std::string("\xFE\xFF\0x", 4)})
    expect_has(message_of<InputError>([&] { (void)input_text(folder.with("b", other)); }), "UTF-16");
}

}  // namespace
}  // namespace drumlin
