#pragma once
// Energy ledger: where the energy of the grains comes from and goes to, in identities that hold for the
// discrete scheme and not only in the limit of small steps (docs/theory/energy.md).
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/stepping/impacts.hpp"

namespace drumlin::particles {

/// Energies now, and what each mechanism gave to the grains since the start (a loss is negative); rho0 g d^3
/// per unit of depth. kinetic + potential - those at the start = the sum of the others.
struct EnergyLedger {
  double kinetic = 0;    ///< of translation and spin, in the laboratory
  double potential = 0;  ///< in gravity, 0 at the origin
  double kinetic_at_start = 0, potential_at_start = 0;
  double walls = 0;                ///< work of the walls
  double friction = 0;             ///< work of tangential impulses on sliding
  double impacts = 0;              ///< work of normal impulses
  double time_integration = 0;     ///< gravity's work less the fall: what vanishes with the step
  double projection = 0;           ///< potential energy of position corrections
  std::optional<double> rolling;   ///< work of rolling couples; only with rolling resistance
  std::optional<double> cohesion;  ///< work of attraction; only with cohesion
  std::optional<double> cell;      ///< work of a moving cell; only in a scene with one
  double turnover = 0;             ///< sum of the sizes of all these exchanges, step by step
};

/// The exchanges by name, those that the scene has, in the order of the columns of energy.csv.
std::vector<std::pair<std::string, double>> exchanges(const EnergyLedger&);
/// Energy now less that at the start less all exchanges: 0 but for rounding.
double closing_error(const EnergyLedger&);

/// Books the work of a cell that moves, between contacts or where grains cross its border: the kinetic energy
/// that it adds.
void book_cell(double work, EnergyLedger&);

/// One contact of a step, as it acted.
struct WorkingContact {
  std::int32_t i = 0, j = 0;  ///< grains; j < 0: a wall
  double n_x = 0, n_z = 0;    ///< unit normal from j to i; the tangent is (n_z, -n_x)
  double normal = 0;          ///< impulses: of the contact law, without cohesion
  double tangential = 0;
  double rolling = 0;  ///< and lever of i and j (GeneralDelassus)
  double lever = 0;
  double attraction = 0;  ///< cohesive impulse
  Point wall_velocity;    ///< mean of before and after the step; between grains that of the image
  double wall_spin = 0;
};

/// A step that has been done: what the grains were at its beginning and before the position projection.
class EnergyBooks {
 public:
  explicit EnergyBooks(std::optional<Point> gravity) : gravity_(gravity) {}

  /// Remembers the grains at the beginning of a step; the first time also where the ledger starts.
  void open(const Bodies&, std::optional<EnergyLedger>& ledger);
  /// Books the impacts of the step, which come before its contacts.
  void strike(std::span<const StruckGrain>, const ImpactWork&, EnergyLedger&);
  /// Adds the work of a contact, from the velocities then and now.
  void add(const WorkingContact&, const Bodies& now, EnergyLedger&) const;
  /// Books gravity once the grains have been moved, before the position projection.
  void move(const Bodies& now, double time_step, EnergyLedger&);
  /// Ends the step, after the position projection.
  void close(const Bodies& now, EnergyLedger&) const;

 private:
  double potential(const Bodies&) const;

  std::optional<Point> gravity_;
  std::vector<double> x_, z_, v_x_, v_z_, spin_;
};

}  // namespace drumlin::particles
