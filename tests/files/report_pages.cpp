#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/json/comparison_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/pending_figures.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/signed_folder.hpp"

namespace drumlin::apps {
using namespace coupling;
namespace {

using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;
using Json = nlohmann::ordered_json;
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

Json content(bool reduced) {
  Json json{{"title", "a <drum> & its flow"}, {"reduced", reduced}};
  add_comparison(json, small_comparison());
  add_paper(json, std::nullopt, {});
  for (const auto* key : {"costs", "settings", "particles", "continuum", "provenance"})
    json[key] = Json::object();
  return json;
}

/// The page that a template makes of this content and of the figures in the folder.
std::string page_of(const TemporaryFolder& folder, const Json& json, const std::string& page = "comparison") {
  const auto file = folder / "content.json";
  write_json(file, json);
  throw_if_figures_failed(file, draw_pending_figures(folder.path(), {}, ResultPage{page, file}));
  return file_text(folder / "index.html");
}

std::string page_of(const Json& json) { return page_of(TemporaryFolder(), json); }

/// Every element that is opened is closed in its turn; the first that is not, else nothing.
std::string unbalanced(const std::string& page) {
  std::vector<std::string> open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const bool closes = page[at + 1] == '/';
    const std::size_t from = at + (closes ? 2 : 1);
    const std::string name = page.substr(from, page.find_first_of(" >", from) - from);
    if (name == "!DOCTYPE" || name == "meta" || name == "img" || name == "br") continue;
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

void expect_escaped(const std::string& page, const std::vector<std::string>& raw) {
  EXPECT_EQ(unbalanced(page), "");
  for (const std::string& text : raw) expect_lacks(page, text);
}

void expect_nothing_loaded(const std::string& page) {
  for (const auto* loaded : {"<script", "http://", "https://", "<link", "url(", "@import"})
    expect_lacks(page, loaded);
}

TEST(ReportPage, SaysTheSizeOfAMissAndHidesNoText) {
  const auto page = page_of(content(false));
  expect_has(page, "meets 1 of 2 targets");
  expect_has(page, "1.5 (limit 1, deg)");
  expect_has(page, "a &lt;drum&gt; &amp; its flow");
  expect_lacks(page, "<drum>");
  expect_lacks(page, "reduced:");
}

TEST(ReportPage, IsSoundHtmlWhateverTheNamesAre) {
  auto json = content(false);
  json["particles"] = {{"kind", "particles"}, {"name", "<b>&"}, {"unsteady", {"a <reason>"}}};
  json["continuum"] = {{"kind", "particles"}, {"name", "\"two\""}};
  json["floor"] = {{"name", "<i>floor"}, {"kind", "particles"}};
  json["costs"] = {{"a <cost>", 3.0}};
  json["cost_ratio"] = {{"wall", 2.0}, {"processor", nullptr}};
  json["targets"][0]["floor"] = 5.0;
  json["settings"] = {{"</pre><u>", "/tmp/<em>'path'"}};
  const std::string page = page_of(json);
  expect_escaped(
      page, {"<b>&", "<reason>", "<i>floor", "<cost>", "<neither>", "<remark>", "<drum>", "<u>", "<em>"});
  expect_has(page, "&lt;neither&gt;");
}

TEST(ReportPage, ShowsTemplatesInNamesAsText) {
  auto json = content(false);
  json["title"] = "{{ 6 * 7 }}{% raw %}";
  expect_has(page_of(json), "<h1>{{ 6 * 7 }}{% raw %}</h1>");
}

TEST(ReportPage, TellsTheLargestMissItsMeaningAndTheNoiseFloor) {
  auto json = content(false);
  json["particles"] = {{"kind", "particles"}, {"name", "one"}};
  json["continuum"] = {{"kind", "continuum"}, {"name", "two"}};
  json["floor"] = {{"name", "seed2"}, {"kind", "particles"}};
  json["targets"][0]["floor"] = 1.2;
  json["costs"] = {{"particles run, processor", 250.0}, {"continuum solve, processor", 5.0}};
  json["cost_ratio"] = {{"wall", nullptr}, {"processor", 50.0}};
  const std::string page = page_of(json);
  expect_has(page,
             "The largest miss: slope θ (deg), 1.5 (limit 1, deg), 1.5 times the limit. "
             "The whole surface has another slope: the friction is off as a whole.");
  expect_has(page, "(seed2), compared in the same way,\nmisses slope θ (deg) (1.2): a difference");
  expect_has(page, "50 times the processor time");
}

TEST(ReportPage, FindsTheRecordsOfCosts) {
  const TemporaryFolder folder;
  for (const auto* name : {"cost_accuracy_one.png", "cost_effects_two.png"}) folder.with(name, "foobar");
  const std::string page = page_of(folder, content(false));
  for (const auto* record : {"data/cost/one.json.", "data/cost/two.json."}) expect_has(page, record);
}

TEST(ReportPage, OfAReducedRunSaysSo) {
  expect_has(page_of(content(true)), "reduced: a small drum and a short run");
}

/// The vectors of RFC 4648, and bytes that are no text.
TEST(ReportPage, HoldsItsFiguresAndLoadsNothing) {
  const std::vector<std::pair<std::string, std::string>> vectors{
      {"velocity", "foobar"}, {"stresses", "fooba"}, {"ratios", "foob"}, {"friction", "\xff\xfe"}};
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : vectors) folder.with(name + ".png", bytes);
  const std::string page = page_of(folder, content(false));
  for (const auto* text : {"Zm9vYmFy\"", "Zm9vYmE=\"", "Zm9vYg==\"", "//4=\""})
    expect_has(page, std::string("data:image/png;base64,") + text);
  expect_nothing_loaded(page);
}

TEST(ReportPage, ThatLacksANumberIsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  auto json = content(false);
  json.erase("zones");
  const std::string message = message_of<IoError>([&] { page_of(folder, json); });
  expect_has(message, "zones");
  expect_has(message, "comparison_tables.html");
  EXPECT_FALSE(std::filesystem::exists(folder / "index.html"));
}

Json speeds_content() {
  Json json =
      Json::parse(R"json({"title": "speeds", "reduced": true, "law": {"a": "<law>"}, "effects": "<effects>",
      "warnings": ["a <warning>"], "fitted_on": ["run <six>"],
      "speeds": [{"rotation_rpm": 4.0, "role": "predicted", "particles": [], "continuum": null, "scalars": {},
                  "verdict": {"met": 1, "missed": 1, "not_measured": 0, "by_noise_floor": 0}, "targets": [],
                  "seconds": {"particles": null, "continuum": null, "ratio": null, "start": "<cold>"}}],
      "laws": {"depth": {"formula": "H = <c> sqrt(Q)", "paper": {"c": {"value": 3.0, "ci99": 0.1}}}},
      "verdict": {"role": "predicted", "met": 1, "missed": 1, "not_measured": 0, "by_noise_floor": 0},
      "verdict_lines": ["4 rpm, predicted: 1 of 2 targets met"], "provenance": {"machine": "<machine>"}})json");
  Json& speed = json["speeds"][0];
  for (const char* name : {"theta_deg", "Q", "H", "lambda", "shear_rate", "I_th"})
    speed["scalars"][name] = {
        {"paper", 20.0}, {"particles", {{"value", 19.5}, {"ci99", 1.8}}}, {"continuum", 18.0}};
  for (const Target& target : small_comparison().targets) speed["targets"].push_back(to_json(target));
  speed["targets"][0]["inside_interval"] = true;
  return json;
}

TEST(SpeedComparisonPage, CountsPredictionsShowsEveryTableAndEscapesNames) {
  const TemporaryFolder folder;
  for (const auto* name : {"speeds.png", "rates.png", "errors.png"}) folder.with(name, "foobar");
  const std::string page = page_of(folder, speeds_content(), "speed_comparison");
  for (const auto* text :
       {"At speeds that it was not calibrated on the continuum meets 1 of 2 targets", "reduced: small drums",
        "4 rpm, predicted: 1 of 2 targets met", "<td>19.5 ± 1.8</td><td>18</td>",
        "1.5 deg, inside the interval", "H = &lt;c&gt; sqrt(Q)", "c = 3 ± 0.1", "&lt;cold&gt;",
        "run &lt;six&gt;", "Zm9vYmFy"})
    expect_has(page, text);
  expect_escaped(page,
                 {"<six>", "<warning>", "<c>", "<law>", "<effects>", "<machine>", "<cold>", "<remark>"});
  expect_nothing_loaded(page);
}

TEST(SpeedComparisonPage, WithoutAFigureIsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  folder.with("speeds.png", "foobar");
  const std::string message =
      message_of<IoError>([&] { page_of(folder, speeds_content(), "speed_comparison"); });
  expect_has(message, "rates.png: is missing");
}

Json study_content() {
  return Json::parse(R"json({"reduced": false, "warnings": ["run <2>: half a turn only"],
      "verdict": {"agrees": 0, "open": 0, "near": 0, "differs": 1, "imposed": 0, "not measured": 0},
      "runs": [], "speeds": [], "over_all_speeds": {}, "friction": null, "paper_friction": null, "collapse": {},
      "laws": {"depth": {"formula": "H = <c> sqrt(Q)", "coefficients": {"c": {"value": 3.0, "ci99": 0.1}},
                         "reduced_chi2": 0.0, "rms": 0.0, "points": 0}},
      "consistency": [],
      "paper_table": [{"quantity": "H <d>", "rotation_rpm": null, "expects": "value", "paper": 14.6,
                       "paper_half_width": 0.5, "ours": {"value": 19.7, "ci99": 1.2}, "verdict": "differs",
                       "reason": "outside the interval", "source": "Fig. <6>"}]})json");
}

TEST(StudyPage, ShowsVerdictsLawsAndListedFiguresAndEscapesThem) {
  const TemporaryFolder folder;
  folder.with("fig01.png", "foobar");
  folder.with("figures.json", R"({"format": "drumlin-study-figures-1", "figures": [{"file": "fig01.png",
      "title": "Fig. <1>", "paper": "<p1>", "here": "<p2> & more"}]})");
  const std::string page = page_of(folder, study_content(), "study");
  for (const auto* text :
       {"0 entries agree, 0 are near, 1 differ", "14.6 ± 0.5", "19.7 ± 1.2", "class=\"missed\">differs",
        "c = 3 ± 0.1", "Fig. &lt;1&gt;", "&lt;p2&gt; &amp; more", "Zm9vYmFy", "half a turn only"})
    expect_has(page, text);
  expect_escaped(page, {"<2>", "<c>", "<d>", "<6>", "<1>", "<p1>", "<p2>"});
  expect_nothing_loaded(page);
}

TEST(StudyPage, WithoutTheListOrAListedFigureIsAnError) {
  const TemporaryFolder folder;
  expect_has(message_of<IoError>([&] { page_of(folder, study_content(), "study"); }), "figures.json");
  folder.with("figures.json", R"({"format": "drumlin-study-figures-1", "figures": [{"file": "none.png",
      "title": "", "paper": "", "here": ""}]})");
  expect_has(message_of<IoError>([&] { page_of(folder, study_content(), "study"); }), "none.png");
}

TEST(PendingFigures, ThatFailLoseNeitherTheOthersNorThePageAndAreNamed) {
  const TemporaryFolder folder;
  const auto result = folder / "comparison.json";
  const auto bad = folder.with("bad.py", "import sys\nsys.exit('no <layers>')\n");
  const auto good = folder.with("good.py", "import sys\nopen(sys.argv[1], 'w').write('foobar')\n");
  note_pending_figures(folder.path());
  write_json(result, content(false));
  EXPECT_FALSE(is_complete(result)) << "nothing is drawn yet";
  const auto failures =
      draw_pending_figures(folder.path(), {{bad, {}}, {good, {(folder / "velocity.png").string()}}},
                           ResultPage{"comparison", result});
  const std::string message = message_of<IoError>([&] { throw_if_figures_failed(result, failures); });
  expect_has(message, "bad.py failed:\nno <layers>");
  EXPECT_FALSE(is_complete(result)) << "to be drawn again";
  expect_has(file_text(folder / "figures.pending"), "bad.py failed:\nno <layers>");
  const std::string page = file_text(folder / "index.html");
  expect_has(page, "no &lt;layers&gt;");
  expect_has(page, "Zm9vYmFy");
  expect_has(page, "meets 1 of 2 targets");
}

TEST(PendingFigures, ThatAreDrawnLeaveACompleteFolder) {
  const TemporaryFolder folder;
  const auto result = folder / "comparison.json";
  note_pending_figures(folder.path());
  write_json(result, content(false));
  EXPECT_TRUE(draw_pending_figures(folder.path(), {}, ResultPage{"comparison", result}).empty());
  drumlin::testing::sign(folder.path(), "compare");
  EXPECT_TRUE(is_complete(result));
  EXPECT_FALSE(is_complete(folder / "none.json"));
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
