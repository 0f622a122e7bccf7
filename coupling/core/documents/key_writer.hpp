#pragma once
// Turns a described struct into a tree (key_table.hpp).
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/core/documents/document.hpp"
#include "coupling/core/documents/key_spec.hpp"

namespace drumlin {

/// Turns a struct into a tree that holds every key, defaults too; absent optionals stay absent.
class KeyWriter : public TablesOfHeld {
 public:
  KeyWriter();
  void format(const std::string& text) { add("format", Node{text, 0, 0}); }

  template <class T>
  void value(const std::string& key, const T& source, const KeySpec&) {
    add(key, node_of(source));
  }
  template <class T>
  void value(const std::string& key, const std::optional<T>& source, const KeySpec&) {
    if (source) add(key, node_of(*source));
  }
  template <class T>
  void table(const std::string& key, T& source, Need, const std::string&) {
    add(key, below(source));
  }
  template <class T>
  void optional_table(const std::string& key, std::optional<T>& source, const std::string&) {
    if (source) add(key, below(*source));
  }
  template <class T>
  void tables(const std::string& key, std::vector<T>& source, std::size_t, const std::string&) {
    Node::Array entries;
    for (auto& entry : source) entries.push_back(below(entry));
    add(key, Node{std::move(entries), 0, 0});
  }
  template <class V, class... T>
  void variant(const std::string& key, V& source, const std::string&, const Alternative<T>&... options) {
    (write_if_held(key, source, options), ...);
  }
  template <class V, class... T>
  void one_table_of(V& source, const std::string&, const Alternative<T>&... options) {
    (write_table_if_held(source, options), ...);
  }
  Node take() { return std::move(root_); }

 private:
  static Node node_of(bool b) { return {b, 0, 0}; }
  static Node node_of(int i) { return {std::int64_t{i}, 0, 0}; }
  static Node node_of(std::uint64_t i) { return {static_cast<std::int64_t>(i), 0, 0}; }
  static Node node_of(double d) { return {d, 0, 0}; }
  static Node node_of(const std::string& text) { return {text, 0, 0}; }
  static Node node_of(const std::filesystem::path& path) { return {path.string(), 0, 0}; }
  template <Named E>
  static Node node_of(const E& value) {
    return node_of(std::string(name_of(value)));
  }
  template <class Range>
  static Node node_of(const Range& range) {
    Node::Array entries;
    for (const auto& entry : range) entries.push_back(node_of(entry));
    return {std::move(entries), 0, 0};
  }
  void add(const std::string& key, Node node);
  template <class T>
  static Node below(T& source) {
    KeyWriter writer;
    describe(writer, source);
    return writer.take();
  }
  template <class V, class T>
  void write_if_held(const std::string& key, V& source, const Alternative<T>& option) {
    if (auto* held = std::get_if<T>(&source)) {
      add(key, Node{option.word, 0, 0});
      describe(*this, *held);
    }
  }
  template <class V, class T>
  void write_table_if_held(V& source, const Alternative<T>& option) {
    if (auto* held = std::get_if<T>(&source)) add(option.word, below(*held));
  }

  Node root_;
};

}  // namespace drumlin
