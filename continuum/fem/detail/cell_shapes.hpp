#pragma once
// Shape functions of a cell in the form that its integrals use. Private to fem/.
#include <deal.II/fe/fe_values.h>

#include <array>
#include <vector>

#include "continuum/fem/detail/discretisation.hpp"
#include "continuum/rheology/plane_tensor.hpp"

namespace drumlin::continuum::fem {

// Shape functions of one cell in the form that the integrals use. Q2-Q1 is primitive: each shape function has
// one component.
struct CellShapes {
  unsigned int n = 0;
  std::vector<unsigned int> component;
  std::vector<PlaneTensor> rate;             // symmetric gradient, n per point
  std::vector<double> divergence;            // n per point
  std::vector<double> value;                 // n per point
  std::vector<std::array<double, 2>> slope;  // n per point, of the fluidity's; empty without it

  explicit CellShapes(const Discretisation& d) : n(d.elements.n_dofs_per_cell()), component(n) {
    for (unsigned int i = 0; i < n; ++i) component[i] = d.elements.system_to_component_index(i).first;
    rate.resize(n * d.quadrature.size());
    divergence.resize(rate.size());
    value.resize(rate.size());
    if (d.has_fluidity()) slope.resize(rate.size());
  }
  void reinit(const dealii::FEValues<2>& fe) {
    for (const unsigned int q : fe.quadrature_point_indices())
      for (unsigned int i = 0; i < n; ++i) {
        const auto k = q * n + i;
        value[k] = fe.shape_value(i, q);
        if (component[i] == pressure_component) continue;
        const auto g = fe.shape_grad(i, q);
        if (component[i] == fluidity_component) {
          slope[k] = {g[0], g[1]};
          continue;
        }
        rate[k] = component[i] == 0 ? PlaneTensor{g[0], 0, 0.5 * g[1]} : PlaneTensor{0, g[1], 0.5 * g[0]};
        divergence[k] = g[component[i]];
      }
  }
};

struct PointValues {
  PlaneTensor D;
  double divergence = 0;
  double p = 0;
  double ln_fluidity = 0;                  ///< with a threshold of fluidity
  std::array<double, 2> fluidity_slope{};  ///< its gradient
};

inline PointValues point_values(const CellShapes& s, unsigned int q, const dealii::Vector<double>& local) {
  PointValues at;
  for (unsigned int i = 0; i < s.n; ++i) {
    const auto k = q * s.n + i;
    if (s.component[i] == pressure_component) {
      at.p += local[i] * s.value[k];
    } else if (s.component[i] == fluidity_component) {
      at.ln_fluidity += local[i] * s.value[k];
      at.fluidity_slope[0] += local[i] * s.slope[k][0];
      at.fluidity_slope[1] += local[i] * s.slope[k][1];
    } else {
      at.D = at.D + local[i] * s.rate[k];
      at.divergence += local[i] * s.divergence[k];
    }
  }
  return at;
}

/// Calls visit(values, point) at every quadrature point of this rank's cells, `point` counting them.
template <class Visit>
void for_each_point(const Discretisation& d, const FieldVector& solution, Visit visit) {
  dealii::FEValues<2> fe(d.mapping, d.elements, d.quadrature,
                         dealii::update_values | dealii::update_gradients);
  CellShapes shapes(d);
  dealii::Vector<double> local(shapes.n);
  std::size_t point = 0;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    fe.reinit(cell);
    shapes.reinit(fe);
    cell->get_dof_values(solution, local);
    for (const unsigned int q : fe.quadrature_point_indices()) visit(point_values(shapes, q, local), point++);
  }
}

}  // namespace drumlin::continuum::fem
