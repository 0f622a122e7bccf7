#include "continuum/fem/neglected_terms.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>

#include "continuum/fem/detail/carried_field.hpp"
#include "continuum/fem/detail/fluidity.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/rheology/nonlocal_law.hpp"
#include "continuum/rheology/threshold_fluidity.hpp"

namespace drumlin::continuum {
namespace {

using dealii::FEValuesExtractors::Scalar;
using dealii::FEValuesExtractors::Vector;

struct Sums {
  double area = 0, inertia = 0, largest = 0;
  double surface = 0, height = 0;
  double wall = 0, overloaded = 0;
};

void add_inside(const fem::SolvedLevel& level, dealii::FEValues<2>& fe, Sums& sums) {
  std::vector<dealii::Tensor<1, 2>> u(fe.n_quadrature_points);
  std::vector<dealii::Tensor<2, 2>> gradient(fe.n_quadrature_points);
  fe[Vector(0)].get_function_values(level.state.solution, u);
  fe[Vector(0)].get_function_gradients(level.state.solution, gradient);
  for (const unsigned int q : fe.quadrature_point_indices()) {
    const double acceleration = (gradient[q] * u[q]).norm();  // over g = 1
    sums.area += fe.JxW(q);
    sums.inertia += acceleration * acceleration * fe.JxW(q);
    sums.largest = std::max(sums.largest, acceleration);
  }
}

void add_side(const fem::SolvedLevel& level, const BoundaryCondition& condition,
              const dealii::FEFaceValues<2>& face, Sums& sums) {
  std::vector<dealii::Tensor<1, 2>> u(face.n_quadrature_points);
  std::vector<dealii::Tensor<2, 2>> gradient(face.n_quadrature_points);
  std::vector<double> p(face.n_quadrature_points), y;
  face[Vector(0)].get_function_values(level.state.solution, u);
  face[Vector(0)].get_function_gradients(level.state.solution, gradient);
  face[Scalar(fem::pressure_component)].get_function_values(level.state.solution, p);
  if (level.discretisation->has_fluidity()) {
    y.resize(p.size());
    face[Scalar(fem::fluidity_component)].get_function_values(level.state.solution, y);
  }
  for (const unsigned int q : face.quadrature_point_indices()) {
    const auto n = face.normal_vector(q);
    if (const auto* spring = std::get_if<NormalSpring>(&condition)) {
      const double height = spring->stiffness *
                            (u[q] * level.discretisation->surface_normal(face.quadrature_point(q), n)) /
                            (level.problem.density * std::cos(level.state.theta));
      sums.surface += face.JxW(q);
      sums.height += height * height * face.JxW(q);
    } else if (std::holds_alternative<PrescribedVelocity>(condition)) {
      const auto& g = gradient[q];
      const PlaneTensor D{g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])};
      const Regularisation& r = level.setting.regularisation;
      const double law_pressure = regularised_pressure(p[q], r).value;
      const double rate = regularised_rate(D, r);
      const double F = y.empty() ? strength(level.setting.law, rate, law_pressure).value
                                 : strength(FluidityLaw{y[q]}, rate, law_pressure).value;
      const double D_tn = (D.zz - D.xx) * n[0] * n[1] + D.xz * (n[0] * n[0] - n[1] * n[1]);
      const double shear_stress = F * std::abs(D_tn) / rate;
      sums.wall += face.JxW(q);
      if (shear_stress > 0.95 * law_pressure) sums.overloaded += face.JxW(q);
    }
  }
}

// Root mean square of a number per quadrature point over what flows, without the uppermost grain (p < 1): at
// the surface the shear rate vanishes, and with it g_loc, over less than a cell.
double flowing_rms(const fem::SolvedLevel& level, const std::vector<double>& values) {
  const auto& d = *level.discretisation;
  dealii::FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  std::vector<dealii::Tensor<2, 2>> gradient(fe.n_quadrature_points);
  std::vector<double> p(fe.n_quadrature_points);
  double sum = 0, area = 0;
  std::size_t point = 0;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    fe[Vector(0)].get_function_gradients(level.state.solution, gradient);
    fe[Scalar(fem::pressure_component)].get_function_values(level.state.solution, p);
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const auto& g = gradient[q];
      const double rate = magnitude(PlaneTensor{g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])});
      const double value = values[point++];
      if (p[q] < 1 ||
          2 * rate < 1e-3 * std::sqrt(regularised_pressure(p[q], level.setting.regularisation).value))
        continue;
      sum += value * value * fe.JxW(q);
      area += fe.JxW(q);
    }
  }
  area = d.sum(area);
  sum = d.sum(sum);
  return area > 0 ? std::sqrt(sum / area) : 0;
}

std::optional<double> spread_of_fluidity(const fem::SolvedLevel& level) {
  const auto& d = *level.discretisation;
  if (level.problem.threshold_fluidity || !tells_fluidity(level.problem.law)) return std::nullopt;
  const auto g = fem::local_fluidity(level.problem, d, level.state);
  const auto factor = fem::fluidity_factor(level.problem, d, 1, g, 1e-6);
  return flowing_rms(level, fem::at_quadrature(*factor.ln_factor, d));
}

}  // namespace

NeglectedTerms neglected_terms(const FlowField& field) {
  const fem::SolvedLevel& level = field.level();
  const auto& d = *level.discretisation;
  dealii::FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                         dealii::update_values | dealii::update_gradients | dealii::update_JxW_values);
  dealii::FEFaceValues<2> face(d.mapping, d.elements, d.side_quadrature,
                               dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                                   dealii::update_normal_vectors | dealii::update_quadrature_points);
  Sums sums;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    add_inside(level, fe, sums);
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        if (const auto* condition = fem::condition_on(level.problem, cell->face(f)->boundary_id())) {
          face.reinit(cell, f);
          add_side(level, *condition, face, sums);
        }
  }
  const auto share = [&](double part, double whole) {
    const double all = d.sum(whole);
    part = d.sum(part);
    return all > 0 ? part / all : 0;
  };
  return {.inertia_rms = std::sqrt(share(sums.inertia, sums.area)),
          .inertia_largest = dealii::Utilities::MPI::max(sums.largest, d.mesh.get_communicator()),
          .surface_height_rms = std::sqrt(share(sums.height, sums.surface)),
          .wall_friction = share(sums.overloaded, sums.wall),
          .nonlocal = spread_of_fluidity(level)};
}

}  // namespace drumlin::continuum
