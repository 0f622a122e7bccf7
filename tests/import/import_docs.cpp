// docs/formats/import.md lists the keys as the program knows them.
#include <gtest/gtest.h>

#include "coupling/common/text_file.hpp"
#include "particles/import/description.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(ImportDocs, HoldTheTableThatTheProgramPrints) {
  const std::string page = file_text(drumlin::test::docs_folder() / "formats/import.md");
  EXPECT_NE(page.find(keys_as_markdown(import_keys())), std::string::npos)
      << "replace the table of docs/formats/import.md by the output of `drumlin import --keys --markdown`";
}

}  // namespace
}  // namespace drumlin
