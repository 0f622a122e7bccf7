#include "continuum/fem/flow_field.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>
#include <cstring>
#include <map>

#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/detail/spring_faces.hpp"
#include "coupling/core/basics/inertial_number.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin::continuum {
namespace {

using dealii::FEValuesExtractors::Scalar;
using dealii::FEValuesExtractors::Vector;

// Values at the points of one FEValues, in the order of its points.
struct Values {
  std::vector<dealii::Tensor<1, 2>> velocity;
  std::vector<dealii::Tensor<2, 2>> gradient;
  std::vector<double> pressure, ln_fluidity;

  Values(const dealii::FEValues<2>& fe, const fem::FieldVector& solution)
      : velocity(fe.n_quadrature_points), gradient(fe.n_quadrature_points), pressure(fe.n_quadrature_points) {
    fe[Vector(0)].get_function_values(solution, velocity);
    fe[Vector(0)].get_function_gradients(solution, gradient);
    fe[Scalar(fem::pressure_component)].get_function_values(solution, pressure);
    if (fe.get_fe().n_components() > fem::fluidity_component) {
      ln_fluidity.resize(fe.n_quadrature_points);
      fe[Scalar(fem::fluidity_component)].get_function_values(solution, ln_fluidity);
    }
  }
  fem::PointValues at(unsigned int q) const;
};

PlaneTensor strain_rate(const dealii::Tensor<2, 2>& g) {
  return {g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])};
}

fem::PointValues Values::at(unsigned int q) const {
  return {.motion = fem::motion_of(gradient[q]),
          .D = strain_rate(gradient[q]),
          .divergence = gradient[q][0][0] + gradient[q][1][1],
          .p = pressure[q],
          .ln_fluidity = ln_fluidity.empty() ? 0 : ln_fluidity[q]};
}

PointState point_state(const fem::PointReport& s, const dealii::Tensor<1, 2>& u,
                       const dealii::Tensor<2, 2>& g, double p) {
  return {.velocity = {u[0], u[1]},
          .dvx_dx = g[0][0],
          .dvx_dz = g[0][1],
          .dvz_dx = g[1][0],
          .dvz_dz = g[1][1],
          .pressure = p,
          .sigma_xx = p - s.stress.xx,
          .sigma_zz = p - s.stress.zz,
          .sigma_xz = s.stress.xz,
          .shear_stress = s.along,
          .rate = magnitude(strain_rate(g)),
          .law_pressure = s.normal,
          .k = s.ratio,
          .axis_angle = s.angle,
          .fluidity_factor = s.fluidity,
          .viscosity = s.viscosity,
          .memory_xx = s.memory ? s.memory->xx : no_value,
          .memory_xz = s.memory ? s.memory->xz : no_value,
          .memory_rho = s.memory ? s.memory->rho : no_value,
          .well_posedness = s.margin,
          .fluidity = no_value};
}

// Force, power and torque of the sides with a given velocity, from the residual in their unknowns.
void add_given_sides(const fem::SolvedLevel& level, Vec2 centre, FlowIntegrals& sums) {
  const auto& d = *level.discretisation;
  const auto forces = fem::nodal_forces(level.problem, d, level.setting, level.state);
  const auto places = fem::places_of_unknowns(d);
  const auto along_x =
      dealii::DoFTools::extract_dofs(d.unknowns, dealii::ComponentMask({true, false, false}));
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    const auto i = d.owned.nth_index_in_set(k);
    if (!d.given.is_element(i) || d.conforming.is_constrained(i)) continue;
    const auto& place = places.at(i);
    if (along_x.is_element(i)) sums.given_side_force_x += forces[i];
    sums.given_side_power += forces[i] * level.state.solution[i];
    sums.given_side_torque +=
        forces[i] * (along_x.is_element(i) ? place[1] - centre.z : -(place[0] - centre.x));
  }
}

void add_surface(const fem::SolvedLevel& level, Vec2 centre, FlowIntegrals& sums) {
  const auto& d = *level.discretisation;
  std::vector<dealii::Tensor<1, 2>> u(d.side_quadrature.size());
  fem::for_each_spring_face(level.problem, d, [&](const auto&, const auto& face, const NormalSpring& spring) {
    face[Vector(0)].get_function_values(level.state.solution, u);
    for (const unsigned int q : face.quadrature_point_indices()) {
      const auto normal = d.surface_normal(face.quadrature_point(q), face.normal_vector(q));
      const double u_n = u[q] * normal;
      sums.surface_force += spring.stiffness * u_n * face.JxW(q);
      sums.surface_moment += fem::lever(face.quadrature_point(q), {centre.x, centre.z}, normal) *
                             spring.stiffness * u_n * face.JxW(q);
      sums.surface_leak += 0.5 * std::abs(u_n) * face.JxW(q);
    }
  });
}

// Each rank has found the points of its own cells: what the first rank that has one says of it holds for all.
void share_among_ranks(const fem::Discretisation& d, const std::vector<bool>& found,
                       std::vector<PointState>& states) {
  using dealii::Utilities::MPI::min;
  using dealii::Utilities::MPI::sum;
  const MPI_Comm ranks = d.mesh.get_communicator();
  const int count = static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(ranks));
  if (count == 1) return;
  const int rank = static_cast<int>(dealii::Utilities::MPI::this_mpi_process(ranks));
  std::vector<int> owner(states.size(), count);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (found[i]) owner[i] = rank;
  min(owner, ranks, owner);
  constexpr std::size_t numbers = sizeof(PointState) / sizeof(double);
  static_assert(numbers * sizeof(double) == sizeof(PointState) && std::is_trivially_copyable_v<PointState>);
  std::vector<double> values(numbers * states.size(), 0.0);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (owner[i] == rank) std::memcpy(&values[numbers * i], &states[i], sizeof(PointState));
  sum(values, ranks, values);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (owner[i] < count)
      std::memcpy(static_cast<void*>(&states[i]), &values[numbers * i], sizeof(PointState));
}

void sum_over_ranks(const fem::Discretisation& d, FlowIntegrals& sums) {
  constexpr std::size_t numbers = sizeof(FlowIntegrals) / sizeof(double);
  static_assert(numbers * sizeof(double) == sizeof(FlowIntegrals) &&
                std::is_trivially_copyable_v<FlowIntegrals>);
  std::vector<double> values(numbers);
  std::memcpy(values.data(), &sums, sizeof sums);
  dealii::Utilities::MPI::sum(values, d.mesh.get_communicator(), values);
  std::memcpy(static_cast<void*>(&sums), values.data(), sizeof sums);
}

}  // namespace

FlowField::FlowField(std::shared_ptr<const fem::SolvedLevel> level) : level_(std::move(level)) {}
double FlowField::theta() const { return level_->state.theta; }
const std::optional<SurfaceShape>& FlowField::surface() const { return level_->discretisation->surface; }
int FlowField::unknowns() const { return static_cast<int>(level_->discretisation->unknowns.n_dofs()); }
bool FlowField::has_fluidity() const { return level_->discretisation->has_fluidity(); }
bool FlowField::remembers() const { return level_->problem.memory.has_value(); }
bool FlowField::on_first_rank() const {
  return dealii::Utilities::MPI::this_mpi_process(level_->discretisation->mesh.get_communicator()) == 0;
}
int FlowField::cells() const {
  return static_cast<int>(level_->discretisation->mesh.n_global_active_cells());
}

std::vector<PointState> FlowField::at(std::span<const Vec2> points) const {
  const auto& d = *level_->discretisation;
  std::vector<PointState> states(points.size());
  std::vector<bool> found(points.size(), false);
  for (const auto& [cell, places] : fem::locate(d, points)) {
    std::vector<dealii::Point<2>> unit_points;
    for (const auto& place : places) unit_points.push_back(place.unit);
    dealii::FEValues<2> fe(d.mapping, d.elements, dealii::Quadrature<2>(unit_points),
                           dealii::update_values | dealii::update_gradients);
    fe.reinit(cell);
    const Values values(fe, level_->state.solution);
    const auto& held = level_->state.held;
    const auto held_here = held ? fem::held_at(*held, d, cell, unit_points) : fem::HeldValues{};
    for (std::size_t q = 0; q < places.size(); ++q) {
      found[places[q].point] = true;
      const auto report = fem::point_report(level_->problem, level_->setting, values.at(q), held_here, q);
      auto& at = states[places[q].point];
      at = point_state(report, values.velocity[q], values.gradient[q], values.pressure[q]);
      if (d.has_fluidity()) at.fluidity = std::exp(values.ln_fluidity[q]);
    }
  }
  share_among_ranks(d, found, states);
  return states;
}

std::vector<FlowPiece> FlowField::pieces(unsigned int points_per_side) const {
  const auto& d = *level_->discretisation;
  const dealii::QGauss<2> rule(points_per_side);
  dealii::FEValues<2> fe(d.mapping, d.elements, rule,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                             dealii::update_quadrature_points);
  std::vector<FlowPiece> all;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    const Values values(fe, level_->state.solution);
    const auto& held = level_->state.held;
    const auto held_here = held ? fem::held_at(*held, d, cell, rule.get_points()) : fem::HeldValues{};
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const auto report = fem::point_report(level_->problem, level_->setting, values.at(q), held_here, q);
      const auto x = fe.quadrature_point(q);
      all.push_back({{x[0], x[1]},
                     fe.JxW(q),
                     point_state(report, values.velocity[q], values.gradient[q], values.pressure[q])});
    }
  }
  return all;
}

FlowIntegrals FlowField::integrals(Vec2 centre, double law_I_max) const {
  const auto& d = *level_->discretisation;
  const auto& problem = level_->problem;
  FlowIntegrals sums;
  dealii::FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                             dealii::update_quadrature_points);
  const fem::HeldValues& held = level_->state.held_values();
  std::size_t point = 0;
  const Vec2 weight{problem.density * std::sin(theta()), -problem.density * std::cos(theta())};
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    const Values values(fe, level_->state.solution);
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const PlaneTensor D = strain_rate(values.gradient[q]);
      const auto s = fem::point_report(problem, level_->setting, values.at(q), held, point++);
      const auto x = fe.quadrature_point(q);
      sums.area += fe.JxW(q);
      sums.center.x += x[0] * fe.JxW(q);
      sums.center.z += x[1] * fe.JxW(q);
      sums.kinetic_energy += 0.5 * problem.density * values.velocity[q].norm_square() * fe.JxW(q);
      if (s.margin < 0) sums.ill_posed_area += fe.JxW(q);
      const double p = std::max(0.0, s.normal);
      const double I = problem.memory ? inertial_number(problem.memory->law, magnitude(D), p)
                                      : inertial_number(2 * magnitude(D), p);
      if (I > law_I_max) sums.beyond_law_area += fe.JxW(q);
      const double work = contraction(s.stress, D) * fe.JxW(q);
      sums.dissipation += work;
      if (const double rate = magnitude(D); rate > 0)
        sums.law_dissipation += work * regularised_rate(D, level_->setting.regularisation) / rate;
      sums.weight_power += (weight.x * values.velocity[q][0] + weight.z * values.velocity[q][1]) * fe.JxW(q);
      sums.weight_torque += (weight.x * (x[1] - centre.z) - weight.z * (x[0] - centre.x)) * fe.JxW(q);
    }
  }
  add_given_sides(*level_, centre, sums);
  add_surface(*level_, centre, sums);
  sum_over_ranks(d, sums);
  return sums;
}

}  // namespace drumlin::continuum
