#include "apps/process/request_sum.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/checksum.hpp"
#include "coupling/core/files/manifest.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

std::string request_sum(const nlohmann::ordered_json& requested) {
  return text_sum(requested.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string input_sum(const fs::path& input) {
  if (fs::is_regular_file(input)) return file_sum(fs::canonical(input)).checksum;
  if (!fs::is_directory(input)) return "";
  if (has_manifest(input)) return manifest_sum(read_manifest(input));
  // Measurements that were cut out of a run, and nothing else: a mistyped folder is not read.
  const bool ours = fs::exists(input / "run.json") || fs::exists(input / "measured.json") ||
                    fs::exists(input / "flow.json");
  if (!ours) return "";
  Checksum sum;
  std::vector<std::string> names = files_below(input);
  std::erase_if(names, [](const std::string& name) { return name.starts_with("snapshots/"); });
  for (const auto& [name, entry] : entries_of(input, names)) sum.add(name + " " + entry.sum.checksum + "\n");
  return sum.text();
}

std::string measured_run_sum(const fs::path& run) { return input_sum(run) + input_sum(run / "measured"); }

void refuse_other(const fs::path& folder, const std::string& requested) {
  if (!has_manifest(folder)) return;
  const std::string before = read_manifest(folder).requested;
  if (!before.empty() && before != requested)
    throw InputError(folder.string() +
                     ": holds results of other inputs or options; --overwrite makes them anew");
}

}  // namespace drumlin::apps
