#pragma once
// A flow scene: what a user asks of the continuum, in SI as the keys say (docs/formats/flow.md).
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "continuum/model/flow_region.hpp"
#include "coupling/core/basics/scales.hpp"
#include "coupling/core/documents/key_lister.hpp"

namespace drumlin::continuum {

struct FlowDrum {
  double diameter_mm = 0;
  double rotation_rpm = 0;
  std::optional<double> slope_deg;  ///< absent: found
};
/// A layer on a rough plane, free at the top, endless along the slope.
struct FlowIncline {
  double height_mm = 0;
  double slope_deg = 0;
};
/// Between two rough plates without weight: the lower one at rest, the upper one dragged and pressed.
struct FlowPlaneShear {
  double gap_mm = 0;
  double wall_speed_mm_s = 0;
  double pressure_pa = 0;
};
/// Between two rough upright walls, pressed together, the weight along them.
struct FlowChute {
  double half_width_mm = 0;
  double pressure_pa = 0;
};
/// Between two rough cylinders without weight: the inner one turns, the outer one is at rest and pressed.
struct FlowAnnulus {
  double inner_radius_mm = 0;
  double outer_radius_mm = 0;
  double rotation_rpm = 0;
  double pressure_pa = 0;
};
using FlowGeometry = std::variant<FlowDrum, FlowIncline, FlowPlaneShear, FlowChute, FlowAnnulus, FlowRegion>;

/// Their sizes and density give the units; in a drum, their total area over the law's nu is the area of the
/// flow domain.
struct FlowGrains {
  std::optional<int> count;    ///< of a drum alone
  double diameter_min_mm = 0;  ///< diameters uniform between the two
  double diameter_max_mm = 0;
  double density_kg_m3 = 0;
};
struct FlowGravity {
  double acceleration_m_s2 = 9.81;
  std::optional<double> direction_deg;  ///< of a region alone, and always there
};
struct FlowMesh {
  double surface_cell = 1;   ///< d, of the finest mesh
  double surface_zone = 16;  ///< d
  double growth = 0.25;      ///< of the cell size per unit depth, on the coarsest mesh
  int levels = 2;
  double refined_share = 1;
};
struct FlowBoundary {
  double entrainment_length = 3.6;  ///< d
  double surface_stiffness = 1e4;   ///< rho0 g
};
struct FlowRegularisation {
  double shear_rate = 1e-5;  ///< 1/sqrt(d/g)
  double pressure = 0.4;     ///< rho0 g d; the uppermost layer of grains carries nu/2 in the mean
};
struct FlowSolverKeys {
  double tolerance = 1e-8;
  double linear_tolerance = 1e-6;
  int max_iterations = 40;
  bool sensitivity = false;
};
/// Takes no key: naming it is all.
struct FlowInertia {};
struct FlowRotatingFrame {};
struct FlowWallSlip {
  double friction = 0;       ///< of the wall against the grains
  double slip_speed = 1e-4;  ///< sqrt(g d)
};
/// Takes no key: the law says all.
struct FlowMemory {};
/// Fluidity that spreads: over one length (NonlocalFluidity), or over one that grows towards a threshold
/// (ThresholdFluidity).
struct FlowNonlocal {
  std::optional<double> length = {};     ///< d
  std::optional<double> amplitude = {};  ///< A, d
  std::optional<double> threshold = {};  ///< mu_s; absent: that of the law
};
/// See MovingSurface (continuum/model/flow_problem.hpp).
struct FlowMovingSurface {
  std::optional<int> degree;  ///< absent: as the finest mesh allows (drum_problem)
  double tolerance = 0.01;    ///< d
};
/// Absent unless named.
struct FlowEffects {
  std::optional<FlowInertia> inertia;
  std::optional<FlowRotatingFrame> rotating_frame;
  std::optional<FlowWallSlip> wall_slip;
  std::optional<FlowMemory> memory;
  std::optional<FlowNonlocal> nonlocal;
  std::optional<FlowMovingSurface> moving_surface;
};
/// Steps in time with inertia, by the implicit Euler method.
struct FlowTime {
  double step_s = 0;
  int steps = 0;
  double ramp_s = 0;  ///< over which the speed of rotation goes linearly from that of the start
  int every = 10;     ///< steps from kept state to kept state
};
struct FlowOutput {
  std::optional<double> slice_width;  ///< d; of a drum alone, and always there
  double layer_thickness = 1;         ///< d
  double map_spacing = 0.5;           ///< d
  bool figures = true;                ///< draws them
};

struct FlowScene {
  std::string title;
  bool reduced = false;
  FlowGeometry geometry;
  FlowGrains grains;
  FlowGravity gravity;
  FlowMesh mesh;                         ///< of no region, which has its own, as of time and output
  std::optional<FlowBoundary> boundary;  ///< of a drum alone, and always there
  FlowEffects effects;                   ///< of a drum alone
  std::optional<FlowTime> time;          ///< of a drum alone; absent: the steady flow
  FlowRegularisation regularisation;
  FlowSolverKeys solver;
  FlowOutput output;
};

/// Reads and checks. Throws InputError with every problem of the file and of the overrides.
FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
FlowScene parse_flow_scene(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides = {});
/// The scene with all its defaults as TOML.
std::string flow_scene_text(const FlowScene& scene);
std::vector<KeyRow> flow_scene_keys();

/// d = mean of the smallest and largest diameter.
Scales scales_of(const FlowScene& scene);
/// Expected total area of `count` discs, d^2.
double grain_area(const FlowGrains& grains, int count);

}  // namespace drumlin::continuum
