#include "apps/support/asked.hpp"

#include <nlohmann/json.hpp>

#include "coupling/common/checksum.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/manifest.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

std::string asked_sum(const nlohmann::ordered_json& asked) {
  Checksum sum;
  sum.add(asked.dump());
  return sum.text();
}

std::string input_sum(const fs::path& input) {
  if (fs::is_regular_file(input)) return file_sum(fs::canonical(input)).checksum;
  if (!fs::is_directory(input)) return "";
  if (has_manifest(input)) return manifest_sum(read_manifest(input));
  Checksum sum;
  for (const auto& [name, entry] : entries_of(input, files_below(input)))
    sum.add(name + " " + entry.sum.checksum + "\n");
  return sum.text();
}

std::string measured_run_sum(const fs::path& run) { return input_sum(run) + input_sum(run / "measured"); }

void refuse_other(const fs::path& folder, const std::string& asked) {
  if (!has_manifest(folder)) return;
  const std::string before = read_manifest(folder).asked;
  if (!before.empty() && before != asked)
    throw InputError(folder.string() +
                     ": holds results of other inputs or options; --overwrite makes them anew");
}

}  // namespace drumlin::apps
