#include "coupling/core/results/profile_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/results/quantities.hpp"

namespace drumlin {

namespace {

constexpr std::string_view first_line = "# drumlin-profiles-1";
constexpr std::string_view interval_suffix = "_ci99";
constexpr std::string_view column_prefix = "column ";  // of a key of the header

bool names_interval(std::string_view name) { return name.ends_with(interval_suffix); }

/// A set that could not be read back is refused here, where its maker can still be found.
void check_writable(const std::filesystem::path& file, const ProfileSet& profiles) {
  const auto refuse = [&](const std::string& key, const std::string& what, const std::string& allowed) {
    throw InputError({InputProblem{file.string(), 0, 0, key, what, allowed}});
  };
  for (std::size_t i = 0; i < profiles.z.size(); ++i)
    if (!std::isfinite(profiles.z[i]) || (i > 0 && profiles.z[i] <= profiles.z[i - 1]))
      refuse("z", fmt::format("entry {} is {}", i, profiles.z[i]), "finite and ascending");
  std::set<std::string> names{"z"};
  for (const auto& column : profiles.columns) {
    if (column.name.empty() || names_interval(column.name) ||
        column.name.find_first_of(", \t\n#") != std::string::npos)
      refuse(column.name, "cannot name a column", "a word that does not end in _ci99");
    if (!names.insert(column.name).second) refuse(column.name, "appears twice", "once");
    if (column.value.size() != profiles.z.size() ||
        (!column.ci99.empty() && column.ci99.size() != profiles.z.size()))
      refuse(column.name, "has another length than z", fmt::format("{} entries", profiles.z.size()));
  }
  if (const std::string fault = fault_of(profiles.header); !fault.empty()) refuse("", fault, "");
}

class ProfileReader {
 public:
  explicit ProfileReader(const std::filesystem::path& file) : file_(file), text_(input_text(file)) {}

  ProfileSet read() {
    if (!next_line() || trimmed(line_) != first_line)
      refuse("", "is not a profile file of this version", fmt::format("\"{}\" as first line", first_line));
    std::vector<HeaderLine> header;
    bool found_names = false;
    while (!found_names && next_line()) {
      if (trimmed(line_).starts_with('#'))
        header.push_back({number_, trimmed(line_).substr(1)});
      else
        found_names = true;
    }
    profiles_.header = read_header(header, file_.string());
    if (!found_names) refuse("", "ends before the line of column names", "");
    read_names();
    while (next_line())
      if (!trimmed(line_).empty()) read_layer();
    for (const ProfileColumn& column : profiles_.columns)  // their names say as much
      profiles_.header.further.erase(std::string(column_prefix) + column.name);
    return std::move(profiles_);
  }

 private:
  [[noreturn]] void refuse(std::string_view key, const std::string& what, const std::string& allowed) const {
    throw InputError({InputProblem{file_.string(), number_, 0, std::string(key), what, allowed}});
  }

  bool next_line() {
    if (position_ >= text_.size()) return false;
    const auto end = std::min(text_.find('\n', position_), text_.size());
    line_ = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    ++number_;
    return true;
  }

  void read_names() {
    const auto names = csv_fields(line_);
    if (names.front() != "z") refuse(names.front(), "is not the first column", "z");
    std::set<std::string_view> seen{"z"};
    for (std::size_t i = 1; i < names.size(); ++i) {
      if (names[i].empty() || !seen.insert(names[i]).second)
        refuse(names[i], "is empty or appears twice", "");
      if (!names_interval(names[i])) {
        profiles_.columns.push_back({std::string(names[i]), {}, {}});
        is_interval_.push_back(false);
      } else {
        const auto owner = names[i].substr(0, names[i].size() - interval_suffix.size());
        if (i == 1 || owner != names[i - 1])
          refuse(names[i], "does not follow its column", std::string(owner));
        is_interval_.push_back(true);
      }
    }
  }

  double number(std::string_view field, std::string_view key) const {
    const auto value = csv_value(field);
    if (!value || std::abs(*value) > largest_value)
      refuse(key, fmt::format("\"{}\" does not do", field),
             fmt::format("a number of at most {:g} from 0, or nothing where it was not computed",
                         largest_value));
    return *value;
  }

  void read_layer() {
    const auto fields = csv_fields(line_);
    if (fields.size() != is_interval_.size() + 1)
      refuse("", fmt::format("has {} fields", fields.size()), fmt::format("{}", is_interval_.size() + 1));
    const double z = number(fields[0], "z");
    if (std::isnan(z) || (!profiles_.z.empty() && z <= profiles_.z.back()))
      refuse("z", fmt::format("\"{}\" does not continue the layers", fields[0]), "ascending");
    profiles_.z.push_back(z);
    auto column = profiles_.columns.begin();
    for (std::size_t i = 0; i < is_interval_.size(); ++i) {
      if (is_interval_[i])
        std::prev(column)->ci99.push_back(number(fields[i + 1], std::prev(column)->name));
      else {
        column->value.push_back(number(fields[i + 1], column->name));
        ++column;
      }
    }
  }

  std::filesystem::path file_;
  std::string text_;
  std::size_t position_ = 0;
  std::string_view line_;
  int number_ = 0;
  std::vector<bool> is_interval_;  ///< of each field after z
  ProfileSet profiles_;
};

}  // namespace

const ProfileColumn* ProfileSet::find(const std::string& name) const {
  for (const auto& candidate : columns)
    if (candidate.name == name) return &candidate;
  return nullptr;
}

const ProfileColumn& ProfileSet::column(const std::string& name) const {
  if (const auto* found = find(name)) return *found;
  throw InputError("the profiles have no column " + name);
}

double interpolated(const std::vector<double>& z, const std::vector<double>& value, double at) {
  const auto upper = std::lower_bound(z.begin(), z.end(), at);
  if (upper == z.end()) return no_value;
  const auto i = static_cast<std::size_t>(upper - z.begin());
  if (*upper == at) return value[i];
  if (i == 0) return no_value;
  const double share = (at - z[i - 1]) / (z[i] - z[i - 1]);
  return (1 - share) * value[i - 1] + share * value[i];
}

std::string profile_table(const ProfileSet& profiles, const std::string& coordinate) {
  std::vector<std::string> fields{coordinate};
  for (const auto& column : profiles.columns) {
    fields.push_back(column.name);
    if (!column.ci99.empty()) fields.push_back(column.name + std::string(interval_suffix));
  }
  std::string text = csv_line(fields);
  for (std::size_t i = 0; i < profiles.z.size(); ++i) {
    fields = {csv_number(profiles.z[i])};
    for (const auto& column : profiles.columns) {
      fields.push_back(csv_number(column.value[i]));
      if (!column.ci99.empty()) fields.push_back(csv_number(column.ci99[i]));
    }
    text += csv_line(fields);
  }
  return text;
}

std::string column_lines(const ProfileSet& profiles) {
  std::string lines;
  for (const auto& column : profiles.columns)
    if (const auto [unit, meaning] = quantity_words(column.name); !unit.empty())
      lines += fmt::format("# {}{} = {}: {}\n", column_prefix, column.name, unit, meaning);
  return lines;
}

void write_profiles(const std::filesystem::path& file, const ProfileSet& profiles) {
  check_writable(file, profiles);
  replace_file(file, fmt::format("{}\n{}{}{}", first_line, header_lines(profiles.header, "# "),
                                 column_lines(profiles), profile_table(profiles)));
}

ProfileSet read_profiles(const std::filesystem::path& file) { return ProfileReader(file).read(); }

}  // namespace drumlin
