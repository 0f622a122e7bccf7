#pragma once
// What a key may hold: the words in which a struct describes its keys (key_table.hpp).
#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "coupling/core/basics/enum_names.hpp"

namespace drumlin {

/// What a value may be: an interval for numbers and numbers of an array, a closed list for texts.
struct Allowed {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  ///< min itself is excluded
  bool max_open = false;
  std::vector<std::string> choices;  ///< empty: any text that is not empty
  bool may_be_empty = false;         ///< a text without characters, an array without entries
  std::size_t longest = 4096;        ///< characters of a text, all on one line; what a path may have

  bool holds(double number) const;
};
Allowed anything();  ///< every finite number, every text or array, also an empty one
Allowed above(double min,
              double max = std::numeric_limits<double>::infinity());  ///< min excluded, max included
Allowed at_least(double min, double max = std::numeric_limits<double>::infinity());  ///< both included
Allowed not_empty();
/// A text for people: one line of at most 200 characters, also an empty one.
Allowed title_line();
Allowed one_of(std::vector<std::string> words);
/// The names of an enumeration.
template <Named E>
Allowed one_of() {
  constexpr auto names = names_of(E{});
  return one_of({names.begin(), names.end()});
}

enum class Need { required, defaulted, optional };

struct KeySpec {
  Need need = Need::required;
  std::string unit;  ///< "" for a pure number or a text
  Allowed allowed;
  std::string sentence;
};
/// Of the largest length in a file: none is smaller.
constexpr double least_share_of_length = 1e-9;
/// What is above 0 in a unit of nature has a least value, too.
KeySpec required(std::string unit, Allowed allowed, std::string sentence);
KeySpec defaulted(std::string unit, Allowed allowed, std::string sentence);
/// For std::optional members: absent stays absent.
KeySpec when_given(std::string unit, Allowed allowed, std::string sentence);

/// What a user calls the type of a value.
template <class T>
std::string type_name() {
  if constexpr (std::is_same_v<T, bool>)
    return "true or false";
  else if constexpr (std::is_integral_v<T>)
    return "integer";
  else if constexpr (std::is_same_v<T, double>)
    return "number";
  else if constexpr (std::is_same_v<T, std::filesystem::path>)
    return "file";
  else if constexpr (std::is_same_v<T, std::string> || Named<T>)
    return "text";
  else if constexpr (std::is_same_v<T, std::vector<std::string>>)
    return "array of texts";
  else if constexpr (std::is_same_v<T, std::vector<double>>)
    return "array of numbers";
  else if constexpr (std::is_same_v<T, std::vector<std::array<double, 2>>>)
    return "array of pairs of numbers";
  else
    return "array of " + std::to_string(std::tuple_size_v<T>) + " numbers";
}

/// What values of this type the key may hold: "> 0", "\"nlgs\", \"nncg\"", "" for true or false.
std::string allowed_text(const std::string& type, const Allowed& allowed);

/// One alternative of a variant: the word that chooses it.
template <class T>
struct Alternative {
  std::string word;
  std::string sentence;
};
template <class T>
Alternative<T> alternative(std::string word, std::string sentence) {
  return {std::move(word), std::move(sentence)};
}

/// What visitors of a value that is there have: the tables beside that of the alternative T, `own` describing
/// those of T, `others` those of all the rest.
struct TablesOfHeld {
  template <class T, class V, class Own, class Others>
  void with_table(V& target, const std::string&, Own own, Others others) {
    if (auto* held = std::get_if<T>(&target))
      own(*held);
    else
      others();
  }
};

}  // namespace drumlin
