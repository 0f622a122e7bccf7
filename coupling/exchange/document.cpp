// toml++ 3.3 asserts on input that is merely wrong (the bytes "[\0m[", found by fuzzing): its asserts are off
// here.
#ifndef NDEBUG
#define NDEBUG
#endif
#include "coupling/exchange/document.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <fstream>

namespace drumlin {

namespace {

constexpr std::size_t largest_file = 1 << 20;  // bytes; a scene of 10 kB is a long one

/// An InputError with one problem.
InputError fault(const std::string& file, int line, int column, const std::string& key,
                 const std::string& what, const std::string& allowed = "") {
  return InputError(std::vector<InputProblem>{{file, line, column, key, what, allowed}});
}

int line_of(const toml::source_position& position) { return static_cast<int>(position.line); }
int column_of(const toml::source_position& position) { return static_cast<int>(position.column); }

/// Turns the tree of toml++ into ours and notes what has no counterpart.
class Converter {
 public:
  explicit Converter(const std::string& file) : file_(file) {}

  Node converted(const toml::node& node, const std::string& path) {
    Node result;
    result.line = line_of(node.source().begin);
    result.column = column_of(node.source().begin);
    if (const auto* table = node.as_table())
      result.value = converted_table(*table, path);
    else if (const auto* array = node.as_array())
      result.value = converted_array(*array, path);
    else if (const auto* text = node.as_string())
      result.value = text->get();
    else if (const auto* integer = node.as_integer())
      result.value = integer->get();
    else if (const auto* real = node.as_floating_point())
      result.value = real->get();
    else if (const auto* truth = node.as_boolean())
      result.value = truth->get();
    else
      problems_.push_back({file_, result.line, result.column, path, "is a date or a time",
                           "text, number, true, false, array, table"});
    return result;
  }

  std::vector<InputProblem>& problems() { return problems_; }

 private:
  Node::Table converted_table(const toml::table& table, const std::string& path) {
    struct Entry {
      const toml::key* key;
      const toml::node* node;
    };
    std::vector<Entry> entries;
    for (auto&& [key, node] : table) entries.push_back({&key, &node});
    // toml++ sorts by name; the file's own order is what a reader of messages expects.
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      const auto &p = a.key->source().begin, &q = b.key->source().begin;
      return std::pair(p.line, p.column) < std::pair(q.line, q.column);
    });
    Node::Table result;
    for (const auto& entry : entries) {
      const std::string name(entry.key->str());
      result.emplace_back(name, converted(*entry.node, path.empty() ? name : path + "." + name));
    }
    return result;
  }

  Node::Array converted_array(const toml::array& array, const std::string& path) {
    Node::Array result;
    for (const auto& entry : array)
      result.push_back(converted(entry, fmt::format("{}.{}", path, result.size())));
    return result;
  }

  std::string file_;
  std::vector<InputProblem> problems_;
};

Node parsed(const std::string& text, const std::string& name) {
  try {
    const toml::table table = toml::parse(std::string_view(text), std::string_view(name));
    Converter converter(name);
    Node root = converter.converted(table, "");
    if (!converter.problems().empty()) throw InputError(converter.problems());
    root.line = root.column = 1;
    return root;
  } catch (const toml::parse_error& error) {
    const auto& place = error.source().begin;
    throw fault(name, line_of(place), column_of(place), "", std::string(error.description()), "TOML 1.0");
  }
}

/// A word that needs no quotes on a command line: nncg, grains.csv, run-3/list.csv.
bool is_bare_word(const std::string& text) {
  constexpr std::string_view marks = "_-+./";
  return !text.empty() && std::all_of(text.begin(), text.end(), [&](unsigned char c) {
    return (c < 128 && std::isalnum(c)) || marks.find(static_cast<char>(c)) != std::string_view::npos;
  });
}

/// Marks a tree as not standing in any file.
void forget_places(Node& node) {
  node.line = node.column = 0;
  if (auto* array = std::get_if<Node::Array>(&node.value))
    for (auto& entry : *array) forget_places(entry);
  if (auto* table = std::get_if<Node::Table>(&node.value))
    for (auto& [name, entry] : *table) forget_places(entry);
}

constexpr const char* override_source = "override";

Node override_value(const std::string& text, const std::string& path) {
  const auto refused = [&] {
    return fault(override_source, 0, 0, path, fmt::format("cannot read \"{}\"", text),
                 "one value in TOML syntax, or a bare word as text");
  };
  if (text.find_first_of("\n\r") != std::string::npos) throw refused();  // could smuggle in a second key
  try {
    Node root = parsed("value = " + text, override_source);
    forget_places(root);
    return std::move(std::get<Node::Table>(root.value).front().second);
  } catch (const InputError&) {
    if (is_bare_word(text)) return Node{text, 0, 0};
    throw refused();
  }
}

/// The entry `step` of `node`, made anew in a table that has none.
Node& entry_of(Node& node, const std::string& step, const std::string& path) {
  if (auto* array = std::get_if<Node::Array>(&node.value)) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(step.data(), step.data() + step.size(), index);
    if (error != std::errc() || end != step.data() + step.size() || index >= array->size())
      throw fault(override_source, 0, 0, path, fmt::format("\"{}\" is no entry of this array", step),
                  array->empty() ? "none, it is empty" : fmt::format("0 to {}", array->size() - 1));
    return (*array)[index];
  }
  auto* table = std::get_if<Node::Table>(&node.value);
  if (!table)
    throw fault(override_source, 0, 0, path, fmt::format("nothing can stand below at \"{}\"", step));
  for (auto& [name, entry] : *table)
    if (name == step) return entry;
  return table->emplace_back(step, Node{Node::Table{}, 0, 0}).second;
}

void apply_override(Node& root, const std::string& text) {
  const auto equals = text.find('=');
  const std::string path = text.substr(0, equals);
  if (equals == std::string::npos || path.empty())
    throw fault(override_source, 0, 0, text, "is no override", "path.to.key=value");
  Node* node = &root;
  for (std::size_t from = 0; from <= path.size();) {
    const auto dot = std::min(path.find('.', from), path.size());
    if (dot == from) throw fault(override_source, 0, 0, path, "has an empty part", "path.to.key=value");
    node = &entry_of(*node, path.substr(from, dot - from), path);
    from = dot + 1;
  }
  *node = override_value(text.substr(equals + 1), path);
}

/// The bytes of a file, refused before a parser sees what it need not bear.
std::string checked_text(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw fault(name, 0, 0, "", "does not exist", "a TOML file");
  if (std::filesystem::is_directory(status)) throw fault(name, 0, 0, "", "is a folder", "a TOML file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw IoError(name + ": cannot be opened");
  std::string text(largest_file + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw IoError(name + ": cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

const Node* Node::find(const std::string& key) const {
  if (const auto* table = std::get_if<Table>(&value))
    for (const auto& [name, entry] : *table)
      if (name == key) return &entry;
  return nullptr;
}

Document parse_toml(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides) {
  if (text.size() > largest_file) throw fault(name, 0, 0, "", "is too large", "at most 1 MiB");
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw fault(name, 1, 1, "", "is empty", "a TOML file");
  if (const auto zero = text.find('\0'); zero != std::string::npos) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n') + 1;
    throw fault(name, static_cast<int>(line), 0, "", "holds a NUL byte", "text");
  }
  Document document{name, parsed(text, name)};
  for (const auto& change : overrides) apply_override(document.root, change);
  return document;
}

Document read_toml(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return parse_toml(checked_text(file), file.string(), overrides);
}

}  // namespace drumlin
