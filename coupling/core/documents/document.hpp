#pragma once
// A TOML file as a tree that remembers where each value stands, and one description of keys that reads,
// checks, writes and lists them. toml++ is included by document.cpp alone.
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/core/basics/errors.hpp"

namespace drumlin {

/// A value of a document: boolean, integer, real, text, array or table, and its place in the file.
struct Node {
  using Array = std::vector<Node>;
  struct Entry;                      // no std::pair: clang wants its parts to be complete
  using Table = std::vector<Entry>;  ///< in the order of the file
  std::variant<bool, std::int64_t, double, std::string, Array, Table> value;
  int line = 0;
  int column = 0;

  const Node* find(const std::string& key) const;  ///< nullptr if this is no table or has no such key
};

/// A key of a table and what it holds.
struct Node::Entry {
  std::string key;
  Node node;
};

/// A parsed file. `root` is always a table.
struct Document {
  std::string file;
  Node root;
  std::vector<std::string> changes = {};  ///< "key = value" of each override that changed something
};

/// Reads a TOML file of at most 1 MiB without NUL bytes, keys of at most 200 bytes and nothing deeper than 32
/// levels; a byte order mark of UTF-8 is skipped. `overrides` are texts "path.to.key=value" (array
/// entries by index: "stages.1.time_step_s=2e-3"), the value in TOML syntax, a bare word counting as text.
/// Throws InputError (file, line, column) on wrong syntax, on a missing or empty file, on a folder.
Document read_toml(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
/// The same from a text; `name` stands for the file in messages.
Document parse_toml(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides = {});

/// The title of a file with what was changed in it, "Drum, 15 rpm [drum.rotation_rpm = 12]": so that it says
/// nothing that the changes made untrue. Changes at and below the keys `silent` are left out, and all of them
/// where the title is empty or is itself an override.
std::string title_with_changes(const std::string& title, const Document& document,
                               const std::vector<std::string>& silent);

}  // namespace drumlin
