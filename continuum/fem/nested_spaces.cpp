#include "continuum/fem/detail/nested_spaces.hpp"

#include <deal.II/dofs/dof_tools.h>

#include <cstring>
#include <map>

#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {
namespace {

using Index = dealii::types::global_dof_index;
using Row = std::map<Index, double>;

// A matrix from its rows on this rank.
SharedMatrix matrix_of(const std::vector<Row>& rows, std::size_t owned_columns, MPI_Comm ranks) {
  std::vector<PetscInt> start{0}, column;
  std::vector<double> value;
  for (const Row& row : rows) {
    for (const auto& [j, weight] : row) {
      column.push_back(static_cast<PetscInt>(j));
      value.push_back(weight);
    }
    start.push_back(static_cast<PetscInt>(column.size()));
  }
  Mat matrix = nullptr;
  check(MatCreateMPIAIJWithArrays(ranks, static_cast<PetscInt>(rows.size()),
                                  static_cast<PetscInt>(owned_columns), PETSC_DETERMINE, PETSC_DETERMINE,
                                  start.data(), column.data(), value.data(), &matrix),
        "make an interpolation");
  return shared(matrix);
}

}  // namespace

std::vector<bool> pressures(const Discretisation& d) {
  const auto set = dealii::DoFTools::extract_dofs(
      d.unknowns, d.elements.component_mask(dealii::FEValuesExtractors::Scalar(pressure_component)));
  std::vector<bool> result(d.owned.n_elements(), false);
  for (const auto index : set) result[d.owned.index_within_set(index)] = true;
  return result;
}

NestingRecord::NestingRecord(Discretisation& d) : number_(d.field()) {
  const auto is_pressure = pressures(d);
  for (std::size_t k = 0; k < is_pressure.size(); ++k)
    if (const Index i = d.owned.nth_index_in_set(k); !d.homogeneous.is_constrained(i)) {
      free_.push_back(static_cast<PetscInt>(i));
      is_pressure_.push_back(is_pressure[k]);
    }
  long before = 0;
  const long here = static_cast<long>(free_.size());
  MPI_Exscan(&here, &before, 1, MPI_LONG, MPI_SUM, d.mesh.get_communicator());
  number_ = -1;
  for (std::size_t k = 0; k < free_.size(); ++k)
    number_[static_cast<Index>(free_[k])] = static_cast<double>(before + static_cast<long>(k));
  number_.update_ghost_values();
  handle_ = d.mesh.register_data_attach([this, &d](const auto& cell, const auto) { return packed(d, cell); },
                                        /*returns_variable_size_data=*/true);
}

// Per unknown of the cell the number of its terms, then the terms.
std::vector<char> NestingRecord::packed(const Discretisation& d,
                                        const dealii::Triangulation<2>::cell_iterator& cell) const {
  const dealii::DoFHandler<2>::active_cell_iterator here(&d.mesh, cell->level(), cell->index(), &d.unknowns);
  std::vector<Index> unknown(d.elements.n_dofs_per_cell());
  here->get_dof_indices(unknown);
  std::vector<double> words;
  const auto add = [&](Index i, double weight) {
    if (number_[i] < 0) return 0;
    words.push_back(number_[i]);
    words.push_back(weight);
    return 1;
  };
  for (const Index i : unknown) {
    const std::size_t count = words.size();
    words.push_back(0);
    int terms = 0;
    if (!d.homogeneous.is_constrained(i))
      terms = add(i, 1);
    else if (const auto* entries = d.homogeneous.get_constraint_entries(i))
      for (const auto& [master, weight] : *entries) terms += add(master, weight);
    words[count] = terms;
  }
  std::vector<char> bytes(words.size() * sizeof(double));
  std::memcpy(bytes.data(), words.data(), bytes.size());
  return bytes;
}

NestingRecord::Terms NestingRecord::unpacked(const char* begin, unsigned int unknowns_of_cell) {
  const auto next = [&begin] {
    double word;
    std::memcpy(&word, begin, sizeof word);
    begin += sizeof word;
    return word;
  };
  Terms terms(unknowns_of_cell);
  for (auto& of_unknown : terms) {
    const auto count = static_cast<std::size_t>(next());
    for (std::size_t k = 0; k < count; ++k) {
      const auto i = static_cast<Index>(next());
      of_unknown.push_back({i, next()});
    }
  }
  return terms;
}

Nesting NestingRecord::nesting(Discretisation& d) {
  const unsigned int n = d.elements.n_dofs_per_cell();
  std::vector<Row> rows(d.owned.n_elements());
  std::vector<bool> done(rows.size(), false);
  std::vector<Index> unknown(n);
  // The unknowns of a cell over the terms of its parent's; without a child, over its own.
  const auto add_cell = [&](const auto& cell, const Terms& terms,
                            const dealii::FullMatrix<double>* to_child) {
    const dealii::DoFHandler<2>::active_cell_iterator here(&d.mesh, cell->level(), cell->index(),
                                                           &d.unknowns);
    if (!here->is_locally_owned()) return;
    here->get_dof_indices(unknown);
    for (unsigned int i = 0; i < n; ++i) {
      if (!d.owned.is_element(unknown[i])) continue;
      const auto k = d.owned.index_within_set(unknown[i]);
      if (done[k] || d.homogeneous.is_constrained(unknown[i])) continue;
      done[k] = true;
      for (unsigned int j = 0; j < n; ++j) {
        const double share = to_child ? (*to_child)(i, j) : (i == j ? 1 : 0);
        if (share == 0) continue;
        for (const Term& term : terms[j]) rows[k][term.unknown] += share * term.weight;
      }
    }
  };
  d.mesh.notify_ready_to_unpack(handle_, [&](const auto& cell, const auto, const auto& data) {
    const Terms terms = unpacked(&*data.begin(), n);
    if (!cell->has_children()) return add_cell(cell, terms, nullptr);
    for (unsigned int child = 0; child < cell->n_children(); ++child)
      add_cell(cell->child(child), terms, &d.elements.get_prolongation_matrix(child));
  });
  return {matrix_of(rows, free_.size(), d.mesh.get_communicator()), is_pressure_};
}

SharedMatrix NestingRecord::free_rows(const SharedMatrix& finer) const {
  IS rows = nullptr;
  check(ISCreateGeneral(PetscObjectComm(reinterpret_cast<PetscObject>(finer.get())),
                        static_cast<PetscInt>(free_.size()), free_.data(), PETSC_USE_POINTER, &rows),
        "choose rows");
  Mat chosen = nullptr;
  const auto code = MatCreateSubMatrix(finer.get(), rows, nullptr, MAT_INITIAL_MATRIX, &chosen);
  ISDestroy(&rows);
  check(code, "choose rows");
  return shared(chosen);
}

}  // namespace drumlin::continuum::fem
