#pragma once
// Contact detection: pairs of grains and walls that touch or may touch within the next step.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

struct DetectionInput {
  std::span<const Shape> shapes;      ///< at the beginning of the step
  std::span<const Pose> shape_steps;  ///< displacement of each shape over the step
  double time_step = 0;
  double margin = 0;  ///< pairs closer than this are always kept
  Period period;
};

/// All pairs with gap < margin + 2 h a + h (a_i + a_j), where a is the approach speed of the pair (0 if it
/// parts) and a_i the largest approach speed of any pair of body i: an impact on i pushes it on to neighbours
/// that it did not approach. Pairs of slow bodies (less than 0.25 d per step) are looked at within margin + 4
/// of their largest displacement. v_x and v_z are the velocities that the bodies would have without contacts.
/// The order depends on nothing but the arguments.
class ContactDetection {
 public:
  /// Lets a team share the work; the result does not depend on it.
  void use(ThreadTeam* team) { loops_ = TeamLoops(team); }
  /// The result may be reordered by the caller.
  std::vector<Candidate>& find(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
                               const DetectionInput& input);
  /// Twice the way, in the last search, by which the approach of its pairs may push a grain: 2 h a_i.
  double jolt(std::int32_t body) const { return jolt_[body]; }

 private:
  class Looking;
  /// Gaps, normals and approach of the pairs looked at from `from` on, and what it does to their bodies.
  void weigh(std::size_t from, const DetectionInput& input);
  void look_at_wall(const NearGrain& grain, std::int32_t shape, double farthest, const DetectionInput&);
  void find_near_walls(double fastest, double largest, const DetectionInput& input);
  /// Looks further around the grains that move far within the step, and around those that they hit.
  void find_near_fast_grains(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
                             const DetectionInput& input, double looked_at, double fastest, double largest);
  void keep_near_pairs(const DetectionInput& input);

  struct Pair {
    const NearGrain *a, *b;
  };
  struct Weighed {
    Candidate pair;
    double reach;  // 2 h a
  };
  TeamLoops loops_;
  GrainGrids grids_;
  std::vector<Pair> looked_at_;
  std::vector<NearGrain> fast_;  // grains around which is looked further
  std::vector<Weighed> weighed_;
  std::vector<Candidate> candidates_;
  std::vector<double> jolt_;  // 2 h a_i of each body
};

/// Gap and normal of a disc and a shape; `point` receives the point of the shape that is nearest.
double gap_to_shape(const Shape& shape, double x, double z, double radius, double& n_x, double& n_z,
                    Point& point);

/// Gap of a candidate's pair at the positions of `bodies` and `shapes`, with the normal there.
double gap_now(const Candidate& pair, const Bodies& bodies, std::span<const Shape> shapes,
               const Period& period, double& n_x, double& n_z);

}  // namespace drumlin::particles
