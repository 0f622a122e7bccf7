#include "coupling/core/documents/key_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "coupling/core/documents/one_line.hpp"
#include "tests/support/says.hpp"

namespace drumlin::garden {

struct Round {
  double radius_m = 0;
};
struct Square {
  double side_m = 0;
  std::array<double, 2> corner_m{0, 0};
};
using Shape = std::variant<Round, Square>;
struct Sown {
  int seeds = 0;
};
struct Planted {
  std::filesystem::path plan;
};
struct Water {
  double litres = 2;
};
struct Bed {
  std::string name;
  Shape shape;
};
struct Garden {
  std::string title;
  bool open = false;
  std::uint64_t visitors = 0;
  std::optional<double> height_m;
  std::string soil = "loam";
  std::vector<double> rows{1, 2};
  std::variant<Sown, Planted> start;
  std::optional<Water> water;
  Water rain;
  std::vector<Bed> beds;
};

template <class V>
void describe(V& v, Round& r) {
  v.value("radius_m", r.radius_m, required("m", above(0), "Radius."));
}
template <class V>
void describe(V& v, Square& s) {
  v.value("side_m", s.side_m, required("m", above(0), "Side."));
  v.value("corner_m", s.corner_m, defaulted("m", anything(), "Corner."));
}
template <class V>
void describe(V& v, Sown& s) {
  v.value("seeds", s.seeds, required("", at_least(1, 100), "Number of seeds."));
}
template <class V>
void describe(V& v, Planted& p) {
  v.value("plan", p.plan, required("", not_empty(), "Plan."));
}
template <class V>
void describe(V& v, Water& w) {
  v.value("litres", w.litres, defaulted("l", at_least(0), "Amount."));
}
template <class V>
void describe(V& v, Bed& b) {
  v.value("name", b.name, required("", not_empty(), "Name."));
  v.variant("shape", b.shape, "Shape.", alternative<Round>("round", "a circle."),
            alternative<Square>("square", "a square."));
}
template <class V>
void describe(V& v, Garden& g) {
  v.format("garden-1");
  v.value("title", g.title, defaulted("", title_line(), "Title."));
  v.value("open", g.open, defaulted("", anything(), "Whether it is open."));
  v.value("visitors", g.visitors, defaulted("", anything(), "Visitors."));
  v.value("height_m", g.height_m, when_given("m", above(0, 3), "Height."));
  v.value("soil", g.soil, defaulted("", one_of({"loam", "sand"}), "Soil."));
  v.value("rows", g.rows, defaulted("", at_least(0), "Rows."));
  v.one_table_of(g.start, "How it starts.", alternative<Sown>("sown", "From seeds."),
                 alternative<Planted>("planted", "From a plan."));
  v.optional_table("water", g.water, "Watered by hand.");
  v.table("rain", g.rain, Need::defaulted, "Rain.");
  v.tables("beds", g.beds, 1, "Beds.");
}

const std::string least =
    "format = \"garden-1\"\n[sown]\nseeds = 3\n[[beds]]\nname = \"a\"\nshape = \"round\"\nradius_m = 1\n";

std::vector<InputProblem> problems_of(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) {
  std::vector<InputProblem> problems;
  read_keys<Garden>(parse_toml(text, "g.toml", overrides), problems);
  return problems;
}
std::string only_problem(const std::vector<std::string>& overrides) {
  const auto problems = problems_of(least, overrides);
  EXPECT_EQ(problems.size(), 1u) << (overrides.empty() ? "" : overrides[0]);
  return problems.empty() ? "" : problems[0].text();
}

// They go into the headers of files, whose reader would meet the rest as another line.
TEST(KeyTable, TextsStandOnOneLineWithoutControlCharacters) {
  for (const char* escape : {"\\n", "\\r", "\\t", "\\u0000", "\\u001B", "\\u007F", "\\u0085", "\\u2028"})
    for (const char* key : {"title", "beds.0.name"}) {
      const auto problems = problems_of(least, {std::string(key) + "=\"a" + escape + "b\""});
      EXPECT_TRUE(std::any_of(problems.begin(), problems.end(),
                              [&](const InputProblem& problem) {
                                return problem.key == key &&
                                       problem.what.starts_with("holds a control character (U+");
                              }))
          << key << escape;
    }
}

TEST(KeyTable, TitlesHaveAtMost200Characters) {
  std::string umlauts;
  for (int k = 0; k < 200; ++k) umlauts += "ü";
  EXPECT_TRUE(problems_of(least, {"title=\"" + umlauts + "\""}).empty());
  const std::string said = only_problem({"title=\"" + umlauts + "x\""});
  expect_has(said, "title: has 201 characters (allowed: one line of at most 200 characters)");
}

TEST(OneLine, IsWellFormedUtf8) {
  EXPECT_EQ(fault_of_line("$x_1$ \\alpha, 5 % – é \xF0\x9F\x98\x80", 100), "");
  for (const char* bytes :
       {"\xff", "\xC3", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF5\x80\x80\x80", "a\x80"})
    EXPECT_EQ(fault_of_line(bytes, 100), "is no UTF-8");
}

TEST(KeyTable, ReadsEveryKindOfValue) {
  std::vector<InputProblem> problems;
  const auto g = read_keys<Garden>(
      parse_toml(
          "format = \"garden-1\"\ntitle = \"T\"\nopen = true\nvisitors = 7\nheight_m = 2\nsoil = \"sand\"\n"
          "rows = [3, 4.5]\n[planted]\nplan = \"p.csv\"\n[water]\n[rain]\nlitres = 9\n[[beds]]\nname = "
          "\"b\"\n"
          "shape = \"square\"\nside_m = 2\ncorner_m = [-1, 0.5]\n",
          "g.toml"),
      problems);
  ASSERT_TRUE(problems.empty()) << problems[0].text();
  EXPECT_EQ(g.title, "T");
  EXPECT_TRUE(g.open);
  EXPECT_EQ(g.visitors, 7u);
  EXPECT_EQ(g.height_m, 2.0);
  EXPECT_EQ(g.soil, "sand");
  EXPECT_EQ(g.rows, (std::vector<double>{3, 4.5}));
  EXPECT_EQ(std::get<Planted>(g.start).plan, "p.csv");
  ASSERT_TRUE(g.water);
  EXPECT_EQ(g.water->litres, 2);
  EXPECT_EQ(g.rain.litres, 9);
  EXPECT_EQ(std::get<Square>(g.beds[0].shape).corner_m, (std::array<double, 2>{-1, 0.5}));
}

TEST(KeyTable, ReportsAllProblemsOfAFileInItsOrder) {
  const auto problems = problems_of(
      "format = \"garden-1\"\nheight_m = 4\nsoil = \"lome\"\nopen = 1\ncolour = 3\n[sown]\nseeds = 1.5\n"
      "[[beds]]\nshape = \"round\"\nradius_m = -1\n[[beds]]\nname = \"b\"\nshape = \"oval\"\nlength = 1\n");
  std::vector<std::string> texts;
  for (const auto& problem : problems) texts.push_back(problem.text());
  EXPECT_EQ(
      texts,
      (std::vector<std::string>{
          "g.toml:2:12: height_m: is 4 (allowed: number in m, 1e-12 to 3)",
          "g.toml:3:8: soil: is \"lome\"; did you mean \"loam\"? (allowed: text, \"loam\", \"sand\")",
          "g.toml:4:8: open: is an integer (allowed: true or false)",
          "g.toml:5:10: colour: is unknown (allowed: beds, format, height_m, open, planted, rain, rows, "
          "soil, sown, title, visitors, water)",
          "g.toml:7:9: sown.seeds: is a number (allowed: integer, 1 to 100)",
          "g.toml:8:1: beds.0.name: is missing (allowed: text, not empty)",
          "g.toml:10:12: beds.0.radius_m: is -1 (allowed: number in m, >= 1e-12)",
          "g.toml:13:9: beds.1.shape: is \"oval\" (allowed: \"round\", \"square\")"}));
}

TEST(KeyTable, SuggestsTheNearestKey) {
  expect_has(only_problem({"heigth_m=1"}), "did you mean \"height_m\"?");
  expect_has(only_problem({"beds.0.radius_mm=1"}), "did you mean \"radius_m\"?");
  expect_lacks(only_problem({"xyzzy=1"}), "did you mean");
}

TEST(KeyTable, RefusesKeysOfAnotherAlternative) {
  expect_has(only_problem({"beds.0.side_m=1"}), "beds.0.side_m: is unknown");
}

TEST(KeyTable, RefusesValuesOutsideTheirRange) {
  for (const char* wrong :
       {"sown.seeds=0", "sown.seeds=101", "sown.seeds=9223372036854775807", "height_m=0", "height_m=nan",
        "height_m=inf", "rain.litres=-1", "rain.litres=inf", "visitors=-1", "rows=[-1]", "rows=[]",
        "soil=clay", "beds.0.name=\"\"", "beds.0.radius_m=0"})
    EXPECT_NE(only_problem({wrong}), "") << wrong;
}

TEST(KeyTable, WantsTheRightLengthOfAnArray) {
  const std::string square = "beds.0={name=\"a\", shape=\"square\", side_m=1, corner_m=[1,2,3]}";
  expect_has(only_problem({square}), "has 3 entries (allowed: array of 2 numbers in m, any finite)");
}

TEST(KeyTable, WantsExactlyOneTableOfAChoice) {
  const auto both = problems_of(least, {"planted.plan=p.csv"});
  EXPECT_EQ(both.size(), 2u);
  const auto none =
      problems_of("format = \"garden-1\"\n[[beds]]\nname = \"a\"\nshape = \"round\"\nradius_m = 1\n");
  ASSERT_EQ(none.size(), 1u);
  expect_has(none[0].allowed, "sown, planted");
}

TEST(KeyTable, RefusesAnotherVersionAndNothingElse) {
  const auto problems = problems_of("format = \"garden-2\"\nnew_key = 1\n");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].key, "format");
  EXPECT_EQ(problems[0].line, 1);
  EXPECT_EQ(problems_of("title = \"T\"\n").front().key, "format");
}

TEST(KeyTable, SaysThatAnOverrideIsToBlame) {
  EXPECT_EQ(only_problem({"height_m=4"}), "override: height_m: is 4 (allowed: number in m, 1e-12 to 3)");
}

TEST(KeyTable, NoLengthIsFarBelowTheLargest) {
  EXPECT_TRUE(problems_of(least, {"height_m=2e-9"}).empty());
  EXPECT_EQ(only_problem({"height_m=2e-10"}),
            "override: height_m: is 2e-10 (allowed: at least 1e-09 of the largest length)");
}

TEST(KeyTable, WritesWhatItReads) {
  std::vector<InputProblem> problems;
  const auto first =
      toml_text(write_keys(read_keys<Garden>(parse_toml(least, "g.toml", {"water={litres=0.1}"}), problems)));
  const auto second = toml_text(write_keys(read_keys<Garden>(parse_toml(first, "first.toml"), problems)));
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(first, second);
  expect_has(first, "soil = \"loam\"");
  expect_lacks(first, "height_m");
}

TEST(KeyTable, ListsEveryKeyOfEveryAlternative) {
  const auto rows = list_keys<Garden>();
  std::string paths;
  for (const auto& row : rows)
    paths += row.path + (row.condition.empty() ? "" : "(" + row.condition + ")") + " ";
  EXPECT_EQ(paths,
            "format title open visitors height_m soil rows sown sown.seeds planted planted.plan water "
            "water.litres rain "
            "rain.litres beds[] beds[].name beds[].shape beds[].radius_m(shape = \"round\") "
            "beds[].side_m(shape = \"square\") "
            "beds[].corner_m(shape = \"square\") ");
  for (const auto& row : rows) EXPECT_FALSE(row.sentence.empty()) << row.path;
  EXPECT_EQ(rows[5].standard, "\"loam\"");
  EXPECT_EQ(rows[5].allowed, "\"loam\", \"sand\"");
  EXPECT_EQ(rows[4].standard, "absent");
  expect_has(keys_as_text(rows), "sown.seeds\n    integer, 1 to 100, required\n    Number of seeds.\n");
  expect_has(keys_as_markdown(rows), "| `height_m` | m, [1e-12, 3] | absent | Height. |");
  const KeyRow turn{"wall.turn_deg", "number", "deg", "-360 to 360", "0.0", "kind = \"rocking\"", "Turn."};
  expect_has(keys_as_markdown({turn}), "| `wall.turn_deg` (rocking) | deg, +-360 | `0.0` | Turn. |");
}

TEST(KeyTable, PrintsTheKeysOfEqualTablesOnce) {
  const auto table = [](const std::string& name, const std::string& depth) {
    return std::vector<KeyRow>{{name, "table", "", "", "absent", "", "A pond."},
                               {name + ".depth_m", "number", "m", depth, "required", "", "Depth."}};
  };
  std::vector<KeyRow> rows = table("pond", "> 0");
  for (const auto& more : {table("pool", "> 0"), table("well", "> 9")})
    rows.insert(rows.end(), more.begin(), more.end());
  EXPECT_EQ(keys_as_markdown(rows),
            "| key | value | default | meaning |\n|---|---|---|---|\n"
            "| `pond` | table | absent | A pond. |\n"
            "| `pond.depth_m` | m, > 0 |  | Depth. |\n"
            "| `pool` | table | absent | A pond. Keys: those of `pond`. |\n"
            "| `well` | table | absent | A pond. |\n"
            "| `well.depth_m` | m, > 9 |  | Depth. |\n");
}

TEST(KeyTable, PrintsOnceWhatAlternativesShare) {
  const auto row = [](const std::string& allowed, const std::string& word) {
    return KeyRow{"bed.side_m", "number", "m", allowed, "required", "shape = \"" + word + "\"", "Side."};
  };
  EXPECT_EQ(keys_as_markdown({row("above 0 to 1000000", "square"), row("0 to 150", "star"),
                              row("above 0 to 1000000", "hexagon")}),
            "| key | value | default | meaning |\n|---|---|---|---|\n"
            "| `bed.side_m` (square, hexagon) | m, (0, 1e6] |  | Side. |\n"
            "| `bed.side_m` (star) | m, [0, 150] |  | Side. |\n");
}

TEST(KeyTable, FindsThePlaceOfAPath) {
  const Document document = parse_toml(least, "g.toml");
  EXPECT_EQ(problem_at(document, "beds.0.radius_m", "x").line, 7);
  EXPECT_EQ(problem_at(document, "beds.0.missing", "x").line, 4) << "the nearest table above";
  EXPECT_EQ(problem_at(document, "beds.9.name", "x").key, "beds.9.name");
}

}  // namespace drumlin::garden
