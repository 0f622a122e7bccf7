// docs/formats/import.md lists the keys as the program knows them.
#include <gtest/gtest.h>

#include "coupling/exchange/text_file.hpp"
#include "particles/import/description.hpp"

namespace drumlin {
namespace {

TEST(ImportDocs, HoldTheTableThatTheProgramPrints) {
  const std::string page = file_text(std::string(DRUMLIN_DATA) + "/../docs/formats/import.md");
  EXPECT_NE(page.find(keys_as_markdown(import_keys())), std::string::npos)
      << "replace the table of docs/formats/import.md by the output of `drumlin import --keys --markdown`";
}

}  // namespace
}  // namespace drumlin
