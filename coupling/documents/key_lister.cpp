#include "coupling/documents/key_lister.hpp"

#include <fmt/format.h>

#include <tuple>

#include "coupling/documents/toml_text.hpp"

namespace drumlin {

namespace {

/// A pipe would end a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

/// The range of a key for a table of a page: "-1 to 1" as "+-1".
std::string range_cell(const std::string& allowed) {
  const std::size_t middle = allowed.find(" to ");
  if (!allowed.starts_with('-') || middle == std::string::npos) return allowed;
  const std::string most = allowed.substr(middle + 4);
  return allowed.substr(1, middle - 1) == most ? "+-" + most : allowed;
}

/// The value of a key for a table of a page, where a unit alone ("mm") is a number in it.
std::string value_cell(const KeyRow& row) {
  std::string type = row.type.starts_with("array of ") ? row.type.substr(9) : row.type;
  if (!row.unit.empty()) type = type == "number" ? row.unit : type + " in " + row.unit;
  return row.allowed.empty() || row.allowed == "not empty" ? type : type + ", " + range_cell(row.allowed);
}

/// The word of `kind = "word"` that a key is of.
std::string choice_cell(const std::string& condition) {
  const std::size_t quote = condition.find('"');
  return condition.empty() ? "" : " (" + condition.substr(quote + 1, condition.rfind('"') - quote - 1) + ")";
}

bool is_table_row(const KeyRow& row) { return row.type == "table" || row.type == "array of tables"; }

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
    const bool quotes_default = !is_table_row(row) && row.standard != "required" && row.standard != "absent";
    text += fmt::format("| `{}`{} | {} | {} | {}{} |\n", cell(row.path), choice_cell(row.condition),
                        cell(value_cell(row)), quotes_default ? "`" + cell(row.standard) + "`" : row.standard,
                        cell(row.sentence),
                        printed == nullptr ? "" : " Keys: those of `" + cell(printed->path) + "`.");
    i = printed == nullptr ? i + 1 : end;
  }
  return text;
}

void KeyLister::format(const std::string& text) {
  rows_.push_back({"format", "text", "", "\"" + text + "\"", "required", "", "Version of this format."});
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
