// Numbers that wait on the disk come back as they were, and few of them are in memory.
#include "coupling/core/files/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstring>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {
namespace {

std::vector<std::byte> pattern(std::size_t size, unsigned seed) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 31 + i / 251 + seed);
  return bytes;
}

TEST(ScratchFile, GivesBackWhatWasAppended) {
  ScratchFile file;
  const std::size_t piece = 100'013;
  for (unsigned k = 0; k < 5; ++k) EXPECT_EQ(file.append(pattern(piece, k)), k * piece);
  for (unsigned k = 0; k < 5; ++k) {
    std::vector<std::byte> back(piece);
    file.read(k * piece, back);
    EXPECT_EQ(back, pattern(piece, k)) << k;
  }
  std::vector<std::byte> middle(100), across(200);
  file.read(2 * piece + 50, middle);
  const auto expected = pattern(piece, 2);
  EXPECT_EQ(std::memcmp(middle.data(), expected.data() + 50, 100), 0);
  file.read(piece - 100, across);  // of two appended one after the other
  EXPECT_EQ(std::memcmp(across.data() + 100, pattern(piece, 1).data(), 100), 0);
  EXPECT_THROW(file.read(5 * piece - 1, middle), IoError);
}

TEST(ScratchFile, LeavesNoNameBehind) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "drumlin-scratch-test";
  std::filesystem::create_directories(folder);
  {
    ScratchFile file(folder);
    file.append(pattern(1000, 1));
    EXPECT_TRUE(std::filesystem::is_empty(folder));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
}

TEST(ScratchFile, AFullDiskAndAMissingFolderAreSaid) {
  const auto much = pattern(2000, 1);
  EXPECT_THROW(ScratchFile("/nowhere/at/all").append(much), IoError);
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit small { 1000, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  ScratchFile file;
  EXPECT_THROW(file.append(much), IoError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
}

TEST(ScratchList, ListsThatShareAFileStayApart) {
  const auto file = std::make_shared<ScratchFile>();
  ScratchList<int> even(file), odd(file);
  for (int k = 0; k < 5000; ++k) (k % 2 == 0 ? even : odd).push_back(k);
  EXPECT_EQ(even.size(), 2500u);
  int next = 0;
  even.each([&](int k) {
    EXPECT_EQ(k, next);
    next += 2;
  });
  EXPECT_EQ(next, 5000);
  int sum = 0;
  odd.each([&](int k) { sum += k; });
  EXPECT_EQ(sum, 2500 * 2500);
}

}  // namespace
}  // namespace drumlin
