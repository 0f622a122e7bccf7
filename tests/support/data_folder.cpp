#include "tests/support/data_folder.hpp"

namespace drumlin::test {

std::filesystem::path data_folder() { return DRUMLIN_DATA; }

std::filesystem::path docs_folder() { return data_folder().parent_path() / "docs"; }

}  // namespace drumlin::test
