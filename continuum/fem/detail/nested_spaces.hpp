#pragma once
// Takes down how the unknowns of a mesh follow from those of the mesh that it was refined from. Private to
// fem/.
#include <vector>

#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {

/// Per unknown of this rank.
std::vector<bool> pressures(const Discretisation& d);

/// Takes down the nesting of one refinement. The mesh may change parts among the ranks: what the coarser
/// unknowns of a cell are travels with it.
class NestingRecord {
 public:
  /// After the cells to refine were marked, before they are cut. No cell may be coarsened.
  explicit NestingRecord(Discretisation& d);
  /// After the unknowns of the finer mesh were distributed.
  Nesting nesting(Discretisation& d);
  /// The rows of `finer` that belong to free unknowns of the mesh before the refinement.
  SharedMatrix free_rows(const SharedMatrix& finer) const;

 private:
  struct Term {
    dealii::types::global_dof_index unknown;  // number among the free ones
    double weight;
  };
  using Terms = std::vector<std::vector<Term>>;  // per unknown of a cell

  std::vector<char> packed(const Discretisation& d,
                           const dealii::Triangulation<2>::cell_iterator& cell) const;
  static Terms unpacked(const char* begin, unsigned int unknowns_of_cell);

  FieldVector number_;          // among the free unknowns, -1 where constrained
  std::vector<PetscInt> free_;  // numbers of this rank's free unknowns among all
  std::vector<bool> is_pressure_;
  unsigned int handle_ = 0;
};

}  // namespace drumlin::continuum::fem
