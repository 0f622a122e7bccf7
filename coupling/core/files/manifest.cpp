#include "coupling/core/files/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <sstream>
#include <string_view>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/folder_lock.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view first_line = "# drumlin-manifest-1\n", last_key = "# sum = ";
constexpr std::size_t sum_letters = 64;
constexpr std::ptrdiff_t most_names = 3;  // of a path: two folders and a file

bool is_sum(std::string_view text) {
  return text.size() == sum_letters && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Takes a line of the manifest over, `entry` being the one whose size was read last; false where it is none.
bool take_line(const std::string& line, Manifest& manifest, ManifestEntry& entry) {
  std::string value;
  const auto tells = [&](std::string_view key) {
    if (line.starts_with(key)) value = line.substr(key.size());
    return line.starts_with(key);
  };
  if (tells("# command = ")) return manifest.command = value, true;
  if (tells("# state = "))
    return manifest.complete = value == "complete", manifest.complete || value == "unfinished";
  if (tells("# accepted = ")) return manifest.accepted.push_back(value), true;
  if (tells("# source = ")) return is_sum(manifest.source = value);
  if (tells("# asked = ")) return is_sum(manifest.requested = value);
  if (tells("# bytes = ")) {
    const char* const end = value.data() + value.size();
    const auto [rest, fault] = std::from_chars(value.data(), end, entry.sum.bytes);
    entry.grows = std::string_view(rest, end) == ", grows";
    return fault == std::errc() && (rest == end || entry.grows);
  }
  if (line.size() <= sum_letters + 2 || line.compare(sum_letters, 2, "  ") != 0) return false;
  const std::string name = line.substr(sum_letters + 2);
  entry.sum.checksum = line.substr(0, sum_letters);
  return is_sum(entry.sum.checksum) && can_be_listed(name) && manifest.files.emplace(name, entry).second;
}

/// All lines but the last.
std::string summed_text(const Manifest& manifest) {
  std::string text = fmt::format("{}# command = {}\n# state = {}\n", first_line, manifest.command,
                                 manifest.complete ? "complete" : "unfinished");
  if (!manifest.source.empty()) text += "# source = " + manifest.source + "\n";
  if (!manifest.requested.empty()) text += "# asked = " + manifest.requested + "\n";
  for (const std::string& reason : manifest.accepted) text += "# accepted = " + reason + "\n";
  for (const auto& [name, entry] : manifest.files)
    fmt::format_to(std::back_inserter(text), "# bytes = {}{}\n{}  {}\n", entry.sum.bytes,
                   entry.grows ? ", grows" : "", entry.sum.checksum, name);
  return text;
}

}  // namespace

bool has_manifest(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(fs::symlink_status(folder / manifest_name, error));
}

Manifest read_manifest(const fs::path& folder) {
  const fs::path file = folder / manifest_name;
  const std::string text = file_text(file);
  if (!text.starts_with(first_line))
    throw InputError(file.string() + ": does not begin with '# drumlin-manifest-1'");
  const std::size_t last = text.rfind(last_key);
  if (last == std::string::npos ||
      text.substr(last) != fmt::format("{}{}\n", last_key, text_sum(std::string_view(text).substr(0, last))))
    throw InputError(
        fmt::format("{}: damaged or changed by hand; drumlin accept {} --reason TEXT takes the "
                    "folder as it is",
                    file.string(), folder.string()));
  Manifest manifest;
  ManifestEntry entry;
  std::istringstream lines(text.substr(first_line.size(), last - first_line.size()));
  int number = 1;
  for (std::string line; std::getline(lines, line);)
    if (++number; !take_line(line, manifest, entry))
      throw InputError(
          {InputProblem{file.string(), number, 0, "", "'" + line + "' is no line of a manifest", ""}});
  return manifest;
}

std::vector<std::string> names_in(const Manifest& manifest) {
  std::vector<std::string> names;
  for (const auto& [name, entry] : manifest.files) names.push_back(name);
  return names;
}

FileKind kind_of_file(const fs::path& name) { return {name.parent_path(), name.extension()}; }

std::set<FileKind> kinds_in(const Manifest& manifest) {
  std::set<FileKind> kinds;
  for (const std::string& name : names_in(manifest))
    if (fs::path(name).has_parent_path()) kinds.insert(kind_of_file(name));
  return kinds;
}

bool can_be_listed(const fs::path& name) {
  return !name.empty() && std::distance(name.begin(), name.end()) <= most_names &&
         std::none_of(name.begin(), name.end(), [](const fs::path& part) {
           const std::string& text = part.native();  // of an absolute path the first is "/"
           return text.empty() || text.front() == '.' || text.front() == '/';
         });
}

void refuse_links(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    for (fs::path way = fs::path(name).parent_path(); !way.empty(); way = way.parent_path())
      if (std::error_code error; fs::is_symlink(fs::symlink_status(folder / way, error)))
        throw InputError((folder / way).string() +
                         ": is a symbolic link, and none is followed below a folder of results; remove it");
}

std::string manifest_sum(const Manifest& manifest) { return text_sum(summed_text(manifest)); }

void write_manifest(const fs::path& folder, const Manifest& manifest) {
  std::string text = summed_text(manifest);
  text += fmt::format("{}{}\n", last_key, text_sum(text));
  replace_file(folder / manifest_name, text);
}

std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> names;
  for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::recursive_directory_iterator();
       ++entry) {
    const fs::path& path = entry->path();
    const std::string name = path.filename().string();
    const bool is_folder = entry->is_directory() && !entry->is_symlink();
    if (name.starts_with(".drumlin-") || (is_folder && has_manifest(path))) {
      if (is_folder) entry.disable_recursion_pending();
    } else if (entry->symlink_status().type() == fs::file_type::regular && name != manifest_name &&
               name != folder_lock_name) {
      names.push_back(path.lexically_relative(folder).generic_string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::map<std::string, ManifestEntry> entries_of(const fs::path& folder,
                                                const std::vector<std::string>& names) {
  std::map<std::string, ManifestEntry> entries;
  for (const std::string& name : names) {
    if (name.find_first_of("\n\r") != std::string::npos)
      throw InputError(folder.string() + ": holds a file with a line break in its name");
    entries[name].sum = file_sum(folder / name);
  }
  return entries;
}

}  // namespace drumlin
