#pragma once
// Shape functions of a cell in the form that its integrals use. Private to fem/.
#include <deal.II/fe/fe.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <vector>

#include "continuum/fem/detail/discretisation.hpp"
#include "continuum/rheology/tensor_law.hpp"

namespace drumlin::continuum::fem {

/// Shape functions of one cell, of Q2-Q1 and the fluidity's Q1: each unknown has one component, and the
/// components of the velocity have the same functions, as have pressure and fluidity.
struct CellShapes {
  static constexpr unsigned int nodes = 9, corners = 4;
  struct Point {
    std::array<double, nodes> value, x, z;             // Q2 and its gradient
    std::array<double, corners> linear;                // Q1
    std::array<std::array<double, 2>, corners> slope;  // its gradient, where there is a fluidity
    /// Strain rate of a velocity along `c` with function a.
    PlaneTensor rate(unsigned int c, unsigned int a) const {
      return c == 0 ? PlaneTensor{x[a], 0, 0.5 * z[a]} : PlaneTensor{0, z[a], 0.5 * x[a]};
    }
  };
  unsigned int n = 0;                   // unknowns
  std::vector<unsigned int> component;  // of each
  // Unknowns by component, in the order of their functions.
  std::array<std::array<unsigned int, nodes>, 2> velocity;
  std::array<unsigned int, corners> pressure;
  std::array<unsigned int, corners> fluidity;
  bool has_fluidity;
  std::vector<Point> points;

  explicit CellShapes(const Discretisation& d)
      : n(d.elements.n_dofs_per_cell()),
        component(n),
        has_fluidity(d.has_fluidity()),
        points(d.quadrature.size()),
        reference_(points.size()) {
    for (unsigned int i = 0; i < n; ++i) {
      const auto [c, of_element] = d.elements.system_to_component_index(i);
      component[i] = c;
      if (moves(c))
        velocity[c][of_element] = i;
      else if (c == pressure_component)
        pressure[of_element] = i;
      else
        fluidity[of_element] = i;
    }
    const auto &quadratic = d.elements.base_element(0), &linear = d.elements.base_element(1);
    for (std::size_t q = 0; q < points.size(); ++q) {
      const auto& unit = d.quadrature.point(q);
      for (unsigned int a = 0; a < nodes; ++a) {
        const auto slope = quadratic.shape_grad(a, unit);
        points[q].value[a] = quadratic.shape_value(a, unit);
        reference_[q].velocity[a] = {slope[0], slope[1]};
      }
      for (unsigned int b = 0; b < corners; ++b) {
        const auto slope = linear.shape_grad(b, unit);
        points[q].linear[b] = linear.shape_value(b, unit);
        reference_[q].fluidity[b] = {slope[0], slope[1]};
      }
    }
  }
  /// Of the cell whose first quadrature point is this one of Discretisation::points.
  void reinit(const CellPoint* at) {
    const auto turned = [](const CellPoint& to, const std::array<double, 2>& slope, unsigned int d) {
      return slope[0] * to.inverse_jacobian[0][d] + slope[1] * to.inverse_jacobian[1][d];
    };
    for (std::size_t q = 0; q < points.size(); ++q) {
      Point& here = points[q];
      for (unsigned int a = 0; a < nodes; ++a) {
        here.x[a] = turned(at[q], reference_[q].velocity[a], 0);
        here.z[a] = turned(at[q], reference_[q].velocity[a], 1);
      }
      if (has_fluidity)
        for (unsigned int b = 0; b < corners; ++b)
          here.slope[b] = {turned(at[q], reference_[q].fluidity[b], 0),
                           turned(at[q], reference_[q].fluidity[b], 1)};
    }
  }

 private:
  /// Slopes in the reference cell.
  struct Slopes {
    std::array<std::array<double, 2>, nodes> velocity;
    std::array<std::array<double, 2>, corners> fluidity;
  };
  std::vector<Slopes> reference_;
};

/// What velocities do to the forces on velocities: [component][function of the velocity][component of the
/// force][its function].
using VelocityTangent =
    std::array<std::array<std::array<std::array<double, CellShapes::nodes>, 2>, CellShapes::nodes>, 2>;

/// Velocity and its gradient at a point.
struct PointMotion {
  std::array<double, 2> u{};
  std::array<std::array<double, 2>, 2> gradient{};  ///< [component][direction]
};
template <class Gradient>  // g[component][direction]
PointMotion motion_of(const Gradient& g) {
  return {.gradient = {{{g[0][0], g[0][1]}, {g[1][0], g[1][1]}}}};
}
/// W, in the sense of dv_x/dz.
inline double spin_of(const PointMotion& at) { return 0.5 * (at.gradient[0][1] - at.gradient[1][0]); }

struct PointValues {
  PointMotion motion = {};
  PlaneTensor D;
  double divergence = 0;
  double p = 0;
  double ln_fluidity = 0;                  ///< with a threshold of fluidity
  std::array<double, 2> fluidity_slope{};  ///< its gradient
};

inline PointMotion point_motion(const CellShapes& s, unsigned int q, const dealii::Vector<double>& local) {
  const CellShapes::Point& shape = s.points[q];
  PointMotion at;
  for (unsigned int c = 0; c < 2; ++c)
    for (unsigned int a = 0; a < s.nodes; ++a) {
      const double here = local[s.velocity[c][a]];
      at.u[c] += here * shape.value[a];
      at.gradient[c][0] += here * shape.x[a];
      at.gradient[c][1] += here * shape.z[a];
    }
  return at;
}

inline PointValues point_values(const CellShapes& s, unsigned int q, const dealii::Vector<double>& local) {
  const CellShapes::Point& shape = s.points[q];
  PointValues at;
  at.motion = point_motion(s, q, local);
  const auto& [x, z] = at.motion.gradient;
  at.D = {x[0], z[1], 0.5 * (x[1] + z[0])};
  at.divergence = x[0] + z[1];
  for (unsigned int b = 0; b < s.corners; ++b) at.p += local[s.pressure[b]] * shape.linear[b];
  if (s.has_fluidity)
    for (unsigned int b = 0; b < s.corners; ++b) {
      const double here = local[s.fluidity[b]];
      at.ln_fluidity += here * shape.linear[b];
      at.fluidity_slope[0] += here * shape.slope[b][0];
      at.fluidity_slope[1] += here * shape.slope[b][1];
    }
  return at;
}

/// Advances the dual variable at each point of a cell by a change of the cell's unknowns.
inline void advance_dual(const CellShapes& s, const Regularisation& r, const dealii::Vector<double>& local,
                         const dealii::Vector<double>& change, PlaneTensor* dual) {
  for (unsigned int q = 0; q < s.points.size(); ++q) {
    const PlaneTensor D = point_values(s, q, local).D, dD = point_values(s, q, change).D;
    dual[q] = continuum::advanced_dual(D, dD, dual[q], regularised_rate(D, r));
  }
}

/// Calls visit(shapes, cell, point) for this rank's cells, `point` the number of their first quadrature
/// point.
template <class Visit>
void for_each_cell(const Discretisation& d, Visit visit) {
  CellShapes shapes(d);
  std::size_t point = 0;
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    shapes.reinit(&d.points[point]);
    visit(shapes, cell, point);
    point += d.quadrature.size();
  }
}

/// Calls visit(values, point) at every quadrature point of this rank's cells, `point` counting them.
template <class Visit>
void for_each_point(const Discretisation& d, const FieldVector& solution, Visit visit) {
  dealii::Vector<double> local(d.elements.n_dofs_per_cell());
  for_each_cell(d, [&](const CellShapes& shapes, const auto& cell, std::size_t first) {
    cell->get_dof_values(solution, local);
    for (unsigned int q = 0; q < shapes.points.size(); ++q) visit(point_values(shapes, q, local), first + q);
  });
}

}  // namespace drumlin::continuum::fem
