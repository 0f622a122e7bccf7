#pragma once
// What the columns of profiles and the fields of maps are, by their names.
#include <string>
#include <string_view>

namespace drumlin {

struct QuantityWords {
  std::string unit;  ///< "1" of a number
  std::string meaning;
};

/// Empty for a name that is no quantity of ours. "displacement_NAME", "NAME_particles" and the like follow
/// from NAME.
QuantityWords quantity_words(std::string_view name);

}  // namespace drumlin
