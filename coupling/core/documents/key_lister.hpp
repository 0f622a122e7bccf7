#pragma once
// Lists the keys of a described struct for a user (key_table.hpp).
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "coupling/core/documents/key_spec.hpp"
#include "coupling/core/documents/key_writer.hpp"

namespace drumlin {

/// One key as listed for a user.
struct KeyRow {
  std::string path;  ///< "stages[].time_step_s"
  std::string type;  ///< "number", "integer", "text", "table", ...
  std::string unit;
  std::string allowed;
  std::string standard;   ///< its default as TOML, "required" or "absent"
  std::string condition;  ///< "shape = \"disc\"" where the key belongs to one alternative
  std::string sentence;
};
std::string keys_as_text(const std::vector<KeyRow>& rows);
/// A Markdown table. A table whose keys stand there already under another name refers to them; keys that
/// several alternatives share stand there once. A key without a default is required.
std::string keys_as_markdown(const std::vector<KeyRow>& rows);

/// Walks a default-constructed struct, every alternative of its variants, one entry of its arrays.
class KeyLister {
 public:
  void format(const std::string& text);

  template <class T>
  void value(const std::string& key, const T& standard, const KeySpec& spec) {
    add_value(key, type_name<T>(), spec, spec.need == Need::defaulted ? standard_text(standard) : "required");
  }
  template <class T>
  void value(const std::string& key, const std::optional<T>&, const KeySpec& spec) {
    add_value(key, type_name<T>(), spec, "absent");
  }
  template <class T>
  void table(const std::string& key, T& target, Need need, const std::string& sentence) {
    add_table(key, "table", need == Need::required ? "required" : "its defaults", sentence);
    below(key, target);
  }
  template <class T>
  void optional_table(const std::string& key, std::optional<T>& target, const std::string& sentence) {
    add_table(key, "table", "absent", sentence);
    below(key, target.emplace());
  }
  template <class T>
  void tables(const std::string& key, std::vector<T>& target, std::size_t at_least,
              const std::string& sentence) {
    add_table(key + "[]", "array of tables", at_least > 0 ? "required" : "none", sentence);
    below(key + "[]", target.emplace_back());
  }
  template <class V, class... T>
  void variant(const std::string& key, V& target, const std::string& sentence,
               const Alternative<T>&... options) {
    add_choice(key, sentence, {{options.word, options.sentence}...});
    (list_alternative(key, target, options), ...);
  }
  template <class V, class... T>
  void one_table_of(V& target, const std::string& sentence, const Alternative<T>&... options) {
    (list_table(target, sentence, options), ...);
  }
  template <class T, class V, class Own, class Others>
  void with_table(V& target, const std::string& word, Own own, Others others) {
    others();
    const std::size_t first = rows_.size();
    own(target.template emplace<T>());
    for (std::size_t row = first; row < rows_.size(); ++row)
      if (rows_[row].condition.empty()) rows_[row].condition = "[" + word + "]";
  }
  std::vector<KeyRow> take() { return std::move(rows_); }

 private:
  template <class T>
  static std::string standard_text(const T& standard) {
    KeyWriter writer;
    writer.value("standard", standard, {});
    return text_of_only_value(writer.take());
  }
  static std::string text_of_only_value(const Node& table);

  void add_value(const std::string& key, const std::string& type, const KeySpec& spec,
                 const std::string& standard);
  void add_table(const std::string& key, const std::string& type, const std::string& standard,
                 const std::string& sentence);
  void add_choice(const std::string& key, const std::string& sentence,
                  const std::vector<std::pair<std::string, std::string>>& options);
  template <class T>
  void below(const std::string& key, T& target) {
    const std::string outer_prefix = prefix_, outer_condition = std::exchange(condition_, "");
    prefix_ += key + ".";
    describe(*this, target);
    prefix_ = outer_prefix;
    condition_ = outer_condition;
  }
  template <class V, class T>
  void list_alternative(const std::string& key, V& target, const Alternative<T>& option) {
    condition_ = key + " = \"" + option.word + "\"";
    describe(*this, target.template emplace<T>());
    condition_.clear();
  }
  template <class V, class T>
  void list_table(V& target, const std::string& sentence, const Alternative<T>& option) {
    add_table(option.word, "table", "one of these", sentence + " " + option.sentence);
    below(option.word, target.template emplace<T>());
  }

  std::string prefix_;
  std::string condition_;
  std::vector<KeyRow> rows_;
};

}  // namespace drumlin
