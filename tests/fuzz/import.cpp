// Fuzz target: an import, all its files in one text: a line "### NAME" begins a file, NAME one of
// import.toml, dump.1, contacts.1, grains.csv, contacts.csv.
#include <array>
#include <sstream>

#include "particles/import/description.hpp"
#include "particles/import/import_run.hpp"
#include "tests/fuzz/one_input.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace drumlin;

namespace {

constexpr std::array names{"import.toml", "dump.1", "contacts.1", "grains.csv", "contacts.csv"};

void write_files(const testing::TemporaryFolder& folder, const std::string& text) {
  for (const char* name : names) std::filesystem::remove(folder / name);
  std::istringstream lines(text);
  std::string name, content;
  const auto write = [&] {
    if (std::find(names.begin(), names.end(), name) != names.end()) folder.with(name, content);
    content.clear();
  };
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("### "))
      write(), name = line.substr(4);
    else
      content += line + "\n";
  }
  write();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const testing::TemporaryFolder folder;
  write_files(folder, fuzz::text_of(data, size));
  return fuzz::read_or_refused([&] {
    const auto description = particles::read_import_description(folder / "import.toml");
    // Its patterns may lead out of the folder: only what the target wrote is read.
    const auto inside = [](const std::vector<std::string>& files) {
      return std::all_of(files.begin(), files.end(),
                         [](const std::string& file) { return file.find('/') == std::string::npos; });
    };
    const bool all_inside =
        std::visit([&](const auto& source) { return inside(source.grains) && inside(source.contacts); },
                   description.source);
    if (all_inside)
      (void)particles::import_run(description, folder.path(), [](const particles::Snapshot&) {});
  });
}
