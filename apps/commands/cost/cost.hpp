#pragma once
// What `drumlin cost` does for the scripts that plan it (apps/costs): facts of a scene, and work on it.
// Wishes and answers are JSON.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "apps/command_line/command.hpp"
#include "particles/scene/effect_variants.hpp"
#include "particles/stretches/stretch.hpp"

namespace drumlin::apps {

struct CostOptions {
  std::filesystem::path scene;     ///< of particles or of a flow
  std::vector<std::string> sweep;  ///< "tolerance" or "tolerance=1e-2:1e-3"; empty: all that the scene has
  std::optional<double> horizon_s, statistics_s, time_limit_s;
  std::optional<std::filesystem::path> from, rheology, output;
  std::vector<int> ranks = {1};
  std::vector<std::string> neighbour, variants, overrides;
  int repeats = 1, threads = 1;
  bool effects = false;  ///< the price list of the scene's effects, in place of a sweep
  std::vector<std::filesystem::path> against;
  double seconds = 1;  ///< of --effects, simulated, from the start of the scene
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d);
};

/// The scene and the law, as they are and without any effect, as texts; the scene's effects as changes for
/// --set, by name.
nlohmann::ordered_json flow_facts(const CostOptions& options);

/// A scene of particles. Throws InputError for what is none.
class ParticleWork {
 public:
  explicit ParticleWork(const CostOptions& options);

  nlohmann::ordered_json facts() const;
  /// Reads or makes the state that all stretches begin with: the end of the run of --from, or the beginning
  /// of the last stage, up to which the scene is run; kept in `file`. Throws InputError when the run is
  /// unfinished or of other grains, walls, effects.
  void begin(const std::filesystem::path& file);
  /// Goes through a stretch of `length_s` with `solver`, `tolerance`, `step_s`: what it took after a quarter,
  /// half and all of it. With `keep` the grains at these marks stay in files of that prefix; else the marks
  /// have the differences to each of `against`, prefixes of such files, and the stretch is repeated for its
  /// time.
  nlohmann::ordered_json stretch(const nlohmann::ordered_json& wish) const;
  /// Makes `folder` one in which `drumlin run folder/scene.toml -o folder/run --resume` goes on from the
  /// state, with settings as above and `snapshots`; the steps that lie behind the state.
  nlohmann::ordered_json lay_down(const nlohmann::ordered_json& wish) const;
  /// What variant number `variant` of the scene's effects takes.
  nlohmann::ordered_json price(const nlohmann::ordered_json& wish) const;

 private:
  const CostOptions& options_;
  particles::Scene scene_;
  std::vector<particles::EffectVariant> variants_;  ///< empty: no prices are asked for
  particles::SweepStart start_;
};

}  // namespace drumlin::apps
