#pragma once
// A simulation that its caller steps, looks at and changes between steps.
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// Its setters hold from the next step on, as the same key of a stage would, and refuse with InputError what
/// a scene file could not say. Not for several threads at once.
class SteppedScene {
 public:
  /// `scene`: what the simulation was made of, as a file tells it.
  SteppedScene(Scene scene, std::unique_ptr<Simulation> simulation)
      : scene_(std::move(scene)), simulation_(std::move(simulation)) {}

  /// One step. Throws NotConvergedError as checked_step() does, again and again: such a step must not be
  /// built upon; InputError at the end of the scene.
  StepReport step();

  void set_friction(double grain_grain, double grain_wall);
  /// Gravity along x and z, in units of g.
  void set_gravity(double x, double z);
  /// The wall moves on with a velocity and, clockwise, a rotation about a point, both of this moment.
  void set_wall(const std::string& wall, std::array<double, 2> velocity, double spin,
                std::array<double, 2> center);
  /// Of a cell that is periodic in x and z and that the stage shears.
  void set_shear_rate(double rate);

  const Scene& scene() const { return scene_; }  ///< with what setters changed
  const Simulation& simulation() const { return *simulation_; }
  Simulation& simulation() { return *simulation_; }

 private:
  /// Changes the stage of the next step as a scene file could, whose checks it passes.
  void change_stage(const std::function<void(Stage&)>& change, const std::string& moved = "");

  Scene scene_;
  std::unique_ptr<Simulation> simulation_;
  std::string fault_;  ///< of a step that must not be built upon
};

}  // namespace drumlin::particles
