#pragma once
// walls.csv of a run: loads on walls as means over intervals, in SI (docs/formats/run.md).
#include <string>

#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

inline constexpr const char* wall_table_name = "walls.csv";
inline constexpr const char* wall_table_header =
    "time_s,interval_s,wall,force_x_n_m,force_z_n_m,torque_n,x_mm,z_mm,angle_deg,v_x_mm_s,v_z_mm_s,spin_rad_"
    "s\n";

/// A line for each wall that was there, of the interval that is over.
std::string wall_lines(particles::Simulation& simulation);

}  // namespace drumlin::apps
