#pragma once
// Drag of what surrounds the grains, a fluid or a glass plate on which they lie: a force against the velocity
// and a couple against the spin, each proportional to it. Exact in free motion, for any time step.
#include <optional>

#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/effects/law_input.hpp"

namespace drumlin::particles {

/// What the force grows with from disc to disc.
enum class DragOver { mass, diameter };
constexpr auto names_of(DragOver) { return std::array{"mass", "diameter"}; }

struct Drag {
  static constexpr const char *name = "drag", *sentence = "Force against velocity, couple against spin.";
  static constexpr const char *modest_text = "1 / s", *account = "drag";
  static Drag modest() { return {1}; }
  void check(const auto& scene, auto refuse) const {
    if (moves_cell(scene))
      refuse("holds grains back against a frame in which a moving cell flows", "without stages.cell",
             "stages");
  }

  double rate_per_s = 0;
  std::optional<double> spin_rate_per_s = {};
  DragOver grows_with = DragOver::mass;
};

template <class Visitor>
void describe(Visitor& v, Drag& d) {
  v.value("rate_per_s", d.rate_per_s,
          required("1/s", above(0, 1e9), "The velocity of a mean disc decays as exp(-rate t)."));
  v.value("spin_rate_per_s", d.spin_rate_per_s,
          when_given("1/s", at_least(0, 1e9), "The same of its spin; without: rate_per_s."));
  v.value("grows_with", d.grows_with,
          defaulted("", one_of<DragOver>(),
                    "The force from disc to disc: as under a plate, or as in a viscous fluid."));
}

/// The law m dv/dt = F - rate m v. A force F that is constant within a step h makes of v
///   exp(-rate h) v + (1 - exp(-rate h)) / (rate h) h F / m:
/// gravity, attractions and contacts act through a mass that is larger by the second factor's inverse.
struct DragLaw {
  double rate = 0, spin_rate = 0;  ///< of a disc of the mean diameter
  bool with_diameter = false;
  static constexpr bool changes_inertia = true;

  /// What a disc's rates are in those of the mean one: 1, or diameter over mass.
  double share(const Bodies& bodies, std::size_t b) const;
  void move_freely(const Bodies&, std::size_t begin, std::size_t end, double time_step, FreeMotion&) const;
  void turn_freely(Bodies&, double time_step) const;
  double work(const Bodies& before, const Bodies& now, double time_step) const;
};
DragLaw law_of(const Drag&, const LawInput&);

}  // namespace drumlin::particles
