// Fuzz target: a checkpoint, described by lines (h5_recipe.hpp) or as raw bytes.
#include "particles/io/checkpoint_file.hpp"
#include "tests/fuzz/h5_recipe.hpp"
#include "tests/fuzz/one_input.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace drumlin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const testing::TemporaryFolder folder;
  fuzz::write_described(folder / "c.h5", fuzz::text_of(data, size));
  return fuzz::read_or_refused([&] { (void)particles::read_checkpoint(folder / "c.h5"); });
}
