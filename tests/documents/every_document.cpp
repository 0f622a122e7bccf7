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
            data / "plane-shear-flow.toml", data / "chute-flow.toml", data / "annulus-flow.toml",
            data / "column-collapse-flow.toml", here / "every_key_region.toml"},
           "[effects.wall_slip]\nfriction = 0.4\n[effects.nonlocal]\nlength = 1\n"
           "[effects.moving_surface]\n"}};
}

/// Calls visit(table, place in it, path) for every key, "stages.0.name".
template <class Visit>
void each_key(Node& node, const std::string& path, Visit visit) {
  if (auto* table = std::get_if<Node::Table>(&node.value))
    for (std::size_t k = 0; k < table->size(); ++k) {
      const std::string key = path + (*table)[k].key;
      visit(*table, k, key);
      each_key((*table)[k].node, key + ".", visit);
    }
  if (auto* array = std::get_if<Node::Array>(&node.value))
    for (std::size_t k = 0; k < array->size(); ++k)
      each_key((*array)[k], path + std::to_string(k) + ".", visit);
}

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

/// Needs of a key, as the list says them, and what it allows.
std::pair<std::set<std::string>, std::string> listed(const Kind& kind, const std::string& path) {
  const std::string name = std::regex_replace(path, std::regex("\\.[0-9]+(?=\\.|$)"), "[]");
  std::pair<std::set<std::string>, std::string> found;
  for (const KeyRow& row : kind.rows)
    if (row.path == name || row.path == name + "[]")
      found.first.insert(row.standard), found.second = row.allowed;
  EXPECT_FALSE(found.first.empty()) << name << " is not listed";
  return found;
}

/// Spoils one key of a tree after the other, each in several ways.
void expect_refusals(const Kind& kind, Node& root) {
  /// Whether a problem names the key and says the words.
  const auto says = [&](const std::string& key, const std::string& words) {
    try {
      (void)kind.resolved(toml_text(root));
    } catch (const InputError& error) {
      for (const InputProblem& problem : error.problems())
        if (problem.key == key && problem.what.find(words) != std::string::npos) return true;
    }
    return false;
  };
  each_key(root, "", [&](Node::Table& table, std::size_t k, const std::string& path) {
    SCOPED_TRACE(path);
    const auto [needs, allowed] = listed(kind, path);
    const Node::Entry entry = table[k];
    table.erase(table.begin() + static_cast<long>(k));
    const bool missed = says(path, "is missing");
    table.insert(table.begin() + static_cast<long>(k), entry);
    // Of what excludes or replaces another key nothing follows.
    if (needs == std::set<std::string>{"required"}) {
      EXPECT_TRUE(missed);
    } else if (!needs.contains("required") && !needs.contains("absent") && !needs.contains("one of these")) {
      EXPECT_FALSE(missed);
    }
    table.push_back(entry);
    table.back().key.insert(0, 1, entry.key[0]);
    const std::string misspelt = path.substr(0, path.rfind('.') + 1) + table.back().key;
    EXPECT_TRUE(says(misspelt, "is unknown; did you mean \"" + entry.key + "\""));
    table.pop_back();
    const auto refuses = [&](auto value) {
      table[k].node.value = value;
      const bool refused = says(path, "");
      table[k] = entry;
      return refused;
    };
    const bool is_text = std::holds_alternative<std::string>(entry.node.value);
    EXPECT_TRUE(is_text ? refuses(std::int64_t{7}) : refuses(std::string("x")));
    const bool whole = std::holds_alternative<std::int64_t>(entry.node.value);
    if (!whole && !std::holds_alternative<double>(entry.node.value)) return;
    for (const double number : numbers_beyond(allowed)) EXPECT_TRUE(refuses(number)) << number;
  });
}

TEST(EveryDocument, RefusesEachKeyThatIsAbsentMisspeltOfAnotherTypeOrOutOfRange) {
  for (const Kind& kind : kinds())
    for (const auto& file : kind.files) {
      SCOPED_TRACE(file);
      const std::string text = file_text(file) + (file == kind.files[0] ? kind.more : "");
      Node root = parse_toml(kind.resolved(text), "t.toml").root;
      expect_refusals(kind, root);
    }
}

}  // namespace
}  // namespace drumlin
