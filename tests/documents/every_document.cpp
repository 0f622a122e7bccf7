// Every key of every kind of scene: absent, of another type, out of its range, misspelt. Refused by its path,
// or accepted where the list of keys says so.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <regex>
#include <set>

#include "continuum/model/flow_scene.hpp"
#include "coupling/core/documents/toml_text.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
namespace {

struct Kind {
  std::vector<KeyRow> rows;
  std::function<std::string(const std::string&)> resolved;  ///< a text with its defaults
  std::vector<std::filesystem::path> files;
  std::string more = {};  ///< tables that stand in none of them, for the first
};

std::vector<Kind> kinds() {
  const auto data = test::data_folder() / "scenes", here = test::data_folder().parent_path() / "tests/scene";
  const auto scene = [](const std::string& text) {
    return particles::scene_text(particles::parse_scene(text, "scene.toml"));
  };
  const auto flow = [](const std::string& text) {
    return continuum::flow_scene_text(continuum::parse_flow_scene(text, "flow.toml"));
  };
  return {{particles::scene_keys(),
           scene,
           {here / "every_key_drum.toml", here / "every_key_floor.toml", here / "every_key_cell.toml",
            data / "silo-recycled.toml", data / "biaxial.toml"}},
          {continuum::flow_scene_keys(),
           flow,
           {data / "drum-6rpm-flow.toml", data / "drum-6rpm-memory-flow.toml", data / "incline-flow.toml",
            data / "plane-shear-flow.toml", data / "chute-flow.toml", data / "annulus-flow.toml"},
           "[effects.wall_slip]\nfriction = 0.4\n[effects.nonlocal]\nlength = 1\n"
           "[effects.moving_surface]\n"}};
}

/// The keys of a table and below it, "stages.0.name".
void collect(const Node& node, const std::string& path, std::vector<std::string>& paths) {
  if (const auto* table = std::get_if<Node::Table>(&node.value))
    for (const auto& [key, below] : *table)
      paths.push_back(path + key), collect(below, path + key + ".", paths);
  if (const auto* array = std::get_if<Node::Array>(&node.value))
    for (std::size_t k = 0; k < array->size(); ++k)
      collect((*array)[k], path + std::to_string(k) + ".", paths);
}

/// Calls change(table, place in it) where the path leads to.
template <class Change>
std::string changed(Node root, const std::string& path, Change change) {
  Node* node = &root;
  std::size_t begin = 0;
  for (;;) {
    const auto end = path.find('.', begin);
    const std::string key = path.substr(begin, end - begin);
    if (auto* array = std::get_if<Node::Array>(&node->value)) {
      node = &(*array)[std::stoul(key)];
    } else {
      auto& table = std::get<Node::Table>(node->value);
      const auto at =
          std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.key == key; });
      if (end == path.npos) {
        change(table, at);
        return toml_text(root);
      }
      node = &at->node;
    }
    begin = end + 1;
  }
}

class Spoilt {
 public:
  Spoilt(const Kind& kind, const std::string& path, const Node& root)
      : kind_(kind), path_(path), root_(root) {}

  /// Whether a problem names the path, or another, and says the words.
  template <class Change>
  bool is_refused(Change change, const std::string& words = "", const std::string& named = "") const {
    try {
      (void)kind_.resolved(changed(root_, path_, change));
    } catch (const InputError& error) {
      for (const InputProblem& problem : error.problems())
        if (problem.key == (named.empty() ? path_ : named) && problem.what.find(words) != std::string::npos)
          return true;
    }
    return false;
  }
  template <class Value>
  bool refuses(const Value& value) const {
    return is_refused([&](auto&, auto at) { at->node.value = value; });
  }

 private:
  const Kind& kind_;
  const std::string& path_;
  const Node& root_;
};

/// Numbers beyond the bounds that a key names, and what is none.
std::vector<double> numbers_beyond(const std::string& allowed) {
  std::vector<double> beyond{std::nan(""), std::numeric_limits<double>::infinity()};
  std::smatch found;
  const std::string number = "(-?[0-9][-+.0-9e]*)";
  if (std::regex_search(allowed, found, std::regex("to " + number)))
    beyond.push_back(std::stod(found[1]) + 1 + std::abs(std::stod(found[1])));
  if (std::regex_search(allowed, found, std::regex("(?:^|above |>= )" + number)))
    beyond.push_back(std::stod(found[1]) - 1 - std::abs(std::stod(found[1])));
  return beyond;
}

void expect_refusals(const Kind& kind, const std::string& path, const Node& root, const Node& value) {
  SCOPED_TRACE(path);
  const std::string listed = std::regex_replace(path, std::regex("\\.[0-9]+(?=\\.|$)"), "[]");
  std::vector<const KeyRow*> rows;
  for (const KeyRow& row : kind.rows)
    if (row.path == listed || row.path == listed + "[]") rows.push_back(&row);
  ASSERT_FALSE(rows.empty()) << listed << " is not listed";
  const auto all = [&](auto holds) { return std::all_of(rows.begin(), rows.end(), holds); };
  const Spoilt spoilt(kind, path, root);
  const bool missed = spoilt.is_refused([](auto& table, auto at) { table.erase(at); }, "is missing");
  // Of what excludes or replaces another key nothing follows.
  if (all([](const KeyRow* row) { return row->standard == "required"; })) {
    EXPECT_TRUE(missed);
  } else if (all([](const KeyRow* row) {
               return !std::set<std::string>{"required", "absent", "one of these"}.contains(row->standard);
             })) {
    EXPECT_FALSE(missed);
  }
  const std::size_t last = path.rfind('.') + 1;
  const std::string key = path.substr(last), misspelt = path.substr(0, last) + key[0] + key;
  const auto misspell = [](auto&, auto at) { at->key.insert(0, 1, at->key[0]); };
  EXPECT_TRUE(spoilt.is_refused(misspell, "is unknown; did you mean \"" + key + "\"", misspelt) ||
              spoilt.is_refused(misspell, "is missing"));  // what chooses among alternatives
  const bool is_text = std::holds_alternative<std::string>(value.value);
  EXPECT_TRUE(is_text ? spoilt.refuses(std::int64_t{7}) : spoilt.refuses(std::string("x")));
  const bool real = std::holds_alternative<double>(value.value);
  if (!real && !std::holds_alternative<std::int64_t>(value.value)) return;
  for (const double number : numbers_beyond(rows[0]->allowed)) EXPECT_TRUE(spoilt.refuses(number)) << number;
}

TEST(EveryDocument, RefusesEachKeyThatIsAbsentMisspeltOfAnotherTypeOrOutOfRange) {
  for (const Kind& kind : kinds())
    for (const auto& file : kind.files) {
      SCOPED_TRACE(file);
      const std::string text = file_text(file) + (file == kind.files[0] ? kind.more : "");
      const Node root = parse_toml(kind.resolved(text), "t.toml").root;
      std::vector<std::string> paths;
      collect(root, "", paths);
      EXPECT_GT(paths.size(), 20u);
      for (const std::string& path : paths) {
        Node value;
        (void)changed(root, path, [&](auto&, auto at) { value = at->node; });
        expect_refusals(kind, path, root, value);
      }
    }
}

}  // namespace
}  // namespace drumlin
