#include "coupling/core/documents/toml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace drumlin {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string real_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  // "10" would read back as an integer.
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 128 && std::isalnum(c)) || c == '_' || c == '-';
  });
  return bare ? key : quoted(key);
}

bool is_table(const Node& node) { return std::holds_alternative<Node::Table>(node.value); }

bool is_array_of_tables(const Node& node) {
  const auto* array = std::get_if<Node::Array>(&node.value);
  return array && !array->empty() && std::all_of(array->begin(), array->end(), is_table);
}

void append_table(std::string& text, const Node::Table& table, const std::string& path) {
  for (const auto& [key, node] : table)
    if (!is_table(node) && !is_array_of_tables(node)) text += key_text(key) + " = " + toml_value(node) + "\n";
  for (const auto& [key, node] : table) {
    const std::string below = path.empty() ? key_text(key) : path + "." + key_text(key);
    if (is_table(node)) {
      text += "\n[" + below + "]\n";
      append_table(text, std::get<Node::Table>(node.value), below);
    } else if (is_array_of_tables(node)) {
      for (const auto& entry : std::get<Node::Array>(node.value)) {
        text += "\n[[" + below + "]]\n";
        append_table(text, std::get<Node::Table>(entry.value), below);
      }
    }
  }
}

}  // namespace

std::string toml_value(const Node& value) {
  struct Printer {
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(std::int64_t i) const { return fmt::format("{}", i); }
    std::string operator()(double d) const { return real_text(d); }
    std::string operator()(const std::string& s) const { return quoted(s); }
    std::string operator()(const Node::Array& array) const {
      std::string text = "[";
      for (const auto& entry : array) text += (text.size() > 1 ? ", " : "") + toml_value(entry);
      return text + "]";
    }
    std::string operator()(const Node::Table& table) const {
      std::string text = "{";
      for (const auto& [key, entry] : table)
        text += (text.size() > 1 ? ", " : "") + key_text(key) + " = " + toml_value(entry);
      return text + "}";
    }
  };
  return std::visit(Printer{}, value.value);
}

std::string toml_text(const Node& table) {
  std::string text;
  append_table(text, std::get<Node::Table>(table.value), "");
  return text;
}

}  // namespace drumlin
