#include "particles/stepping/energy_ledger.hpp"

#include <cmath>

namespace drumlin::particles {
namespace {

void book(double work, double& account, EnergyLedger& ledger) {
  account += work;
  ledger.turnover += std::abs(work);
}

/// What moves the other side of a contact: walls, or the cell.
double& mover(EnergyLedger& ledger) { return ledger.cell ? *ledger.cell : ledger.walls; }

}  // namespace

void book_cell(double work, EnergyLedger& ledger) {
  if (!ledger.cell) ledger.cell = 0;
  book(work, *ledger.cell, ledger);
}

std::vector<std::pair<std::string, double>> exchanges(const EnergyLedger& ledger) {
  std::vector<std::pair<std::string, double>> all = {
      {"walls", ledger.walls}, {"friction", ledger.friction}, {"impacts", ledger.impacts}};
  if (ledger.rolling) all.emplace_back("rolling", *ledger.rolling);
  if (ledger.cohesion) all.emplace_back("cohesion", *ledger.cohesion);
  if (ledger.cell) all.emplace_back("cell", *ledger.cell);
  all.emplace_back("time_integration", ledger.time_integration);
  all.emplace_back("projection", ledger.projection);
  return all;
}

double closing_error(const EnergyLedger& ledger) {
  double sum = 0;
  for (const auto& [name, work] : exchanges(ledger)) sum += work;
  return (ledger.kinetic - ledger.kinetic_at_start) + (ledger.potential - ledger.potential_at_start) - sum;
}

double EnergyBooks::potential(const Bodies& bodies) const {
  if (!gravity_) return 0;
  double sum = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    sum -= (gravity_->x * bodies.x[b] + gravity_->z * bodies.z[b]) / bodies.inverse_mass[b];
  return sum;
}

void EnergyBooks::open(const Bodies& bodies, std::optional<EnergyLedger>& ledger) {
  x_ = bodies.x, z_ = bodies.z, v_x_ = bodies.v_x, v_z_ = bodies.v_z, spin_ = bodies.spin;
  if (ledger) return;
  ledger.emplace();
  ledger->kinetic = ledger->kinetic_at_start = kinetic_energy(bodies);
  ledger->potential = ledger->potential_at_start = potential(bodies);
}

void EnergyBooks::strike(std::span<const StruckGrain> struck, const ImpactWork& work, EnergyLedger& ledger) {
  book(work.normal, ledger.impacts, ledger);
  book(work.tangential, ledger.friction, ledger);
  book(work.walls, mover(ledger), ledger);
  for (const StruckGrain& grain : struck) {
    v_x_[grain.grain] += grain.v_x, v_z_[grain.grain] += grain.v_z;
    x_[grain.grain] += grain.shift.x, z_[grain.grain] += grain.shift.z;
    if (!spin_.empty()) spin_[grain.grain] += grain.spin;
  }
}

void EnergyBooks::add(const WorkingContact& c, const Bodies& now, EnergyLedger& ledger) const {
  const auto mean = [](const std::vector<double>& before, const std::vector<double>& after, std::int32_t b) {
    return (before[b] + after[b]) / 2;
  };
  const bool wall = c.j < 0;
  const Point of_j = c.wall_velocity;  // beyond that of j itself
  const double d_x = mean(v_x_, now.v_x, c.i) - (wall ? 0 : mean(v_x_, now.v_x, c.j)) - of_j.x;
  const double d_z = mean(v_z_, now.v_z, c.i) - (wall ? 0 : mean(v_z_, now.v_z, c.j)) - of_j.z;
  const double u_n = c.n_x * d_x + c.n_z * d_z;
  double u_t = c.n_z * d_x - c.n_x * d_z;
  if (!spin_.empty()) {
    const double rim_i = now.radius[c.i] * mean(spin_, now.spin, c.i);
    const double rim_j = wall ? 0 : now.radius[c.j] * mean(spin_, now.spin, c.j);
    u_t -= rim_i + rim_j;
    if (ledger.rolling) {
      const double of_wall = wall ? now.radius[c.i] * c.wall_spin : 0;
      const double u_r = c.lever * rim_i - (1 - c.lever) * rim_j - of_wall;
      book(c.rolling * u_r, *ledger.rolling, ledger);
      book(c.rolling * of_wall, ledger.walls, ledger);
    }
  }
  book(c.normal * u_n, ledger.impacts, ledger);
  book(c.tangential * u_t, ledger.friction, ledger);
  if (ledger.cohesion) book(-c.attraction * u_n, *ledger.cohesion, ledger);
  if (!wall && of_j.x == 0 && of_j.z == 0) return;
  const double p_n = c.normal - c.attraction;
  const double p_x = c.n_x * p_n + c.n_z * c.tangential, p_z = c.n_z * p_n - c.n_x * c.tangential;
  book(p_x * of_j.x + p_z * of_j.z, mover(ledger), ledger);
}

void EnergyBooks::move(const Bodies& now, double h, EnergyLedger& ledger) {
  double fall = 0, late = 0;
  for (std::size_t b = 0; gravity_ && b < now.count(); ++b) {
    const double m = 1 / now.inverse_mass[b], w_x = m * gravity_->x, w_z = m * gravity_->z;
    const double moved = w_x * (now.x[b] - x_[b]) + w_z * (now.z[b] - z_[b]);
    fall += moved;
    late += h / 2 * (w_x * (v_x_[b] + now.v_x[b]) + w_z * (v_z_[b] + now.v_z[b])) - moved;
  }
  ledger.turnover += std::abs(fall);  // between potential and kinetic energy
  book(late, ledger.time_integration, ledger);
  x_ = now.x, z_ = now.z;
}

void EnergyBooks::close(const Bodies& now, EnergyLedger& ledger) const {
  ledger.kinetic = kinetic_energy(now);
  double corrected = 0;
  for (std::size_t b = 0; gravity_ && b < now.count(); ++b)
    corrected -= (gravity_->x * (now.x[b] - x_[b]) + gravity_->z * (now.z[b] - z_[b])) / now.inverse_mass[b];
  book(corrected, ledger.projection, ledger);
  ledger.potential = potential(now);
}

}  // namespace drumlin::particles
