#pragma once
// Frames: fields, surface and loads of a flow at given times, on one grid, of one run or of several side by
// side (docs/formats/frames.md).
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/kernel_nodes.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "coupling/core/results/run_header.hpp"

namespace drumlin {

/// One run at one instant. Names: docs/formats/frames.md.
struct Frame {
  /// Of each column, d: of the surface, NaN where there is none; area in the column over its width and
  /// nu_bulk.
  std::vector<double> height, mass_height;
  std::map<std::string, std::vector<double>> fields;  ///< one value per node, row after row
  std::map<std::string, double> scalars;
  std::map<std::string, std::array<double, 2>> loads;  ///< x, z
};

struct Frames {
  MapGrid grid;  ///< axes of the scene
  RunHeader header;
  Scales scales;
  double time_origin_s = 0;       ///< time of the scene at which times are 0
  double nu_bulk = 0;             ///< of the fill at the origin
  std::vector<std::string> runs;  ///< a continuum is one
  std::vector<double> times;      ///< sqrt(d/g)
  std::vector<Frame> frames;      ///< all times of the first run, then those of the next one
};

/// What keeps frames from being written, in words; empty when nothing does.
std::string fault_of(const Frames& frames);

/// What the fields of frames are made of at a node: volume fraction, mean velocity with its gradient, and
/// stress, compression positive.
struct NodeFlow {
  double nu = 0, v_x = 0, v_z = 0;
  PlaneMatrix gradient, pressure;
};
/// Sets fields and height of a frame by what there is at each node: NaN where nu is less than least_map_nu,
/// and the height at half of nu_bulk.
void set_fields(const MapGrid& grid, double nu_bulk, const std::function<NodeFlow(std::size_t node)>& flow_at,
                Frame& frame);

/// A piece of a continuum: a point of its quadrature.
struct MaterialPiece {
  double x = 0, z = 0, area = 0;
  NodeFlow flow;  ///< its gradient is not asked for
};

/// A continuum under the kernel of coarse graining, as grains are: sums of pieces at the nodes of a grid, and
/// no correction at walls, where nu falls to half of what it is inside.
class SmoothedFlow {
 public:
  /// `grid` lives as long as this.
  SmoothedFlow(const MapGrid& grid, double width) : grid_(grid), kernel_(grid, width), nodes_(grid.nodes()) {}
  void add(const MaterialPiece& piece);
  /// Fields, and height at half of nu_bulk. The stress has that of the velocities' spread under the kernel,
  /// as that of grains has.
  Frame frame(double nu_bulk) const;

 private:
  struct Node {
    KernelSums<3> carried;  ///< of the mass and its velocity
    PlaneMatrix pressure;   ///< with nu v v
  };
  const MapGrid& grid_;
  KernelNodes kernel_;
  std::vector<Node> nodes_;
};

}  // namespace drumlin
