#include "apps/output/output_folder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/folder_lock.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;

OutputRequest request_for(const fs::path& folder, ExistingOutput existing = ExistingOutput::refuse,
                          const std::string& command = "measure") {
  return {folder, existing, command, {}};
}

/// Results of one file, as a command leaves them.
void leave(const fs::path& folder, const std::string& name, const std::string& text,
           ExistingOutput existing = ExistingOutput::refuse) {
  StagedOutput output(request_for(folder, existing));
  fs::create_directories((output.folder() / name).parent_path());
  replace_file(output.folder() / name, text);
  output.publish();
}

/// What stands in a folder, the manifest left out.
std::vector<std::string> content_of(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().filename() != manifest_name)
      names.push_back(entry.path().lexically_relative(folder));
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST(OutputFolder, IsMadeWithItsParentsAndSigned) {
  const TemporaryFolder folder;
  leave(folder / "a/b", "slices/1.csv", "1");
  check_all_files(open_result_folder(folder / "a/b"));
  EXPECT_EQ(content_of(folder / "a/b"), Names{"slices/1.csv"});
  EXPECT_TRUE(holds_results(folder / "a/b", "slices/1.csv"));
}

TEST(OutputFolder, WithContentIsRefusedAndTheWayOutNamed) {
  const TemporaryFolder folder;
  leave(folder.path(), "measured.json", "{}");
  const auto message = message_of<InputError>([&] { StagedOutput{request_for(folder.path())}; });
  expect_has(message, "--resume");
  expect_has(message, "--overwrite");
  EXPECT_TRUE(fs::exists(folder / "measured.json"));
}

TEST(OutputFolder, OfAStrangerIsRefusedWhateverWasAskedFor) {
  const TemporaryFolder folder;
  folder.with("log.csv", "of another program");
  for (const auto existing : {ExistingOutput::refuse, ExistingOutput::resume, ExistingOutput::overwrite}) {
    EXPECT_THROW(StagedOutput{request_for(folder.path(), existing)}, InputError);
    const auto message = message_of<InputError>(
        [&] { GrowingOutput(request_for(folder.path(), existing, "run"), {"log.csv"}); });
    expect_has(message, "drumlin accept");
    EXPECT_EQ(file_text(folder / "log.csv"), "of another program");
    EXPECT_EQ(content_of(folder.path()), Names{"log.csv"});
  }
}

TEST(OutputFolder, OfAnotherCommandIsRefused) {
  const TemporaryFolder folder;
  leave(folder.path(), "measured.json", "{}");
  for (const auto existing : {ExistingOutput::resume, ExistingOutput::overwrite})
    EXPECT_THROW(StagedOutput{request_for(folder.path(), existing, "plot")}, InputError);
}

TEST(OutputFolder, NewResultsReplaceTheOldOnesAndLeaveFilesOfOthers) {
  const TemporaryFolder folder;
  leave(folder.path(), "old/1.csv", "old");
  folder.with("notes.txt", "years of work");
  {
    StagedOutput output(request_for(folder.path(), ExistingOutput::overwrite));
    replace_file(output.folder() / "new.csv", "new");
    check_all_files(open_result_folder(folder.path()));  // the old ones, until the new are there
    EXPECT_EQ(file_text(folder / "old/1.csv"), "old");
    output.publish();
  }
  EXPECT_EQ(content_of(folder.path()), (Names{"new.csv", "notes.txt"}));
  EXPECT_FALSE(fs::exists(folder / "old"));
  check_all_files(open_result_folder(folder.path()));
}

TEST(OutputFolder, AFailureLeavesTheOldResultsAndNothingElse) {
  const TemporaryFolder folder;
  leave(folder / "there", "a.csv", "old");
  const auto fail = [&](const fs::path& path, ExistingOutput existing) {
    const StagedOutput output(request_for(path, existing));
    replace_file(output.folder() / "b.csv", "half");
    throw InputError("a failure on the way");
  };
  EXPECT_THROW(fail(folder / "there", ExistingOutput::overwrite), InputError);
  EXPECT_EQ(content_of(folder / "there"), Names{"a.csv"});
  EXPECT_THROW(fail(folder / "new", ExistingOutput::refuse), InputError);
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST(OutputFolder, AFileOfSomebodyElseInTheWayIsNotReplaced) {
  const TemporaryFolder folder;
  leave(folder.path(), "a.csv", "ours");
  folder.with("b.csv", "theirs");
  EXPECT_THROW(leave(folder.path(), "b.csv", "ours", ExistingOutput::overwrite), InputError);
  EXPECT_EQ(file_text(folder / "b.csv"), "theirs");
  EXPECT_EQ(file_text(folder / "a.csv"), "ours");
}

/// Runs `action` in another process, which kills itself at its end.
template <class Action>
void killed(Action action) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    action();
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

TEST(OutputFolder, WhatAKilledCommandLeftIsNotSeen) {
  const TemporaryFolder folder;
  leave(folder.path(), "a.csv", "old");
  killed([&] {
    const StagedOutput output(request_for(folder.path(), ExistingOutput::overwrite));
    replace_file(output.folder() / "snapshot.h5", "half");
    ::raise(SIGKILL);
  });
  check_all_files(open_result_folder(folder.path()));
  leave(folder.path(), "b.csv", "new", ExistingOutput::overwrite);
  EXPECT_EQ(content_of(folder.path()), Names{"b.csv"});
}

/// New results that are all there, of a call that was ended while it put them in their places.
void end_while_publishing(const fs::path& folder) {
  leave(folder, "a.csv", "old");
  leave(folder, "c.csv", "old", ExistingOutput::overwrite);
  killed([&] {
    StagedOutput output(request_for(folder, ExistingOutput::overwrite));
    replace_file(output.folder() / "b.csv", "new");
    replace_file(output.folder() / "c.csv", "new");
    fs::remove(folder / "c.csv");
    fs::create_directories(folder / "c.csv/in the way");
    EXPECT_THROW(output.publish(), fs::filesystem_error);
  });
  fs::remove_all(folder / "c.csv");
}

TEST(OutputFolder, AnInterruptedReplacementIsFinishedByTheNextClaim) {
  const TemporaryFolder folder;
  end_while_publishing(folder.path());
  EXPECT_THROW((void)claim(request_for(folder.path())), InputError);
  EXPECT_EQ(content_of(folder / ".drumlin-new"), Names{"c.csv"});
  (void)claim(request_for(folder.path(), ExistingOutput::resume));
  check_all_files(open_result_folder(folder.path()));
  EXPECT_EQ(content_of(folder.path()), (Names{"b.csv", "c.csv"}));
  EXPECT_EQ(file_text(folder / "c.csv"), "new");
}

/// A folder elsewhere, with the results `name` and a file that no program made.
Names elsewhere(const fs::path& folder, const std::string& name) {
  leave(folder, name, "theirs");
  replace_file(folder / "notes.txt", "years of work");
  return content_of(folder);
}

TEST(OutputFolder, ALinkWithinIsNoWayToFilesElsewhere) {
  const TemporaryFolder folder;
  const Names before = elsewhere(folder / "theirs", "1.csv");
  leave(folder / "ours", "y/1.csv", "ours");
  fs::remove_all(folder / "ours/y");
  fs::create_directory_symlink(folder / "theirs", folder / "ours/y");
  EXPECT_THROW((void)open_result_folder(folder / "ours"), InputError);
  for (const char* name : {"y/1.csv", "z.csv"})  // replaced, and removed
    EXPECT_THROW(leave(folder / "ours", name, "new", ExistingOutput::overwrite), InputError) << name;
  EXPECT_EQ(content_of(folder / "theirs"), before);
  EXPECT_EQ(file_text(folder / "theirs/1.csv"), "theirs");
}

// Its sums need no secret: whoever packs a folder can make new results that look whole.
TEST(OutputFolder, NewResultsThatLieElsewhereAreNotFetched) {
  const TemporaryFolder folder;
  const Names before = elsewhere(folder / "theirs", "1.csv");
  leave(folder / "ours", "a.csv", "ours");
  leave(folder / "planted", "y/1.csv", "theirs");
  fs::rename(folder / "planted", folder / "ours/.drumlin-new");
  fs::remove_all(folder / "ours/.drumlin-new/y");
  fs::create_directory_symlink(folder / "theirs", folder / "ours/.drumlin-new/y");
  EXPECT_THROW((void)claim(request_for(folder / "ours", ExistingOutput::resume)), InputError);
  EXPECT_EQ(content_of(folder / "theirs"), before);
  EXPECT_EQ(file_text(folder / "ours/a.csv"), "ours");
}

TEST(OutputFolder, ThatIsALinkIsRefused) {
  const TemporaryFolder folder;
  const Names before = elsewhere(folder / "theirs", "measured.json");
  fs::create_directory_symlink(folder / "theirs", folder / "measured");
  for (const auto existing : {ExistingOutput::refuse, ExistingOutput::resume, ExistingOutput::overwrite})
    EXPECT_THROW(StagedOutput{request_for(folder / "measured", existing)}, InputError);
  EXPECT_EQ(content_of(folder / "theirs"), before);
}

TEST(GrowingOutput, DoesNotFollowLinks) {
  const Names known{"*.csv", "points/*.h5"};
  for (const bool listed : {true, false})
    for (const char* name : {"points", "replaced"}) {
      const TemporaryFolder folder;
      const fs::path ours = folder / "ours";
      const Names before = elsewhere(folder / "theirs", "1.h5");
      {
        GrowingOutput output(request_for(ours, ExistingOutput::refuse, "run"), known);
        fs::create_directory(ours / "points");
        replace_file(ours / "a.csv", "1");
        if (listed) replace_file(ours / "points/1.h5", "ours");
        output.finish();
      }
      if (fs::exists(ours / name)) fs::rename(ours / name, folder / "kept");
      fs::create_directory_symlink(folder / "theirs", ours / name);
      for (const auto existing : {ExistingOutput::resume, ExistingOutput::overwrite})
        EXPECT_THROW(GrowingOutput(request_for(ours, existing, "run"), known), InputError) << name;
      EXPECT_EQ(content_of(folder / "theirs"), before);
      EXPECT_EQ(file_text(ours / "a.csv"), "1");
    }
}

// A link in the place of our folder for new results would have its target moved or written into.
TEST(OutputFolder, APlantedLinkInThePlaceOfNewResultsIsRemovedAndNotFollowed) {
  const TemporaryFolder folder;
  const fs::path theirs = folder / "theirs", ours = folder / "ours";
  leave(theirs, "measured.json", "theirs");
  const Names before = content_of(theirs);
  leave(ours, "measured.json", "old");
  fs::create_directory_symlink(theirs, ours / ".drumlin-new");
  leave(ours, "measured.json", "new", ExistingOutput::overwrite);
  EXPECT_EQ(file_text(ours / "measured.json"), "new");
  EXPECT_EQ(content_of(theirs), before);
  EXPECT_EQ(file_text(theirs / "measured.json"), "theirs");
  check_all_files(open_result_folder(theirs));
}

TEST(OutputFolder, HasOneWriter) {
  const TemporaryFolder folder;
  const StagedOutput first(request_for(folder / "out"));
  for (const auto existing : {ExistingOutput::refuse, ExistingOutput::resume, ExistingOutput::overwrite}) {
    const auto message = message_of<InputError>([&] { StagedOutput{request_for(folder / "out", existing)}; });
    expect_has(message, "is being written by process");
  }
}

TEST(GrowingOutput, GoesOnOnlyFromFilesThatAreWhole) {
  const TemporaryFolder folder;
  {
    GrowingOutput output(request_for(folder.path(), ExistingOutput::refuse, "run"), {"*.csv"});
    folder.with("a.csv", "1");
    output.list("a.csv");
    output.save();
  }
  folder.with("a.csv", "2");
  EXPECT_THROW(GrowingOutput(request_for(folder.path(), ExistingOutput::resume, "run"), {"*.csv"}),
               InputError);
  folder.with("a.csv", "1");
  GrowingOutput output(request_for(folder.path(), ExistingOutput::resume, "run"), {"*.csv"});
  EXPECT_FALSE(holds_results(folder.path(), "a.csv"));
  output.finish();
  EXPECT_TRUE(holds_results(folder.path(), "a.csv"));
}

TEST(GrowingOutput, OldResultsWaitUntilTheNewOnesAreComplete) {
  const TemporaryFolder folder;
  const auto again = [&] {
    return GrowingOutput(request_for(folder.path(), ExistingOutput::overwrite, "run"),
                         {"*.csv", "points/*.h5"});
  };
  folder.with("notes.txt", "");
  fs::remove(folder / "notes.txt");
  {
    GrowingOutput output(request_for(folder.path(), ExistingOutput::refuse, "run"), {"*.csv", "points/*.h5"});
    fs::create_directory(folder / "points");
    folder.with("points/1.h5", "old");
    output.finish();
    leave(folder / "measured", "measured.json", "{}");
  }
  folder.with("notes.txt", "years of work");
  {
    const GrowingOutput output = again();
    folder.with("half.csv", "half");
  }
  EXPECT_EQ(content_of(folder.path()),
            (Names{"half.csv", "notes.txt", "replaced/measured/measured.json", "replaced/points/1.h5"}));
  check_all_files(open_result_folder(folder / "replaced"));
  GrowingOutput output = again();
  folder.with("whole.csv", "new");
  output.finish();
  EXPECT_EQ(content_of(folder.path()), (Names{".lock", "notes.txt", "whole.csv"}));
}

TEST(GrowingOutput, AnInterruptedMoveOfOldResultsIsFinishedByTheNextClaim) {
  const TemporaryFolder folder;
  {
    GrowingOutput output(request_for(folder.path(), ExistingOutput::refuse, "run"), {"points/*.h5"});
    fs::create_directory(folder / "points");
    folder.with("points/1.h5", "old");
    output.finish();
    leave(folder / "plots/inner", "a.csv", "old");
    leave(folder / "plots/inner", "z.csv", "old", ExistingOutput::overwrite);
  }
  // As it stands when it was killed: the outer files are moved, of the inner folder not even its own.
  fs::create_directories(folder / "replaced/points");
  fs::copy(folder / manifest_name, folder / "replaced");
  fs::rename(folder / "points/1.h5", folder / "replaced/points/1.h5");
  fs::create_directories(folder / "plots/inner/emptied");
  {
    const GrowingOutput output(request_for(folder.path(), ExistingOutput::resume, "run"), {"points/*.h5"});
    EXPECT_TRUE(output.manifest().files.empty());
  }
  EXPECT_EQ(content_of(folder.path()), (Names{"replaced/plots/inner/z.csv", "replaced/points/1.h5"}));
  check_all_files(open_result_folder(folder / "replaced/plots/inner"));
  StagedOutput{request_for(folder / "plots/inner")};  // holds but an empty folder
}

TEST(OutputFolder, OverwriteSparesAFolderThatHoldsAnInput) {
  const TemporaryFolder folder;
  leave(folder.path(), "run.json", "{}");
  const auto scene = folder.with("scene.toml", "mine");
  OutputRequest request = request_for(folder.path(), ExistingOutput::overwrite);
  request.inputs = {scene};
  EXPECT_THROW(StagedOutput{request}, InputError);
  EXPECT_TRUE(fs::exists(scene));
}

TEST(OutputFolder, FileInItsPlaceIsRefusedAlways) {
  const TemporaryFolder folder;
  const auto file = folder.with("a", "text");
  for (const auto existing : {ExistingOutput::refuse, ExistingOutput::resume, ExistingOutput::overwrite})
    EXPECT_THROW(StagedOutput{request_for(file, existing)}, InputError);
  EXPECT_TRUE(fs::is_regular_file(file));
}

TEST(OutputFile, IsRefusedIfItExistsOrIsNoFile) {
  const TemporaryFolder folder;
  { const FolderLock lock = prepare_output_file(folder / "new/rheology.toml", ExistingOutput::refuse); }
  EXPECT_TRUE(fs::is_directory(folder / "new"));
  const auto file = folder.with("rheology.toml", "");
  EXPECT_THROW((void)prepare_output_file(file, ExistingOutput::refuse), InputError);
  const FolderLock lock = prepare_output_file(file, ExistingOutput::overwrite);
  EXPECT_THROW((void)prepare_output_file(file, ExistingOutput::overwrite), InputError);  // by another writer
  for (const fs::path& other : {folder.path(), fs::path("/dev/null")})
    EXPECT_THROW((void)prepare_output_file(other, ExistingOutput::overwrite), InputError);
}

}  // namespace
}  // namespace drumlin::apps
