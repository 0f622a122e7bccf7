#include "apps/json/hard_case_json.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

double number(const Json& value) { return number_or_nan(value).value(); }

}  // namespace

Json to_json(const HardCase& hard, const HardResult& result) {
  Json checks = Json::array();
  for (const HardCheck& check : result.checks)
    checks.push_back({{"what", check.what},
                      {"relation", name_of(check.relation)},
                      {"expected", check.expected},
                      {"got", check.got},
                      {"tolerance", check.tolerance},
                      {"reason", check.reason},
                      {"holds", check.holds()}});
  return {{"name", hard.name},         {"outcome", hard.outcome},   {"fast", hard.fast},
          {"seconds", result.seconds}, {"passed", result.passed()}, {"checks", checks}};
}

HardRow hard_row(const Json& json) {
  HardRow row;
  row.hard.name = json.at("name").get<std::string>();
  row.hard.outcome = json.at("outcome").get<std::string>();
  row.hard.fast = json.at("fast").get<bool>();
  row.result.seconds = json.at("seconds").get<double>();
  for (const Json& check : json.at("checks")) {
    HardCheck read{.what = check.at("what").get<std::string>(),
                   .expected = number(check.at("expected")),
                   .got = number(check.at("got")),
                   .tolerance = number(check.at("tolerance")),
                   .reason = check.at("reason").get<std::string>()};
    read.relation = enumerator<Relation>(check.at("relation").get<std::string>()).value();
    row.result.checks.push_back(std::move(read));
  }
  return row;
}

}  // namespace drumlin::apps
