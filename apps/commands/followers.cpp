#include "apps/commands/followers.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "apps/process/interruption.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/files/last_whole.hpp"
#include "coupling/core/machine/own_costs.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

enum class Order { begin, step, tell_costs, end };

/// An order of the first rank to all others, with a number.
struct Message {
  Order order = Order::end;
  int number = 0;        ///< begin: threads; end: exit code
  bool goes_on = false;  ///< begin: from a checkpoint
};

/// A number that two states share only if they are the same.
using Mark = std::uint64_t;

Mark mixed(Mark sum, std::uint64_t number) { return std::rotl((sum ^ number) * 0x9E3779B97F4A7C15U, 29); }

Mark mark_of(const particles::Simulation& simulation) {
  const particles::Bodies& bodies = simulation.state().bodies;
  Mark mark = 1;
  for (const auto* numbers : {&bodies.x, &bodies.z, &bodies.v_x, &bodies.v_z, &bodies.spin})
    for (const double number : *numbers) mark = mixed(mark, std::bit_cast<std::uint64_t>(number));
  return mark;
}

/// The same of a simulation that is begun, and of the program.
Mark mark_at_start(const particles::Simulation& simulation) {
  return mixed(mark_of(simulation), std::hash<std::string>()(version_text()));
}

/// The rank whose state is not that of the first one; 0: none.
int other_than_first(particles::World& world, Mark own) {
  const std::vector<Mark> marks = world.of_each(own);
  for (int r = 1; r < world.ranks(); ++r)
    if (marks[r] != marks[0]) return r;
  return 0;
}

std::string from_first(particles::World& world, std::string text) {
  text.resize(world.of_first(text.size()));
  world.bytes_of_first(std::as_writable_bytes(std::span(text)));
  return text;
}

RankCosts own_costs(const particles::World& world) {
  return {own_cpu_seconds(), world.waiting_seconds(), own_peak_memory_mb()};
}

/// What the first rank has begun; none, after a message, where this rank cannot.
std::unique_ptr<particles::Simulation> simulation_in(const fs::path& run, bool goes_on, int threads,
                                                     particles::World& world) {
  try {
    const particles::Scene scene = particles::read_scene(run / "scene.toml");
    if (!goes_on) return std::make_unique<particles::Simulation>(scene, threads, &world);
    auto last = last_whole_checkpoint(run, particles::read_checkpoint);
    if (!last) throw IoError(run.string() + ": no checkpoint is to be seen there");
    return std::make_unique<particles::Simulation>(scene, std::move(last->content.state), threads, &world);
  } catch (const std::exception& error) {
    print_error(fmt::format("rank {}: {}\n", world.rank(), error.what()));
    return nullptr;
  }
}

}  // namespace

void Followers::begin(const fs::path& run, bool goes_on, int threads,
                      const particles::Simulation& simulation) const {
  if (world_ == nullptr) return;
  world_->of_first(Message{Order::begin, threads, goes_on});
  (void)from_first(*world_, fs::absolute(run).string());
  compare(mark_at_start(simulation), simulation);
}

particles::StepReport Followers::step(particles::Simulation& simulation) const {
  if (world_ == nullptr) return simulation.step();
  world_->of_first(Message{Order::step});
  world_->in_step = true;
  particles::StepReport report;
  try {
    report = simulation.step();
  } catch (const NotConvergedError&) {  // on all ranks
    world_->in_step = false;
    throw;
  }
  world_->in_step = false;
  compare(mark_of(simulation), simulation);
  return report;
}

void Followers::compare(std::uint64_t own, const particles::Simulation& simulation) const {
  if (const int rank = other_than_first(*world_, own))
    throw IoError(
        fmt::format("rank {} has another state than rank 0 after step {}: ranks need the same program, "
                    "the same files and processors of one kind",
                    rank, simulation.state().step));
}

std::vector<RankCosts> Followers::costs() const {
  if (world_ == nullptr) return {};
  world_->of_first(Message{Order::tell_costs});
  return world_->of_each(own_costs(*world_));
}

void Followers::end(int exit_code) const {
  if (world_ == nullptr) return;
  if (world_->in_step) world_->end_all(exit_code);
  world_->of_first(Message{Order::end, exit_code});
}

int follow(particles::World& world) {
  const CaughtInterruptions caught;  // the first rank says when a signal ends the run
  std::unique_ptr<particles::Simulation> simulation;
  for (;;) {
    const Message message = world.of_first(Message{});
    switch (message.order) {
      case Order::begin:
        simulation = simulation_in(from_first(world, ""), message.goes_on, message.number, world);
        (void)other_than_first(world, simulation ? mark_at_start(*simulation) : Mark{0});
        break;
      case Order::step:
        try {
          (void)simulation->step();
        } catch (const NotConvergedError&) {  // on all ranks, and the first one says so
          break;
        }
        (void)other_than_first(world, mark_of(*simulation));
        break;
      case Order::tell_costs:
        (void)world.of_each(own_costs(world));
        break;
      case Order::end:
        return message.number;
    }
  }
}

}  // namespace drumlin::apps
