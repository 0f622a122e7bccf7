#include "continuum/model/scene_effects.hpp"

#include "continuum/rheology/nonlocal_law.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

/// What the scene and the law say together of a fluidity with a threshold: here a law's own numbers take the
/// place of those that the scene does not name.
struct ThresholdKeys {
  std::optional<double> amplitude, threshold;
};
ThresholdKeys threshold_keys(const FlowNonlocal& named, const RheologyFit& law) {
  ThresholdKeys keys{named.amplitude, named.threshold};
  if (law.nonlocal && !keys.amplitude) keys.amplitude = law.nonlocal->amplitude;
  if (law.nonlocal && !keys.threshold) keys.threshold = law.nonlocal->mu_s;
  return keys;
}

InputProblem nonlocal_problem(const std::string& key, const std::string& what, const std::string& allowed) {
  return {.file = "", .key = key, .what = what, .allowed = allowed};
}

// `memory`: its mu(I), a table without a threshold, takes the place of the law's.
void check_threshold(const ThresholdKeys& keys, const RheologyFit& law, bool memory,
                     std::vector<InputProblem>& problems) {
  if (!keys.amplitude)
    problems.push_back(nonlocal_problem(
        "effects.nonlocal", "says over which length nowhere",
        "with the key length or the key amplitude, or a rheology file with a table [nonlocal]"));
  if (law.k)
    problems.push_back(nonlocal_problem("effects.nonlocal",
                                        "has a threshold, and the k of the law knows of none",
                                        "a rheology file without a table [k]"));
  if (keys.amplitude && !keys.threshold && (memory || !threshold(law.mu)))
    problems.push_back(nonlocal_problem("effects.nonlocal.threshold",
                                        "is missing, and the law's mu(I) has no threshold of its own",
                                        "above 0"));
}

void check_nonlocal(const FlowEffects& effects, const RheologyFit& law, const StressLaw& mu,
                    std::vector<InputProblem>& problems) {
  if (!is_of_inertial_number(mu))
    problems.push_back(nonlocal_problem(
        "effects.nonlocal",
        "spreads the fluidity of a mu(I), and the law, " + described(law.mu) + ", depends on p besides I",
        "absent, or a rheology file with another mu.law"));
  else if (!effects.nonlocal->length)
    check_threshold(threshold_keys(*effects.nonlocal, law), law, effects.memory.has_value(), problems);
  else if (!effects.memory && !tells_fluidity(mu))
    problems.push_back(nonlocal_problem(
        "effects.nonlocal",
        "spreads the fluidity that mu determines, and the law's mu is the same at all rates "
        "or has a threshold, below which it determines none",
        "a rheology file whose mu is a logarithm or a table, or effects.nonlocal.amplitude"));
}

void check_law(const FlowEffects& effects, const RheologyFit& law, const StressLaw& mu) {
  std::vector<InputProblem> problems;
  if (effects.memory && !law.memory)
    problems.push_back({.file = "",
                        .key = "effects.memory",
                        .what = "carries the axes of past strain along, and the law has no table [memory]",
                        .allowed = "a rheology file with a table [memory]"});
  if (effects.memory && law.k)
    problems.push_back({.file = "",
                        .key = "effects.memory",
                        .what = "turns the axes of the stress, and so does the k of the law",
                        .allowed = "a rheology file without a table [k]"});
  if (effects.nonlocal) check_nonlocal(effects, law, mu, problems);
  if (effects.nonlocal && !effects.nonlocal->length && effects.memory && law.memory && law.memory->amount)
    problems.push_back(nonlocal_problem("effects.nonlocal",
                                        "has a threshold, below which the friction does not follow from I, "
                                        "and the memory of the amount adds to a friction that does",
                                        "effects.nonlocal.length, or a law without [memory.amount]"));
  if (!problems.empty()) throw InputError(problems);
}

void add_nonlocal(const FlowNonlocal& named, const RheologyFit& law, FlowProblem& problem) {
  if (named.length) {
    problem.nonlocal = NonlocalFluidity{*named.length};
    return;
  }
  const ThresholdKeys keys = threshold_keys(named, law);
  problem.threshold_fluidity = ThresholdFluidity{keys.amplitude.value(), keys.threshold};
}

}  // namespace

void add_law_and_effects(const FlowScene& scene, const RheologyFit& law, FlowProblem& problem) {
  const FlowEffects& effects = scene.effects;
  problem.law = stress_law(law);
  check_law(effects, law, problem.law);
  if (law.k) problem.turned = NonCoaxialStress{.k = StressRatioLaw(law.k->I, law.k->k)};
  if (effects.nonlocal) add_nonlocal(*effects.nonlocal, law, problem);
  if (effects.memory) problem.memory.emplace(*law.memory);
  if (effects.inertia) problem.inertia = Inertia{};
}

void refuse_effects_of_the_drum(const FlowEffects& effects) {
  std::vector<InputProblem> problems;
  const auto refuse = [&](bool named, const char* key) {
    if (named)
      problems.push_back(
          {.file = "", .key = key, .what = "belongs to a drum", .allowed = "absent without [drum]"});
  };
  refuse(effects.rotating_frame.has_value(), "effects.rotating_frame");
  refuse(effects.wall_slip.has_value(), "effects.wall_slip");
  refuse(effects.moving_surface.has_value(), "effects.moving_surface");
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace drumlin::continuum
