#pragma once
// HDF5 files described line by line, so that inputs reach our checks: raw bytes behind a valid checksum would
// test HDF5 instead (docs/decisions.md).
#include <filesystem>
#include <string>

namespace drumlin::fuzz {

/// Writes the file that a text describes, with its checksum: on each line the name of a dataset, its type
/// (double, float, int, long or text) and its numbers, or its text in which \n ends a line. Lines that
/// describe nothing that HDF5 takes are left out. A text that begins with "raw" and the end of the line is
/// the bytes of the file behind it.
void write_described(const std::filesystem::path& file, const std::string& text);

}  // namespace drumlin::fuzz
