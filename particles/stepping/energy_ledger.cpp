#include "particles/stepping/energy_ledger.hpp"

#include <cmath>

namespace drumlin::particles {

void add_work(double work, double& account, EnergyLedger& ledger) {
  account += work;
  ledger.turnover += std::abs(work);
}

double& mover(EnergyLedger& ledger) { return ledger.cell ? *ledger.cell : ledger.walls; }

void add_cell_work(double work, EnergyLedger& ledger) {
  if (!ledger.cell) ledger.cell = 0;
  add_work(work, *ledger.cell, ledger);
}

std::vector<std::pair<std::string, double>> exchanges(const EnergyLedger& ledger) {
  std::vector<std::pair<std::string, double>> all = {
      {"walls", ledger.walls}, {"friction", ledger.friction}, {"impacts", ledger.impacts}};
  each_account(ledger.effects, [&all](const std::string& name, const std::optional<double>& work) {
    if (work) all.emplace_back(name, *work);
  });
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

double StepEnergy::potential(const Bodies& bodies) const {
  if (!gravity_) return 0;
  double sum = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b)
    sum -= dot(*gravity_, position(bodies, b)) / bodies.inverse_mass[b];
  return sum;
}

void StepEnergy::open(const Bodies& bodies, std::optional<EnergyLedger>& ledger) {
  before_ = bodies;
  if (ledger) return;
  ledger.emplace();
  ledger->kinetic = ledger->kinetic_at_start = kinetic_energy(bodies);
  ledger->potential = ledger->potential_at_start = potential(bodies);
}

void StepEnergy::add_impacts(std::span<const CollidedGrain> collided, const ImpactWork& work,
                             EnergyLedger& ledger) {
  add_work(work.normal, ledger.impacts, ledger);
  add_work(work.tangential, ledger.friction, ledger);
  add_work(work.walls, mover(ledger), ledger);
  for (const CollidedGrain& grain : collided) {
    before_.v_x[grain.grain] += grain.v_x, before_.v_z[grain.grain] += grain.v_z;
    before_.x[grain.grain] += grain.shift.x, before_.z[grain.grain] += grain.shift.z;
    if (!before_.spin.empty()) before_.spin[grain.grain] += grain.spin;
  }
}

void StepEnergy::move(const Bodies& now, double h, EnergyLedger& ledger) {
  double fall = 0, late = 0;
  for (std::size_t b = 0; gravity_ && b < now.count(); ++b) {
    const Point weight = 1 / now.inverse_mass[b] * *gravity_;
    const double moved = dot(weight, position(now, b) - position(before_, b));
    fall += moved;
    late += h / 2 * dot(weight, velocity(before_, b) + velocity(now, b)) - moved;
  }
  ledger.turnover += std::abs(fall);  // between potential and kinetic energy
  add_work(late, ledger.time_integration, ledger);
  before_.x = now.x, before_.z = now.z;
}

void StepEnergy::close(const Bodies& now, EnergyLedger& ledger) const {
  ledger.kinetic = kinetic_energy(now);
  double corrected = 0;
  for (std::size_t b = 0; gravity_ && b < now.count(); ++b)
    corrected -= dot(*gravity_, position(now, b) - position(before_, b)) / now.inverse_mass[b];
  add_work(corrected, ledger.projection, ledger);
  ledger.potential = potential(now);
}

}  // namespace drumlin::particles
