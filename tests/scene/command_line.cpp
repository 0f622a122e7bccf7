#include "apps/command_line/command_line.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "apps/commands/all_commands.hpp"
#include "apps/output/program.hpp"
#include "apps/process/program_files.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/support/says.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

std::variant<TextToShow, std::unique_ptr<Call>> request(const std::string& line) {
  std::istringstream stream("drumlin " + line);
  const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  return parse_command_line(static_cast<int>(pointers.size()), pointers.data(), all_commands());
}

/// What is shown for a command line whose words have no blanks in them.
std::string shown(const std::string& line) { return std::get<TextToShow>(request(line)).text; }

/// The options that it fills in.
Json parsed(const std::string& line) { return json_of(std::get<1>(request(line))->description()); }

TEST(CommandLine, FillsTheOptionsOfACommand) {
  const Json run = parsed("run -o out --set x=1 --set y=[1,2] ./a.toml --threads 4 --resume");
  EXPECT_EQ(run, Json({{"scene", "./a.toml"},
                       {"output", "out"},
                       {"set", {"x=1", "y=[1,2]"}},
                       {"threads", 4},
                       {"ranks", nullptr},
                       {"accuracy", nullptr},
                       {"accuracy-seconds", nullptr},
                       {"extend", nullptr},
                       {"resume", true},
                       {"overwrite", false}}));
  EXPECT_EQ(parsed("run ./a.toml -o out")["threads"], processors_at_hand());
  EXPECT_EQ(parsed("cost ./s.toml --sweep mesh=1:2,eps")["sweep"], Json({"mesh=1:2", "eps"}));
  EXPECT_EQ(parsed("cost ./s.toml --ranks 1,2")["ranks"], Json({1, 2}));
  EXPECT_EQ(parsed("cost --effects ./s.toml --against r1 r2")["against"], Json({"r1", "r2"}));
  EXPECT_EQ(parsed("measure r --position -5")["position"], -5);
  EXPECT_EQ(parsed("calibrate r1 -o law.toml --I-min 1e-3")["I-min"], 1e-3);
  EXPECT_EQ(parsed("solve-contacts p.h5 --watch 10")["watch"], 10);
  EXPECT_EQ(parsed("compare a b -o o --overwrite")["overwrite"], true);
}

/// The words that stand for the options of a call make the same options.
TEST(CommandLine, WordsOfOptionsMakeTheSameOptions) {
  for (const std::string line :
       {"run ./a.toml -o o --set x=1 --set y=[1,2] --extend 1e-3 --resume",
        "flow ./f.toml --rheology ./r -o o --from g",
        "measure r --slices -1,0,2.5 --parts maps,forces --position -5 --verbose",
        "calibrate r1 r2 -o l --validate r3 r4 --I-max 0.1 --memory --amount --own-weight 0.5",
        "cost ./s.toml --sweep mesh=1:2,eps --ranks 1,2 --neighbour a=1 --neighbour b=2 --against r1 r2"}) {
    const auto call = std::get<1>(request(line));
    const Json options = json_of(call->description());
    std::string again = line.substr(0, line.find(' '));
    for (const std::string& word : words_of(call->description())) again += " " + word;
    EXPECT_EQ(parsed(again), options) << again;
  }
}

/// Options as a command may have them; each by its kind.
struct EveryKind {
  std::filesystem::path input, output;
  std::optional<std::filesystem::path> second;
  std::vector<double> numbers;
  std::optional<double> number;
  int count = 1;
  bool flag = false, shown = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("input", input, "FILE", "a file").required();
    d.output(output, "DIR", "a folder");
    d.add("--second", second, "FILE", "a second file");
    d.add("--numbers", numbers, "X,X", "numbers");
    d.add("--number", number, "d", above(0), "a number");
    d.add("--count", count, "", at_least(1, 4), "a count");
    d.add("--flag", flag, "a flag");
    d.add("--shown", shown, "what is shown").decides(Decides::nothing);
    d.existing(existing);
  }
};

TEST(CommandLine, WhatDecidesTheResultsIsSummedAndNothingElse) {
  const testing::TemporaryFolder folder;
  EveryKind options;
  options.input = folder.with("input", "one");
  const auto sum = [&] { return requested_sum(described(options)); };
  std::set<std::string> sums{sum()};
  const auto changes = [&](const char* what) { EXPECT_TRUE(sums.insert(sum()).second) << what; };
  options.number = 2;
  changes("number");
  options.numbers = {1, 2};
  changes("numbers");
  options.count = 2;
  changes("count");
  options.flag = true;
  changes("flag");
  options.second = folder.with("second", "one");
  changes("second");
  folder.with("input", "two");
  changes("content");
  const std::string before = sum();
  options.output = "elsewhere";
  options.shown = true;
  options.existing = ExistingOutput::overwrite;
  options.input = folder.with("moved", "two");
  EXPECT_EQ(sum(), before);
  EXPECT_EQ(inputs_of(described(options)), (std::vector{options.input, *options.second}));
}

/// A long name is on one line of the help, in the page for man and in each completion.
TEST(CommandLine, EveryOptionIsInHelpManAndCompletions) {
  const std::string man = shown("--man"), json = shown("--commands");
  for (const Json& command : Json::parse(json)) {
    const std::string name = command["name"], help = shown(name + " --help");
    for (const Json& option : command["options"]) {
      const std::string word = (option["is_positional"] ? "" : "--") + option["name"].get<std::string>();
      expect_has(help, word);
      if (option["is_positional"]) continue;
      for (const char* shell : {"bash", "zsh"}) expect_has(shown(std::string("--completion ") + shell), word);
      if (name.find(' ') == std::string::npos)
        expect_has(shown("--completion fish"), name + "' -l " + word.substr(2) + " ");
    }
    expect_has(man, ".SS " + (name == "solve-contacts" ? "solve\\-contacts" : name));
  }
}

/// A call of a command with a word for each option that it needs.
std::string call_of(const Command& command, const Description& description) {
  std::string line = command.name;
  for (const Option& option : description.options())
    if (option.is_positional() || option.is_required)
      line += (option.is_positional() ? " " : " --" + option.name() + " ") +
              (!option.choices().empty() ? option.choices().front()
               : option.allowed          ? fmt::format("{}", option.allowed->min)
                                         : "./x");
  return line;
}

TEST(CommandLine, EveryRangeIsHeldAtItsEnds) {
  int tried = 0;
  for (const Command& command : all_commands()) {
    if (!command.call) continue;
    const Description description = command.call()->description();
    for (const Option& option : description.options()) {
      if (!option.allowed || !option.choices().empty()) continue;
      const Allowed& range = *option.allowed;
      std::vector<std::string> outside{"nan", "inf", "two"};
      if (std::isfinite(range.min))
        outside.push_back(fmt::format("{}", range.min - (range.min_open ? 0 : 1)));
      if (std::isfinite(range.max)) outside.push_back(fmt::format("{}", range.max + 1));
      for (const std::string& value : outside) {
        const std::string line =
            fmt::format("{} --{}={}", call_of(command, description), option.name(), value);
        expect_has(message_of<InputError>([&] { request(line); }), value);
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 80);
}

TEST(CommandLine, RefusesWrongUsage) {
  for (const char* line :
       {"", "walk", "run", "run ./a.toml", "run ./a.toml -o o --resume --overwrite",
        "run ./a.toml -o o --unknown", "run ./a.toml ./b.toml -o o", "new avalanche -o mine.toml",
        "calibrate r -o l --amount", "export r --vtu --measurements", "cost ./s.toml --ranks 1,0", "scene",
        "scene check", "--completion tcsh"})
    EXPECT_THROW(request(line), InputError) << "drumlin " << line;
}

TEST(CommandLine, SuggestsTheNameThatWasMeant) {
  using Case = std::pair<const char*, const char*>;
  for (const auto& [line, meant] :
       std::vector<Case>{{"run drum-smokee -o o", "\"drum-smoke\""},
                         {"flow drum-6rpm --rheology ./r -o o", "drum-6rpm-flow, drum-6rpm-inertial-flow"},
                         {"run drum-6rpm-flow -o o", "drumlin flow; its other side: drum-6rpm"},
                         {"flow drum-smoke-flow --rheology drum-6pm -o o", "\"drum-6rpm\""},
                         {"scene chekc x", "\"check\""},
                         {"mesure r", "\"measure\""},
                         {"run ./a.toml -o o --ovewrite", "\"--overwrite\""},
                         {"new shute -o o", "\"chute\""}})
    expect_has(message_of<InputError>([&] { request(line); }), meant);
}

/// Each example of the help is a call that the parser takes.
TEST(CommandLine, ExamplesAreCalls) {
  int tried = 0;
  const auto try_all = [&](const Command& command) {
    for (const std::string& example : command.examples) {
      if (!example.starts_with("drumlin ")) continue;
      std::string line = std::regex_replace(example.substr(8), std::regex(" ([\\w-]+\\.(toml|h5))"), " ./$1");
      line = std::regex_replace(line, std::regex("rheology rheology"), "rheology ./rheology");
      EXPECT_NO_THROW(request(std::regex_replace(line, std::regex("\"[^\"]*\""), "why"))) << example;
      ++tried;
    }
  };
  for (const Command& command : all_commands()) {
    EXPECT_FALSE(command.examples.empty()) << command.name;
    try_all(command);
  }
  EXPECT_GT(tried, 20);
}

TEST(CommandLine, ShowsHelpWithDefaultUnitAndRange) {
  const std::string help = shown("measure --help");
  expect_has(help, "--slice-width FLOAT=20");
  expect_has(help, "[d, > 0]");
  expect_has(shown("--help"), "solve-contacts");
}

TEST(CommandLine, SaysWhatToInstallForAProgramThatIsMissing) {
  expect_has(message_of<InputError>([] { (void)program_beside("no-such-program"); }), "libdeal.ii-dev");
}

}  // namespace
}  // namespace drumlin::apps
