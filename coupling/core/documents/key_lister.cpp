#include "coupling/core/documents/key_lister.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "coupling/core/documents/toml_text.hpp"

namespace drumlin {

namespace {

/// A pipe would end a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

/// A number of a range as short as it goes: "1000000" as "1e6".
std::string short_number(const std::string& number) {
  const std::size_t last = number.find_last_not_of('0');
  const std::size_t zeros = last == std::string::npos ? 0 : number.size() - 1 - last;
  const bool is_power = zeros > 3 && number.find_first_not_of("-0123456789") == std::string::npos;
  return is_power ? fmt::format("{}e{}", number.substr(0, last + 1), zeros) : number;
}

/// The range of a key for a table of a page: "above 0 to 1" as "(0, 1]", "-1 to 1" as "+-1".
std::string range_cell(const std::string& allowed) {
  const std::size_t middle = allowed.find(" to ");
  if (middle == std::string::npos) return allowed;
  const bool is_open = allowed.starts_with("above ");
  const std::string least = allowed.substr(is_open ? 6 : 0, middle - (is_open ? 6 : 0));
  const std::string most = allowed.substr(middle + 4);
  if (least == "-" + most) return "+-" + short_number(most);
  return fmt::format("{}{}, {}]", is_open ? '(' : '[', short_number(least), short_number(most));
}

bool is_table_row(const KeyRow& row) { return row.type == "table" || row.type == "array of tables"; }

/// The value of a key for a table of a page, where a unit alone ("mm") is a number in it and a list of words
/// a text.
std::string value_cell(const KeyRow& row) {
  std::string type = row.type.starts_with("array of ") ? row.type.substr(9) : row.type;
  if (type == "true or false") type = "boolean";
  if (!row.unit.empty()) type = type == "number" ? row.unit : type + " in " + row.unit;
  if (row.allowed.empty() || row.allowed == "not empty") return type;
  return row.allowed.starts_with('"') ? row.allowed : type + ", " + range_cell(row.allowed);
}

/// The default of a key for a table of a page: empty for one that is required.
std::string default_cell(const KeyRow& row) {
  if (row.standard == "required") return "";
  return is_table_row(row) || row.standard == "absent" ? row.standard : "`" + cell(row.standard) + "`";
}

/// The word of `kind = "word"`, or the [table], that a key is of; empty for a key of no alternative.
std::string choice_of(const KeyRow& row) {
  const std::size_t quote = row.condition.find('"');
  return quote == std::string::npos ? row.condition
                                    : row.condition.substr(quote + 1, row.condition.rfind('"') - quote - 1);
}

/// Whether two rows say the same of one key of two alternatives.
bool same_key_of_alternatives(const KeyRow& a, const KeyRow& b) {
  return !a.condition.empty() && !b.condition.empty() &&
         std::tie(a.path, a.type, a.unit, a.allowed, a.standard, a.sentence) ==
             std::tie(b.path, b.type, b.unit, b.allowed, b.standard, b.sentence);
}

/// Where the keys of the table in row `table` end; `table` + 1 for a row that is no table.
std::size_t end_of_table(const std::vector<KeyRow>& rows, std::size_t table) {
  std::size_t end = table + 1;
  if (is_table_row(rows[table]))
    while (end < rows.size() && rows[end].path.starts_with(rows[table].path + ".")) ++end;
  return end;
}

/// Whether two tables have the same keys, in all but the tables' names.
bool same_keys(const std::vector<KeyRow>& rows, std::size_t first, std::size_t second) {
  const std::size_t count = end_of_table(rows, second) - second;
  if (end_of_table(rows, first) - first != count) return false;
  for (std::size_t i = 1; i < count; ++i) {
    const KeyRow &a = rows[first + i], &b = rows[second + i];
    if (a.path.substr(rows[first].path.size()) != b.path.substr(rows[second].path.size()) ||
        std::tie(a.type, a.unit, a.allowed, a.standard, a.condition, a.sentence) !=
            std::tie(b.type, b.unit, b.allowed, b.standard, b.condition, b.sentence))
      return false;
  }
  return true;
}

/// The first table that has the keys of the table in row `table`, if there are any and they stand before it.
const KeyRow* same_table_before(const std::vector<KeyRow>& rows, std::size_t table) {
  if (end_of_table(rows, table) == table + 1) return nullptr;
  for (std::size_t i = 0; i < table; ++i)
    if (is_table_row(rows[i]) && same_keys(rows, i, table)) return &rows[i];
  return nullptr;
}

}  // namespace

std::string keys_as_text(const std::vector<KeyRow>& rows) {
  std::string text;
  for (const auto& row : rows) {
    text += row.path;
    if (!row.condition.empty()) text += "  (with " + row.condition + ")";
    text += fmt::format("\n    {}", row.type);
    if (!row.unit.empty()) text += " in " + row.unit;
    if (!row.allowed.empty()) text += ", " + row.allowed;
    text += row.standard == "required" ? ", required" : ", default: " + row.standard;
    text += fmt::format("\n    {}\n", row.sentence);
  }
  return text;
}

std::string keys_as_markdown(const std::vector<KeyRow>& rows) {
  std::string text = "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (std::size_t i = 0; i < rows.size();) {
    const KeyRow& row = rows[i];
    const std::size_t end = end_of_table(rows, i);
    const KeyRow* printed = same_table_before(rows, i);
    const auto is_same = [&](const KeyRow& other) { return same_key_of_alternatives(row, other); };
    const auto first = rows.begin() + static_cast<std::ptrdiff_t>(i);
    if (!is_table_row(row) && std::any_of(rows.begin(), first, is_same)) {
      ++i;
      continue;
    }
    std::string choices = choice_of(row);
    if (!is_table_row(row))
      for (auto other = first + 1; other != rows.end(); ++other)
        if (is_same(*other)) choices += ", " + choice_of(*other);
    text += fmt::format("| `{}`{} | {} | {} | {}{} |\n", cell(row.path),
                        choices.empty() ? "" : " (" + choices + ")", cell(value_cell(row)), default_cell(row),
                        cell(row.sentence),
                        printed == nullptr ? "" : " Keys: those of `" + cell(printed->path) + "`.");
    i = printed == nullptr ? i + 1 : end;
  }
  return text;
}

void KeyLister::format(const std::string& text) {
  rows_.push_back({"format", "text", "", "\"" + text + "\"", "required", "", "Version."});
}

std::string KeyLister::text_of_only_value(const Node& table) {
  return toml_value(std::get<Node::Table>(table.value).front().node);
}

void KeyLister::add_value(const std::string& key, const std::string& type, const KeySpec& spec,
                          const std::string& standard) {
  rows_.push_back({prefix_ + key, type, spec.unit, allowed_text(type, spec.allowed), standard, condition_,
                   spec.sentence});
}

void KeyLister::add_table(const std::string& key, const std::string& type, const std::string& standard,
                          const std::string& sentence) {
  rows_.push_back({prefix_ + key, type, "", "", standard, condition_, sentence});
}

void KeyLister::add_choice(const std::string& key, const std::string& sentence,
                           const std::vector<std::pair<std::string, std::string>>& options) {
  std::vector<std::string> words;
  std::string explained = sentence;
  for (const auto& [word, meaning] : options) {
    words.push_back(word);
    explained += " " + word + ": " + meaning;
  }
  rows_.push_back(
      {prefix_ + key, "text", "", allowed_text("text", one_of(words)), "required", condition_, explained});
}

}  // namespace drumlin
