#include "coupling/documents/key_lister.hpp"

#include <fmt/format.h>

#include "coupling/documents/toml_text.hpp"

namespace drumlin {

namespace {

/// A pipe would end a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

bool is_table_row(const KeyRow& row) { return row.type == "table" || row.type == "array of tables"; }

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
  std::string text = "| key | value | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const auto& row : rows) {
    const std::string condition = row.condition.empty() ? "" : " with `" + row.condition + "`";
    const bool quotes_default = !is_table_row(row) && row.standard != "required" && row.standard != "absent";
    text += fmt::format("| `{}`{} | {} | {} | {} | {} | {} |\n", cell(row.path), cell(condition), row.type,
                        row.unit, cell(row.allowed),
                        quotes_default ? "`" + cell(row.standard) + "`" : row.standard, cell(row.sentence));
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
