// Fuzz target: the text of a particle scene.
#include "particles/scene/scene_file.hpp"
#include "tests/fuzz/one_input.hpp"

using namespace drumlin;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refused([&] {
    const particles::Scene scene = particles::parse_scene(fuzz::text_of(data, size), "scene.toml");
    // What was read is written so that it reads back: the scene of a run folder repeats the run.
    const std::string written = particles::scene_text(scene);
    if (particles::scene_text(particles::parse_scene(written, "scene.toml")) != written) std::abort();
  });
}
