#pragma once
// The faces of the free surface. Private to fem/.
#include <deal.II/fe/fe_values.h>

#include <variant>

#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {

/// Calls visit(cell, face, spring) for every face of this rank's cells that lies on a side with a spring;
/// `face` knows values, places, normals and weights of its quadrature points.
template <class Visit>
void for_each_spring_face(const FlowProblem& problem, const Discretisation& d, Visit visit) {
  dealii::FEFaceValues<2> face(d.mapping, d.elements, d.side_quadrature,
                               dealii::update_values | dealii::update_JxW_values |
                                   dealii::update_normal_vectors | dealii::update_quadrature_points);
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary()) continue;
      const auto* condition = condition_on(problem, cell->face(f)->boundary_id());
      const auto* spring = condition ? std::get_if<NormalSpring>(condition) : nullptr;
      if (!spring) continue;
      face.reinit(cell, f);
      visit(cell, face, *spring);
    }
  }
}

}  // namespace drumlin::continuum::fem
