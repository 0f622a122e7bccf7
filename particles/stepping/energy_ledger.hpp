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
#include "particles/effects/effects.hpp"
#include "particles/stepping/impacts.hpp"

namespace drumlin::particles {

/// Energies now, and what each mechanism gave to the grains since the start (a loss is negative); rho0 g d^3
/// per unit of depth. kinetic + potential - those at the start = the sum of the others.
struct EnergyLedger {
  double kinetic = 0;    ///< of translation and spin, in the laboratory
  double potential = 0;  ///< in gravity, 0 at the origin
  double kinetic_at_start = 0, potential_at_start = 0;
  double walls = 0;             ///< work of the walls
  double friction = 0;          ///< work of tangential impulses on sliding
  double impacts = 0;           ///< work of normal impulses
  double time_integration = 0;  ///< gravity's work less the fall: what vanishes with the step
  double projection = 0;        ///< potential energy of position corrections
  EffectsOf<WorkOf> effects;    ///< work of those that the scene has
  std::optional<double> cell;   ///< work of a moving cell; only in a scene with one
  double turnover = 0;          ///< sum of the sizes of all these exchanges, step by step
};

/// The exchanges by name, those that the scene has, in the order of the columns of energy.csv.
std::vector<std::pair<std::string, double>> exchanges(const EnergyLedger&);
/// Energy now less that at the start less all exchanges: 0 but for rounding.
double closing_error(const EnergyLedger&);

/// Adds work that `account` gives to the grains.
void add_work(double work, double& account, EnergyLedger& ledger);
/// What moves the other side of a contact: walls, or the cell.
double& mover(EnergyLedger& ledger);
/// Adds the work of a cell that moves, between contacts or where grains cross its border: the kinetic energy
/// that it adds.
void add_cell_work(double work, EnergyLedger&);

/// A step that has been done: what the grains were at its beginning and before the position projection.
class StepEnergy {
 public:
  explicit StepEnergy(std::optional<Point> gravity) : gravity_(gravity) {}

  /// Remembers the grains at the beginning of a step; the first time also where the ledger starts.
  void open(const Bodies&, std::optional<EnergyLedger>& ledger);
  /// Adds the impacts of the step, which come before its contacts.
  void add_impacts(std::span<const CollidedGrain>, const ImpactWork&, EnergyLedger&);
  /// The grains at the beginning of the step, with what impacts have changed.
  const Bodies& before() const { return before_; }
  /// Adds that of gravity once the grains have been moved, before the position projection.
  void move(const Bodies& now, double time_step, EnergyLedger&);
  /// Ends the step, after the position projection.
  void close(const Bodies& now, EnergyLedger&) const;

 private:
  double potential(const Bodies&) const;

  std::optional<Point> gravity_;
  Bodies before_;
};

}  // namespace drumlin::particles
