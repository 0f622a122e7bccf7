#pragma once
// Where a command leaves its results, without losing what stands there: one writer at a time, a manifest that
// marks the folder as ours, files of others untouched (docs/formats/manifest.md).
#include <filesystem>
#include <string>
#include <vector>

#include "apps/command_line/options.hpp"
#include "coupling/core/files/folder_lock.hpp"
#include "coupling/core/files/manifest.hpp"

namespace drumlin::apps {

struct OutputRequest {
  std::filesystem::path folder;
  ExistingOutput existing = ExistingOutput::refuse;
  std::string command;                        ///< "run", "measure", ...
  std::vector<std::filesystem::path> inputs;  ///< what the command reads: never in a folder to be overwritten
  std::string source = {};                    ///< manifest_sum() of the folder that all is computed from
  std::string requested = {};                 ///< requested_sum() of the command's options
  bool goes_on = true;                        ///< the command knows --resume
};

/// Claims a folder: makes it, locks it, clears what a killed command left aside. Throws InputError if it is a
/// file, is not empty and carries no manifest (whatever was asked for), holds results of another command, is
/// being written by another process, holds results and was not to be resumed or overwritten, or is to be
/// overwritten and holds an input.
FolderLock claim(const OutputRequest& request);

/// Results that are made in one go: written beside, in a folder within the folder, and put in the place of
/// the old ones when all are there. What an interruption leaves is either not seen or put in place by the
/// next claim.
class StagedOutput {
 public:
  /// As claim().
  explicit StagedOutput(OutputRequest request);
  /// What was not published vanishes; the old results stay.
  ~StagedOutput();
  StagedOutput(const StagedOutput&) = delete;
  StagedOutput& operator=(const StagedOutput&) = delete;

  /// Where the new results are to be written.
  const std::filesystem::path& folder() const { return staging_; }
  /// All files of folder() replace the old results, with a manifest of them. Throws InputError if a file of
  /// somebody else stands in the way.
  void publish();

 private:
  OutputRequest request_;
  bool made_;
  FolderLock lock_;
  std::filesystem::path staging_;
};

/// Results that take long and are gone on with: written where they stay, the manifest growing with them. What
/// is overwritten waits in FOLDER/replaced, a result folder of its own, until the new results are complete.
class GrowingOutput {
 public:
  /// `known`: names of all files that the command may leave ("snapshots/*.h5"; * does not stand for /). As
  /// claim(); to be resumed, the listed files must be whole (InputError).
  GrowingOutput(OutputRequest request, std::vector<std::string> known);

  const std::filesystem::path& folder() const { return request_.folder; }
  Manifest& manifest() { return manifest_; }
  const Manifest& manifest() const { return manifest_; }
  /// Takes the sum of a file as it is now; written by save().
  void list(const std::string& name);
  /// Files of this pattern are not listed until finish().
  void forget(const std::string& pattern);
  /// Writes the manifest: there is more to come.
  void save() const;
  /// Lists all known files and says that the results are complete; removes what they replace.
  void finish();

 private:
  OutputRequest request_;
  std::vector<std::string> known_;
  FolderLock lock_;
  Manifest manifest_;
};

/// Whether FOLDER/`finished` and all results beside it are there, whole. Throws InputError that names what is
/// damaged or missing.
bool holds_results(const std::filesystem::path& folder, const std::string& finished);

/// Makes place for a single file that a command writes and keeps other writers of it out: refused if it
/// exists, unless to be overwritten (or resumed, which writes it anew).
[[nodiscard]] FolderLock prepare_output_file(const std::filesystem::path& file, ExistingOutput existing);

}  // namespace drumlin::apps
