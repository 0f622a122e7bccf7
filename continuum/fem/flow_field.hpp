#pragma once
// A solved flow: values at points, integrals, files. Free of deal.II, which stays behind the pointer.
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "continuum/fem/flow_state.hpp"
#include "continuum/model/surface_shape.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/basics/scales.hpp"

namespace drumlin::continuum {

namespace fem {
struct SolvedLevel;
}

/// Velocity, its gradient and the stress at a point; laboratory frame, stresses compression positive. All NaN
/// outside the domain.
struct PointState {
  Vec2 velocity{no_value, no_value};
  double dvx_dx = no_value, dvx_dz = no_value, dvz_dx = no_value, dvz_dz = no_value;
  double pressure = no_value;
  double sigma_xx = no_value, sigma_zz = no_value;
  double sigma_xz = no_value;      ///< traction of the upper layer on the lower one, > 0 in the flow
  double shear_stress = no_value;  ///< along D: |tau| without k
  double rate = no_value;          ///< |D|
  /// The law's sigma_zz, without k its p: I = 2 rate/sqrt(law_pressure), mu = shear_stress/law_pressure.
  double law_pressure = no_value;
  double k = no_value;                ///< of the law; 1 without
  double axis_angle = no_value;       ///< from the axes of D to those of the stress, rad
  double fluidity_factor = no_value;  ///< g_loc/g with nonlocal fluidity; 1 without
  double viscosity = no_value;
  double memory_xx = no_value, memory_xz = no_value,
         memory_rho = no_value;      ///< A and rho with memory of the axes; NaN without
  double well_posedness = no_value;  ///< margin (coupling/core/law/well_posedness.hpp), negative: ill-posed
  double fluidity = no_value;        ///< g = 2|D|/mu with a threshold of fluidity, 1/sqrt(d/g); NaN without
};

/// What a small piece of the domain holds.
struct FlowPiece {
  Vec2 place;
  double area = 0;
  PointState state;
};

/// Integrals over the domain and its sides, by quadrature of the fields themselves.
struct FlowIntegrals {
  double area = 0;
  double ill_posed_area = 0;      ///< where the symbol of the linearised equations is negative
  double beyond_law_area = 0;     ///< where I is larger than the law was measured at
  double dissipation = 0;         ///< integral of tau:D
  double law_dissipation = 0;     ///< of tau:D with |D| in place of the regularised one: 2 |D| mu p
  double weight_power = 0;        ///< integral of f.u
  double kinetic_energy = 0;      ///< integral of nu u^2/2
  Vec2 center;                    ///< integral of the place: over the area the centre of mass
  double given_side_power = 0;    ///< of the sides with a given velocity, from their nodal forces
  double weight_torque = 0;       ///< about the origin of the moments, in the sense of dv_x/dz
  double given_side_torque = 0;   ///< from the nodal forces
  double given_side_force_x = 0;  ///< likewise
  double surface_moment = 0;  ///< of sigma_nn over the side with the spring: of a chord integral x sigma_nn
  double surface_force = 0;   ///< integral sigma_nn dx over it
  double surface_leak = 0;    ///< half the integral of |u_n| over it
};

/// All member functions are collective: every rank calls them and gets the same answer.
class FlowField {
 public:
  explicit FlowField(std::shared_ptr<const fem::SolvedLevel> level);
  const fem::SolvedLevel& level() const { return *level_; }

  double theta() const;  ///< rad
  /// Where the surface has moved to; absent: nowhere.
  const std::optional<SurfaceShape>& surface() const;
  int unknowns() const;
  int cells() const;
  bool has_fluidity() const;   ///< among the unknowns
  bool remembers() const;      ///< memory of the axes
  bool on_first_rank() const;  ///< the one that writes files and messages
  std::vector<PointState> at(std::span<const Vec2> points) const;
  /// The domain in pieces: Gauss's points of each cell, so many along each side. Of this rank alone.
  std::vector<FlowPiece> pieces(unsigned int points_per_side) const;
  /// For another solve to start from (solve_flow_from).
  FlowState state() const;
  /// Torques are taken about `centre`.
  /// `law_I_max`: the largest I that the law was measured at.
  FlowIntegrals integrals(Vec2 centre = {}, double law_I_max = std::numeric_limits<double>::infinity()) const;
  /// Velocity, pressure, stresses and what the law says, in SI, x to the right and y upwards from the axis of
  /// a drum, as the grains' files for ParaView; each cell cut in four. On several ranks `file` (.vtu) is
  /// replaced by one with the ending .pvtu, which names one .vtu per rank. Throws IoError.
  void write_vtu(const std::filesystem::path& file, const Scales& scales) const;

 private:
  std::shared_ptr<const fem::SolvedLevel> level_;
};

}  // namespace drumlin::continuum
