// Fuzz target: comma-separated files. The first line names the reader: profiles, log or grains.
#include "coupling/core/results/profile_set.hpp"
#include "particles/measurement/run_log.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/fuzz/one_input.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace drumlin;

namespace {

/// A box whose grains stand in a list.
const char* const scene_of_a_list = R"(format = "drumlin-scene-1"
[grains]
density_kg_m3 = 2700
[grains.listed]
file = "list.csv"
[[walls]]
name = "floor"
shape = "segment"
from_mm = [-1000, -1000]
to_mm = [1000, -1000]
[[stages]]
name = "fall"
duration_s = 0.1
time_step_s = 1e-3
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const testing::TemporaryFolder folder;
  const std::string text = fuzz::text_of(data, size);
  const auto end = std::min(text.find('\n'), text.size());
  const std::string name = text.substr(0, end), content = text.substr(std::min(end + 1, text.size()));
  const auto file = folder.with("list.csv", content);
  return fuzz::read_or_refused([&] {
    if (name == "log")
      (void)particles::accuracy_scalars(file, 0, 1);
    else if (name == "grains")
      (void)particles::parse_scene(scene_of_a_list, (folder / "scene.toml").string());
    else
      (void)read_profiles(file);
  });
}
