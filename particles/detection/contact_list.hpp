#pragma once
// Contact detection: pairs of grains and walls that touch or may touch within the next step.
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/shape_step.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/detection/cell_grid.hpp"
#include "particles/detection/grain_pairs.hpp"
#include "particles/parallel/parallel_loops.hpp"

namespace drumlin::particles {

struct DetectionInput {
  std::span<const Shape> shapes;           ///< at the beginning of the step
  std::span<const ShapeStep> shape_steps;  ///< of each shape
  double time_step = 0;
  double margin = 0;  ///< pairs closer than this are always kept
  Period period;
};

/// A grain that impacts have hit harder than a search allowed for: 2 h |change of velocity|.
struct CollidedDisc {
  std::int32_t grain = 0;
  double displacement = 0;
};

/// All pairs with gap < margin + 2 h a + h (a_i + a_j), where a is the approach speed of the pair (0 if it
/// parts) and a_i the largest approach speed of body i in any pair with gap < margin + 2 h a: an impact on i
/// pushes it on to neighbours that it did not approach. v_x and v_z are the velocities that the bodies would
/// have without contacts. The cost grows with the number of bodies and of such pairs, not with the space that
/// the bodies take nor with a motion that neighbours have in common. In the order of (i, j).
///
/// A search may use the cells and the list of near pairs of earlier ones again, where grains have moved
/// little against their neighbours since. That changes its cost, never what it finds.
class ContactDetection {
 public:
  /// Lets a pool share the work; the result does not depend on it.
  void use(ThreadPool* pool) { loops_ = ParallelLoops(pool), pairs_.use(pool); }
  /// Takes the candidates, and what finds them, from a memory: they end with the scope in which they were
  /// found.
  void use(WorkMemory* memory) { grids_.use(memory), pairs_.use(memory), candidates_.use(memory); }
  /// The pairs stand until the next search.
  std::span<const Candidate> find(const Bodies& bodies, std::span<const double> v_x,
                                  std::span<const double> v_z, const DetectionInput& input);

  /// Adds the pairs that hit grains may meet, now that v_x and v_z are the velocities: with a wall those
  /// with gap < margin + 2 h a + J_i / 2, with another grain k
  ///   gap < 2 margin + 2 h a + J_i / 2 + displacement_bound(k),
  /// J_i the displacement of the hit grain i, which becomes its bound. So all pairs are found that close
  /// within the step, if no grain is hit harder than (bound + margin) / (2 h) again. Looks around these
  /// grains only, at the positions of the last search; at all grains where that would be most of them, and
  /// then keeps the pairs found before.
  /// Returns whether the candidates are others than before.
  bool find_around(std::span<const CollidedDisc> collided, const Bodies& bodies, std::span<const double> v_x,
                   std::span<const double> v_z, const DetectionInput& input);
  std::span<const Candidate> candidates() const { return {candidates_.data(), candidates_.size()}; }
  /// Positions among the candidates, ascending, of the pairs that the last search around hit grains has
  /// added; empty where it had to begin anew.
  std::span<const std::int32_t> added() const { return added_; }

  /// The next search begins anew, as the first one.
  void forget() { lists_ = {}; }
  /// Distances between grains that the last search of all measured: what it cost.
  std::int64_t distances() const { return pairs_.distances(); }
  /// Pairs that the list holds from one search to the next, and what that takes.
  std::span<const ListedPair> listed_pairs() const { return pairs_.listed_pairs(); }
  /// All pairs with smaller gaps are among them, whatever the age of the list.
  double listed_within() const { return listed_within_; }
  std::size_t listed() const { return listed_pairs().size(); }
  std::size_t bytes() const { return pairs_.bytes() + grids_.bytes(); }
  /// Twice the displacement, in the last search, that the approach of its pairs may give a grain: 2 h a_i.
  double displacement_bound(std::int32_t body) const { return bounds_[body]; }

 private:
  void weigh_at_wall(const NearGrain& grain, std::int32_t shape, double farthest, const DetectionInput&);
  void find_near_walls(double fastest, double largest, const DetectionInput& input);

  /// Whether searches around the hit grains alone, as far as `reach`, look at fewer grains than there
  /// are.
  bool is_local(std::span<const CollidedDisc> collided, double reach) const;
  void add_around(const CollidedDisc&, double range, const Bodies& bodies, std::span<const double> v_x,
                  std::span<const double> v_z, const DetectionInput& input);
  bool insert_found();
  static void add_image_velocities(const Bodies& bodies, const Period& period, std::span<Candidate>);

  /// Whether lists of near pairs are used again.
  struct Lists {
    double skin = 0;     ///< of the list, beyond what its own search asked for; 0: it is used once
    int used_again = 0;  ///< the list, so many times
    int once = 1;        ///< so many more lists are made to be used once
    bool good = false;   ///< the next search may use the list
  };
  void list_pairs(const SearchedState& state, const PairRule& rule, double range, double smallest);

  ParallelLoops loops_;
  GrainGrids grids_;
  GrainPairs pairs_;
  Lists lists_;
  double listed_within_ = 0;
  double cell_ = 0;                   // edge of the cells of the finest grid of a list that is used once
  std::vector<WeighedPair> weighed_;  // of grains and walls
  std::vector<double> bounds_;        // 2 h a_i of each body
  WorkArray<Candidate> candidates_;
  std::vector<Candidate> found_;     // around hit grains
  std::vector<std::int32_t> added_;  // positions of those of them that were new
};

/// Unit vector of (dx, dz), upwards for coincident points; returns the length.
inline double normal_of(double dx, double dz, double& n_x, double& n_z) {
  const double distance = std::sqrt(dx * dx + dz * dz);
  n_x = distance > 0 ? dx / distance : 0;
  n_z = distance > 0 ? dz / distance : 1;
  return distance;
}

/// Gap of a thin wall to a disc beside the wall that goes on from it, outside a concave joint: infinite
/// where pairs are looked for, since the other wall has its own pair; that of the other wall's line on the
/// path of a disc that comes there within a step, for which no search has found that pair.
enum class BesideNext { infinite, line };

/// Gap and normal of a disc and a shape; `point` receives the point of the shape that is nearest.
double gap_to_shape(const Shape& shape, double x, double z, double radius, double& n_x, double& n_z,
                    Point& point, BesideNext beside_next = BesideNext::infinite);

/// Gap of a candidate's pair at the positions of `bodies` and `shapes`, with the normal there.
double gap_now(const Candidate& pair, const Bodies& bodies, std::span<const Shape> shapes,
               const Period& period, double& n_x, double& n_z);

}  // namespace drumlin::particles
