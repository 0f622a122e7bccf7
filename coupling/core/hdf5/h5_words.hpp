#pragma once
// What the numbers of a dataset are, and which of them are read.
#include <string_view>

namespace drumlin {

/// Which numbers a reader takes: all are finite, and so are squares and quotients of them.
enum class H5Range {
  finite,   ///< at most 1e100 from 0
  from_0,   ///< 0, or 1e-100 to 1e100
  above_0,  ///< 1e-100 to 1e100
};

/// Attributes `unit` ("1": none) and `description` of a dataset, absent without one.
struct H5Words {
  std::string_view unit = {}, description = {};
  H5Range range = H5Range::finite;
};

}  // namespace drumlin
