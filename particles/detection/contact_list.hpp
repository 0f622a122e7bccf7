#pragma once
// Which grains and walls touch or may touch within the next step.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/detection/cell_grid.hpp"

namespace drumlin {

/// A pair that may touch. The unit normal points from j to i.
struct Candidate {
  std::int32_t i = 0;  ///< grain
  std::int32_t j = 0;  ///< grain with j > i, or -1 - s for wall shape s
  double gap = 0;      ///< distance of the surfaces, negative when they overlap
  double n_x = 0, n_z = 0;
  double wall_v_x = 0,
         wall_v_z = 0;  ///< displacement of the wall's material point over the step / step; 0 between grains
};

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
/// Sorted by (i, j): the order depends on nothing but the state.
class ContactDetection {
 public:
  const std::vector<Candidate>& find(const Bodies& bodies, std::span<const double> v_x,
                                     std::span<const double> v_z, const DetectionInput& input);

 private:
  struct Velocities {
    std::span<const double> x, z;
  };
  void keep_if_near(std::int32_t i, std::int32_t j, const Bodies&, const Velocities&, const DetectionInput&);
  void keep_if_near_wall(std::int32_t b, std::int32_t shape, double farthest, const Bodies&,
                         const Velocities&, const DetectionInput&);

  /// Keeps a pair for the moment, and what its approach does to its bodies.
  void note(const Candidate& pair, double approach, const DetectionInput& input);
  void drop_far_pairs(const DetectionInput& input);
  /// Looks further around the bodies that fast ones hit.
  void push_on_fast_impacts(const Bodies& bodies, const Velocities& v, const DetectionInput& input,
                            double looked_at, double largest);

  CellGrid grid_;
  double range_ = 0;  // pairs with a larger gap are not looked at
  std::vector<Candidate> candidates_;
  std::vector<double> reach_;       // 2 h a of each candidate
  std::vector<double> jolt_;        // 2 h a_i of each body
  std::vector<std::int32_t> fast_;  // grains that move far within one step
};

/// Gap and normal of a disc and a shape; `point` receives the point of the shape that is nearest.
double gap_to_shape(const Shape& shape, double x, double z, double radius, double& n_x, double& n_z,
                    Point& point);

/// Gap of a candidate's pair at the positions of `bodies` and `shapes`, with the normal there.
double gap_now(const Candidate& pair, const Bodies& bodies, std::span<const Shape> shapes,
               const Period& period, double& n_x, double& n_z);

}  // namespace drumlin
