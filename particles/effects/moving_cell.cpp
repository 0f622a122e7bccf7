#include "particles/effects/moving_cell.hpp"

#include <cmath>

namespace drumlin::particles {
namespace {

/// Mass, centre and mean velocity of all grains.
struct Whole {
  double mass = 0;
  Point center, velocity;
};

Whole whole_of(const Bodies& bodies) {
  Whole all;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double m = 1 / bodies.inverse_mass[b];
    all.mass += m;
    all.center.x += m * bodies.x[b], all.center.z += m * bodies.z[b];
    all.velocity.x += m * bodies.v_x[b], all.velocity.z += m * bodies.v_z[b];
  }
  for (Point* p : {&all.center, &all.velocity}) p->x /= all.mass, p->z /= all.mass;
  return all;
}

double inverse_inertia(const CellLaw& law, double mass, double length) {
  return 12 / (law.inertia * mass * length * length);
}

}  // namespace

double energy_of_drift(const Bodies& bodies) {
  const Whole all = whole_of(bodies);
  return all.mass * (all.velocity.x * all.velocity.x + all.velocity.z * all.velocity.z) / 2;
}

Period period_of(const CellState& cell) {
  return {cell.middle_x - cell.length_x / 2,
          cell.length_x,
          cell.middle_z - cell.length_z / 2,
          cell.length_z,
          cell.offset,
          cell.rate_x,
          cell.rate_z,
          cell.shear};
}

CellState cell_at_rest(const Period& period) {
  CellState cell;
  cell.middle_x = period.origin + period.length / 2, cell.middle_z = period.origin_z + period.length_z / 2;
  cell.length_x = period.length, cell.length_z = period.length_z;
  return cell;
}

CellLaw cell_law(const std::optional<StageCell>& keys, const Scales& scales) {
  CellLaw law;
  if (!keys) return law;
  const double speed = scales.length_m / scales.time_s;
  const double pressure = scales.density_kg_m3 * speed * speed;
  const auto set = [&](const std::optional<CellAxis>& axis, std::optional<double>& pressed, double& rate) {
    if (axis && axis->pressure_n_m2) pressed = *axis->pressure_n_m2 / pressure;
    if (axis && axis->rate_per_s) rate = *axis->rate_per_s * scales.time_s;
  };
  set(keys->xx, law.pressure_x, law.rate_x);
  set(keys->zz, law.pressure_z, law.rate_z);
  law.shear = keys->shear_rate_per_s.value_or(0) * scales.time_s;
  law.inertia = keys->inertia;
  return law;
}

CellResponse response_of(const CellLaw& law, const CellState& cell, const Bodies& bodies) {
  CellResponse response;
  if (!law.pressure_x && !law.pressure_z) return response;
  const double mass = whole_of(bodies).mass;
  response.length_x = cell.length_x, response.length_z = cell.length_z;
  if (law.pressure_x) response.inverse_inertia_x = inverse_inertia(law, mass, cell.length_x);
  if (law.pressure_z) response.inverse_inertia_z = inverse_inertia(law, mass, cell.length_z);
  return response;
}

void drive_cell(const CellLaw& law, const CellResponse& response, double h, CellState& cell, Bodies& bodies) {
  double rate_x = law.rate_x, rate_z = law.rate_z;
  if (response.pressed()) {
    const Whole all = whole_of(bodies);
    const double area = cell.length_x * cell.length_z;
    double motion_x = 0, motion_z = 0;  // area times the stress of motion
    for (std::size_t b = 0; b < bodies.count(); ++b) {
      const double x = bodies.x[b] - all.center.x, z = bodies.z[b] - all.center.z;
      const double u_x = bodies.v_x[b] - all.velocity.x - cell.rate_x * x - cell.shear * z;
      const double u_z = bodies.v_z[b] - all.velocity.z - cell.rate_z * z;
      motion_x += u_x * u_x / bodies.inverse_mass[b], motion_z += u_z * u_z / bodies.inverse_mass[b];
    }
    if (law.pressure_x)
      rate_x = cell.rate_x +
               response.inverse_inertia_x * (h * (motion_x - area * *law.pressure_x) + cell.struck_x);
    if (law.pressure_z)
      rate_z = cell.rate_z +
               response.inverse_inertia_z * (h * (motion_z - area * *law.pressure_z) + cell.struck_z);
  }
  change_rates(rate_x, rate_z, law.shear, cell, bodies);
}

void change_rates(double rate_x, double rate_z, double shear, CellState& cell, Bodies& bodies) {
  const double d_x = rate_x - cell.rate_x, d_z = rate_z - cell.rate_z, d_shear = shear - cell.shear;
  cell.rate_x = rate_x, cell.rate_z = rate_z, cell.shear = shear;
  if (d_x == 0 && d_z == 0 && d_shear == 0) return;
  // About the middle, not the centre of mass, which jumps where a grain crosses the border: the cell would
  // drift.
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double x = bodies.x[b] - cell.middle_x, z = bodies.z[b] - cell.middle_z;
    bodies.v_x[b] += d_x * x + d_shear * z;
    bodies.v_z[b] += d_z * z;
  }
}

void change_rates_in_step(Point change, double h, CellState& cell, Bodies& bodies) {
  for (std::size_t b = 0; b < bodies.count(); ++b)
    bodies.x[b] -= h * bodies.v_x[b], bodies.z[b] -= h * bodies.v_z[b];
  change_rates(cell.rate_x + change.x, cell.rate_z + change.z, cell.shear, cell, bodies);
  for (std::size_t b = 0; b < bodies.count(); ++b)
    bodies.x[b] += h * bodies.v_x[b], bodies.z[b] += h * bodies.v_z[b];
}

void follow_images(const CellState& before, const CellState& cell, Bodies& bodies) {
  const Period period = period_of(cell);
  const double d_x = cell.length_x - before.length_x, d_z = cell.length_z - before.length_z;
  const double d_offset = period.nearest(cell.offset - before.offset);
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double up = (bodies.z[b] - cell.middle_z) / cell.length_z;
    const double right = (bodies.x[b] - cell.middle_x - cell.offset * up) / cell.length_x;
    const Point change = period.image_velocity({d_x * right + d_offset * up, d_z * up});
    bodies.v_x[b] += change.x, bodies.v_z[b] += change.z;
  }
}

void stretch_cell(Point strain, CellState& cell, Bodies& bodies) {
  cell.length_x *= 1 + strain.x, cell.offset *= 1 + strain.x;
  cell.length_z *= 1 + strain.z;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    bodies.x[b] += strain.x * (bodies.x[b] - cell.middle_x);
    bodies.z[b] += strain.z * (bodies.z[b] - cell.middle_z);
  }
}

void move_cell(double h, CellState& cell) {
  cell.offset += h * (cell.rate_x * cell.offset + cell.shear * cell.length_z);
  cell.length_x += h * cell.rate_x * cell.length_x;
  cell.length_z += h * cell.rate_z * cell.length_z;
  cell.offset -= cell.length_x * std::round(cell.offset / cell.length_x);  // another image above: the same
}

std::vector<Point> wrap_grains(const CellState& cell, Bodies& bodies) {
  const Period period = period_of(cell);
  std::vector<Point> shifts;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const Point first = period.first({bodies.x[b], bodies.z[b]});
    const Point shift{first.x - bodies.x[b], first.z - bodies.z[b]};
    if (shift.x == 0 && shift.z == 0) continue;
    if (shifts.empty()) shifts.resize(bodies.count());
    shifts[b] = shift;
    const Point velocity = period.image_velocity(shift);
    bodies.x[b] = first.x, bodies.z[b] = first.z;
    bodies.v_x[b] += velocity.x, bodies.v_z[b] += velocity.z;
  }
  return shifts;
}

}  // namespace drumlin::particles
