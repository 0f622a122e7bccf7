#pragma once
// Checks of the headers and layers of profiles.csv, each adding what it finds to a list.
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin {

/// Equal to 1e-3: the mean diameter in one file is that of the scene, in another that of the discs drawn.
bool nearly_equal(double a, double b);

/// The header says which side it is and places the frame: theta_deg, rotation, drum_radius, diameter_m and
/// position are finite numbers, and in a drum axis_depth and wall_z too.
void check_frame(const std::filesystem::path& file, const RunHeader& header, RunSide side,
                 std::vector<InputProblem>& problems);

/// The header's number agrees (near) with one that `where` names.
void require_number_near(const std::filesystem::path& file, const RunHeader& header, HeaderNumber number,
                         double expected, const std::string& where, std::vector<InputProblem>& problems);

/// Layers that lie inside the packing, wholly above the wall and below z = 0, hold finite v_x and stresses;
/// there are three of them at least. Elsewhere (in the wall, above the surface) a layer may be empty.
void check_layers(const std::filesystem::path& file, const ProfileSet& profiles,
                  std::vector<InputProblem>& problems);

}  // namespace drumlin
