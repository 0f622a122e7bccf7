#pragma once
// For every key of a scene file: a scene, another value of the key, and what it changes in a tiny run.
#include <string>
#include <vector>

#include "tests/scene/every_key_runs.hpp"

namespace drumlin::testing {

struct Case {
  std::string path;       ///< as listed
  std::string condition;  ///< as listed
  const std::string* scene;
  std::vector<std::string> common;  ///< overrides of both runs
  std::string change;               ///< one more override
  Observable seen;
};

/// A dozen grains in a drum that first rests, then turns; every effect.
const std::string& drum_scene();
/// Eight grains without friction that fall beside two knobs on a floor.
const std::string& floor_scene();

/// Overrides that cases of several parts make.
inline const std::string sliding = "effects.gravity.direction_deg=-45";
inline const std::string pairs = ".pairs=[{between=[\"a\", \"b\"], value=0.05}]";
/// Two materials among the grains, the wall of one of them.
inline const std::vector<std::string> materials = {"grains.materials=[{name=\"a\"}, {name=\"b\"}]",
                                                   "walls.0.material=b"};
/// `all` and one more.
inline std::vector<std::string> with(std::vector<std::string> all, const std::string& one) {
  all.push_back(one);
  return all;
}

/// One per key that exists, by the part of the scene that the keys belong to.
std::vector<Case> cases_of_the_run();  ///< format, title, seed, solver, output
std::vector<Case> cases_of_grains();   ///< periodic_x, grains
std::vector<Case> cases_of_walls();
std::vector<Case> cases_of_effects();
std::vector<Case> cases_of_stages();
std::vector<Case> cases_of_stage_changes();  ///< opened walls, gravity, coefficients, ends
std::vector<Case> cases_of_servo_walls();    ///< and other keys that came with them
std::vector<Case> cases_of_cell();           ///< periodic_z, how stages move the cell
std::vector<Case> cases_of_traffic();        ///< outlets, sources, groups, grains of other runs

}  // namespace drumlin::testing
