#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin {
namespace {

using testing::TemporaryFolder;

TEST(TextFile, ReplacesTheOldContentWhole) {
  const TemporaryFolder folder;
  const auto file = folder.with("a", "a longer text than the new one");
  replace_file(file, "new\0text");
  EXPECT_EQ(file_text(file), "new\0text");
  replace_file(file, "");
  EXPECT_EQ(file_text(file), "");
}

TEST(TextFile, FailedWriteLeavesTheOldFileAndNothingBeside) {
  const TemporaryFolder folder;
  EXPECT_THROW(replace_file(folder / "missing/a", "text"), IoError);
  const auto file = folder.with("a", "old");
  std::filesystem::create_directory(file.string() + ".part");  // the place aside is taken
  EXPECT_THROW(replace_file(file, "new"), IoError);
  EXPECT_EQ(file_text(file), "old");
}

}  // namespace
}  // namespace drumlin
