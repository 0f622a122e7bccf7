#pragma once
// The options of a command, described once: a struct names its members, with the words of each, what it may
// hold and what it means. The parser, help, completions and the page for man, the sum of what was requested,
// the words for another program and the signature in Python come from that.
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "apps/process/program_files.hpp"
#include "coupling/core/documents/key_spec.hpp"

namespace drumlin::apps {

/// What a command does with an output that exists already.
enum class ExistingOutput { refuse, resume, overwrite };

/// Of --threads: more than any machine that this program was made for, and few enough that all can be
/// started.
inline constexpr int most_threads = 256;

/// A flag that says one thing of an existing output.
struct ExistingWord {
  ExistingOutput* existing;
  ExistingOutput word;
};
/// What an option fills in.
using Member = std::variant<bool*, int*, double*, std::string*, std::filesystem::path*, std::optional<int>*,
                            std::optional<double>*, std::optional<std::filesystem::path>*, std::vector<int>*,
                            std::vector<double>*, std::vector<std::string>*,
                            std::vector<std::filesystem::path>*, ExistingWord>;

/// By what an option decides the results.
enum class Decides {
  value,     ///< what stands on the command line
  content,   ///< what the file or folder of this name holds (input_sum)
  measured,  ///< what the run of this name and its measurements hold (measured_run_sum)
  nothing    ///< or the command sums it by itself
};

/// One option with the member that it fills in; `describe` changes what is not usual of it.
struct Option {
  std::string names;  ///< "-o,--output"; without a dash: by its position
  Member member;
  std::string kind;  ///< stands for the value in the help; empty for a flag
  std::string unit;
  std::optional<Allowed> allowed;
  std::string sentence;
  Decides by = Decides::value;
  bool is_required = false;
  bool is_repeated = false;                             ///< one value at a time
  std::vector<std::string> needed = {}, excluded = {};  ///< words of other options
  std::string (*read)(const std::string&) = nullptr;    ///< what a word stands for; absent: for itself

  Option& required() { return is_required = true, *this; }
  Option& repeated() { return is_repeated = true, *this; }
  Option& decides(Decides what) { return by = what, *this; }
  Option& needs(std::string other) { return needed.push_back(std::move(other)), *this; }
  Option& excludes(std::string other) { return excluded.push_back(std::move(other)), *this; }

  bool is_positional() const { return !names.starts_with("-"); }
  bool is_of_paths() const;
  /// The long name without its dashes, or that of the position.
  std::string name() const { return names.substr(names.rfind("--") + (is_positional() ? 1 : 2)); }
  /// Choices of a text; empty: any.
  std::vector<std::string> choices() const;
  /// The kind of its value with its choices, as the help shows it.
  std::string kind_text() const;
  /// The sentence with unit and range.
  std::string help_text() const;
};

/// What a struct of options says of its members, in the order of the help.
class Description {
 public:
  /// A flag.
  Option& add(std::string names, bool& flag, std::string sentence) {
    return push({std::move(names), &flag, "", "", {}, std::move(sentence)});
  }
  /// A text, path or list, by its kind ("RUN").
  template <class T>
  Option& add(std::string names, T& member, std::string kind, std::string sentence) {
    return push({std::move(names), &member, std::move(kind), "", {}, std::move(sentence)});
  }
  /// The same where it has choices, or a range for each; a number with its unit.
  template <class T>
  Option& add(std::string names, T& member, std::string what, Allowed allowed, std::string sentence) {
    std::string kind, unit;
    if constexpr (std::is_same_v<T, int> || std::is_same_v<T, std::optional<int>>)
      kind = "INT", unit = std::move(what);
    else if constexpr (std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>)
      kind = "FLOAT", unit = std::move(what);
    else
      kind = what.empty() ? "TEXT" : std::move(what);
    return push({std::move(names), &member, std::move(kind), std::move(unit), std::move(allowed),
                 std::move(sentence)});
  }
  /// The scene that a command reads: a file, or a shipped scene by its name; --set changes its keys. Both are
  /// summed by the command, as the scene that it has read.
  void scene(std::filesystem::path& scene, const std::string& sentence,
             std::string (*read)(const std::string&) = shipped_scene);
  /// A law: a file, or a shipped one by its name.
  template <class Path>
  Option& law(std::string names, Path& law, const std::string& sentence) {
    Option& option = add(std::move(names), law, "RHEOLOGY.toml",
                         sentence + ", a file from calibrate or the name of one of data/rheology");
    option.read = shipped_law;
    return option;
  }
  void changes(std::vector<std::string>& overrides);
  /// Where the results go: -o; a path has to be given, an optional one not.
  template <class Path>
  void output(Path& output, std::string kind, std::string sentence) {
    Option& option = add("-o,--output", output, std::move(kind), std::move(sentence));
    option.read = linked_folder;
    option.decides(Decides::nothing).is_required = std::is_same_v<Path, std::filesystem::path>;
  }
  /// --resume and --overwrite; without either an existing output is refused.
  void existing(ExistingOutput& existing,
                std::string resume_sentence = "Keeps what an earlier call has finished");
  /// --overwrite alone.
  Option& overwrite(ExistingOutput& existing, std::string sentence = "Replaces what an earlier call left");
  void accuracy(std::optional<std::filesystem::path>& accuracy);

  const std::deque<Option>& options() const { return options_; }

 private:
  Option& push(Option option);
  /// A link to a folder that a user names for results stands for that folder; no other link is followed.
  static std::string linked_folder(const std::string& name);
  std::deque<Option> options_;
};

/// Each option by its name: as it is, paths as texts, what is absent as null.
nlohmann::ordered_json json_of(const Description& description);
/// What the options are: name, kind, default, sentence of each.
nlohmann::ordered_json page_of(const Description& description);
/// The words that stand for these values on a command line.
std::vector<std::string> words_of(const Description& description);
/// The sum of what was requested: `first`, what the command has made of its inputs, then each option that
/// decides the results. --resume takes what is done already only if it has this sum.
std::string requested_sum(const Description& description,
                          nlohmann::ordered_json first = nlohmann::ordered_json::array());
/// The files and folders that are read: they may lie in no folder that is overwritten.
std::vector<std::filesystem::path> inputs_of(const Description& description);

/// Of a struct of options.
template <class Options>
Description described(const Options& options) {
  Description description;
  const_cast<Options&>(options).describe(description);  // its readers change nothing
  return description;
}

}  // namespace drumlin::apps
