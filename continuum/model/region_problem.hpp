#pragma once
// A flow scene of a region, with its law, in the units of its grains.
#include <vector>

#include "continuum/model/flow_scene.hpp"
#include "continuum/model/region.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::continuum {

/// Walls and openings in the order of the scene, walls first; and the fill.
Region region_of(const FlowScene& scene);

/// The nodes of a grid along one axis.
struct FrameAxis {
  double from = 0, to = 0;  ///< nodes from `from` on, the last one at most half a spacing beyond `to`
};

/// All that the flow of a region is computed from: units d, sqrt(d/g), rho0 g d.
struct RegionFlow {
  Region region;
  StressLaw law;
  double nu = 0;
  Vec2 gravity;  ///< unit vector
  Regularisation regularisation;
  double cell = 0;       ///< largest, d
  double slot_cell = 0;  ///< largest at an opening
  double step = 0;       ///< largest
  double end = 0;
  std::vector<double> frames;  ///< times, ascending
  double spacing = 0;          ///< of the frames' grid
  FrameAxis x, z;
};

/// Throws InputError for a law with a part that a region does not take: k.
RegionFlow region_flow(const FlowScene& scene, const RheologyFit& law);

}  // namespace drumlin::continuum
