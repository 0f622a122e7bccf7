#pragma once
// What the columns of profiles and the fields of maps are, by their names: docs/formats/quantities.md, which
// is compiled in.
#include <string>
#include <string_view>
#include <vector>

namespace drumlin {

struct Quantity {
  std::string_view name, label;
  std::string_view unit;      ///< "1" of a number
  std::string_view compared;  ///< as what a comparison covers it; empty: not
  std::string_view meaning;
};

/// All rows, in the order of the page.
const std::vector<Quantity>& quantities();

struct QuantityWords {
  std::string unit, meaning;
};

/// Empty for a name that is no quantity of ours. "displacement_NAME", "NAME_particles" and the like follow
/// from NAME.
QuantityWords quantity_words(std::string_view name);

/// 180 for angles of axes (half a turn apart they are one axis), 0 for what has no period.
double period_of(std::string_view name);

}  // namespace drumlin
