#pragma once
// Whole text files, read and written so that nobody ever sees half of one.
#include <filesystem>
#include <string>

namespace drumlin {

/// Content of a file. Throws InputError if it is missing or no regular file, IoError if it cannot be read.
std::string file_text(const std::filesystem::path& file);

/// Writes `text` aside, forces it to the disk and renames it to `file`: a kill leaves the old file or the new
/// one. Throws IoError, the old file then being intact.
void replace_file(const std::filesystem::path& file, const std::string& text);

}  // namespace drumlin
