#include "coupling/core/results/quantities.hpp"

#include <array>
#include <string>

#include "coupling/core/documents/csv.hpp"

namespace drumlin {

extern const std::string_view quantity_page;  // docs/formats/quantities.md (CMakeLists.txt)

namespace {

constexpr std::string_view inner_name = "NAME";

std::vector<Quantity> quantity_rows(std::string_view page) {
  std::vector<Quantity> rows;
  for (std::size_t end = 0; !page.empty(); page.remove_prefix(end)) {
    end = std::min(page.find('\n'), page.size() - 1) + 1;
    std::string_view line = page.substr(0, end);
    if (!line.starts_with("| ") || line.starts_with("| name ")) continue;
    std::array<std::string_view, 5> cells;
    for (std::string_view& cell : cells) {
      line.remove_prefix(1);
      cell = trimmed(line.substr(0, line.find('|')));
      line.remove_prefix(line.find('|'));
    }
    rows.push_back({cells[0], cells[1], cells[2], cells[3], cells[4]});
  }
  return rows;
}

/// What stands for NAME in a name that is made so; empty: it is not.
std::string_view made_of(std::string_view made, std::string_view name) {
  const std::size_t at = made.find(inner_name);
  if (at == std::string_view::npos || !name.starts_with(made.substr(0, at))) return {};
  name.remove_prefix(at), made.remove_prefix(at + inner_name.size());
  return name.ends_with(made) ? name.substr(0, name.size() - made.size()) : std::string_view{};
}

const Quantity* quantity_named(std::string_view name) {
  for (const Quantity& known : quantities())
    if (known.name == name) return &known;
  return nullptr;
}

}  // namespace

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> all =
      quantity_rows(quantity_page.substr(0, quantity_page.find("\n## ")));
  return all;
}

QuantityWords quantity_words(std::string_view name) {
  if (const Quantity* known = quantity_named(name))
    return {std::string(known->unit), std::string(known->meaning)};
  for (const Quantity& made : quantities()) {
    const std::string_view inner = made_of(made.name, name);
    if (inner.empty()) continue;
    QuantityWords words = quantity_words(inner);
    if (words.meaning.empty()) return {};
    if (!made.unit.empty()) words.unit = made.unit;
    words.meaning =
        std::string(made.meaning).replace(made.meaning.find(inner_name), inner_name.size(), words.meaning);
    return words;
  }
  return {};
}

double period_of(std::string_view name) {
  if (const Quantity* known = quantity_named(name)) return known->compared == "half turns" ? 180 : 0;
  for (const Quantity& made : quantities())
    if (const std::string_view inner = made_of(made.name, name); !inner.empty()) return period_of(inner);
  return 0;
}

}  // namespace drumlin
