// Manifests, checked readings, the lock of a folder, the newer of two checkpoints.
#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/folder_lock.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/files/manifest.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/signed_folder.hpp"

namespace drumlin {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

/// log.csv, snapshots/1.h5 and snapshots/2.h5, signed.
void make_run(const TemporaryFolder& folder, bool complete = true) {
  fs::create_directory(folder / "snapshots");
  folder.with("log.csv", "step\n1\n");
  folder.with("snapshots/1.h5", "one");
  folder.with("snapshots/2.h5", "two");
  Manifest manifest{.command = "run", .complete = complete, .accepted = {}, .files = {}};
  manifest.files = entries_of(folder.path(), files_below(folder.path()));
  manifest.files["log.csv"].grows = !complete;
  write_manifest(folder.path(), manifest);
}

std::string refusal(const TemporaryFolder& folder) {
  return message_of<InputError>([&] { check_all_files(open_result_folder(folder.path())); });
}

TEST(Checksum, IsThatOfTheStandard) {
  Checksum sum;
  EXPECT_EQ(sum.text(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  sum.add("ab"), sum.add("c");  // FIPS 180-2, appendix B
  EXPECT_EQ(sum.text(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sum.text(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Manifest, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  Manifest manifest{.command = "run", .complete = true, .accepted = {"today: a typing error"}, .files = {}};
  manifest.files["a name, with spaces.csv"] = {{7, std::string(64, 'a')}, true};
  manifest.files["b/c.h5"] = {{0, std::string(64, '0')}, false};
  write_manifest(folder.path(), manifest);
  const Manifest read = read_manifest(folder.path());
  EXPECT_EQ(read.command, "run");
  EXPECT_TRUE(read.complete);
  EXPECT_EQ(read.accepted, manifest.accepted);
  EXPECT_EQ(read.files, manifest.files);
}

TEST(Manifest, EveryChangedByteOfItIsNoticed) {
  const TemporaryFolder folder;
  make_run(folder);
  const std::string text = file_text(folder / manifest_name);
  for (std::size_t i = 0; i < text.size(); i += 3) {
    std::string other = text;
    other[i] = static_cast<char>(other[i] ^ 1);
    folder.with(manifest_name, other);
    EXPECT_THROW(read_manifest(folder.path()), InputError) << i;
    folder.with(manifest_name, text.substr(0, i));
    EXPECT_THROW(read_manifest(folder.path()), InputError) << i;
  }
}

TEST(ResultFolder, IsReadWhereItIsWhole) {
  const TemporaryFolder folder;
  make_run(folder);
  folder.with("notes.txt", "of somebody");
  const ResultFolder opened = open_result_folder(folder.path());
  check_all_files(opened);
  EXPECT_EQ(checked_file(opened, "log.csv"), folder / "log.csv");
  EXPECT_THROW(checked_file(opened, "notes.txt"), InputError);  // is no result
  EXPECT_EQ(checked_file(opened, "nothing"), folder / "nothing");
}

TEST(ResultFolder, NamesWhatIsDamagedMissingOrTooMany) {
  const TemporaryFolder folder;
  make_run(folder);
  folder.with("snapshots/2.h5", "tvo");
  expect_has(refusal(folder), "2.h5: damaged or changed");
  folder.with("snapshots/2.h5", "too long");
  expect_has(refusal(folder), "2.h5: has 8 bytes, 3 in");
  fs::remove(folder / "snapshots/2.h5");
  expect_has(refusal(folder), "2.h5: is missing");
  expect_has(refusal(folder), "drumlin accept");
  folder.with("theirs", "two");
  fs::create_symlink(folder / "theirs", folder / "snapshots/2.h5");
  expect_has(refusal(folder), "2.h5: is missing");
  fs::remove(folder / "snapshots/2.h5");
  folder.with("snapshots/2.h5", "two");
  folder.with("snapshots/3.h5", "three");
  expect_has(refusal(folder), "3.h5: is not listed");
}

TEST(ResultFolder, OfAnUnfinishedRunMayGrow) {
  const TemporaryFolder folder;
  make_run(folder, false);
  folder.with("snapshots/3.h5", "three");
  folder.with("log.csv", "step\n1\n2\n");
  check_all_files(open_result_folder(folder.path()));
  folder.with("log.csv", "step\n9\n2\n");
  expect_has(refusal(folder), "log.csv: damaged");
}

TEST(ResultFolder, WithoutAManifestIsRefusedUnlessFilesAreCutOutOfOne) {
  const TemporaryFolder folder;
  folder.with("log.csv", "step\n");
  expect_has(refusal(folder), "drumlin accept");
  const ResultFolder cut_out = open_result_folder(folder.path(), WithoutManifest::accept);
  EXPECT_EQ(checked_file(cut_out, "log.csv"), folder / "log.csv");
}

TEST(ResultFolder, ManifestCannotNameWhatLiesElsewhere) {
  const TemporaryFolder folder;
  for (const char* name : {"../a", "/etc/passwd", "a/../../b"}) {
    Manifest manifest{.command = "run", .complete = true, .accepted = {}, .files = {}};
    manifest.files[name] = {{0, std::string(64, '0')}, false};
    write_manifest(folder.path(), manifest);
    EXPECT_THROW(read_manifest(folder.path()), InputError) << name;
  }
}

TEST(FolderLock, KeepsOthersOutAndTellsWhoHoldsIt) {
  const TemporaryFolder folder;
  const fs::path file = folder / folder_lock_name;
  {
    const FolderLock lock(file, "drumlin run");
    const std::string said = message_of<InputError>([&] { FolderLock(file, "drumlin run"); });
    expect_has(said, "process " + std::to_string(::getpid()) + ", drumlin run, since 2");
  }
  EXPECT_FALSE(fs::exists(file));
  folder.with(folder_lock_name, "process 1, of a killed one");
  const FolderLock again(file, "drumlin run");
  expect_lacks(file_text(file), "killed");
}

/// Reads a file, unless it holds this.
template <class Error>
auto all_but(const std::string& wrong) {
  return [wrong](const fs::path& file) {
    const std::string text = file_text(file);
    if (text == wrong) throw Error(file.string() + ": " + wrong);
    return text;
  };
}

TEST(LastWhole, IsThePreviousCheckpointWhereTheNewestIsDamaged) {
  const TemporaryFolder folder;
  const auto read = all_but<InputError>("damaged");
  EXPECT_FALSE(last_whole_checkpoint(folder.path(), read));
  folder.with(checkpoint_name, "new");
  folder.with(previous_checkpoint_name, "old");
  EXPECT_EQ(last_whole_checkpoint(folder.path(), read)->content, "new");
  folder.with(checkpoint_name, "damaged");
  EXPECT_EQ(last_whole_checkpoint(folder.path(), read)->content, "old");
  expect_has(last_whole_checkpoint(folder.path(), read)->passed_over, "checkpoint.h5: damaged");
  fs::remove(folder / checkpoint_name);  // killed between two renames
  EXPECT_EQ(last_whole_checkpoint(folder.path(), read)->content, "old");
  folder.with(previous_checkpoint_name, "damaged");
  EXPECT_THROW(last_whole_checkpoint(folder.path(), read), InputError);
}

TEST(LastWhole, IsThePreviousCheckpointWhereTheDiskDoesNotGiveTheNewest) {
  const TemporaryFolder folder;
  const auto read = all_but<IoError>("bad sector");
  folder.with(checkpoint_name, "bad sector");
  folder.with(previous_checkpoint_name, "old");
  const auto last = last_whole_checkpoint(folder.path(), read);
  EXPECT_EQ(last->content, "old");
  expect_has(last->passed_over, "checkpoint.h5: bad sector");
  set_aside_passed_over_checkpoint(folder.path());  // or the next one would take the place of the old
  EXPECT_FALSE(fs::exists(folder / checkpoint_name));
  EXPECT_EQ(file_text(folder / passed_over_checkpoint_name), "bad sector");
  EXPECT_EQ(last_whole_checkpoint(folder.path(), read)->content, "old");
  folder.with(previous_checkpoint_name, "bad sector");
  EXPECT_THROW(last_whole_checkpoint(folder.path(), read), IoError);
}

TEST(ResultFolder, ResultsBelongToTheStateThatTheyWereComputedFrom) {
  const TemporaryFolder folder;
  const fs::path run = folder / "run", measured = run / "measured";
  fs::create_directories(measured);
  replace_file(run / "log.csv", "1");
  replace_file(measured / "measured.json", "{}");
  const auto said = [&] {
    return message_of<InputError>(
        [&] { check_source(open_result_folder(measured), open_result_folder(run), "drumlin measure RUN"); });
  };
  testing::sign(measured, "measure");
  testing::sign(run, "run");
  expect_has(said(), "does not say from which state");
  Manifest manifest = read_manifest(measured);
  manifest.source = manifest_sum(read_manifest(run));
  write_manifest(measured, manifest);
  EXPECT_NO_THROW(check_source(open_result_folder(measured), open_result_folder(run), ""));
  EXPECT_EQ(read_manifest(measured).source, manifest.source);

  Manifest accepted = read_manifest(run);
  accepted.accepted.emplace_back("now: why (log.csv)");
  write_manifest(run, accepted);
  for (const char* part :
       {"measured", "as it was before", "drumlin measure RUN computes it anew", "drumlin accept"})
    expect_has(said(), part);
  fs::remove(measured / manifest_name);  // cut out of a folder
  EXPECT_NO_THROW(
      check_source(open_result_folder(measured, WithoutManifest::accept), open_result_folder(run), ""));
}

}  // namespace
}  // namespace drumlin
