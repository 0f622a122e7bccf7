// Damaged and hostile files beyond the fuzz targets (tests/fuzz): read, or refused with InputError. Mutations
// are drawn from fixed seeds, so that a failure can be repeated (docs/decisions.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/random.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// What a reader may do with a file.
template <class Read>
bool read_or_refused(Read read) {
  try {
    read();
    return true;
  } catch (const InputError& refused) {
    EXPECT_NE(std::string(refused.what()), "");
    return false;
  }
}

std::size_t below(RandomStream& random, std::size_t size) {
  return random.bits() % std::max<std::size_t>(size, 1);
}

/// Changes a text as a slip of the pen, a bad merge or malice would.
std::string mutated(std::string text, RandomStream& random) {
  static const std::vector<std::string> pieces = {"[",    "]",   "{",        "}",      "=",
                                                  "\"",   "#",   "\n",       "1e999",  "-1",
                                                  "nan",  "inf", "0",        "1e-300", "[[",
                                                  "true", "'''", "\\u0000",  "\xff",   "99999999999999999999",
                                                  ".",    ",",   "[stages]", "= []",   "kind = \"force\""};
  for (std::size_t n = 1 + below(random, 4); n > 0; --n) {
    const std::size_t at = below(random, text.size()), length = below(random, 40);
    switch (random.bits() % 4) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, pieces[below(random, pieces.size())]);
        break;
      case 2:
        text.insert(at, text.substr(below(random, text.size()), length));
        break;
      default:
        if (!text.empty()) text[at] = static_cast<char>(random.bits());
    }
  }
  return text;
}

/// A drum after some steps, with restitution, spin, ledger and a mark.
Checkpoint some_checkpoint(Scene& scene) {
  scene = scene_of({{-1, 0}, {0.02, 0}, {1.03, 0}, {0, 1}});
  scene.walls = {{"drum", ContainerShape{{0, 0}, 4}}};
  scene.effects.gravity = Gravity{};
  scene.effects.friction = Friction{0.4, 0.4};
  scene.effects.restitution = Restitution{0.5, 0.5};
  scene.effects.spin = Spin{};
  scene.output.energy_ledger = true;
  add_stage(scene, 3, 0.05);
  Simulation simulation(scene);
  for (int s = 0; s < 20; ++s) (void)simulation.step();
  Checkpoint checkpoint;
  checkpoint.scene = "s";
  checkpoint.state = simulation.state();
  return checkpoint;
}

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(HostileFile, EveryBitFlipOfACheckpointIsRefused) {
  const TemporaryFolder folder;
  Scene scene;
  const auto file = folder.path() / "c.h5", damaged = folder.path() / "d.h5";
  write_checkpoint(file, some_checkpoint(scene));
  const std::string good = bytes_of(file);
  RandomStream random(12, "flips");
  for (int k = 0; k < 3000; ++k) {
    std::string bad = good;
    const std::size_t place = below(random, bad.size());
    bad[place] = static_cast<char>(bad[place] ^ (1 << (random.bits() % 8)));
    std::ofstream(damaged, std::ios::binary) << bad;
    ASSERT_THROW(read_checkpoint(damaged), InputError) << place;
  }
}

double wild(RandomStream& random) {
  const double values[] = {0,
                           -1,
                           1,
                           1e308,
                           -1e308,
                           std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           1e-320};
  return values[below(random, std::size(values))];
}

template <class T>
void spoil(std::vector<T>& values, RandomStream& random) {
  if (random.bits() % 3 == 0) values.resize(below(random, values.size() + 3));
  if (values.empty()) return;
  if constexpr (std::is_floating_point_v<T>)
    values[below(random, values.size())] = wild(random);
  else
    values[below(random, values.size())] =
        static_cast<T>(random.bits() % 2 ? random.bits() : below(random, 9));
}

TEST(HostileFile, NoCheckpointOfValidChecksumBreaksTheRun) {
  const TemporaryFolder folder;
  Scene scene;
  const Checkpoint good = some_checkpoint(scene);
  RandomStream random(13, "checkpoints");
  for (int k = 0; k < 400; ++k) {
    Checkpoint bad = good;
    SimulationState& s = bad.state;
    std::vector<double>* doubles[] = {&s.bodies.x, &s.bodies.v_x, &s.bodies.spin, &s.memory.impulse};
    switch (random.bits() % 4) {
      case 0:
        spoil(*doubles[below(random, std::size(doubles))], random);
        break;
      case 1:
        spoil(random.bits() % 2 ? s.memory.i : s.memory.j, random);
        break;
      case 2:
        s.stage = static_cast<int>(random.bits());
        break;
      default:
        (random.bits() % 2 ? s.step : s.step_in_stage) = static_cast<std::int64_t>(random.bits());
    }
    write_checkpoint(folder.path() / "c.h5", bad);
    SCOPED_TRACE(k);
    (void)read_or_refused([&] { Simulation(scene, read_checkpoint(folder.path() / "c.h5").state); });
  }
}

TEST(HostileFile, NoMapsOfValidChecksumBreakTheirReader) {
  const TemporaryFolder folder;
  RandomStream random(16, "maps");
  int read = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<double> x = {0, 1, 2}, z = {-1, 0}, nu(6, 0.8);
    std::string names = "nu\n", header = "side = particles\nkernel = spline\n";
    std::vector<double>* doubles[] = {&x, &z, &nu};
    std::string* texts[] = {&names, &header};
    if (random.bits() % 2)
      spoil(*doubles[below(random, std::size(doubles))], random);
    else
      *texts[below(random, 2)] = mutated(*texts[below(random, 2)], random);
    H5Writer out;
    out.add_text("format", "drumlin-maps-1"), out.add_text("names", names), out.add_text("header", header);
    for (const char* scale : {"length_m", "time_s", "density_kg_m3"})
      out.add_number(std::string("scales/") + scale, 1.0);
    out.add("x", std::span<const double>(x)), out.add("z", std::span<const double>(z));
    out.add_table("fields/nu", nu, 1 + below(random, 6));
    out.save(folder.path() / "m.h5");
    SCOPED_TRACE(k);
    read += read_or_refused([&] { (void)read_field_map(folder.path() / "m.h5"); });
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace drumlin
