#pragma once
// The walls that a scene asks for, in the units of the simulation.
#include <span>
#include <vector>

#include "particles/bodies/walls.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// The lines of a polyline, the one that closes it last.
std::vector<SegmentShape> segments_of(const PolylineShape&);
/// Length of the line on which discs can be glued; 0 for a polyline or an arc.
double wall_length_mm(const Wall& wall);
/// Centres of the discs glued to a wall, in mm: evenly round a container or a disc, or along a segment with
/// half a spacing free at either end, so that a segment as long as the period closes on itself. Empty for a
/// smooth wall.
std::vector<Point_mm> glued_centers_mm(const Wall& wall);

/// Dimensionless walls of a scene, at rest.
Walls walls_of(const Scene&, const Scales&);
/// Begins a stage: poses are carried over from `time_in_old_stage`,
/// motions are replaced by those of `stage`. `driven`: states of the walls that the old stage drove. Returns
/// those of the new stage: a wall that it drives starts with what velocity it has along the new direction, if
/// it was driven or glided.
std::vector<DrivenState> begin_stage(Walls&, const Stage& stage, const Scales&, double time_in_old_stage,
                                     std::span<const DrivenState> driven = {});

}  // namespace drumlin::particles
