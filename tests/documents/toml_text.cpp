#include "coupling/core/documents/toml_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace drumlin {
namespace {

Node read_back(const Node& table) { return parse_toml(toml_text(table), "t.toml").root; }

TEST(TomlText, ReadsBackEveryRealExactly) {
  for (const double value : {0.0, 10.0, 0.1, 1e-3, 1.0 / 3.0, 6.02214076e23, -1e-300, 5e-324, 123456789.0,
                             std::numeric_limits<double>::max(), 1e16, 1e22}) {
    Node table{Node::Table{{"x", Node{value, 0, 0}}}, 0, 0};
    const Node back = read_back(table);
    ASSERT_TRUE(std::holds_alternative<double>(back.find("x")->value)) << toml_text(table);
    EXPECT_EQ(std::get<double>(back.find("x")->value), value);
  }
}

TEST(TomlText, ReadsBackEveryText) {
  const std::string text = "quote \" backslash \\ newline \n tab \t bell \a, \xc3\xa9";
  Node table{Node::Table{{"a key", Node{text, 0, 0}}}, 0, 0};
  EXPECT_EQ(std::get<std::string>(read_back(table).find("a key")->value), text);
}

TEST(TomlText, PutsValuesBeforeSubTables) {
  Node inner{Node::Table{{"b", Node{std::int64_t{2}, 0, 0}}}, 0, 0};
  Node list{Node::Array{inner, inner}, 0, 0};
  Node table{Node::Table{
                 {"t", inner}, {"list", list}, {"a", Node{true, 0, 0}}, {"empty", Node{Node::Table{}, 0, 0}}},
             0, 0};
  EXPECT_EQ(toml_text(table), "a = true\n\n[t]\nb = 2\n\n[[list]]\nb = 2\n\n[[list]]\nb = 2\n\n[empty]\n");
  EXPECT_EQ(toml_text(read_back(table)), toml_text(table));
}

}  // namespace
}  // namespace drumlin
