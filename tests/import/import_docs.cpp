// docs/formats/import.md lists the keys as the program knows them.
#include <gtest/gtest.h>

#include "coupling/common/files/text_file.hpp"
#include "particles/import/description.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(ImportDocs, HoldTheTableThatTheProgramPrints) {
  const std::string page = file_text(drumlin::test::docs_folder() / "formats/import.md");
  expect_has(page, keys_as_markdown(import_keys()));
}

}  // namespace
}  // namespace drumlin
