#include "continuum/fem/detail/carried_field.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_dgq.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <fmt/format.h>

#include <algorithm>
#include <complex>

#include "continuum/fem/detail/direct_solver.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

using dealii::FEValuesExtractors::Vector;
using Indices = std::vector<dealii::types::global_dof_index>;

// What a cell has along: one number, or the two of a traceless tensor that the material turns with itself.
struct Sources {
  std::span<const double> rate;
  std::vector<std::span<const double>> target;  // per component
  bool turns() const { return target.size() == 2; }
};

// In the sense of dv_x/dz, as the laboratory sees it.
std::vector<double> spin(const dealii::FEValuesBase<2>& fe, const FieldVector& solution,
                         const std::optional<RotatingFrame>& frame) {
  std::vector<dealii::Tensor<2, 2>> gradient(fe.n_quadrature_points);
  fe[Vector(0)].get_function_gradients(solution, gradient);
  std::vector<double> W;
  for (const auto& g : gradient) W.push_back(0.5 * (g[0][1] - g[1][0]) + (frame ? frame->rotation : 0));
  return W;
}

// As the laboratory sees it: the field is steady there, and the mesh is at rest.
std::vector<dealii::Tensor<1, 2>> velocity(const dealii::FEValuesBase<2>& fe, const FieldVector& solution,
                                           const std::optional<RotatingFrame>& frame) {
  std::vector<dealii::Tensor<1, 2>> u(fe.n_quadrature_points);
  fe[Vector(0)].get_function_values(solution, u);
  if (frame)
    for (const unsigned int q : fe.quadrature_point_indices()) {
      const auto x = fe.quadrature_point(q);
      const Vec2 rigid = rigid_rotation(frame->rotation, frame->axis_offset, {x[0], x[1]});
      u[q][0] += rigid.x;
      u[q][1] += rigid.z;
    }
  return u;
}

const dealii::UpdateFlags side_flags =
    dealii::update_values | dealii::update_JxW_values | dealii::update_normal_vectors;
const dealii::UpdateFlags u_flags = dealii::update_values | dealii::update_quadrature_points;

// The rows of the cells of this rank; each needs no more than its neighbours' indices.
class Assembler {
 public:
  Assembler(const FlowProblem& problem, const Discretisation& d, const FieldVector& solution,
            const ScalarField& field, const Sources& sources)
      : problem_(problem),
        d_(d),
        solution_(solution),
        field_(field),
        sources_(sources),
        kept_(*d.systems[sources.target.size()]),
        component_(components_of(*field.element)),
        indices_(field.element->n_dofs_per_cell()),
        upwind_(indices_.size()),
        fe_(d.mapping, *field.element, d.quadrature,
            dealii::update_values | dealii::update_gradients | dealii::update_JxW_values),
        fe_u_(d.mapping, d.elements, d.quadrature,
              sources.turns() ? u_flags | dealii::update_gradients : u_flags),
        side_(d.mapping, *field.element, d.side_quadrature, side_flags),
        side_u_(d.mapping, d.elements, d.side_quadrature, u_flags),
        other_side_(d.mapping, *field.element, d.side_quadrature, dealii::update_values),
        part_(d.mapping, *field.element, d.side_quadrature, side_flags),
        part_u_(d.mapping, d.elements, d.side_quadrature, u_flags),
        other_part_(d.mapping, *field.element, d.side_quadrature, dealii::update_values) {
    if (kept_.matrix.m() == 0) couple_across_faces(d, field, kept_.matrix);
    kept_.matrix = 0;
    rhs_ = field.values;
    rhs_ = 0;
  }

  void add_cells() {
    std::size_t first = 0;
    for (const auto& cell : d_.unknowns.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      const std::vector<double> mean_target = add_inside(cell, first);
      for (const unsigned int f : cell->face_indices()) add_side(cell, f, mean_target);
      first += d_.quadrature.size();
    }
    kept_.matrix.compress(dealii::VectorOperation::add);
    rhs_.compress(dealii::VectorOperation::add);
  }

  /// The true relative residual.
  double solve(FieldVector& values) {
    kept_.factors.factorise(kept_.matrix);
    return kept_.factors.solve(rhs_, values);
  }

 private:
  static std::vector<unsigned int> components_of(const dealii::FiniteElement<2>& element) {
    std::vector<unsigned int> component(element.n_dofs_per_cell());
    for (unsigned int i = 0; i < component.size(); ++i)
      component[i] = element.system_to_component_index(i).first;
    return component;
  }

  // v.grad b + rate b = rate target, of a tensor with 2 i W b on the left; returns the mean targets. `first`
  // is the number of the cell's first quadrature point.
  std::vector<double> add_inside(const MeshCell& cell, std::size_t first) {
    const auto own = on(field_.places, cell);
    own->get_dof_indices(indices_);
    fe_.reinit(own);
    fe_u_.reinit(cell);
    const auto u = velocity(fe_u_, solution_, problem_.frame);
    const auto W = sources_.turns() ? spin(fe_u_, solution_, problem_.frame) : std::vector<double>();
    dealii::FullMatrix<double> local(fe_.dofs_per_cell, fe_.dofs_per_cell);
    dealii::Vector<double> local_rhs(fe_.dofs_per_cell);
    std::vector<double> mean(sources_.target.size(), 0.0);
    double area = 0;
    for (const unsigned int q : fe_.quadrature_point_indices()) {
      const double rate = sources_.rate[first + q];
      for (unsigned int i = 0; i < fe_.dofs_per_cell; ++i) {
        const double at_i = fe_.shape_value(i, q) * fe_.JxW(q);
        local_rhs[i] += rate * sources_.target[component_[i]][first + q] * at_i;
        for (unsigned int j = 0; j < fe_.dofs_per_cell; ++j)
          if (component_[i] == component_[j])
            local(i, j) += (u[q] * fe_.shape_grad(j, q) + rate * fe_.shape_value(j, q)) * at_i;
          else
            local(i, j) += (component_[i] == 0 ? -2 : 2) * W[q] * fe_.shape_value(j, q) * at_i;
      }
      for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += sources_.target[c][first + q] * fe_.JxW(q);
      area += fe_.JxW(q);
    }
    kept_.matrix.add(indices_, local);
    rhs_.add(indices_, local_rhs);
    for (double& value : mean) value /= area;
    return mean;
  }

  // Of a face between cells of unequal size the parts are those of the smaller ones.
  void add_side(const MeshCell& cell, unsigned int f, const std::vector<double>& mean_target) {
    const auto own = on(field_.places, cell);
    const bool seam = own->has_periodic_neighbor(f);
    if (own->at_boundary(f) && !seam) {
      side_.reinit(own, f);
      side_u_.reinit(cell, f);
      add_entry(side_, side_u_, mean_target);
      return;
    }
    if (const auto neighbor = own->neighbor_or_periodic_neighbor(f); neighbor->has_children()) {
      for (unsigned int part = 0; part < own->face(f)->n_children(); ++part) {
        const auto child =
            seam ? own->periodic_neighbor_child_on_subface(f, part) : own->neighbor_child_on_subface(f, part);
        part_.reinit(own, f, part);
        part_u_.reinit(cell, f, part);
        other_side_.reinit(
            child, seam ? own->periodic_neighbor_of_periodic_neighbor(f) : own->neighbor_of_neighbor(f));
        add_exchange(part_, part_u_, other_side_, child);
      }
    } else {
      side_.reinit(own, f);
      side_u_.reinit(cell, f);
      if (seam ? own->periodic_neighbor_is_coarser(f) : own->neighbor_is_coarser(f)) {
        const auto [face, part] = seam ? own->periodic_neighbor_of_coarser_periodic_neighbor(f)
                                       : own->neighbor_of_coarser_neighbor(f);
        other_part_.reinit(neighbor, face, part);
        add_exchange(side_, side_u_, other_part_, neighbor);
      } else {
        other_side_.reinit(
            neighbor, seam ? own->periodic_neighbor_of_periodic_neighbor(f) : own->neighbor_of_neighbor(f));
        add_exchange(side_, side_u_, other_side_, neighbor);
      }
    }
  }

  template <class Visit>
  void for_inflow(const dealii::FEFaceValuesBase<2>& side, const dealii::FEFaceValuesBase<2>& side_u,
                  Visit&& visit) {
    const auto u = velocity(side_u, solution_, problem_.frame);
    for (const unsigned int q : side.quadrature_point_indices())
      if (const double inflow = -(u[q] * side.normal_vector(q)); inflow > 0) visit(q, inflow * side.JxW(q));
  }

  template <class Neighbor>
  void add_exchange(const dealii::FEFaceValuesBase<2>& side, const dealii::FEFaceValuesBase<2>& side_u,
                    const dealii::FEFaceValuesBase<2>& other, const Neighbor& neighbor) {
    const unsigned int n = fe_.dofs_per_cell;
    dealii::FullMatrix<double> from_own(n, n), from_upwind(n, n);
    for_inflow(side, side_u, [&](unsigned int q, double flux) {
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j) {
          if (component_[i] != component_[j]) continue;
          from_own(i, j) += flux * side.shape_value(i, q) * side.shape_value(j, q);
          from_upwind(i, j) -= flux * side.shape_value(i, q) * other.shape_value(j, q);
        }
    });
    neighbor->get_dof_indices(upwind_);
    kept_.matrix.add(indices_, from_own);
    kept_.matrix.add(indices_, upwind_, from_upwind);
  }

  void add_entry(const dealii::FEFaceValuesBase<2>& side, const dealii::FEFaceValuesBase<2>& side_u,
                 const std::vector<double>& entering) {
    const unsigned int n = fe_.dofs_per_cell;
    dealii::FullMatrix<double> from_own(n, n);
    dealii::Vector<double> from_outside(n);
    for_inflow(side, side_u, [&](unsigned int q, double flux) {
      for (unsigned int i = 0; i < n; ++i) {
        from_outside[i] += flux * side.shape_value(i, q) * entering[component_[i]];
        for (unsigned int j = 0; j < n; ++j)
          if (component_[i] == component_[j])
            from_own(i, j) += flux * side.shape_value(i, q) * side.shape_value(j, q);
      }
    });
    kept_.matrix.add(indices_, from_own);
    rhs_.add(indices_, from_outside);
  }

  const FlowProblem& problem_;
  const Discretisation& d_;
  const FieldVector& solution_;
  const ScalarField& field_;
  const Sources& sources_;
  KeptSystem& kept_;
  FieldVector rhs_;
  std::vector<unsigned int> component_;
  Indices indices_, upwind_;
  dealii::FEValues<2> fe_, fe_u_;
  dealii::FEFaceValues<2> side_, side_u_, other_side_;
  dealii::FESubfaceValues<2> part_, part_u_, other_part_;
};

struct Range {
  double low = 0, high = 0;
};

Range range_of(const Discretisation& d, std::span<const double> values) {
  Range range{1e300, -1e300};
  for (const double value : values) range = {std::min(range.low, value), std::max(range.high, value)};
  const MPI_Comm ranks = d.mesh.get_communicator();
  return {dealii::Utilities::MPI::min(range.low, ranks), dealii::Utilities::MPI::max(range.high, ranks)};
}

// Draws each cell towards its mean, as far as `limit(cell's values, mean)` says, which may move the mean;
// both hold a number per component. A bilinear function has its extremes at its nodes, the corners. The mean
// stays (Zhang & Shu, J. Comput. Phys. 229 (2010)) unless that lies outside itself.
template <class Limit>
void limit_cells(const Discretisation& d, ScalarField& field, Limit limit) {
  const auto& element = *field.element;
  dealii::FEValues<2> fe(d.mapping, element, d.quadrature, dealii::update_values | dealii::update_JxW_values);
  Indices indices(fe.dofs_per_cell);
  std::vector<std::vector<double>> values(element.n_components());
  std::vector<double> mean(values.size());
  for (const auto& cell : field.places.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    cell->get_dof_indices(indices);
    double area = 0;
    for (const unsigned int q : fe.quadrature_point_indices()) area += fe.JxW(q);
    for (auto& of_component : values) of_component.clear();
    std::fill(mean.begin(), mean.end(), 0.0);
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i) {
      const unsigned int c = element.system_to_component_index(i).first;
      values[c].push_back(field.values[indices[i]]);
      for (const unsigned int q : fe.quadrature_point_indices())
        mean[c] += values[c].back() * fe.shape_value(i, q) * fe.JxW(q);
    }
    for (double& value : mean) value /= area;
    if (!limit(values, mean)) continue;
    for (unsigned int i = 0; i < fe.dofs_per_cell; ++i) {
      const auto [c, node] = element.system_to_component_index(i);
      field.values[indices[i]] = values[c][node];
    }
  }
}

// Returns the largest distance from the range.
double bring_into(const Range& range, const Discretisation& d, ScalarField& field) {
  double overshoot = 0;
  limit_cells(d, field, [&](std::vector<std::vector<double>>& values, const std::vector<double>& means) {
    const auto [least, most] = std::minmax_element(values[0].begin(), values[0].end());
    const Range here{*least, *most};
    const double outside = std::max({0.0, range.low - here.low, here.high - range.high});
    if (outside == 0) return false;
    overshoot = std::max(overshoot, outside);
    const double mean = std::clamp(means[0], range.low, range.high);
    double share = 1;
    if (here.high > range.high) share = std::min(share, (range.high - mean) / (here.high - mean));
    if (here.low < range.low) share = std::min(share, (mean - range.low) / (mean - here.low));
    for (double& value : values[0]) value = std::clamp(mean + share * (value - mean), range.low, range.high);
    return true;
  });
  return dealii::Utilities::MPI::max(overshoot, d.mesh.get_communicator());
}

// Largest share of `step` that stays in the unit disc, from a place inside.
double share_inside(std::complex<double> from, std::complex<double> step) {
  const double square = std::norm(step), along = (std::conj(from) * step).real();
  if (std::abs(from + step) <= 1 || square == 0) return 1;
  const double left = std::max(0.0, 1 - std::norm(from));
  return std::clamp((std::sqrt(along * along + square * left) - along) / square, 0.0, 1.0);
}

}  // namespace

void bring_into_unit_disc(const Discretisation& d, ScalarField& field) {
  limit_cells(d, field, [](std::vector<std::vector<double>>& values, const std::vector<double>& means) {
    std::complex<double> mean(means[0], means[1]);
    mean /= std::max(1.0, std::abs(mean));
    double share = 1;
    for (std::size_t k = 0; k < values[0].size(); ++k)
      share = std::min(share, share_inside(mean, std::complex(values[0][k], values[1][k]) - mean));
    if (share == 1) return false;
    for (std::size_t k = 0; k < values[0].size(); ++k) {
      values[0][k] = mean.real() + share * (values[0][k] - mean.real());
      values[1][k] = mean.imag() + share * (values[1][k] - mean.imag());
    }
    return true;
  });
}

namespace {

// The field before anything limits it; returns the true relative residual of its solve.
double solve_transport(const FlowProblem& problem, const Discretisation& d, const FieldVector& solution,
                       const Sources& sources, double linear_tolerance, ScalarField& field) {
  Assembler system(problem, d, solution, field, sources);
  system.add_cells();
  const double residual = system.solve(field.values);
  if (!(residual <= linear_tolerance))
    throw NotConvergedError(
        fmt::format("what the material carries: true relative residual {:.2e} of the "
                    "linear solve, tolerance {:.1e}",
                    residual, linear_tolerance));
  return residual;
}

}  // namespace

CarriedField carried_by_flow(const FlowProblem& problem, const Discretisation& d, const FieldVector& solution,
                             const Relaxation& relaxation, double linear_tolerance) {
  auto field = std::make_shared<ScalarField>(d, dealii::FE_DGQ<2>(1));
  CarriedField carried;
  carried.linear_residual =
      solve_transport(problem, d, solution, {relaxation.rate, {relaxation.target}}, linear_tolerance, *field);
  const Range range = range_of(d, relaxation.target);
  const double outside = bring_into(range, d, *field);
  carried.overshoot = range.high > range.low ? outside / (range.high - range.low) : 0;
  field->values.update_ghost_values();
  carried.field = field;
  return carried;
}

std::shared_ptr<ScalarField> axes_carried_by_flow(const FlowProblem& problem, const Discretisation& d,
                                                  const FieldVector& solution,
                                                  const AxesRelaxation& relaxation, double linear_tolerance) {
  auto field = std::make_shared<ScalarField>(d, dealii::FESystem<2>(dealii::FE_DGQ<2>(1), 2));
  solve_transport(problem, d, solution, {relaxation.rate, {relaxation.target_xx, relaxation.target_xz}},
                  linear_tolerance, *field);
  bring_into_unit_disc(d, *field);
  field->values.update_ghost_values();
  return field;
}

}  // namespace drumlin::continuum::fem
