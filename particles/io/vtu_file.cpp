#include "particles/io/vtu_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <new>
#include <span>

namespace drumlin::particles {

namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

std::string base64(std::span<const unsigned char> bytes) {
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const unsigned three =
        (bytes[i] << 16) | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += letters[three >> 18 & 63];
    text += letters[three >> 12 & 63];
    text += left > 1 ? letters[three >> 6 & 63] : '=';
    text += left > 2 ? letters[three & 63] : '=';
  }
  return text;
}

template <class T>
std::span<const unsigned char> bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(T)};
}

/// vtkZLibDataCompressor with one block: number of blocks, their size, size of a last smaller one, size
/// compressed; then the block.
std::string block_of(std::span<const unsigned char> bytes) {
  if (bytes.empty()) return base64(bytes_of(std::vector<std::uint64_t>{0, 0, 0}));
  std::vector<unsigned char> packed(compressBound(bytes.size()));
  uLongf size = packed.size();
  // Only memory can lack here: the room suffices and the level is one of zlib's.
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_BEST_SPEED) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return base64(bytes_of(std::vector<std::uint64_t>{1, bytes.size(), 0, size})) + base64(packed);
}

/// Elements that point into the appended data, and these data.
class AppendedArrays {
 public:
  template <class T>
  void add(const std::string& name, int components, const std::vector<T>& values) {
    const char* type = std::is_same_v<T, float>          ? "Float32"
                       : std::is_same_v<T, std::int32_t> ? "Int32"
                                                         : "UInt8";
    elements += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type, name, components, data.size());
    data += block_of(bytes_of(values));
  }
  void add(const std::string& tag, const std::vector<VtuArray>& arrays) {
    open(tag);
    for (const VtuArray& array : arrays)
      std::visit([&](const auto& values) { add(array.name, array.components, values); }, array.values);
    close(tag);
  }
  void open(const std::string& tag) { elements += "<" + tag + ">\n"; }
  void close(const std::string& tag) { elements += "</" + tag + ">\n"; }

  std::string elements;
  std::string data;
};

}  // namespace

std::string vtu_text(const VtuGrid& grid) {
  AppendedArrays arrays;
  arrays.open("Points");
  arrays.add("Points", 3, grid.points);
  arrays.close("Points");
  arrays.open("Cells");
  arrays.add("connectivity", 1, grid.connectivity);
  arrays.add("offsets", 1, grid.offsets);
  arrays.add("types", 1,
             std::vector<std::uint8_t>(grid.offsets.size(), static_cast<std::uint8_t>(grid.cell)));
  arrays.close("Cells");
  arrays.add("PointData", grid.point_data);
  arrays.add("CellData", grid.cell_data);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
      "compressor=\"vtkZLibDataCompressor\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" "
      "NumberOfCells=\"{}\">\n{}</Piece>\n</UnstructuredGrid>\n"
      "<AppendedData encoding=\"base64\">\n_{}\n</AppendedData>\n</VTKFile>\n",
      grid.points.size() / 3, grid.offsets.size(), arrays.elements, arrays.data);
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& steps) {
  std::string sets;
  for (const auto& [time, file] : steps)
    sets += fmt::format("<DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", time, file);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n{}</Collection>\n</VTKFile>\n",
      sets);
}

}  // namespace drumlin::particles
