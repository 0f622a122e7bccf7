#pragma once
// Readers of the files in data/paper.
#include <filesystem>
#include <string>

#include "coupling/core/documents/document.hpp"

namespace drumlin::coupling {

/// Throws InputError unless the file's format is "drumlin-paper-1".
Document paper_file(const std::filesystem::path& file);

/// The entries of an array of tables; throws InputError if there is none of this name.
Node::Array paper_entries(const Document& document, const std::string& key);

double number_in(const Node* node);     ///< NaN if it is absent or no number
std::string text_in(const Node* node);  ///< empty if it is absent or no text

}  // namespace drumlin::coupling
