#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

TEST(TextFile, ReplacesTheOldContentWhole) {
  const TemporaryFolder folder;
  const auto file = folder.with("a", "a longer text than the new one");
  replace_file(file, std::string_view("new\0text", 8));
  EXPECT_EQ(file_text(file), std::string("new\0text", 8));
  replace_file(file, "");
  EXPECT_EQ(file_text(file), "");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);  // no half-written file beside
}

TEST(TextFile, FailedWriteLeavesTheOldFileAndNothingBeside) {
  const TemporaryFolder folder;
  EXPECT_THROW(replace_file(folder / "missing/a", "text"), IoError);
  fs::create_directory(folder / "taken");
  folder.with("taken/inside", "old");
  EXPECT_THROW(replace_file(folder / "taken", "new"), IoError);  // a folder gives way to no file
  EXPECT_EQ(file_text(folder / "taken/inside"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(TextFile, IsNotWrittenThroughAPlantedLink) {
  const TemporaryFolder folder;
  const auto theirs = folder.with("theirs", "years of work");
  for (const char* name : {"a", "a.part"}) fs::create_symlink(theirs, folder / name);
  replace_file(folder / "a", "new");
  EXPECT_EQ(file_text(theirs), "years of work");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / "a")));
  EXPECT_EQ(file_text(folder / "a"), "new");
}

TEST(TextFile, TheFileBeforeStaysUnderItsOtherName) {
  const TemporaryFolder folder;
  for (const char* text : {"first", "second", "third"}) replace_file(folder / "now", text, folder / "before");
  EXPECT_EQ(file_text(folder / "now"), "third");
  EXPECT_EQ(file_text(folder / "before"), "second");
}

}  // namespace
}  // namespace drumlin
