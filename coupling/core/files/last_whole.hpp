#pragma once
// The newest of several files that can be read: two checkpoints alternate, so that one damaged file is not
// the end.
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

/// Names of the last two checkpoints, of a run and of a march.
inline constexpr const char *checkpoint_name = "checkpoint.h5",
                            *previous_checkpoint_name = "checkpoint-previous.h5",
                            *passed_over_checkpoint_name = "checkpoint-passed-over.h5";

template <class Content>
struct LastWhole {
  Content content;
  std::string passed_over;  ///< why the newest was not taken; empty: it was
};

/// The first of the two checkpoints in `folder` that `read(file)` does not refuse, nor the disk; absent where
/// there is none. Throws InputError, with the faults of both, if none that is there can be read, IoError if
/// that was the disk's fault.
template <class Read>
auto last_whole_checkpoint(const std::filesystem::path& folder, Read read) {
  using Content = std::invoke_result_t<Read, std::filesystem::path>;
  std::optional<LastWhole<Content>> found;
  std::vector<InputProblem> problems;
  bool disk_failed = false;
  for (const char* name : {checkpoint_name, previous_checkpoint_name}) {
    if (!std::filesystem::exists(folder / name)) continue;
    try {
      const std::string passed_over = problems.empty() ? "" : InputError(problems).what();
      found = LastWhole<Content>{read(folder / name), passed_over};
      return found;
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    } catch (const IoError& error) {
      problems.push_back({"", 0, 0, "", error.what(), ""});
      disk_failed = true;
    }
  }
  if (problems.empty()) return found;
  if (disk_failed) throw IoError(InputError(problems).what());
  problems.push_back({folder.string(), 0, 0, "", "no checkpoint can be read; --overwrite starts over", ""});
  throw InputError(std::move(problems));
}

/// To be called before one goes on from the previous checkpoint: the newest, which was passed over, gets a
/// name of its own. It would else take the place of the previous one when the next is written, and no whole
/// one would be left meanwhile. Throws IoError.
inline void set_aside_passed_over_checkpoint(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::rename(folder / checkpoint_name, folder / passed_over_checkpoint_name, error);
  if (error && std::filesystem::exists(folder / checkpoint_name))
    throw IoError((folder / checkpoint_name).string() + ": cannot be renamed: " + error.message());
}

}  // namespace drumlin
