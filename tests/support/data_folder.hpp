#pragma once
// The folder data/ of the source tree, for tests that read what the project ships.
#include <filesystem>

namespace drumlin::test {

/// Absolute path of data/.
std::filesystem::path data_folder();

/// Absolute path of docs/, beside it.
std::filesystem::path docs_folder();

}  // namespace drumlin::test
