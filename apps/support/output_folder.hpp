#pragma once
// Where a command leaves its results, without losing what stands there.
#include <filesystem>
#include <string>
#include <vector>

#include "apps/support/commands.hpp"

namespace drumlin::apps {

/// Makes `folder` ready for new results; `markers` are the files of which at least one stands in every folder
/// that this command made ("run.json", "scene.toml", ...). refuse: throws InputError if the folder exists and
/// is not empty. resume: leaves what stands there. overwrite: removes the folder's content, but only if it
/// carries a marker of ours: a mistyped path must not cost anybody their files. A file in place of the folder
/// throws InputError always, and so does an overwrite that would remove one of `inputs`.
void prepare_output(const std::filesystem::path& folder, ExistingOutput existing,
                    const std::vector<std::string>& markers,
                    const std::vector<std::filesystem::path>& inputs = {});

/// The same for a single file that a command writes: refused if it exists, unless to be overwritten (or
/// resumed, which writes it anew).
void prepare_output_file(const std::filesystem::path& file, ExistingOutput existing);

}  // namespace drumlin::apps
