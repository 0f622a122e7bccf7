#pragma once
// VTK's XML files, as ParaView reads them: unstructured grids (.vtu) and their sequence in time (.pvd).
// Format: VTK 9 file formats, "XML File Formats"; arrays appended, zlib, base64, little endian.
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace drumlin::particles {

/// A named array over points or cells; `components` numbers for each of them, 3 for a vector.
struct VtuArray {
  std::string name;
  int components = 1;
  std::variant<std::vector<float>, std::vector<std::int32_t>> values;
};

enum class VtuCell : std::uint8_t { vertex = 1, line = 3 };

/// Cells of one kind: cell c joins connectivity[offsets[c-1]] to connectivity[offsets[c] - 1].
struct VtuGrid {
  VtuCell cell = VtuCell::vertex;
  std::vector<float> points;  ///< x, y, z of each
  std::vector<std::int32_t> connectivity;
  std::vector<std::int32_t> offsets;
  std::vector<VtuArray> point_data;
  std::vector<VtuArray> cell_data;
};

/// The content of a .vtu file. The same grid gives the same bytes.
std::string vtu_text(const VtuGrid& grid);

/// The content of a .pvd file: (time, file relative to it) of each step.
std::string pvd_text(const std::vector<std::pair<double, std::string>>& steps);

}  // namespace drumlin::particles
