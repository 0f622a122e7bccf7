// drumlin info: what a result folder holds, and whether it is what was written.
#include <fmt/format.h>

#include <algorithm>

#include "apps/command_line/command.hpp"
#include "apps/commands/result_folders.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/result_folder.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

struct InfoOptions {
  fs::path folder;

  void describe(Description& d) { d.add("folder", folder, "DIR", "Result folder of any command").required(); }
};

std::string said_of(const fs::path& folder, const Manifest& manifest) {
  std::uintmax_t bytes = 0;
  for (const auto& [name, entry] : manifest.files) bytes += entry.sum.bytes;
  std::string text = fmt::format("{}: of drumlin {}, {}; {} files, {:.1f} MB\n", folder.string(),
                                 manifest.command, manifest.complete ? "complete" : "unfinished",
                                 manifest.files.size(), 1e-6 * static_cast<double>(bytes));
  for (const std::string& edit : manifest.accepted) text += fmt::format("  accepted {}\n", edit);
  return text;
}

/// The folder and the result folders within, each read whole; what is not as it was written is an error that
/// names all of it.
int info(const InfoOptions& options) {
  if (!fs::is_directory(options.folder)) throw InputError(options.folder.string() + ": no such folder");
  std::vector<fs::path> folders = result_folders(options.folder);
  std::sort(folders.begin(), folders.end());
  std::string faults;
  for (const fs::path& folder : folders) try {
      const ResultFolder found = open_result_folder(folder);
      print_out(said_of(folder, *found.manifest));
      if (found.manifest->command == "measure")
        check_source(found, open_result_folder(folder / ".."),
                     fmt::format("drumlin measure {} --overwrite",
                                 fs::path(folder / "..").lexically_normal().string()));
      check_all_files(found);
    } catch (const InputError& error) {
      faults += (faults.empty() ? "" : "\n") + std::string(error.what());
    }
  if (!faults.empty()) throw InputError(faults);
  print_out("all files are as they were written\n");
  return static_cast<int>(ExitCode::done);
}

}  // namespace

Command info_command() {
  return command("info", "Says what a result folder holds, and whether all of it is as it was written", info);
}

}  // namespace drumlin::apps
