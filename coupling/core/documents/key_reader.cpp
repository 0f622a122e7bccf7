#include "coupling/core/documents/key_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "coupling/core/basics/suggestion.hpp"
#include "coupling/core/documents/number_text.hpp"
#include "coupling/core/documents/one_line.hpp"

namespace drumlin {

namespace {

std::string kind_of(const Node& node) {
  static constexpr const char* kinds[] = {"true or false", "an integer", "a number",
                                          "a text",        "an array",   "a table"};
  return kinds[node.value.index()];
}

template <class Words>
std::string listed(const Words& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// A value made by an override stands in no file.
InputProblem problem_of(const Document& document, const Node& node, const std::string& path,
                        const std::string& what, const std::string& allowed) {
  return {node.line > 0 ? document.file : "override", node.line, node.column, path, what, allowed};
}

/// "number in s, > 0"
std::string wish(const std::string& type, const KeySpec& spec) {
  const std::string allowed = allowed_text(type, spec.allowed);
  return type + (spec.unit.empty() ? "" : " in " + spec.unit) + (allowed.empty() ? "" : ", " + allowed);
}

}  // namespace

InputProblem problem_at(const Document& document, const std::string& path, const std::string& what,
                        const std::string& allowed) {
  const Node* node = &document.root;
  for (std::size_t from = 0; from <= path.size();) {
    const auto dot = std::min(path.find('.', from), path.size());
    const std::string step = path.substr(from, dot - from);
    const Node* next = node->find(step);
    const auto index = parsed_number<std::size_t>(step);
    if (const auto* array = std::get_if<Node::Array>(&node->value); array && index && *index < array->size())
      next = &(*array)[*index];
    if (!next) break;
    node = next;
    from = dot + 1;
  }
  return problem_of(document, *node, path, what, allowed);
}

void sort_by_place(std::vector<InputProblem>& problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const InputProblem& a, const InputProblem& b) {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  });
}

KeyReader::KeyReader(const Document& document, std::vector<InputProblem>& problems)
    : document_(document), problems_(problems) {
  levels_.push_back({&document.root, "", {}, true});
}

void KeyReader::finish() {
  leave();
  double largest = 0;
  for (const auto& [length, problem] : lengths_) largest = std::max(largest, length);
  for (const auto& [length, problem] : lengths_)
    if (length < least_share_of_length * largest) problems_.push_back(problem);
  if (wrong_format_) problems_ = {*wrong_format_};
  sort_by_place(problems_);
}

void KeyReader::format(const std::string& expected) {
  level().known.insert("format");
  const std::string allowed = fmt::format("\"{}\"", expected);
  const Node* node = level().table->find("format");
  if (!node) return report(*level().table, "format", "is missing", allowed);
  const auto* text = std::get_if<std::string>(&node->value);
  if (!text || *text != expected)
    wrong_format_ = problem_of(document_, *node, "format",
                               text ? "is \"" + *text + "\"" : "is " + kind_of(*node), allowed);
}

const Node* KeyReader::wanted(const std::string& key, const std::string& type, const KeySpec& spec) {
  level().known.insert(key);
  const Node* node = level().table->find(key);
  if (!node && spec.need == Need::required) report(*level().table, key, "is missing", wish(type, spec));
  return node;
}

const Node* KeyReader::wanted_table(const std::string& key, Need need) {
  level().known.insert(key);
  const Node* node = level().table->find(key);
  if (!node) {
    if (need == Need::required) report(*level().table, key, "is missing", "a table");
    return nullptr;
  }
  return check_is_table(*node, key) ? node : nullptr;
}

const Node::Array* KeyReader::wanted_tables(const std::string& key, std::size_t at_least_entries) {
  level().known.insert(key);
  const Node* node = level().table->find(key);
  const std::string allowed = at_least_entries > 0
                                  ? fmt::format("an array of at least {} table", at_least_entries)
                                  : "an array of tables";
  if (!node) {
    if (at_least_entries > 0) report(*level().table, key, "is missing", allowed);
    return nullptr;
  }
  const auto* entries = std::get_if<Node::Array>(&node->value);
  if (!entries)
    report(*node, key, "is " + kind_of(*node), allowed);
  else if (entries->size() < at_least_entries)
    report(*node, key, fmt::format("has {} entries", entries->size()), allowed);
  return entries;
}

bool KeyReader::check_is_table(const Node& node, const std::string& key) {
  if (std::holds_alternative<Node::Table>(node.value)) return true;
  report(node, key, "is " + kind_of(node), "a table");
  return false;
}

const std::string* KeyReader::chosen_word(const std::string& key, const std::vector<std::string>& words) {
  level().known.insert(key);
  const std::string allowed = allowed_text("text", one_of(words));
  const Node* node = level().table->find(key);
  const std::string* word = node ? std::get_if<std::string>(&node->value) : nullptr;
  if (!node)
    report(*level().table, key, "is missing", allowed);
  else if (!word)
    report(*node, key, "is " + kind_of(*node), allowed);
  else if (std::find(words.begin(), words.end(), *word) == words.end())
    report(*node, key, fmt::format("is \"{}\"{}", *word, suggestion(*word, words)), allowed);
  else
    return word;
  // Which keys belong to the table is then unknown.
  level().reports_unknown = false;
  return nullptr;
}

std::string KeyReader::present_table(const std::vector<std::string>& words) {
  std::vector<std::string> present;
  for (const auto& word : words) {
    level().known.insert(word);
    if (level().table->find(word)) present.push_back(word);
  }
  if (present.size() == 1) return present.front();
  if (present.empty())
    report(*level().table, words.front(), "is missing", "one table of " + listed(words));
  else
    for (const auto& word : present)
      report(*level().table->find(word), word,
             "excludes " + (word == present.front() ? present.back() : present.front()),
             "one table of " + listed(words));
  return "";
}

void KeyReader::assign(const Node& node, const std::string& key, bool& target, const KeySpec&) {
  if (const auto* truth = std::get_if<bool>(&node.value))
    target = *truth;
  else
    report(node, key, "is " + kind_of(node), "true or false");
}

bool KeyReader::integer(const Node& node, const std::string& key, std::int64_t& target, const KeySpec& spec,
                        std::int64_t largest) {
  const auto* number = std::get_if<std::int64_t>(&node.value);
  if (!number) {
    report(node, key, "is " + kind_of(node), wish("integer", spec));
  } else if (!spec.allowed.holds(static_cast<double>(*number)) || *number > largest) {
    report(node, key, fmt::format("is {}", *number), wish("integer", spec));
  } else {
    target = *number;
    return true;
  }
  return false;
}

void KeyReader::assign(const Node& node, const std::string& key, int& target, const KeySpec& spec) {
  KeySpec fitting = spec;
  fitting.allowed.min = std::max(fitting.allowed.min, static_cast<double>(std::numeric_limits<int>::min()));
  std::int64_t number = 0;
  if (integer(node, key, number, fitting, std::numeric_limits<int>::max())) target = static_cast<int>(number);
}

void KeyReader::assign(const Node& node, const std::string& key, std::uint64_t& target, const KeySpec& spec) {
  KeySpec fitting = spec;
  fitting.allowed.min = std::max(fitting.allowed.min, 0.0);
  std::int64_t number = 0;
  if (integer(node, key, number, fitting, std::numeric_limits<std::int64_t>::max()))
    target = static_cast<std::uint64_t>(number);
}

void KeyReader::assign(const Node& node, const std::string& key, double& target, const KeySpec& spec) {
  double number = 0;
  if (const auto* real = std::get_if<double>(&node.value))
    number = *real;
  else if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    number = static_cast<double>(*whole);
  else
    return report(node, key, "is " + kind_of(node), wish("number", spec));
  if (!spec.allowed.holds(number))
    return report(node, key, fmt::format("is {}", number), wish("number", spec));
  target = number;
  if ((spec.unit == "mm" || spec.unit == "m") && spec.allowed.min > 0)
    lengths_.emplace_back(
        number * (spec.unit == "mm" ? 1e-3 : 1),
        problem_of(document_, node, path_of(key), fmt::format("is {}", number),
                   fmt::format("at least {:g} of the largest length", least_share_of_length)));
}

void KeyReader::assign(const Node& node, const std::string& key, std::string& target, const KeySpec& spec) {
  const auto& choices = spec.allowed.choices;
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text)
    report(node, key, "is " + kind_of(node), wish("text", spec));
  else if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end())
    report(node, key, fmt::format("is \"{}\"{}", *text, suggestion(*text, choices)), wish("text", spec));
  else if (text->empty() && !spec.allowed.may_be_empty)
    report(node, key, "is empty", wish("text", spec));
  else if (const std::string fault = fault_of_line(*text, spec.allowed.longest); !fault.empty())
    report(node, key, fault, fmt::format("one line of at most {} characters", spec.allowed.longest));
  else
    target = *text;
}

void KeyReader::assign(const Node& node, const std::string& key, std::filesystem::path& target,
                       const KeySpec& spec) {
  std::string text;
  assign(node, key, text, spec);
  if (!text.empty()) target = text;
}

const Node::Array* KeyReader::filled_array(const Node& node, const std::string& key, const std::string& type,
                                           const KeySpec& spec) {
  const auto* entries = std::get_if<Node::Array>(&node.value);
  if (!entries)
    report(node, key, "is " + kind_of(node), wish(type, spec));
  else if (!entries->empty() || spec.allowed.may_be_empty)
    return entries;
  else
    report(node, key, "is empty", wish(type, spec));
  return nullptr;
}

void KeyReader::assign_fixed(const Node& node, const std::string& key, double* target, std::size_t count,
                             const KeySpec& spec) {
  const auto* entries = std::get_if<Node::Array>(&node.value);
  const std::string type = fmt::format("array of {} numbers", count);
  if (!entries) return report(node, key, "is " + kind_of(node), wish(type, spec));
  if (entries->size() != count)
    return report(node, key, fmt::format("has {} entries", entries->size()), wish(type, spec));
  for (std::size_t i = 0; i < count; ++i)
    assign((*entries)[i], fmt::format("{}.{}", key, i), target[i], spec);
}

void KeyReader::enter(const Node& node, const std::string& key) {
  levels_.push_back({&node, path_of(key), {}, true});
}

void KeyReader::leave() {
  const Level done = std::move(levels_.back());
  levels_.pop_back();
  if (!done.reports_unknown) return;
  for (const auto& [key, node] : std::get<Node::Table>(done.table->value))
    if (!done.known.contains(key))
      problems_.push_back(problem_of(document_, node, done.path.empty() ? key : done.path + "." + key,
                                     "is unknown" + suggestion(key, {done.known.begin(), done.known.end()}),
                                     listed(done.known)));
}

std::string KeyReader::path_of(const std::string& key) const {
  const std::string& path = levels_.back().path;
  return path.empty() ? key : path + "." + key;
}

void KeyReader::report(const Node& node, const std::string& key, const std::string& what,
                       const std::string& allowed) {
  problems_.push_back(problem_of(document_, node, path_of(key), what, allowed));
}

}  // namespace drumlin
