#pragma once
// A scalar field on the mesh of a flow, beside velocity and pressure: what an effect computes from the flow
// between two runs of Newton's method. Private to fem/.
#include <deal.II/fe/fe.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <functional>
#include <memory>
#include <vector>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {

using MeshCell = dealii::DoFHandler<2>::active_cell_iterator;

/// The same cell, seen through the unknowns of another field.
inline MeshCell on(const dealii::DoFHandler<2>& handler, const MeshCell& cell) {
  return {&handler.get_triangulation(), cell->level(), cell->index(), &handler};
}

/// Continuous or not, as its element is; with two components where that has them. It must not outlive the
/// mesh that it was made for.
struct ScalarField {
  ScalarField(const Discretisation& d, const dealii::FiniteElement<2>& kind);  ///< all zero
  ScalarField(const ScalarField&) = delete;
  ScalarField& operator=(const ScalarField&) = delete;

  std::unique_ptr<const dealii::FiniteElement<2>> element;
  dealii::DoFHandler<2> places;
  FieldVector values;  ///< with the copies around this rank's part
};

/// Hanging nodes and periodicity of a continuous field, closed.
dealii::AffineConstraints<double> conforming_lines(const FlowProblem& problem, const ScalarField& field);

/// An empty matrix among the unknowns of `places`, coupled as `fill` says of those that this rank looks at.
void give_pattern(const Discretisation& d, const dealii::DoFHandler<2>& places, SystemMatrix& matrix,
                  const std::function<void(dealii::DynamicSparsityPattern&)>& fill);
/// Of a continuous field: each unknown couples with those of its cells, `lines` aside.
void couple_in_cells(const Discretisation&, const ScalarField&,
                     const dealii::AffineConstraints<double>& lines, SystemMatrix&);
/// Of a discontinuous field: with those of its cell and of the cells beside it.
void couple_across_faces(const Discretisation&, const ScalarField&, SystemMatrix&);

/// At points of one cell of this rank, given by their places in the reference cell.
std::vector<double> values_at(const ScalarField& field, const MeshCell& cell,
                              const std::vector<dealii::Point<2>>& unit_points, unsigned int component = 0);
/// Per quadrature point of this rank's cells.
std::vector<double> at_quadrature(const ScalarField& field, const Discretisation& d,
                                  unsigned int component = 0);

}  // namespace drumlin::continuum::fem
