#pragma once
// Balance of momentum and fit of mu(I) over the whole of a map.
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "coupling/common/scratch_file.hpp"
#include "coupling/exchange/field_map.hpp"

namespace drumlin::particles {

/// Where the packing ends, in the coordinates of the map.
struct MapBounds {
  double container_radius = 0;  ///< 0: none
  double axis_z = 0;            ///< of the container
  /// Without a container: floor and sides; infinite where there is none.
  double x_min = -std::numeric_limits<double>::infinity();
  double x_max = std::numeric_limits<double>::infinity();
  double z_min = -std::numeric_limits<double>::infinity();
};

struct MapFindingOptions {
  double margin = 3;                  ///< d that the bulk keeps from the wall and from the surface above it
  double surface_nu = 0.7;            ///< of the surface, column by column
  double flowing_I = 1e-2;            ///< I from which a node counts as flowing
  double block = 10;                  ///< d, side of the squares over which the residual is averaged
  double I_min = 1e-4, I_max = 1e-1;  ///< of the fits of mu(I)
};

/// Nodes of the map in the bulk.
std::vector<std::size_t> bulk_nodes(const FieldMap& map, const MapBounds& bounds,
                                    const MapFindingOptions& options);

/// The fields that are read below.
struct FindingField {
  const char* name;
  bool with_intervals;
};
std::span<const FindingField> fields_of_findings();

/// What is missing in the balance of momentum over some nodes, in units of nu g.
struct BalanceResidual {
  std::size_t nodes = 0;
  double rms_x = 0, rms_z = 0;
  double mean_x = 0, mean_z = 0;
  double noise_x = 0, noise_z = 0;              ///< rms of the residual's standard error; NaN without batches
  double rms_x_blocks = 0, rms_z_blocks = 0;    ///< of the means over squares; NaN when no square is full
  double rms_x_contact = 0, rms_z_contact = 0;  ///< with the kinetic stress left out
  double inertia = 0;                           ///< rms of nu v.grad v of the mean velocity, both components
};

struct MomentumBalance {
  BalanceResidual bulk, flowing, slow;  ///< slow: the bulk that does not flow
};
/// `batches`: behind the map's intervals. Squares stand side by side from x = z = 0 on and count when three
/// quarters of their nodes belong to the zone.
MomentumBalance momentum_balance(const FieldMap& map, const MapBounds& bounds,
                                 const MapFindingOptions& options, std::size_t batches);

/// Straight line through y over ln I, every node with the same weight.
struct LogLine {
  double a = std::numeric_limits<double>::quiet_NaN(), b = a, rms = a;  ///< y = a + b ln I
  std::size_t nodes = 0;
};

/// mu(I) over the bulk: by invariants (mu = |tau|/p over I), and as layers have it (sigma_xz/sigma_zz over
/// dv_x/dz / sqrt(sigma_zz), where that is positive).
struct BulkFriction {
  LogLine invariant, ratio;
  std::size_t bulk = 0;  ///< nodes of the bulk
  double noise =
      std::numeric_limits<double>::quiet_NaN();  ///< rms standard error of mu over the invariant's nodes
};
BulkFriction bulk_friction(const FieldMap& map, const MapBounds& bounds, const MapFindingOptions& options,
                           std::size_t batches);

/// BulkFriction::invariant of a map that is seen once, node after node, and not kept: what may belong to the
/// bulk waits in a scratch file until the surface above it is known.
class FrictionLine {
 public:
  FrictionLine(const MapGrid& grid, const MapBounds& bounds, const MapFindingOptions& options,
               const std::shared_ptr<ScratchFile>& file);
  /// Row after row from the lowest up; node = row columns + column.
  void add(std::size_t node, double nu, double p, double I, double mu);
  LogLine line() const;

 private:
  /// The highest node of a column so far that is as dense as the surface, and its neighbour above.
  struct Top {
    std::size_t row = none;
    double nu = 0, nu_above = 0;
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
  };
  struct Point {
    std::size_t node;
    double I, mu;
  };
  double surface(std::size_t column) const;

  MapGrid grid_;
  MapBounds bounds_;
  MapFindingOptions options_;
  std::vector<Top> tops_;
  ScratchList<Point> points_;
};

}  // namespace drumlin::particles
