#include "particles/io/snapshot_list.hpp"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/number_text.hpp"

namespace drumlin::particles {

namespace fs = std::filesystem;

namespace {

/// "7" or "3-9" as its first and last number.
std::optional<std::pair<int, int>> range_of(std::string_view text) {
  int first = 0, last = 0;
  const char* const end = text.data() + text.size();
  auto read = std::from_chars(text.data(), end, first);
  if (read.ec != std::errc()) return std::nullopt;
  last = first;
  if (read.ptr != end && *read.ptr == '-') read = std::from_chars(read.ptr + 1, end, last);
  if (read.ec != std::errc() || read.ptr != end || first > last) return std::nullopt;
  return std::pair(first, last);
}

}  // namespace

int snapshot_number(const fs::path& file) {
  const auto number = parsed_number<int>(file.stem().string());
  if (!number) throw InputError(file.string() + ": is not named as a snapshot (NNNNNN.h5)");
  return *number;
}

std::vector<fs::path> listed_snapshots(const fs::path& folder, const std::vector<fs::path>& snapshots,
                                       const std::string& option, const std::string& list) {
  if (snapshots.empty()) throw InputError(folder.string() + ": holds no snapshots");
  if (list == "all") return snapshots;
  if (list == "last") return {snapshots.back()};
  std::map<int, fs::path> there, chosen;
  for (const fs::path& file : snapshots) there.emplace(snapshot_number(file), file);
  const auto refuse = [&](const std::string& item, const std::string& why) -> InputError {
    return InputError(fmt::format("{}: '{}' {} (allowed: all, last, or numbers and ranges from {} to {})",
                                  option, item, why, there.begin()->first, there.rbegin()->first));
  };
  std::istringstream items(list + ",");
  for (std::string item; std::getline(items, item, ',');) {
    const auto range = range_of(item);
    if (!range) throw refuse(item, "is no number or range");
    if (!there.contains(range->first) || !there.contains(range->second)) throw refuse(item, "is not there");
    for (auto at = there.find(range->first); at != there.end() && at->first <= range->second; ++at)
      chosen.insert(*at);
  }
  std::vector<fs::path> files;
  for (const auto& [number, file] : chosen) files.push_back(file);
  return files;
}

}  // namespace drumlin::particles
