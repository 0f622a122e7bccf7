#pragma once
// The file of the law, rheology.toml (docs/formats/rheology.md).
#include <filesystem>
#include <string>

#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin {

/// Version 1. Throws InputError with line, key, allowed range.
RheologyFit read_rheology(const std::filesystem::path& file);
/// The same from a text; `name` stands for the file in messages.
RheologyFit parse_rheology(const std::string& text, const std::string& name);
/// The text of rheology.toml.
std::string rheology_text(const RheologyFit& fit);
void write_rheology(const std::filesystem::path& file, const RheologyFit& fit);

}  // namespace drumlin
