#pragma once
// maps.h5, written by both sides: RUN/measured/maps.h5 and FLOWRUN/maps.h5 (docs/formats/maps.md).
#include <cstddef>
#include <filesystem>
#include <vector>

#include "coupling/core/hdf5/h5_writer.hpp"
#include "coupling/core/results/field_map.hpp"

namespace drumlin {

/// How much of a map is kept: every bit, or values to 3e-5 and intervals to 1 % of themselves, packed.
enum class MapStorage { whole, packed };

/// The datasets `x` and `z` of a file over a grid.
void add_nodes(const MapGrid& grid, H5Content& out);

/// Format "drumlin-maps-1". Throws InputError on a map that could not be read back, IoError when the file
/// cannot be written; an older file of that name is then untouched.
void write_field_map(const std::filesystem::path& file, const FieldMap& map,
                     MapStorage storage = MapStorage::whole);

/// The same file, MapStorage::whole, from rows that follow each other: the map is never in memory as a whole.
class FieldMapWriter {
 public:
  /// `outline`: grid, header and scales. Throws IoError.
  FieldMapWriter(std::filesystem::path file, FieldMap outline);
  /// The next rows of all fields, from the lowest up. The first ones say what fields there are, and which of
  /// them have intervals. Throws InputError on what could not be read back.
  void add(const std::vector<MapField>& fields);
  /// Puts the file in its place. Throws InputError if rows are missing, IoError as write_field_map().
  void save();

 private:
  std::filesystem::path file_;
  FieldMap outline_;
  std::size_t rows_ = 0;  // added
  H5FileWriter out_;
};

/// Throws InputError naming file and dataset on another version, on damage, on anything missing or of another
/// size than the grid.
FieldMap read_field_map(const std::filesystem::path& file);

}  // namespace drumlin
