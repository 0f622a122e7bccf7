#include "particles/import/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"
#include "particles/import/description_keys.hpp"

namespace drumlin::particles {
namespace {

namespace fs = std::filesystem;

/// What the keys alone cannot know: which of them need each other.
void check_together(const ImportDescription& description, const Document& document,
                    std::vector<InputProblem>& problems) {
  const auto refuse = [&](const std::string& key, const std::string& what, const std::string& allowed) {
    problems.push_back(problem_at(document, key, what, allowed));
  };
  if (description.drum && description.periodic_x)
    refuse("periodic_x", "appears beside a drum", "one of the two");
  const auto* csv = std::get_if<CsvSource>(&description.source);
  const auto* files = std::get_if<FilesSource>(&description.source);
  const std::string table = csv ? "csv." : files ? "files." : "lammps.";
  if (!csv && !files) files = &std::get<LammpsSource>(description.source);
  const auto& grains = csv ? csv->grains : files->grains;
  if (grains.empty()) refuse(table + "grains", "names no file", "at least one");
  if (description.grains.may_change && description.grains.velocities != ImportedVelocities::given)
    refuse("grains.velocities", "is displacements of grains that come and go",
           "given, or may_change = false");
  const bool spheres = description.dimensions == 3;
  if (description.drum && spheres) refuse("drum", "appears beside dimensions = 3", "discs in a drum");
  if (description.periodic_y && !spheres) refuse("periodic_y", "appears without dimensions = 3", "spheres");
  if (csv && !csv->heading.empty()) {
    if (csv->columns.empty()) refuse("csv.heading", "appears without columns", "csv.columns beside it");
    if (std::count(csv->heading.begin(), csv->heading.end(), "count") != 1)
      refuse("csv.heading", "does not say how many grains follow", "\"count\" once among its names");
  }
  if (!files || files->contacts.empty()) return;
  const bool dumps = table == "lammps.";
  if (dumps && files->contact_ids.size() != 2)
    refuse(table + "contact_ids", "is needed by the contacts", "two names of columns");
  const std::size_t axes = spheres ? 3 : 2;
  if (dumps && files->contact_forces.size() != axes && files->contact_forces.size() != 2 * axes)
    refuse(table + "contact_forces", "is needed by the contacts",
           fmt::format("{} names of columns, or {} of two parts", axes, 2 * axes));
  if (!files->depth_m && !spheres)
    refuse(table + "depth_m", "is needed by the contacts: forces count per metre of depth", "a number");
}

/// Whether a text is a pattern's, "*" standing for any text. The text between two stars goes where it fits
/// first: whatever fits behind a later place fits behind that one too, so that nothing is tried twice.
bool matches(std::string_view pattern, std::string_view text) {
  const auto first = pattern.find('*');
  if (first == std::string_view::npos) return pattern == text;
  const auto last = pattern.rfind('*');
  const std::string_view begin = pattern.substr(0, first), end = pattern.substr(last + 1);
  if (text.size() < begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end))
    return false;
  text = text.substr(begin.size(), text.size() - begin.size() - end.size());
  for (std::size_t star = first; star < last;) {
    const std::size_t next = pattern.find('*', star + 1);
    const std::string_view part = pattern.substr(star + 1, next - star - 1);
    const auto found = text.find(part);
    if (found == std::string_view::npos) return false;
    text.remove_prefix(found + part.size());
    star = next;
  }
  return true;
}

/// a before b, runs of digits by value: dump.90 before dump.100.
bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    const auto number = [&](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && digit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string first = number(a, i), second = number(b, j);
    if (first.size() != second.size()) return first.size() < second.size();
    if (first != second) return first < second;
  }
  return a.size() - i < b.size() - j;
}

}  // namespace

ImportDescription read_import_description(const fs::path& file, const std::vector<std::string>& overrides) {
  const Document document = read_toml(file, overrides);
  std::vector<InputProblem> problems;
  ImportDescription description = read_keys<ImportDescription>(document, problems);
  if (problems.empty()) check_together(description, document, problems);
  sort_by_place(problems);
  if (!problems.empty()) throw InputError(problems);
  description.title = title_with_changes(description.title, document, {"reduced"});
  return description;
}

std::string import_description_text(const ImportDescription& description) {
  return toml_text(write_keys(description));
}

std::vector<KeyRow> import_keys() { return list_keys<ImportDescription>(); }

std::vector<fs::path> files_of(const fs::path& folder, const std::vector<std::string>& patterns) {
  std::vector<fs::path> files;
  for (const std::string& pattern : patterns) {
    const fs::path whole = folder / pattern;
    const std::string name = whole.filename().string();
    if (name.find('*') == std::string::npos) {
      if (!fs::exists(input_status(whole))) throw InputError(whole.string() + ": no such file");
      files.push_back(whole);
      continue;
    }
    std::vector<std::string> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(whole.parent_path(), error))
      if (matches(name, entry.path().filename().string()) && fs::is_regular_file(input_status(entry)))
        found.push_back(entry.path().filename().string());
    if (found.empty()) throw InputError(whole.string() + ": no file of such a name");
    std::sort(found.begin(), found.end(), natural_less);
    for (const std::string& one : found) files.push_back(whole.parent_path() / one);
  }
  return files;
}

}  // namespace drumlin::particles
