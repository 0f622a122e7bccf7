#pragma once
// What `drumlin run --resume` finds in a run folder: whether it belongs to the scene, and where it goes on.
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "apps/output/output_folder.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::apps {

inline constexpr const char *log_name = "log.csv", *energy_name = "energy.csv";
/// Of the number-th snapshot, from 1.
std::string snapshot_name(std::int64_t number);

/// A folder continues only the scene that it was made from: throws InputError where the texts differ.
void same_scene_or_refuse(const std::filesystem::path& output, const std::string& theirs,
                          const std::string& ours);

/// The same of the scene and of the lists of grains that stand in the folder.
void same_run_or_refuse(const std::filesystem::path& output, const particles::Scene& scene,
                        const std::string& resolved);
/// Whether the folder holds this run, finished and whole, which is then told. Nothing is written, but for a
/// lock that a killed call has left.
bool is_finished(const std::filesystem::path& output, const particles::Scene& scene,
                 const std::string& resolved);

/// The lists of grains of a scene as they stand in the run folder, by the names of their files there.
std::map<std::string, std::string> list_texts(particles::Scene scene);

/// The manifest of what stood at the checkpoint; what stands behind it is made anew. Throws InputError if a
/// snapshot is missing.
void cut_back(GrowingOutput& output, const std::optional<particles::Checkpoint>& from);

/// The checkpoint that a run goes on from; absent: from its start.
std::optional<particles::Checkpoint> checkpoint_in(const std::filesystem::path& output,
                                                   const std::string& resolved);

/// Prolongs the scene of a finished run by about `seconds` (prolong.hpp), and with it its checkpoint. The
/// folder's own checkpoint is replaced: from then on it is that of an unfinished run of the longer scene.
/// Throws InputError if the run is not finished.
void extend(GrowingOutput& output, double seconds, particles::Scene& scene,
            std::optional<particles::Checkpoint>& from);

}  // namespace drumlin::apps
