#include "apps/support/html.hpp"

namespace drumlin::apps {

namespace {

constexpr const char* style = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #1b1b1b; max-width: 78rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: .2rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .28rem .5rem; border-bottom: 1px solid #e4e4e4; white-space: nowrap; }
th { background: #f4f4f4; font-weight: 600; } th:first-child, td:first-child, .left { text-align: left; white-space: normal; }
.met { color: #006b3c; font-weight: 600; } .near { color: #8a5a00; font-weight: 600; } .missed { color: #b00000; font-weight: 600; } .not_measured { color: #666; }
.verdict { background: #f4f4f4; border-left: .4rem solid #555; padding: .7rem 1rem; }
.verdict.good { border-color: #006b3c; } .verdict.bad { border-color: #b00000; }
.reduced { background: #fff2cc; border: 1px solid #d6a400; padding: .5rem 1rem; font-weight: 600; }
figure { margin: 1.2rem 0; } figure img { max-width: 100%; } figcaption, .note { color: #444; font-size: .92rem; }
.wide { overflow-x: auto; } .errors { font-size: .9rem; } .errors th { white-space: normal; vertical-align: bottom; }
.errors tr td[rowspan] { vertical-align: top; } .errors td { padding: .15rem .5rem; }
details { margin: .6rem 0; overflow-x: auto; } summary { cursor: pointer; color: #333; }
pre { background: #f7f7f7; padding: .7rem; overflow-x: auto; font-size: .85rem; }
)";

}  // namespace

std::string page_style() { return style; }

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace drumlin::apps
