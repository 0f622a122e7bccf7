#pragma once
// The moving cell: a domain periodic in x and z whose lengths follow pressures or rates of strain and whose
// images are sheared (Lees and Edwards 1972). There is no wall: the cell deforms homogeneously, and grains
// that cross a border come back with the velocity of that image.
#include <optional>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/period.hpp"

namespace drumlin::particles {

/// What moves one length of the cell: exactly one of the two.
struct CellAxis {
  std::optional<double> pressure_n_m2 = {};
  std::optional<double> rate_per_s = {};
};

template <class Visitor>
void describe(Visitor& v, CellAxis& a) {
  v.value("pressure_n_m2", a.pressure_n_m2,
          when_given("N/m2", above(0, 1e12), "Mean stress along the axis. This or rate_per_s."));
  v.value("rate_per_s", a.rate_per_s,
          when_given("1/s", at_least(-1e6, 1e6), "Strain rate; negative: compression."));
}

/// The keys of a stage's cell.
struct StageCell {
  std::optional<CellAxis> xx = {}, zz = {};
  std::optional<double> shear_rate_per_s = {};
  double inertia = 1;  ///< against pressures, in that of the grains spread evenly over the cell
};

template <class Visitor>
void describe(Visitor& v, StageCell& c) {
  v.optional_table("xx", c.xx, "Length along x; without: fixed.");
  v.optional_table("zz", c.zz, "Length along z.");
  v.value("shear_rate_per_s", c.shear_rate_per_s,
          when_given("1/s", at_least(-1e6, 1e6), "Shear rate dv_x/dz."));
  v.value(
      "inertia", c.inertia,
      defaulted("", above(0, 1e6), "Of a length under pressure, in m L^2 / 12, m the mass of all grains."));
}

/// State of the cell: lengths, displacement of the image above along x, rates. Dimensionless. Its middle
/// stays.
struct CellState {
  double middle_x = 0, middle_z = 0;
  double length_x = 0, length_z = 0;
  double offset = 0;  ///< between half a length to the left and to the right
  double rate_x = 0, rate_z = 0, shear = 0;
  double struck_x = 0, struck_z = 0;  ///< sums of impulse times branch of the impacts of the last step
};
Period period_of(const CellState&);
/// The state at rest of a domain.
CellState cell_at_rest(const Period&);

/// The law of a stage, dimensionless. An axis without pressure has its rate.
struct CellLaw {
  std::optional<double> pressure_x = {}, pressure_z = {};
  double rate_x = 0, rate_z = 0, shear = 0;
  double inertia = 1;
};
/// Without keys the cell stands still.
CellLaw cell_law(const std::optional<StageCell>&, const Scales&);

/// How the rates answer impulses of contacts within a step: 0 where they are given.
struct CellResponse {
  double inverse_inertia_x = 0, inverse_inertia_z = 0;
  double length_x = 1, length_z = 1;
  bool pressed() const { return inverse_inertia_x > 0 || inverse_inertia_z > 0; }
};
/// A cell that moves, with the rates that it has without contacts, and how these answer them.
struct MovingCell {
  CellState& state;
  CellResponse response;
};
CellResponse response_of(const CellLaw&, const CellState&, const Bodies&);

/// Sets the rates that the cell has in a step without contacts: those given, and those that pressures, motion
/// of the grains and the impacts of the last step drive. The grains take the change with them.
void drive_cell(const CellLaw&, const CellResponse&, double time_step, CellState&, Bodies&);
/// Changes the rates of the cell; grains get the change times their distance from its middle.
void change_rates(double rate_x, double rate_z, double shear, CellState&, Bodies&);
/// The same once the grains of a step have been moved with the old rates.
void change_rates_in_step(Point change, double time_step, CellState&, Bodies&);
/// Moves lengths and offset by a step.
void move_cell(double time_step, CellState&);
/// Changes velocities once the lengths of a step are new: an image then moves faster by A times the change of
/// its displacement, and so does every grain by that of its own, whichever image of it stands in the cell.
void follow_images(const CellState& before, const CellState&, Bodies&);
/// Kinetic energy of the grains as one body: a cell without walls may drift.
double energy_of_drift(const Bodies&);
/// Stretches lengths, with the positions of the grains, by shares of themselves.
void stretch_cell(Point strain, CellState&, Bodies&);
/// Brings grains back into the cell, with positions and velocities of the images; returns what was added to
/// positions, one entry per grain, or nothing if all were inside.
std::vector<Point> wrap_grains(const CellState&, Bodies&);

}  // namespace drumlin::particles
