#pragma once
// A flowing drum that another engine and ours compute in turn: processor time and overlaps of each, and the
// ratio of the times, in one record.
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drumlin::benchmark {

/// What an engine is given: a state of the flow and the laws of the scene. SI, laboratory frame, z up, spins
/// positive clockwise, centre of the drum at the origin.
struct FlowingDrum {
  struct Grain {
    double x, z, v_x, v_z, spin, radius;
  };
  std::vector<Grain> grains;
  double diameter = 0;  ///< mean of the grains
  double radius = 0, spin = 0;
  double time_step = 0;
  double gravity_x = 0, gravity_z = 0;
  double friction_grains = 0, friction_drum = 0;
  double restitution_grains = 0, restitution_drum = 0;
  double resting_speed = 0;  ///< 2 g h: a slower approach is that of a lasting contact, without restitution
};

/// What the looks at an engine between its steps have seen.
struct Looks {
  double overlap_sum = 0, overlap_max = 0;  ///< mean diameters
  double contacts = 0;                      ///< that carry an impulse
  double slopes = 0;                        ///< sum of the angles of the centre of mass, degrees
  double count = 0;

  void add_contact(double overlap) {
    overlap = std::max(0.0, overlap);
    overlap_sum += overlap, overlap_max = std::max(overlap_max, overlap), ++contacts;
  }
  /// (x, z): centre of mass, in any unit of length.
  void add_look(double x, double z);
};

class DrumEngine {
 public:
  virtual ~DrumEngine() = default;
  virtual void step() = 0;  ///< only this is timed
  virtual void look(Looks& looks) const = 0;
};

/// Numbers that an engine can be given, by name, with their usual values.
using EngineSettings = std::map<std::string, double>;

/// The engine that ours is compared with.
struct OtherEngine {
  std::string name;
  std::string version;
  EngineSettings settings;
  std::function<std::unique_ptr<DrumEngine>(const FlowingDrum&, const EngineSettings&)> make;
};

/// Lengths that engines made for bodies of 0.1 to 10 units are given: 1000 units to the metre.
constexpr double units_per_metre = 1000;
constexpr int drum_edges = 360;  // they leave the circle by R (1 - cos(pi/360)): 0.26 % of a grain at 450 mm

/// Corner k of the polygon that stands for the drum, clockwise, for a circle of radius 1.
struct Corner {
  double x, z;
};
Corner drum_corner(int k);

/// A whole program: PROGRAM SCENE.toml SNAPSHOT.h5 RESULT.json [NAME=VALUE ...]. Both engines start from the
/// snapshot of `drumlin run` of the scene, in its last stage; after `skip` simulated seconds each takes
/// `repeats` stretches of `seconds`, in turn. `ours=0` leaves ours out. Other names are settings of the
/// engine. Returns the exit code.
int race_drums(int argc, char** argv, const OtherEngine& other);

}  // namespace drumlin::benchmark
