// Numbers and fields of tables as text.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/core/documents/csv.hpp"

namespace drumlin {
namespace {

TEST(Csv, WritesTheShortestDigitsThatReadBackTheSame) {
  for (const double value : {0.1, 1 / 3.0, -2.5e-300, 1e22, 5e-324, 0.0})
    EXPECT_EQ(finite_number(csv_number(value)), value);
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number(std::nan("")), "");
  EXPECT_EQ(csv_number(1 / 3.0, 3), "0.333");
  EXPECT_EQ(csv_number(std::numeric_limits<double>::infinity(), 3), "");
}

TEST(Csv, SplitsALineIntoTrimmedFields) {
  EXPECT_EQ(csv_fields(" a,b c ,,1\r"), (std::vector<std::string_view>{"a", "b c", "", "1"}));
  EXPECT_EQ(csv_fields(""), std::vector<std::string_view>{""});
  EXPECT_EQ(csv_line({"a", "", "1"}), "a,,1\n");
}

TEST(Csv, QuotesTextsThatASpreadsheetWouldCompute) {
  for (const char* formula : {"=1+1", "+1", "@SUM(A1)"}) {
    EXPECT_EQ(csv_text(formula), "\"" + std::string(formula) + "\"");
    const std::string line = csv_line({"1", formula, "2"});
    EXPECT_EQ(csv_fields(std::string_view(line).substr(0, line.size() - 1)),
              (std::vector<std::string_view>{"1", formula, "2"}));
  }
  EXPECT_EQ(csv_text("a, \"b\" "), "\"a, \"\"b\"\" \"");
  EXPECT_EQ(csv_fields("\"a, \"\"b\"\" \",1"), (std::vector<std::string_view>{"a, \"\"b\"\" ", "1"}));
  for (const char* plain : {"", "drum", "-1e-3", "a=b", "a+b"}) EXPECT_EQ(csv_text(plain), plain);
  EXPECT_EQ(csv_fields("\"open,1"), (std::vector<std::string_view>{"\"open", "1"}));
  EXPECT_EQ(csv_fields("\"a\"b,1"), (std::vector<std::string_view>{"\"a\"b", "1"}));
}

TEST(Csv, ReadsWholeFiniteNumbersAlone) {
  EXPECT_TRUE(std::isnan(csv_value("").value()));
  EXPECT_EQ(csv_value("-1e3"), -1000);
  EXPECT_EQ(csv_value("+2.05e+01"), 20.5);
  for (const char* text : {"1x", "++1", "+-1", "-+1", "+", "nan", "inf", "1e999", "1 2", "x"})
    EXPECT_FALSE(csv_value(text)) << text;
  EXPECT_FALSE(finite_number(""));
}

}  // namespace
}  // namespace drumlin
