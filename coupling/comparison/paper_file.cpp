#include "coupling/comparison/paper_file.hpp"

#include <limits>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::coupling {

Document paper_file(const std::filesystem::path& file) {
  Document document = read_toml(file);
  if (text_in(document.root.find("format")) != "drumlin-paper-1")
    throw InputError(
        {InputProblem{file.string(), 1, 0, "format", "is missing or not known here", "\"drumlin-paper-1\""}});
  return document;
}

Node::Array paper_entries(const Document& document, const std::string& key) {
  const Node* node = document.root.find(key);
  const auto* array = node == nullptr ? nullptr : std::get_if<Node::Array>(&node->value);
  if (array == nullptr)
    throw InputError({InputProblem{document.file, 1, 0, key, "is missing", "an array of tables"}});
  return *array;
}

double number_in(const Node* node) {
  if (node == nullptr) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* real = std::get_if<double>(&node->value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&node->value)) return static_cast<double>(*integer);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string text_in(const Node* node) {
  const auto* text = node == nullptr ? nullptr : std::get_if<std::string>(&node->value);
  return text == nullptr ? std::string() : *text;
}

}  // namespace drumlin::coupling
