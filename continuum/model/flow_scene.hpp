#pragma once
// What a user asks of the continuum: a drum, in SI as the keys say (docs/formats/flow.md).
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/exchange/key_lister.hpp"
#include "coupling/exchange/scales.hpp"

namespace drumlin {

struct FlowDrum {
  double diameter_mm = 0;
  double rotation_rpm = 0;
};
/// The grains that fill the drum: their total area over the law's nu is the area of the flow domain.
struct FlowGrains {
  int count = 0;
  double diameter_min_mm = 0;  ///< diameters uniform between the two
  double diameter_max_mm = 0;
  double density_kg_m3 = 0;
};
struct FlowGravity {
  double acceleration_m_s2 = 9.81;
};
struct FlowMesh {
  double surface_cell = 1;   ///< d, of the finest mesh
  double surface_zone = 16;  ///< d
  double growth = 0.25;      ///< of the cell size per unit depth, on the coarsest mesh
  int levels = 2;
};
struct FlowBoundary {
  double corner_taper = 4;         ///< d
  double surface_stiffness = 1e4;  ///< rho0 g
};
struct FlowRegularisation {
  double shear_rate = 1e-5;  ///< 1/sqrt(d/g)
  double pressure = 0.4;     ///< rho0 g d; the uppermost layer of grains carries nu/2 in the mean
};
struct FlowSolverKeys {
  double tolerance = 1e-8;
  double linear_tolerance = 1e-6;
  int max_iterations = 40;
};
struct FlowOutput {
  double slice_width = 20;     ///< d
  double layer_thickness = 1;  ///< d
  double map_spacing = 0.5;    ///< d
};

struct FlowScene {
  std::string title;
  bool reduced = false;
  FlowDrum drum;
  FlowGrains grains;
  FlowGravity gravity;
  FlowMesh mesh;
  FlowBoundary boundary;
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
/// Expected total area of the discs, d^2.
double grain_area(const FlowGrains& grains);

}  // namespace drumlin
