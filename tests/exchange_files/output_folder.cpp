#include "apps/support/output_folder.hpp"

#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin::apps {
namespace {

using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;

TEST(OutputFolder, IsMadeWithItsParents) {
  const TemporaryFolder folder;
  prepare_output(folder / "a/b", ExistingOutput::refuse, {"run.json"});
  EXPECT_TRUE(std::filesystem::is_directory(folder / "a/b"));
  prepare_output(folder / "a/b", ExistingOutput::refuse, {"run.json"});  // empty is as good as new
}

TEST(OutputFolder, WithContentIsRefusedAndTheWayOutNamed) {
  const TemporaryFolder folder;
  folder.with("run.json", "{}");
  const auto message =
      message_of<InputError>([&] { prepare_output(folder.path(), ExistingOutput::refuse, {"run.json"}); });
  EXPECT_NE(message.find("--resume"), std::string::npos);
  EXPECT_NE(message.find("--overwrite"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "run.json"));
}

TEST(OutputFolder, ResumeKeepsEverything) {
  const TemporaryFolder folder;
  folder.with("run.json", "{}");
  prepare_output(folder.path(), ExistingOutput::resume, {"run.json"});
  EXPECT_TRUE(std::filesystem::exists(folder / "run.json"));
}

TEST(OutputFolder, OverwriteEmptiesOnlyAFolderOfOurs) {
  const TemporaryFolder folder;
  folder.with("thesis.tex", "years of work");
  EXPECT_THROW(prepare_output(folder.path(), ExistingOutput::overwrite, {"run.json", "scene.toml"}),
               InputError);
  EXPECT_TRUE(std::filesystem::exists(folder / "thesis.tex"));
  folder.with("scene.toml", "");
  prepare_output(folder.path(), ExistingOutput::overwrite, {"run.json", "scene.toml"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OutputFolder, OverwriteSparesAFolderThatHoldsAnInput) {
  const TemporaryFolder folder;
  folder.with("run.json", "{}");
  const auto scene = folder.with("scene.toml", "mine");
  EXPECT_THROW(prepare_output(folder.path(), ExistingOutput::overwrite, {"run.json"}, {scene}), InputError);
  EXPECT_TRUE(std::filesystem::exists(scene));
}

TEST(OutputFolder, FileInItsPlaceIsRefusedAlways) {
  const TemporaryFolder folder;
  const auto file = folder.with("a", "text");
  for (const auto existing : {ExistingOutput::refuse, ExistingOutput::resume, ExistingOutput::overwrite})
    EXPECT_THROW(prepare_output(file, existing, {"run.json"}), InputError);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST(OutputFile, IsRefusedIfItExistsOrIsAFolder) {
  const TemporaryFolder folder;
  prepare_output_file(folder / "new/rheology.toml", ExistingOutput::refuse);
  EXPECT_TRUE(std::filesystem::is_directory(folder / "new"));
  const auto file = folder.with("rheology.toml", "");
  EXPECT_THROW(prepare_output_file(file, ExistingOutput::refuse), InputError);
  prepare_output_file(file, ExistingOutput::overwrite);
  EXPECT_THROW(prepare_output_file(folder.path(), ExistingOutput::overwrite), InputError);
}

}  // namespace
}  // namespace drumlin::apps
