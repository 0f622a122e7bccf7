#pragma once
// Frames of particle runs: what they are at given times, in the axes of the scene, one run beside the other
// (docs/formats/frames.md).
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/core/results/frames.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// A run of an open scene, its snapshots fetched one by one.
struct FrameRun {
  std::string name;
  std::vector<double> times;  ///< of its snapshots, ascending, sqrt(d/g)
  std::function<Snapshot(std::size_t)> read;
  std::vector<std::string> walls;
  std::vector<int> wall_of_shape;
  std::function<std::vector<Shape>(const Snapshot&)> shapes_at;
};

struct FrameOptions {
  double origin = 0;                                    ///< time of the scene, sqrt(d/g)
  std::vector<double> times;                            ///< since the origin, ascending
  double spacing = 1, width = 1;                        ///< of nodes and kernel, d
  std::optional<std::array<double, 2>> x = {}, z = {};  ///< of the nodes, d; else of all grains
  std::optional<double> nu_bulk = {};                   ///< else of the fill at the origin
};

/// The snapshot next to a time; nothing if it is further away than half of the time to its own neighbour.
std::optional<std::size_t> next_snapshot(std::span<const double> times, double time);

/// Mean volume fraction at the nodes that lie deeper than 3 d in a packing; NaN without any.
double bulk_nu(const Snapshot& snapshot, double spacing, double width);

/// All but the header beyond kernel, kernel_width and snapshot_distance (the greatest one, sqrt(d/g)).
/// `progress` is told the snapshots read so far and in all. Throws InputError where a run has no snapshot
/// next to a time, or nothing tells nu_bulk.
Frames frames_of(std::span<const FrameRun> runs, const FrameOptions& options,
                 const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace drumlin::particles
