#pragma once
// Snapshots of spheres, which imports leave: as a slab that is seen along one of its axes
// (docs/formats/spheres.md).
#include <array>
#include <filesystem>
#include <optional>

#include "particles/bodies/snapshot.hpp"

namespace drumlin::particles {

/// The axis along which spheres are seen. With it x and z of the view are x and z (y), y and z (x), x and y
/// (z) of the file.
enum class SeenAlong { x, y, z };
constexpr auto names_of(SeenAlong) { return std::array{"x", "y", "z"}; }

struct SphereView {
  SeenAlong along = SeenAlong::y;
  std::optional<std::array<double, 2>> slab = {};  ///< along that axis, d; absent: all of it
};

/// Whether a snapshot is one of spheres.
bool holds_spheres(const std::filesystem::path& snapshot);

/// Per depth of the slab: the period along the axis, or the extent of the grains. A grain is in a slab with
/// its centre. Throws InputError as read_snapshot(), and where there is a period along the height of the
/// view.
Snapshot read_spheres(const std::filesystem::path& snapshot, const SphereView& view);

}  // namespace drumlin::particles
