#pragma once
// Reads a described struct from a document, all problems at once (key_table.hpp).
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/document.hpp"
#include "coupling/core/documents/key_spec.hpp"

namespace drumlin {

/// A problem at the place of `path` in the document, or of the nearest table above that exists.
InputProblem problem_at(const Document& document, const std::string& path, const std::string& what,
                        const std::string& allowed = "");
/// By place, so that they read in the order of the file.
void sort_by_place(std::vector<InputProblem>& problems);

/// Fills a struct from a document; collects problems instead of stopping at the first.
class KeyReader : public TablesOfHeld {
 public:
  /// Starts at the root of the document, which outlives the reader; problems are appended.
  KeyReader(const Document& document, std::vector<InputProblem>& problems);
  /// Reports what nothing has asked for and brings the problems into the order of the file.
  void finish();

  /// The key "format" of a root table. Another version hides all other problems: they would mean nothing.
  void format(const std::string& expected);

  template <class T>
  void value(const std::string& key, T& target, const KeySpec& spec) {
    if (const Node* node = wanted(key, type_name<T>(), spec)) assign(*node, key, target, spec);
  }
  template <class T>
  void value(const std::string& key, std::optional<T>& target, const KeySpec& spec) {
    if (const Node* node = wanted(key, type_name<T>(), spec)) assign(*node, key, target.emplace(), spec);
  }

  template <class T>
  void table(const std::string& key, T& target, Need need, const std::string&) {
    if (const Node* node = wanted_table(key, need)) descend(*node, key, target);
  }
  template <class T>
  void optional_table(const std::string& key, std::optional<T>& target, const std::string&) {
    if (const Node* node = wanted_table(key, Need::optional)) descend(*node, key, target.emplace());
  }
  template <class T>
  void tables(const std::string& key, std::vector<T>& target, std::size_t at_least_entries,
              const std::string&) {
    const auto* entries = wanted_tables(key, at_least_entries);
    for (std::size_t i = 0; entries && i < entries->size(); ++i)
      if (check_is_table((*entries)[i], key + "." + std::to_string(i)))
        descend((*entries)[i], key + "." + std::to_string(i), target.emplace_back());
      else
        target.emplace_back();
  }
  /// The word under `key` chooses; the keys of the alternative stand in the same table.
  template <class V, class... T>
  void variant(const std::string& key, V& target, const std::string&, const Alternative<T>&... options) {
    const std::string* word = chosen_word(key, {options.word...});
    if (word) (choose(*word, target, options), ...);
  }
  /// The sub-table that is present chooses; exactly one of them must be.
  template <class V, class... T>
  void one_table_of(V& target, const std::string&, const Alternative<T>&... options) {
    const std::string word = present_table({options.word...});
    if (!word.empty()) (choose_table(word, target, options), ...);
  }

 private:
  struct Level {
    const Node* table;
    std::string path;
    std::set<std::string> known;
    bool reports_unknown = true;
  };

  const Node* wanted(const std::string& key, const std::string& type, const KeySpec& spec);
  const Node* wanted_table(const std::string& key, Need need);
  const Node::Array* wanted_tables(const std::string& key, std::size_t at_least_entries);
  bool check_is_table(const Node& node, const std::string& key);
  const std::string* chosen_word(const std::string& key, const std::vector<std::string>& words);
  std::string present_table(const std::vector<std::string>& words);

  void assign(const Node&, const std::string& key, bool&, const KeySpec&);
  void assign(const Node&, const std::string& key, int&, const KeySpec&);
  void assign(const Node&, const std::string& key, std::uint64_t&, const KeySpec&);
  void assign(const Node&, const std::string& key, double&, const KeySpec&);
  void assign(const Node&, const std::string& key, std::string&, const KeySpec&);
  void assign(const Node&, const std::string& key, std::filesystem::path&, const KeySpec&);
  template <Named E>
  void assign(const Node& node, const std::string& key, E& target, const KeySpec& spec) {
    std::string text;
    assign(node, key, text, spec);
    target = enumerator<E>(text).value_or(target);
  }
  template <std::size_t N>
  void assign(const Node& node, const std::string& key, std::array<double, N>& target, const KeySpec& spec) {
    assign_fixed(node, key, target.data(), N, spec);
  }
  template <class T>
  void assign(const Node& node, const std::string& key, std::vector<T>& target, const KeySpec& spec) {
    const Node::Array* entries = filled_array(node, key, type_name<std::vector<T>>(), spec);
    if (!entries) return;
    target.assign(entries->size(), T{});
    for (std::size_t i = 0; i < entries->size(); ++i)
      assign((*entries)[i], key + "." + std::to_string(i), target[i], spec);
  }
  /// Null where it is none, or an empty one that must not be.
  const Node::Array* filled_array(const Node&, const std::string& key, const std::string& type,
                                  const KeySpec&);
  void assign_fixed(const Node&, const std::string& key, double* target, std::size_t count, const KeySpec&);
  bool integer(const Node&, const std::string& key, std::int64_t& target, const KeySpec&,
               std::int64_t largest);

  template <class T>
  void descend(const Node& node, const std::string& key, T& target) {
    enter(node, key);
    describe(*this, target);
    leave();
  }
  template <class V, class T>
  void choose(const std::string& word, V& target, const Alternative<T>& option) {
    if (word == option.word) describe(*this, target.template emplace<T>());
  }
  template <class V, class T>
  void choose_table(const std::string& word, V& target, const Alternative<T>& option) {
    if (word != option.word) return;
    if (const Node* node = wanted_table(word, Need::required))
      descend(*node, word, target.template emplace<T>());
  }
  void enter(const Node& node, const std::string& key);
  void leave();
  Level& level() { return levels_.back(); }
  std::string path_of(const std::string& key) const;
  void report(const Node& node, const std::string& key, const std::string& what, const std::string& allowed);

  const Document& document_;
  std::vector<InputProblem>& problems_;
  std::optional<InputProblem> wrong_format_;
  std::vector<std::pair<double, InputProblem>> lengths_;  // in m; what to report of one far below the largest
  std::vector<Level> levels_;
};

}  // namespace drumlin
