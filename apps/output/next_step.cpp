#include "apps/output/next_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace drumlin::apps {

namespace {

/// An absent column stands for any; {0}: the output, {1}: seconds. The first row that fits counts.
struct Row {
  std::string_view command;
  std::optional<Flowing> flowing;
  std::optional<Verdict> verdict;
  std::string_view text;
};

constexpr std::string_view ways_of_open =
    "drumlin pair {0}/scene.toml --run {0} --law LAW -o PAIR (LAW: of drumlin law), drumlin history {0}, or "
    "drumlin report {0}";
constexpr auto in_drum = Flowing::drum;
constexpr auto in_layers = Flowing::layers;
constexpr auto in_open = Flowing::open;
constexpr std::nullopt_t always = std::nullopt;

const Row next_steps[] = {
    {"new", always, always, "drumlin scene check {0}, then drumlin run {0} -o RUN"},
    {"new flow", always, always,
     "drumlin flow {0} --rheology LAW -o FLOWRUN; LAW: a file from calibrate, or a name as drum-6rpm"},
    {"run", always, Verdict::no_snapshots,
     "drumlin report {0}; without snapshots (stages.N.snapshots) there is nothing to measure"},
    {"run", in_open, always, ways_of_open},
    {"run", always, always, "drumlin measure {0}, or drumlin plot {0} --player"},
    {"measure", always, Verdict::rests,
     "let it flow (a steeper slope, a faster wall, an open slot) in another run; drumlin report {0} "
     "shows what there is"},
    {"measure", in_open, Verdict::unsteady,
     "drumlin measure {0} --since SECONDS --overwrite leaves the start out; drumlin pair {0}/scene.toml "
     "--run {0} --law LAW -o PAIR, or drumlin report {0}"},
    {"measure", in_open, always, ways_of_open},
    {"measure", always, Verdict::unsteady,
     "drumlin run {0}/scene.toml -o {0} --extend {1:.6g}, then drumlin measure {0} --overwrite; or drumlin "
     "report {0}"},
    {"measure", in_layers, Verdict::one_rate,
     "drumlin pair {0}/scene.toml --run {0} --law LAW -o PAIR (LAW: of drumlin law); one I makes no law: "
     "drumlin calibrate {0} RUN2 RUN3 -o rheology.toml with runs at other rates"},
    {"measure", always, always, "drumlin calibrate {0} -o rheology.toml, or drumlin report {0}"},
    {"measure imported", always, Verdict::rests,
     "let it flow in another run; the pictures in {0}/measured show what there is"},
    {"measure imported", in_open, always,
     "open the pictures in {0}/measured; drumlin export {0} --to vtkhdf shows the grains in ParaView"},
    {"measure imported", always, Verdict::unsteady,
     "drumlin calibrate {0} --accept-unsteady -o rheology.toml; pictures are in {0}/measured"},
    {"measure imported", in_layers, Verdict::one_rate,
     "drumlin calibrate {0} RUN2 RUN3 -o rheology.toml with runs at other rates: one I makes no law"},
    {"measure imported", always, always,
     "drumlin calibrate {0} -o rheology.toml; pictures are in {0}/measured"},
    {"calibrate", always, always,
     "drumlin new {2}-flow -o flow.toml, then drumlin flow flow.toml --rheology {0} -o FLOWRUN"},
    {"flow", in_drum, always, "drumlin compare RUN {0} -o REPORT"},
    {"flow", in_layers, always, "drumlin compare RUN {0} -o REPORT, with RUN of the same layers"},
    {"flow", always, always, "open the pictures in {0}, or flow.vtu in ParaView"},
};

}  // namespace

std::string next_step(std::string_view command, Flowing flowing, Verdict verdict, const std::string& output,
                      double seconds) {
  const auto row = std::ranges::find_if(next_steps, [&](const Row& one) {
    return one.command == command && one.flowing.value_or(flowing) == flowing &&
           one.verdict.value_or(verdict) == verdict;
  });
  if (row == std::end(next_steps)) throw std::logic_error("no next step after " + std::string(command));
  const char* kind = flowing == in_drum ? "drum" : flowing == in_layers ? "chute" : "silo";
  return "next: " + fmt::format(fmt::runtime(row->text), output, seconds, kind) + "\n";
}

}  // namespace drumlin::apps
