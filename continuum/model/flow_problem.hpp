#pragma once
// A flow problem: domain, boundary data, forces, law, effects. No deal.II here.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "continuum/rheology/tensor_law.hpp"
#include "coupling/core/law/memory_law.hpp"
#include "coupling/core/law/stress_ratio.hpp"

namespace drumlin::continuum {

/// Point or vector in the axes of the flow: x along the free surface downslope, z along its outward normal;
/// d, sqrt(g d).
struct Vec2 {
  double x = 0;
  double z = 0;
};

/// Part of a disc below a chord: |r - axis| < radius, z < 0, axis at (0, axis_offset). Sides: top (chord),
/// bottom (arc).
struct ChordDomain {
  double radius = 0;
  double axis_offset = 0;   ///< height of the axis above the chord; negative: more than half full
  double surface_cell = 1;  ///< cell size on the coarsest mesh within surface_zone of the chord, d
  double surface_zone = 0;  ///< depth of the fine zone, d
  double growth = 0.25;     ///< of the cell size per unit depth below that zone
};

/// |x| < width/2, -height < z < 0. Sides: top, bottom, and left and right unless periodic.
struct BoxDomain {
  double width = 1;
  double height = 1;
  int cells_x = 1;  ///< on the coarsest mesh
  int cells_z = 1;
  bool periodic_x = false;
  std::vector<double> layers = {};  ///< heights of the rows of cells from the top down, adding up to
                                    ///< `height`, in place of cells_z equal ones; empty: those
};

/// Ring about the origin. Sides: top (inner circle), bottom (outer circle).
struct AnnulusDomain {
  double inner_radius = 0;
  std::vector<double>
      layers;             ///< thicknesses of the rings of cells on the coarsest mesh, from the inside out
  int cells_around = 24;  ///< of each ring
};

/// The material of a region (continuum/model/region.hpp), meshed. Sides: top, the free surface, and those of
/// the parts of the region.
struct RegionMesh;
struct MeshedDomain {
  std::shared_ptr<const RegionMesh> mesh;
};

using Domain = std::variant<ChordDomain, BoxDomain, AnnulusDomain, MeshedDomain>;

enum class Side : int { top = 0, bottom = 1, left = 2, right = 3 };
/// Of a part of a region, by its index there; free: top.
inline Side side_of_part(int part) { return part < 0 ? Side::top : static_cast<Side>(4 + part); }

/// Velocity given on a side. Where two such sides meet, the one listed first in Side wins. At least one
/// side has to carry something else: nothing would fix the pressure.
struct PrescribedVelocity {
  std::function<Vec2(Vec2)> velocity;
};
/// Free surface kept at its place: T_nn = -stiffness u_n, no tangential traction. T_nn stands for the weight
/// of the grains that would rise above the chord; a large stiffness makes u_n small.
struct NormalSpring {
  double stiffness = 1e4;
};
/// Traction T n given on a side (zero: a free side).
struct Traction {
  std::function<Vec2(Vec2)> traction;
};
/// Wall that moves along itself with the given velocity (its part along the wall counts) and is pressed on
/// the material: T_nn = -pressure. Incompressible material keeps it where it is.
struct PressedWall {
  std::function<Vec2(Vec2)> velocity;
  double pressure = 0;
};
/// Wall that nothing passes and along which the material slides under Coulomb's law: tangential traction
/// -friction p s/sqrt(s^2 + slip_speed^2) for the sliding speed s and the law's pressure p, which is the
/// normal traction wherever the material shears along the wall without stretching. Below friction p it creeps
/// at a speed of the order of slip_speed.
struct FrictionWall {
  std::function<Vec2(Vec2)> velocity;
  double friction = 0;
  double slip_speed = 1e-4;  ///< sqrt(g d); larger while eps is larger
};
using BoundaryCondition = std::variant<PrescribedVelocity, NormalSpring, Traction, PressedWall, FrictionWall>;

/// Slope of the surface: given, or the unknown that makes the moment of the surface traction vanish (the side
/// with the NormalSpring: integral of x sigma_nn dx = 0).
struct FixedSlope {
  double theta = 0;  ///< rad
};
struct SlopeFromMoment {
  double first_guess = 0.3;  ///< rad; the solution does not depend on it
};
using Slope = std::variant<FixedSlope, SlopeFromMoment>;

/// nu (du/dt + u.grad u) in the balance of momentum; steady flows have the second part alone.
struct Inertia {};

/// The unknown is u' = u - Omega x r, along the axes of the laboratory: the observer turns, the axes do not.
/// D is that of u, inertia stays that of u: no answer depends on it.
struct RotatingFrame {
  double rotation = 0;     ///< positive in the sense of dv_x/dz
  double axis_offset = 0;  ///< the observer turns about (0, axis_offset)
};

/// k(I): turns the stress against the strain rate (continuum/rheology/turned_law.hpp).
struct NonCoaxialStress {
  StressRatioLaw k;
  double softness = 0.1;  ///< c of turn_of()
  /// s sgn(W - Omega_D) at a point; empty: from the flow itself, for verification else.
  std::function<double(Vec2)> given_turn = {};
};

/// Fluidity g = 2|D|/mu spreads: g - length^2 lap g = g_loc, without flux through the sides.
struct NonlocalFluidity {
  double length = 0;  ///< d
};

/// Effect: the fluidity g = 2|D|/mu is a field, A^2 lap g/g = mu_loc(I) - mu, without flux through the sides
/// (continuum/rheology/threshold_fluidity.hpp): one more unknown per vertex.
struct ThresholdFluidity {
  double amplitude = 0;  ///< A, d
  /// mu_s, below which no layer flows by itself; absent: the law has one, or creeps at any stress.
  std::optional<double> threshold = {};
};

/// Effect: the material carries the axes of its past strain along, and they share in those of its stress
/// (continuum/rheology/memory_stress.hpp); in place of the problem's law its own mu(I) says how much.
struct AxesMemory {
  explicit AxesMemory(const MemoryLaw& of) : law(of), friction(memory_friction(of)) {}
  MemoryLaw law;
  TabulatedLaw friction;
  /// t: the side to which the material turns through its axes of strain, 1 in the sense of dv_x/dz (in a drum
  /// the sign of its rotation) or -1: the same for every observer.
  double turn = 1;
};

/// Effect: the surface (the side with the NormalSpring) goes where nothing presses on it; its shape is
/// continuum/model/surface_shape.hpp, its area above z = 0 nought. With the slope from the moment, x is along
/// the middle of the surface: the line fitted to it over |x| < slope_half_length.
struct MovingSurface {
  int degree = 20;                ///< of the polynomial that is its height
  double tolerance = 0.01;        ///< d, rms of sigma_nn/(nu cos theta) that the polynomials resolve
  int max_steps = 30;             ///< from solution to solution, on each mesh
  double slope_half_length = 20;  ///< d
  /// Given velocity of the bottom where the ends of the surface are at `left` and `right`; empty: that of its
  /// condition, wherever they are.
  std::function<Vec2(Vec2 point, Vec2 left, Vec2 right)> wall_velocity = {};
};

/// Stresses that statics alone gives, rho0 g d.
struct StaticLoad {
  double shear = 0;
  double pressure = 0;
};

struct FlowProblem {
  Domain domain;
  std::map<Side, BoundaryCondition> boundary;
  StressLaw law;
  std::optional<NonCoaxialStress> turned;  ///< absent: sigma_xx = sigma_zz in simple shear
  /// Absent: mu is that of the local I. The law has to determine a fluidity at any stress
  /// (continuum/rheology/nonlocal_law.hpp).
  std::optional<NonlocalFluidity> nonlocal;
  /// Absent: as with `nonlocal`; not with both, and not with k.
  std::optional<ThresholdFluidity> threshold_fluidity;
  std::optional<AxesMemory> memory;  ///< absent: the stress has the axes that D and k give it; not with k
  Regularisation regularisation;     ///< what the last phase reaches
  double density = 0;                ///< nu; the weight is density (sin theta, -cos theta)
  Slope slope;
  std::function<Vec2(Vec2)> extra_force;  ///< added to the weight; empty: absent
  /// Where the weight alone asks most of the law; absent: what drives the flow adapts.
  std::optional<StaticLoad> load;
  std::optional<Inertia> inertia;               ///< absent: slow flow, 0 = -grad p + div tau + f
  std::optional<RotatingFrame> frame;           ///< absent: the laboratory's
  std::optional<MovingSurface> moving_surface;  ///< absent: the surface stays at z = 0
};

/// Area of the part of a disc of this radius below a chord that lies `axis_offset` below its centre.
double segment_area(double radius, double axis_offset);
/// axis_offset for which segment_area is `area`, 0 < area < pi radius^2.
double chord_offset(double radius, double area);

/// Speed of a rigid rotation about (0, axis_offset), positive in the sense of the vorticity dv_x/dz: (Omega
/// z', -Omega x).
Vec2 rigid_rotation(double rotation, double axis_offset, Vec2 point);

/// Why the weight cannot be carried by a steady flow: its load would need I above `I_limit`; empty if it can.
/// The log law has no bound of its own, so a limit on I has to say where the law ceases to be one.
std::optional<std::string> no_steady_state(const FlowProblem& problem, double I_limit = 10);

}  // namespace drumlin::continuum
