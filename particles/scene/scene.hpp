#pragma once
// Scene: what a user asks for, in SI as the keys say. Nothing here knows how it is solved.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "particles/effects/driven_walls.hpp"
#include "particles/effects/effects.hpp"
#include "particles/scene/generated_grains.hpp"
#include "particles/scene/stage.hpp"
#include "particles/scene/traffic.hpp"

namespace drumlin::particles {

/// Periodic in x between two abscissae; a scene without it is open.
struct PeriodicX {
  double x_min_mm = 0;
  double x_max_mm = 0;
};

/// Periodic in z too, between two heights: a cell without walls.
struct PeriodicZ {
  double z_min_mm = 0;
  double z_max_mm = 0;
};

/// Grains listed in a CSV file: x_mm, z_mm, diameter_mm and optionally v_x_mm_s, v_z_mm_s, spin_rad_s,
/// density_kg_m3; in a scene with materials also the name of each grain's material. read_scene makes the path
/// absolute: in the file it counts from the folder of the scene.
struct ListedGrains {
  std::filesystem::path file;
  /// No key: the list itself where it is not read from the file. Copies of a scene share it.
  std::shared_ptr<const std::string> text = {};
};

/// The grains of a snapshot of another run, as they stand and move in it; in the run folder they stand as a
/// list.
struct GrainsOfRun {
  std::filesystem::path run;
  std::optional<double> time_s = {};  ///< of the snapshot; without, the last one
};

/// Grains beside those of the scene's main source, generated or listed.
struct GrainGroup {
  std::string name;
  std::optional<std::string> material = {};
  std::optional<double> density_kg_m3 = {};  ///< without, that of the scene
  std::variant<GeneratedGrains, ListedGrains> source;
};

/// A material of grains, for laws that differ from pair to pair.
struct GrainMaterial {
  std::string name;
  double share = 1;  ///< of the generated grains, by number, relative to the other shares
};

struct Grains {
  double density_kg_m3 = 0;
  std::vector<GrainMaterial> materials = {};
  std::variant<GeneratedGrains, ListedGrains, GrainsOfRun> source;
  std::optional<double> thermal_speed_mm_s = {};  ///< of random velocities at the start (thermal.hpp)
  std::vector<GrainGroup> groups = {};            ///< behind those of the source
};

/// Circular container, the grains inside it.
struct ContainerShape {
  Point_mm center_mm{0, 0};
  double radius_mm = 0;
};
/// Straight wall between two points, solid on both sides.
struct SegmentShape {
  Point_mm from_mm{0, 0};
  Point_mm to_mm{0, 0};
};
/// Disc that is part of a wall.
struct DiscShape {
  Point_mm center_mm{0, 0};
  double diameter_mm = 0;
};

/// Straight lines from point to point: one wall without gaps at its corners.
struct PolylineShape {
  std::vector<double> x_mm, z_mm;
  std::optional<bool> closed = {};  ///< true: a line leads from the last point back to the first
};

/// Piece of a circle, solid on both sides.
struct ArcShape {
  Point_mm center_mm{0, 0};
  double radius_mm = 0;
  double from_deg = 0, to_deg = 0;  ///< counter-clockwise from x
};

/// Discs glued along a container, a segment or a disc, their centres on it.
struct Roughness {
  double diameter_mm = 0;
  double spacing_mm = 0;  ///< of the centres along the wall; shortened so that a whole number of discs fits
};

/// A wall; several shapes of one name move together.
struct Wall {
  std::string name;
  std::variant<ContainerShape, SegmentShape, DiscShape, PolylineShape, ArcShape> shape;
  std::optional<std::string> material = {};  ///< for laws that differ from pair to pair
  std::optional<Roughness> rough = {};
  std::optional<std::vector<std::string>> acts_on = {};  ///< materials of the grains that it meets
};

/// Contact solver and when it may stop. Tolerances in the project's one definition (docs/conventions.md).
struct SolverSettings {
  std::string name = "accelerated";
  double tolerance = 1e-2;                      ///< of `residual`
  double penetration_tolerance = 1e-3;          ///< of `penetration` and `sinking`, in d
  int max_sweeps = 5000;                        ///< a column of 1000 discs takes some 1000 a step
  int check_every = 10;                         ///< sweeps between two evaluations of the residual
  int projection_sweeps = 20;                   ///< at most; 0: no position projection
  std::optional<double> projection_share = {};  ///< of an overlap that a step takes off; absent: 0.2
  bool stop_when_unconverged = false;  ///< end with exit code 3 at the first step that misses the tolerance
  int capture_unconverged = 0;         ///< so many steps that miss it leave their contact problem as a file
};

struct Output {
  double velocity_window_s = 6e-3;  ///< displacement over this window is stored with each snapshot; 0: none
  int log_every_steps = 1;
  double checkpoint_every_s = 1.0;           ///< simulated time
  bool energy_ledger = false;                ///< where energy comes from and goes to, in energy.csv
  std::optional<double> walls_every_s = {};  ///< loads on walls as means over such intervals, in walls.csv
};

struct Scene {
  std::string title;
  bool reduced = false;  ///< says "reduced" on every output
  std::uint64_t seed = 1;
  std::optional<PeriodicX> periodic_x;
  Grains grains;
  std::vector<Wall> walls;
  Effects effects;
  std::vector<Stage> stages;
  SolverSettings solver;
  Output output;
  std::vector<Outlet> outlets = {};
  std::vector<Source> sources = {};
  std::optional<PeriodicZ> periodic_z = {};
};

/// Whether has(stage) is true of some stage.
template <class Has>
bool any_stage(const Scene& scene, Has has) {
  return std::any_of(scene.stages.begin(), scene.stages.end(), has);
}
/// Whether a force or a pressure moves a wall in some stage.
bool moves_walls_by_force(const Scene& scene);
/// Whether some stage ends when something has happened, so that the times of the stages are results.
bool ends_stages_early(const Scene& scene);
/// Whether some stage opens a wall.
bool opens_walls(const Scene& scene);
/// Whether some stage has a gravity of its own.
bool changes_gravity(const Scene& scene);
/// Whether a stage has values of its own for an effect.
bool changes_coefficients(const Stage& stage);
/// Whether the cell moves in some stage, and whether a pressure moves it there.
bool moves_cell(const Scene& scene);
bool presses_cell(const Scene& scene);
/// Whether the number of grains can change: the scene has outlets or sources.
bool changes_grains(const Scene& scene);
/// The lists of grains that a scene names: of its main source, if it is one, and of its groups.
std::vector<ListedGrains*> lists_of(Scene& scene);

}  // namespace drumlin::particles
