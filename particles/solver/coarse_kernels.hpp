#pragma once
// The inner loops of the coarse correction (particles/solver/coarse_loads.hpp), on vectors: the same numbers
// on any processor, as in sweep_kernels.hpp.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "particles/solver/coarse_field.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// What the field knows of bodies, one record for each of theirs.
///
/// v_k, what the impulses weighted by the hat phi_k do to a body, is phi_k V + d_x phi_k S_x + d_z phi_k S_z:
/// V its velocity change; S_x and S_z the changes by the contacts of which it is the second body, each times
/// how far to the right of it, and above it, the contact is. Contacts are where their first bodies are; phi_k
/// counts as linear between the two.
template <class T>
struct CoarseBodies {
  BodyRecord<T>*
      at;  ///< x, z: position in edges of the field; s: power of the contacts it is the first body of
  BodyRecord<T>* along_x;  ///< S_x
  BodyRecord<T>* along_z;  ///< S_z
};

/// The memory of CoarseBodies, in single or double precision, as the sweeps have it.
template <template <class> class Array>
class CoarseRecords {
 public:
  template <class T>
  struct Of {
    Array<BodyRecord<T>> at, along_x, along_z;

    CoarseBodies<T> bodies() { return {at.data(), along_x.data(), along_z.data()}; }
    void make(std::size_t count) {
      for (auto* of_bodies : {&at, &along_x, &along_z}) of_bodies->assign(count, {});
    }
    void place(std::size_t b, double x, double z, const FieldGrid& grid) {
      at[b].x = static_cast<T>((x - grid.x) / grid.edge), at[b].z = static_cast<T>((z - grid.z) / grid.edge);
    }
    /// Bodies begin to end - 1 have powers and moves of none.
    void rest(std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) at[b].s = 0, along_x[b] = along_z[b] = {};
    }
    /// Factors of the field take the place of powers.
    void set_factors(std::size_t begin, std::size_t end, const FieldGrid& grid,
                     std::span<const double> field) {
      for (std::size_t b = begin; b < end; ++b)
        at[b].s = static_cast<T>(factor_at(grid, at[b].x, at[b].z, field));
    }
  };
  template <class T>
  Of<T>& of() {
    if constexpr (sizeof(T) == sizeof(float))
      return in_single_;
    else
      return in_double_;
  }
  template <class Memory>
  void use(Memory* memory) {
    const auto lend = [memory](auto& own) {
      for (auto* of_bodies : {&own.at, &own.along_x, &own.along_z}) of_bodies->use(memory);
    };
    lend(in_single_), lend(in_double_);
  }

 private:
  Of<float> in_single_;
  Of<double> in_double_;
};

/// What up to eight bodies add to the matrix and the right side, at the nodes of the cells in which they are.
template <class T>
struct CoarseTerms {
  static constexpr std::size_t width = 8;
  using Numbers = std::array<T, width>;
  alignas(64) std::array<Numbers, 10> energies;  ///< m v_k . v_l of the pairs (k, l) of `pairs`
  alignas(64) std::array<Numbers, 4> powers;     ///< phi_k times the power
  void add(const CoarseTerms& more) {
    for (std::size_t p = 0; p < energies.size(); ++p)
      for (std::size_t b = 0; b < width; ++b) energies[p][b] += more.energies[p][b];
    for (std::size_t k = 0; k < powers.size(); ++k)
      for (std::size_t b = 0; b < width; ++b) powers[k][b] += more.powers[k][b];
  }
  /// Corners of a cell from left to right and then up.
  struct Pair {
    int k, l, entry;  ///< entry: of the row of k (coarse_field.hpp)
  };
  static constexpr std::array<Pair, 10> pairs{{{0, 0, 0},
                                               {1, 1, 0},
                                               {2, 2, 0},
                                               {3, 3, 0},
                                               {0, 1, 1},
                                               {2, 3, 1},
                                               {1, 2, 2},
                                               {0, 2, 3},
                                               {1, 3, 3},
                                               {0, 3, 4}}};
};

/// `bodies`: of one problem, as they stand.
template <class T>
CoarseTerms<T> coarse_terms(const FieldGrid&, const BodyRecord<T>* bodies, const CoarseBodies<T>&,
                            std::size_t first, std::size_t count);

/// Calls visit(terms, cells) for what `count` bodies from `first` on add to the matrix and to the right side,
/// up to eight at a time; `cells` of the bodies of the terms.
template <class T, class Visit>
void each_coarse_terms(const FieldGrid& grid, const BodyRecord<T>* bodies, const CoarseBodies<T>& coarse,
                       std::size_t first, std::size_t count, Visit visit) {
  constexpr std::size_t width = CoarseTerms<T>::width;
  std::array<int, width> cells{};
  for (std::size_t begin = first, end = first + count; begin < end; begin += width) {
    const std::size_t some = std::min(width, end - begin);
    for (std::size_t b = 0; b < some; ++b)
      cells[b] = grid.cell_at(coarse.at[begin + b].x, coarse.at[begin + b].z);
    visit(coarse_terms(grid, bodies, coarse, begin, some), std::span(cells).first(some));
  }
}

/// Calls energy(node, entry, value) and power(node, value) for the terms of body b in a cell.
template <class T, class Energy, class Power>
void each_coarse_term(const FieldGrid& grid, const CoarseTerms<T>& terms, std::size_t b, int cell,
                      Energy energy, Power power) {
  for (std::size_t p = 0; p < terms.pairs.size(); ++p)
    energy(grid.corner(cell, terms.pairs[p].k), terms.pairs[p].entry, terms.energies[p][b]);
  for (int k = 0; k < 4; ++k) power(grid.corner(cell, k), terms.powers[k][b]);
}

template <class T, class Law, bool spin>
struct CoarseKernels {
  using Block = ContactBlock<T, Law>;
  /// Adds what contacts do to S_x, S_z and powers.
  static void add_contacts(const Block* blocks, std::size_t count, const BodyRecord<T>* bodies,
                           const CoarseBodies<T>&);
  /// Multiplies impulses by the factors that stand for the first bodies in place of powers; momentum rests.
  static void scale(Block* blocks, std::size_t count, const BodyRecord<T>* factors);
};

}  // namespace drumlin::particles
