#include "coupling/core/documents/document.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/files/folder.hpp"

namespace drumlin {
namespace {

/// The problems of a text that must be refused.
std::vector<InputProblem> problems_of(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) {
  try {
    parse_toml(text, "t.toml", overrides);
  } catch (const InputError& error) {
    return error.problems();
  }
  ADD_FAILURE() << "accepted: " << text;
  return {InputProblem{}};
}

std::vector<InputProblem> problems_of_file(const std::filesystem::path& file) {
  try {
    read_toml(file);
  } catch (const InputError& error) {
    return error.problems();
  }
  ADD_FAILURE() << "accepted: " << file;
  return {InputProblem{}};
}

TEST(Document, RemembersWhereValuesStand) {
  const Document document = parse_toml("a = 1\n\n[b]\n  c = [1.5, \"x\"]\n", "t.toml");
  const Node* a = document.root.find("a");
  ASSERT_NE(a, nullptr);
  EXPECT_EQ(std::get<std::int64_t>(a->value), 1);
  EXPECT_EQ(a->line, 1);
  EXPECT_EQ(a->column, 5);
  const Node* b = document.root.find("b");
  ASSERT_NE(b, nullptr);
  EXPECT_EQ(b->line, 3);
  const auto& c = std::get<Node::Array>(b->find("c")->value);
  EXPECT_EQ(std::get<double>(c[0].value), 1.5);
  EXPECT_EQ(c[1].line, 4);
  EXPECT_EQ(c[1].column, 13);
  EXPECT_EQ(document.root.find("none"), nullptr);
  EXPECT_EQ(a->find("none"), nullptr);
}

TEST(Document, KeepsTheOrderOfTheFile) {
  const Document document = parse_toml("z = 1\ny = 2\na = 3\n", "t.toml");
  std::string order;
  for (const auto& [key, node] : std::get<Node::Table>(document.root.value)) order += key;
  EXPECT_EQ(order, "zya");
}

TEST(Document, RefusesWrongSyntaxWithItsPlace) {
  const auto problems = problems_of("a = 1\nb = = 2\n");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].file, "t.toml");
  EXPECT_EQ(problems[0].line, 2);
  EXPECT_EQ(problems[0].column, 5);
}

TEST(Document, RefusesAKeyThatStandsTwice) { EXPECT_EQ(problems_of("a = 1\na = 2\n")[0].line, 2); }

TEST(Document, RefusesDatesAllAtOnce) {
  const auto problems = problems_of("a = 1979-05-27\n[t]\nb = [07:32:00]\n");
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_EQ(problems[0].key, "a");
  EXPECT_EQ(problems[1].key, "t.b.0");
  EXPECT_EQ(problems[1].line, 3);
}

TEST(Document, RefusesNulBytes) {
  const auto problems = problems_of(std::string("a = 1\n[\0m[", 10));
  EXPECT_EQ(problems[0].line, 2);
  expect_has(problems[0].what, "NUL");
}

TEST(Document, RefusesTextThatIsNoUnicode) { EXPECT_EQ(problems_of("a = \"\xff\xfe\"\n").size(), 1u); }

TEST(Document, RefusesLettersOutsideQuotesThatAreNotAscii) {
  // U+01D4 and U+00E9 are undefined behaviour in an unpatched toml++ 3.3; the test bites in the checked
  // build.
  for (const char* text : {"a\xC7\x94 = 1\n", "\xC3\xA9 = 1\n", "a = \xC3\xA9\n"})
    EXPECT_EQ(problems_of(text).size(), 1u);
}

TEST(Document, RefusesDeepNestingWithoutFalling) {
  EXPECT_EQ(problems_of("a = " + std::string(100000, '[')).size(), 1u);
}

std::string repeated(const std::string& part, int times) {
  std::string text;
  for (int k = 0; k < times; ++k) text += part;
  return text;
}

// Each of them makes the parser call itself for every level.
TEST(Document, RefusesWhatLiesTooDeepBeforeItIsParsed) {
  const int many = 16000;
  for (const std::string& text :
       {repeated("a.", many) + "a = 1\n", "[" + repeated("a.", many) + "a]\n",
        "x = {" + repeated("\"a\" . ", many) + "a = 1}\n", "x = " + repeated("[", many),
        "x = " + repeated("{a = ", many), "x = " + repeated("[{a = ", many),
        "[[" + repeated("'a'.", many) + "a]]\n", "x = '''\n'''\ny = " + repeated("[\n", many)}) {
    const auto problems = problems_of(text);
    expect_has(problems[0].what, "too deep");
    EXPECT_GE(problems[0].line, 1);
  }
  expect_has(problems_of("a = 1", {repeated("a.", many) + "a=1"})[0].what, "too deep");
  EXPECT_EQ(problems_of("a = 1", {"a=" + repeated("[", many)}).size(), 1u);
}

TEST(Document, DotsAndBracketsInTextsAndCommentsAreNoLevels) {
  EXPECT_NO_THROW(parse_toml("a = \"" + repeated("[.", 100) + "\" # " + repeated("[.", 100) + "\nb = '''" +
                                 repeated("{\n", 100) + "'''\nc = \"\"\"" + repeated("\\\"[", 100) +
                                 "\"\"\"\n",
                             "t.toml"));
  EXPECT_NO_THROW(parse_toml(repeated("a.", 31) + "a = 1\n", "t.toml"));
  EXPECT_NO_THROW(parse_toml("x = " + repeated("[", 32) + repeated("]", 32) + "\n", "t.toml"));
}

TEST(Document, RefusesKeysThatNobodyCouldRead) {
  const auto problems = problems_of("[t]\n\"" + std::string(201, 'k') + "\" = 1\n");
  EXPECT_EQ(problems[0].line, 2);
  expect_has(problems[0].what, "201 bytes");
}

TEST(Document, RefusesEmptyText) {
  EXPECT_EQ(problems_of("").size(), 1u);
  EXPECT_EQ(problems_of(" \n\t\r\n").size(), 1u);
}

TEST(Document, RefusesMissingFileFolderAndLargeFile) {
  const testing::TemporaryFolder folder;
  expect_has(problems_of_file(folder / "none.toml")[0].what, "not exist");
  expect_has(problems_of_file(folder.path())[0].what, "folder");
  const auto large = folder / "large.toml";
  std::ofstream(large) << "a = 1\n" << std::string(1 << 20, '\n');
  expect_has(problems_of_file(large)[0].what, "too large");
  EXPECT_EQ(problems_of_file(large)[0].file, large.string());
}

TEST(Overrides, ReplaceAndAddValues) {
  const Document document = parse_toml("[s]\na = 1\n[[t]]\nb = 2\n[[t]]\nb = 3\n", "t.toml",
                                       {"s.a=2.5", "s.word=nncg", "t.1.b=[1, 2]", "u.v.w=true",
                                        "s.quoted=\"x = y\"", "s.file=runs/list-1.csv"});
  const Node& s = *document.root.find("s");
  EXPECT_EQ(std::get<double>(s.find("a")->value), 2.5);
  EXPECT_EQ(s.find("a")->line, 0) << "an override has no place in the file";
  EXPECT_EQ(std::get<std::string>(s.find("word")->value), "nncg");
  EXPECT_EQ(std::get<std::string>(s.find("quoted")->value), "x = y");
  EXPECT_EQ(std::get<std::string>(s.find("file")->value), "runs/list-1.csv");
  const auto& t = std::get<Node::Array>(document.root.find("t")->value);
  EXPECT_EQ(std::get<std::int64_t>(t[0].find("b")->value), 2);
  EXPECT_EQ(std::get<Node::Array>(t[1].find("b")->value).size(), 2u);
  EXPECT_TRUE(std::get<bool>(document.root.find("u")->find("v")->find("w")->value));
}

TEST(Overrides, MayAddAnEmptyTable) {
  const Document document = parse_toml("a = 1\n", "t.toml", {"effects.spin={}"});
  EXPECT_TRUE(std::holds_alternative<Node::Table>(document.root.find("effects")->find("spin")->value));
}

TEST(Overrides, AreToldBehindTheTitle) {
  const auto title = [](const std::vector<std::string>& overrides) {
    return title_with_changes(
        "Drum, 15 rpm",
        parse_toml("speed = 15\nseed = 1\n[output]\na = 1\n[tables.t]\n", "t.toml", overrides),
        {"output", "reduced"});
  };
  EXPECT_EQ(title({}), "Drum, 15 rpm");
  EXPECT_EQ(title({"speed=12"}), "Drum, 15 rpm [speed = 12]");
  EXPECT_EQ(title({"speed=15", "tables.t={}"}), "Drum, 15 rpm") << "what the file says already";
  EXPECT_EQ(title({"output.a=2", "output.b.c=nncg", "reduced=true"}), "Drum, 15 rpm");
  EXPECT_EQ(title({"speed=12", "title=Other"}), "Drum, 15 rpm") << "a title of the user's own";
  EXPECT_EQ(title({"speed=12", "tables.u={}", "speed=10", "outputs=nncg"}),
            "Drum, 15 rpm [tables.u = {}, speed = 10, outputs = \"nncg\"]");
  const std::string part = "word=" + std::string(80, 'x'), whole = "word=" + std::string(190, 'x');
  EXPECT_EQ(title({part, "seed=2", "other_" + part, "speed=3"}),
            "Drum, 15 rpm [word = \"" + std::string(80, 'x') + "\", seed = 2 and 2 more]");
  EXPECT_EQ(title({whole}), "Drum, 15 rpm [keys changed: 1]");
  EXPECT_EQ(title_with_changes("", parse_toml("a = 1\n", "t.toml", {"a=2"}), {}), "");
}

TEST(Overrides, AreRefusedWithTheirKey) {
  const std::string text = "a = 1\n[[t]]\nb = 2\n";
  for (const char* wrong : {"a", "=1", "a..b=1", "a=", "a=1\nb=2", "a=[1,", "t.1.b=1", "t.x.b=1", "t.-1.b=1",
                            "a.b=1", "a=two words", "a.=1", "a=1, b=2"}) {
    const auto problems = problems_of(text, {wrong});
    ASSERT_EQ(problems.size(), 1u) << wrong;
    EXPECT_EQ(problems[0].file, "override") << wrong;
    EXPECT_EQ(problems[0].line, 0) << wrong;
  }
}

}  // namespace
}  // namespace drumlin
