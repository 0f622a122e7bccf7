// Files that are written aside: gone with their object, and when a signal handler ends the process.
#include "coupling/core/files/unfinished_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <vector>

namespace drumlin {
namespace {

namespace fs = std::filesystem;

class UnfinishedFiles : public ::testing::Test {
 protected:
  UnfinishedFiles() { fs::create_directory(folder); }
  ~UnfinishedFiles() override { fs::remove_all(folder); }
  fs::path folder = fs::temp_directory_path() / ("drumlin-unfinished-" + std::to_string(::getpid()));

  static void write(const fs::path& file) { std::ofstream(file) << "half of a"; }
};

TEST_F(UnfinishedFiles, GoWithTheirObjectAndStayUnderTheirFinalName) {
  {
    const UnfinishedFile lost(folder / "lost"), kept(folder / "kept"), never(folder / "never");
    write(lost.path());
    write(kept.path());
    fs::rename(kept.path(), folder / "whole");
  }
  EXPECT_FALSE(fs::exists(folder / "lost"));
  EXPECT_TRUE(fs::exists(folder / "whole"));
}

TEST_F(UnfinishedFiles, GoBeforeASignalHandlerEndsTheProcess) {
  const auto end_within = [&] {
    const UnfinishedFile one(folder / "one"), two(folder / "two");
    {
      const UnfinishedFile before(folder / "before");
      write(before.path());
      fs::rename(before.path(), folder / "whole");
    }
    write(one.path());
    write(two.path());
    remove_unfinished_files();
    ::_exit(7);
  };
  EXPECT_EXIT(end_within(), ::testing::ExitedWithCode(7), "");
  EXPECT_FALSE(fs::exists(folder / "one"));
  EXPECT_FALSE(fs::exists(folder / "two"));
  EXPECT_TRUE(fs::exists(folder / "whole"));
}

TEST_F(UnfinishedFiles, MoreThanAHandlerCanSeeStillGoWithTheirObjects) {
  std::vector<std::unique_ptr<UnfinishedFile>> many;
  for (int k = 0; k < 50; ++k) {
    many.push_back(std::make_unique<UnfinishedFile>(folder / std::to_string(k)));
    write(many.back()->path());
  }
  many.clear();
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace drumlin
