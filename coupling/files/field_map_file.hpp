#pragma once
// maps.h5, written by both sides: RUN/measured/maps.h5 and FLOWRUN/maps.h5 (docs/formats/maps.md).
#include <filesystem>

#include "coupling/exchange/field_map.hpp"

namespace drumlin {

/// How much of a map is kept: every bit, or values to 3e-5 and intervals to 1 % of themselves, packed.
enum class MapStorage { whole, packed };

/// Format "drumlin-maps-1". Throws InputError on a map that could not be read back, IoError when the file
/// cannot be written; an older file of that name is then untouched.
void write_field_map(const std::filesystem::path& file, const FieldMap& map,
                     MapStorage storage = MapStorage::whole);

/// Throws InputError naming file and dataset on another version, on damage, on anything missing or of another
/// size than the grid.
FieldMap read_field_map(const std::filesystem::path& file);

}  // namespace drumlin
