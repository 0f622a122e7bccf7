#include "apps/command_line/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/process/request_sum.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(const Option& option) {
  return std::visit(
      [](const auto& member) -> Json {
        if constexpr (requires { member.word; })
          return *member.existing == member.word;
        else if constexpr (requires { member->has_value(); })
          return *member ? Json(**member) : Json();
        else
          return Json(*member);
      },
      option.member);
}

/// What an option adds to the sum: an absent number counts as 0, an absent path has an empty sum.
Json summed(const Option& option) {
  Json value = json_of(option);
  if (option.by == Decides::value)
    return !value.is_null() ? value : option.kind == "INT" ? Json(0) : Json(0.0);
  const auto sum = [&](const Json& path) -> std::string {
    if (path.is_null() || path == "") return "";
    return option.by == Decides::measured ? measured_run_sum(path.get<std::string>())
                                          : input_sum(path.get<std::string>());
  };
  if (!value.is_array()) return sum(value);
  for (Json& path : value) path = sum(path);
  return value;
}

std::string word_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
}

}  // namespace

bool Option::is_of_paths() const {
  return std::holds_alternative<fs::path*>(member) ||
         std::holds_alternative<std::optional<fs::path>*>(member) ||
         std::holds_alternative<std::vector<fs::path>*>(member);
}

std::vector<std::string> Option::choices() const {
  return allowed ? allowed->choices : std::vector<std::string>{};
}

std::string Option::kind_text() const {
  return choices().empty() ? kind : fmt::format("{}:{{{}}}", kind, fmt::join(choices(), ","));
}

std::string Option::help_text() const {
  if (!allowed || !choices().empty()) return sentence;
  const bool is_one = kind == "INT" || kind == "FLOAT";
  return fmt::format("{} [{}{}{}{}]", sentence, is_one ? "" : "each ", unit, unit.empty() ? "" : ", ",
                     allowed_text("number", *allowed));
}

Option& Description::push(Option option) {
  if (option.is_of_paths()) option.by = Decides::content;
  return options_.emplace_back(std::move(option));
}

std::string Description::linked_folder(const std::string& name) {
  const fs::path given = name, link = given.has_filename() ? given : given.parent_path();
  std::error_code error;
  const bool is_link = is_symlink(symlink_status(link, error)) && is_directory(link, error);
  return is_link ? fs::canonical(link).string() : name;
}

void Description::scene(fs::path& scene, const std::string& sentence,
                        std::string (*read)(const std::string&)) {
  add("scene", scene, "SCENE.toml", sentence + ", or the name of one that drumlin scene list names")
      .required()
      .decides(Decides::nothing)
      .read = read;
}

void Description::changes(std::vector<std::string>& overrides) {
  add("--set", overrides, "KEY=VALUE",
      "Changes one key of the file, e.g. --set solver.max_sweeps=50 or --set stages.1.turns=2; repeatable")
      .repeated()
      .decides(Decides::nothing);
}

void Description::existing(ExistingOutput& existing, std::string resume_sentence) {
  push({"--resume", ExistingWord{&existing, ExistingOutput::resume}, "", "", {}, std::move(resume_sentence)})
      .decides(Decides::nothing)
      .excludes("--overwrite");
  overwrite(existing).excludes("--resume");
}

Option& Description::overwrite(ExistingOutput& existing, std::string sentence) {
  return push({"--overwrite",
               ExistingWord{&existing, ExistingOutput::overwrite},
               "",
               "",
               {},
               std::move(sentence)})
      .decides(Decides::nothing);
}

void Description::accuracy(std::optional<fs::path>& accuracy) {
  add("--accuracy", accuracy, "COST",
      "Left by drumlin cost --statistics for the same scene: from it comes what solver tolerance and time "
      "step leave of error; standard: a record of data/cost, if one is of the scene");
}

Json json_of(const Description& description) {
  Json json = Json::object();
  for (const Option& option : description.options()) json[option.name()] = json_of(option);
  return json;
}

Json page_of(const Description& description) {
  Json page = Json::array();
  for (const Option& option : description.options()) {
    const Json value = json_of(option);
    page.push_back({{"name", option.name()},
                    {"is_positional", option.is_positional()},
                    {"is_required", option.is_required},
                    {"is_list", value.is_array()},
                    {"is_repeated", option.is_repeated},
                    {"is_of_paths", option.is_of_paths()},
                    {"kind", option.kind},
                    {"choices", option.choices()},
                    {"default", value},
                    {"needs", option.needed},
                    {"decides", option.by != Decides::nothing},
                    {"sentence", option.help_text()}});
  }
  return page;
}

std::vector<std::string> words_of(const Description& description) {
  std::vector<std::string> words;
  for (const Option& option : description.options()) {
    const Json value = json_of(option);
    if (value.is_null() || value.empty() || value == "" || value == false) continue;
    const auto name = [&] {
      if (!option.is_positional()) words.push_back("--" + option.name());
    };
    name();
    if (value.is_boolean()) continue;
    const Json list = value.is_array() ? value : Json::array({value});
    words.push_back(word_of(list[0]));
    for (std::size_t i = 1; i < list.size(); ++i) {
      if (option.is_repeated) name();
      if (option.is_repeated || option.is_of_paths())
        words.push_back(word_of(list[i]));
      else
        words.back() += "," + word_of(list[i]);
    }
  }
  return words;
}

std::string requested_sum(const Description& description, Json first) {
  for (const Option& option : description.options())
    if (option.by != Decides::nothing) first.push_back(summed(option));
  return request_sum(first);
}

std::vector<fs::path> inputs_of(const Description& description) {
  std::vector<fs::path> inputs;
  for (const Option& option : description.options()) {
    if (option.by != Decides::content && option.by != Decides::measured) continue;
    const Json value = json_of(option);
    for (const Json& path : value.is_array() ? value : Json::array({value}))
      if (path.is_string() && path != "") inputs.push_back(path.get<std::string>());
  }
  return inputs;
}

}  // namespace drumlin::apps
