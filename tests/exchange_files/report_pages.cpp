#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/support/comparison_json.hpp"
#include "apps/support/report_page.hpp"
#include "coupling/exchange/errors.hpp"
#include "tests/exchange_files/folder.hpp"

namespace drumlin::apps {
namespace {

using drumlin::testing::TemporaryFolder;
using Outcome = Target::Outcome;

Comparison small_comparison() {
  Comparison comparison;
  FieldErrors errors;
  errors.rel_l2 = 0.1, errors.rms = 0.02, errors.max = 0.03, errors.inside_band = 0.5, errors.layers = 12;
  FieldComparison field;
  field.overlay.field = "v_x";
  field.zones.push_back({{"flowing", -15, -3}, errors});
  comparison.fields.push_back(field);
  comparison.slices.missing = "the first side has <neither>";
  comparison.maps.missing = "the first side has no maps";
  comparison.scalars.push_back({"theta_deg", 19.5, 0.3, 18.0});
  comparison.targets.push_back({"theta_deg", "", "deg", 1, 1.5, Outcome::missed, "a <remark>"});
  comparison.targets.push_back({"v_x", "flowing", "relative", 0.2, 0.1, Outcome::met, ""});
  return comparison;
}

nlohmann::ordered_json content(bool reduced) {
  nlohmann::ordered_json json{{"title", "a <drum> & its flow"}, {"reduced", reduced}};
  add_comparison(json, small_comparison());
  add_paper(json, std::nullopt, {});
  for (const auto* key : {"costs", "settings", "particles", "continuum", "provenance"})
    json[key] = nlohmann::ordered_json::object();
  return json;
}

TEST(Base64, MeetsTheVectorsOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(ReportPage, SaysTheSizeOfAMissAndHidesNoText) {
  const auto page = report_page(content(false), {});
  EXPECT_NE(page.find("meets 1 of 2 targets"), std::string::npos);
  EXPECT_NE(page.find("1.5 where 1 (deg) is asked"), std::string::npos);
  EXPECT_NE(page.find("a &lt;drum&gt; &amp; its flow"), std::string::npos);
  EXPECT_EQ(page.find("<drum>"), std::string::npos);
  EXPECT_EQ(page.find("reduced:"), std::string::npos);
}

/// Every element that is opened is closed in its turn; the first that is not, else nothing.
std::string unbalanced(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const bool closes = page[at + 1] == '/';
    const std::size_t from = at + (closes ? 2 : 1);
    const std::string name = page.substr(from, page.find_first_of(" >", from) - from);
    if (name == "!DOCTYPE" || name == "meta" || name == "img") continue;
    if (!closes) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return name + " after " + page.substr(at > 200 ? at - 200 : 0, 200);
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? std::string() : open.back();
}

TEST(ReportPage, IsSoundHtmlWhateverTheNamesAre) {
  auto json = content(false);
  json["particles"] = {{"kind", "particles"}, {"name", "<b>&"}, {"unsteady", {"a <reason>"}}};
  json["continuum"] = {{"kind", "particles"}, {"name", "\"two\""}};
  json["floor"] = {{"name", "<i>floor"}, {"kind", "particles"}};
  json["costs"] = {{"a <cost>", 3.0}};
  json["cost_ratio"] = {{"wall", 2.0}, {"processor", nullptr}};
  json["targets"][0]["floor"] = 5.0;
  const std::string page = report_page(json, {});
  EXPECT_EQ(unbalanced(page), "");
  for (const char* raw : {"<b>&", "<reason>", "<i>floor", "<cost>", "<neither>", "<remark>", "<drum>"})
    EXPECT_EQ(page.find(raw), std::string::npos) << raw;
  EXPECT_NE(page.find("&lt;neither&gt;"), std::string::npos);
}

TEST(ReportPage, TellsTheLargestMissItsMeaningAndTheNoiseFloor) {
  auto json = content(false);
  json["particles"] = {{"kind", "particles"}, {"name", "one"}};
  json["continuum"] = {{"kind", "continuum"}, {"name", "two"}};
  json["floor"] = {{"name", "seed2"}, {"kind", "particles"}};
  json["targets"][0]["floor"] = 1.2;
  json["costs"] = {{"particles run, processor", 250.0}, {"continuum solve, processor", 5.0}};
  json["cost_ratio"] = {{"wall", nullptr}, {"processor", 50.0}};
  const std::string page = report_page(json, {});
  EXPECT_NE(
      page.find("The largest miss: slope &theta; (deg), 1.5 where 1 (deg) is asked, 1.5 times the limit"),
      std::string::npos);
  EXPECT_NE(page.find("friction as a whole is off"), std::string::npos);
  EXPECT_NE(page.find("(seed2), judged in the same way, misses slope &theta; (deg) (1.2)"),
            std::string::npos);
  EXPECT_NE(page.find("50 times the processor time"), std::string::npos);
}

TEST(ReportPage, OfAReducedRunSaysSo) {
  EXPECT_NE(report_page(content(true), {}).find("reduced:"), std::string::npos);
}

TEST(ReportPage, HoldsItsFiguresAndLoadsNothing) {
  const TemporaryFolder folder;
  const auto page = report_page(content(false), {{folder.with("a.png", "foobar"), "A figure"}});
  EXPECT_NE(page.find("data:image/png;base64,Zm9vYmFy"), std::string::npos);
  for (const auto* loaded : {"<script", "http://", "https://", "<link", "url("})
    EXPECT_EQ(page.find(loaded), std::string::npos) << loaded;
  EXPECT_THROW(report_page(content(false), {{folder / "none.png", "missing"}}), InputError);
}

TEST(ComparisonJson, HasTheKeysThatTheFormatPromises) {
  const auto json = content(false);
  EXPECT_EQ(json["errors"]["v_x"]["flowing"]["rel_l2"], 0.1);
  EXPECT_EQ(json["errors"]["v_x"]["flowing"]["max"], 0.03);
  EXPECT_EQ(json["errors"]["v_x"]["flowing"]["inside_band"], 0.5);
  EXPECT_EQ(json["scalars"]["theta_deg"]["particles"]["value"], 19.5);
  EXPECT_EQ(json["scalars"]["theta_deg"]["particles"]["ci99"], 0.3);
  EXPECT_EQ(json["scalars"]["theta_deg"]["continuum"], 18.0);
  EXPECT_EQ(json["verdict"]["missed"], 1);
  EXPECT_TRUE(json["paper"].is_null());
}

}  // namespace
}  // namespace drumlin::apps
