#pragma once
// The physics of a scene alone: what two runs must share to be compared.
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// The scene without what does not change what is computed: title, seed, solver, output, time steps, lengths
/// of stages and their snapshots.
Scene physics_of(Scene scene);

}  // namespace drumlin::particles
