// Numbers of a checkpoint with a valid checksum that no run has written: each is refused by its name, before
// it is cut to the type that holds it.
#include <gtest/gtest.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "tests/files/folder.hpp"
#include "tests/fuzz/h5_recipe.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
namespace {

using particles::read_checkpoint;

/// The checkpoint of the fuzz targets' corpus, its line of `name` replaced.
std::string described_with(const std::string& name, const std::string& rest) {
  std::string text = file_text(test::docs_folder().parent_path() / "tests/fuzz/corpus/checkpoint/two-grains");
  const auto begin = text.find("\n" + name + " ") + 1, end = text.find('\n', begin);
  return text.replace(begin, end - begin, name + " " + rest);
}

TEST(CheckpointNumbers, OfTheCorpusAreRead) {
  const testing::TemporaryFolder folder;
  fuzz::write_described(folder / "c.h5", described_with("bodies/material", "int 0 255"));
  EXPECT_EQ(read_checkpoint(folder / "c.h5").state.bodies.material, (std::vector<std::uint8_t>{0, 255}));
}

TEST(CheckpointNumbers, OutOfRangeAreRefusedByName) {
  const testing::TemporaryFolder folder;
  const struct {
    const char *name, *rest, *value, *allowed;
  } cases[] = {
      {"bodies/material", "int 0 300", "300", "0 to 255"},
      {"bodies/material", "int -1 0", "-1", "0 to 255"},
      {"state/stage", "long 4294967296", "4294967296", "0 to 2147483647"},
      {"state/step", "long -1", "-1", "0 or more"},
      {"state/step_in_stage", "long -7", "-7", "0 or more"},
      {"state/snapshots", "long -1", "-1", "0 or more"},
      {"log_bytes", "long -5", "-5", "0 or more"},
      {"totals/sweeps", "long -1", "-1", "0 or more"},
      {"marks/count", "long -1", "-1", "0 or more"},
      {"state/time_in_stage", "double nan", "nan", "finite"},
      {"memory/time_step", "double nan", "nan", "finite"},
      {"memory/time_step", "double 0", "0", "1e-100 to 1e+100"},
      {"memory/time_step", "double 5e-324", "5e-324", "0 or 1e-100 to 1e+100"},
      {"memory/impulse", "double inf 0", "inf", "finite"},
      {"energy/walls", "double -1e300", "-1e+300", "-1e+100 to 1e+100"},
      {"bodies/x", "double 0 nan", "nan", "finite"},
      {"bodies/radius", "double 0.5 -0.5", "-0.5", "1e-100 to 1e+100"},
      {"bodies/inverse_mass", "double 0 1", "0", "1e-100 to 1e+100"},
      {"marks/0/x", "double nan 1", "nan", "finite"},
      {"marks/0/snapshot_step", "long -2", "-2", "0 or more"},
      {"walls/pose_at_start", "double 0 0 0 1", "4 numbers", "of 3"},
      {"walls/driven", "double 0 0 1", "3 numbers", "of 2"},
  };
  for (const auto& c : cases) {
    fuzz::write_described(folder / "c.h5", described_with(c.name, c.rest));
    const std::string said = message_of<InputError>([&] { (void)read_checkpoint(folder / "c.h5"); });
    for (const char* part : {"c.h5", c.name, c.value, c.allowed}) expect_has(said, part);
  }
}

}  // namespace
}  // namespace drumlin
